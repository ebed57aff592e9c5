// Haptics in six degrees of freedom, without the device: a box of a thousand points, 1000 ticks a
// second.
//
// point_shell MODEL.ptree [MEMORY_MIB [TICKS]]
//   The device holds a box by a spring, turns it, pushes it into the top of the model and draws it
//   in circles. Points of the box that are inside the model push it out again. So the box rests on
//   the surface and follows it, while the device is below: this is virtual coupling (Colgate,
//   Stanley and Brown, 1995), here without inertia. The device feels the spring.

#include <planetree/planetree.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <thread>
#include <vector>

using planetree::Pose;
using planetree::Quaternion;
using planetree::ShellPoint;
using planetree::Vec3;
using planetree::Wrench;

namespace {

using Clock = std::chrono::steady_clock;
constexpr std::chrono::microseconds kPeriod(1000);
constexpr double kTicksPerSecond = 1e6 / static_cast<double>(kPeriod.count());
constexpr int kEdgePoints = 13;  // along each edge of a face of the box: 6 * 13 * 13 points

Vec3 sum(const Vec3& a, const Vec3& b, double times) {
  return {a.x + b.x * times, a.y + b.y * times, a.z + b.z * times};
}
double length(const Vec3& a) { return std::sqrt(a.x * a.x + a.y * a.y + a.z * a.z); }

Quaternion product(const Quaternion& a, const Quaternion& b) {
  return {
      a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z, a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y,
      a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x, a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w};
}
// The rotation turned further by a small angle about an axis: `turn` is the axis times the angle.
Quaternion turned(const Quaternion& rotation, const Vec3& turn) {
  const Quaternion q = product({1, 0.5 * turn.x, 0.5 * turn.y, 0.5 * turn.z}, rotation);
  const double size = std::sqrt(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z);
  return {q.w / size, q.x / size, q.y / size, q.z / size};
}
// The small turn, axis times angle, from one rotation to another.
Vec3 turn_between(const Quaternion& from, const Quaternion& to) {
  const Quaternion q = product(to, {from.w, -from.x, -from.y, -from.z});
  const double factor = q.w < 0 ? -2 : 2;
  return {factor * q.x, factor * q.y, factor * q.z};
}

// The surface of a box with these half lengths of its edges. Points lie in the middle of the cells
// of a grid, with normals into the box.
std::vector<ShellPoint> box_shell(const Vec3& half) {
  std::vector<ShellPoint> points;
  for (const int axis : {0, 1, 2})
    for (const double side : {-1.0, 1.0})
      for (int i = 0; i < kEdgePoints; ++i)
        for (int j = 0; j < kEdgePoints; ++j) {
          const double at[] = {side, (2 * i + 1.0) / kEdgePoints - 1,
                               (2 * j + 1.0) / kEdgePoints - 1};
          const auto of = [&](int other) { return at[(other - axis + 3) % 3]; };
          const auto into = [&](int other) { return other == axis ? -side : 0.0; };
          points.push_back(
              {{half.x * of(0), half.y * of(1), half.z * of(2)}, {into(0), into(1), into(2)}});
        }
  return points;
}

double percentile(std::vector<double> values, double share) {
  const auto at = static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + at, values.end());
  return values[static_cast<std::size_t>(at)];
}

// What a session counted.
struct Report {
  int late = 0, woken_late = 0, touching = 0, degraded = 0;
  double strongest = 0, widest = 0;
  std::size_t contacts = 0, queries = 0;
  Wrench last;
  std::vector<double> microseconds;

  void add(const Wrench& wrench, Clock::time_point due, Clock::time_point begun) {
    const auto now = Clock::now();
    const bool is_late = now - due > kPeriod;
    late += is_late;
    // The machine was busy, if half of the time was over when the thread woke.
    woken_late += is_late && begun - due > kPeriod / 2;
    touching += wrench.contacts > 0;
    degraded += wrench.status != planetree::Status::kExact;
    strongest = std::max(strongest, length(wrench.force));
    widest = std::max(widest, wrench.force_error);
    contacts = std::max(contacts, wrench.contacts);
    queries += wrench.queries;
    if (wrench.contacts > 0) last = wrench;
    microseconds.push_back(std::chrono::duration<double, std::micro>(now - begun).count());
  }
  void print(std::size_t points) const {
    const std::size_t ticks = microseconds.size();
    std::printf("%zu ticks of %zu points: %d with contact, %d degraded\n", ticks, points, touching,
                degraded);
    std::printf("%d late, %d of them since the thread woke late\n", late, woken_late);
    std::printf("a tick takes %.1f us (p50), %.1f us (p99.9), and %.1f queries\n",
                percentile(microseconds, 0.5), percentile(microseconds, 0.999),
                static_cast<double>(queries) / static_cast<double>(ticks));
    std::printf("strongest force %.4g, at most %zu contacts, widest error %.3g\n", strongest,
                contacts, widest);
    std::printf("last contact: force %.6g %.6g %.6g +- %.2g, torque %.6g %.6g %.6g +- %.2g\n",
                last.force.x, last.force.y, last.force.z, last.force_error, last.torque.x,
                last.torque.y, last.torque.z, last.torque_error);
  }
};

struct Tool {
  const planetree::PointShell& shell;
  planetree::PointShellState& state;
  double size;  // model units
};

// Lowers the box over the middle of the model's top while it is certainly free.
Pose start(const planetree::ModelInfo& info, planetree::Probe& probe, const Tool& tool) {
  Vec3 at = sum(info.core_lower, sum(info.core_upper, info.core_lower, -1), 0.5);
  at.z = info.core_upper.z + 2 * tool.size;
  for (int i = 0; i < 1000; ++i) {
    const double free =
        probe.closest_point(at, {.parts = planetree::kDistance}).lower - 2 * tool.size;
    if (free < 0.01 * tool.size) break;
    at.z -= free;
  }
  return {{}, at};
}

Report run(planetree::Probe& probe, const Tool& tool, Pose device, int ticks) {
  const double step = 0.002 * tool.size;  // that the device moves in a tick
  const double points = static_cast<double>(tool.shell.size());
  const double spring = 0.05 * points;  // force per length that holds the box, and of a point: 1
  const double mobility = 1 / points;   // so small that no number of contacts makes it swing
  planetree::ShellOptions options;
  options.wait = planetree::Wait::kNever;
  options.margin = 0.01 * tool.size;
  options.max_depth = tool.size;

  std::vector<planetree::ShellContact> contacts(1);
  Vec3 last = device.translation;
  Report report;
  report.microseconds.reserve(static_cast<std::size_t>(ticks));
  Pose box = device;
  bool is_down = false;
  auto due = Clock::now();
  for (int tick = 0; tick < ticks; ++tick) {
    std::this_thread::sleep_until(due += kPeriod);
    const auto begun = Clock::now();
    const Wrench wrench = tool.shell.wrench(probe, tool.state, box, options, contacts);
    report.add(wrench, due, begun);

    // Pages are read ahead of the first contact that was found, or of the box.
    const Vec3 touched = wrench.contacts > 0 ? contacts[0].position : box.translation;
    probe.motion(touched, sum({}, sum(box.translation, last, -1), kTicksPerSecond));
    last = box.translation;

    // The device presses with a force that stretches the spring so far, and moves in circles.
    const Vec3 stretch = sum(device.translation, box.translation, -1);
    const bool is_pressing = length(stretch) > 0.2 * tool.size;
    const double angle = is_down ? 0.001 * tick : 0;
    is_down = is_down || is_pressing;
    Vec3 way{0, 0, is_pressing ? step : -step};
    if (is_down) way = sum(way, {std::cos(angle), std::sin(angle), 0}, step);
    device.translation = sum(device.translation, way, 1);
    device.rotation = turned(device.rotation, {0, 0.0003, 0.001});

    // The box gives way to the spring and to the contacts.
    const Vec3 twist = turn_between(box.rotation, device.rotation);
    const double arm2 = tool.size * tool.size;
    box.translation = sum(box.translation, sum(wrench.force, stretch, spring), mobility);
    box.rotation = turned(box.rotation,
                          sum(sum({}, wrench.torque, mobility / arm2), twist, spring * mobility));
  }
  return report;
}

int fail(const char* what, const planetree::Error& error) {
  std::fprintf(stderr, "point_shell: %s: %s\n", what, error.text);
  return 1;
}

}  // namespace

int main(int argc, char** argv) {
  const int memory_mib = argc > 2 ? std::atoi(argv[2]) : 16;
  const int ticks = argc > 3 ? std::atoi(argv[3]) : 2000;
  if (argc < 2 || argc > 4 || memory_mib <= 0 || ticks <= 0) {
    std::fprintf(stderr, "usage: point_shell MODEL.ptree [MEMORY_MIB [TICKS]]\n");
    return 2;
  }
  planetree::OpenOptions options;
  options.memory_budget_bytes = static_cast<std::uint64_t>(memory_mib) << 20;
  const auto model = planetree::Model::open(argv[1], options);
  if (!model) return fail(argv[1], model.error());
  auto probe = planetree::Probe::create(*model);
  if (!probe) return fail("probe", probe.error());

  const planetree::ModelInfo& info = model->info();
  const double size = 0.02 * length(sum(info.core_upper, info.core_lower, -1));
  const std::vector<ShellPoint> points = box_shell({size, 0.6 * size, 0.4 * size});
  const auto shell = planetree::PointShell::create(points);
  if (!shell) return fail("shell", shell.error());
  auto state = planetree::PointShellState::create(*shell, *model);
  if (!state) return fail("state", state.error());

  const Tool tool{*shell, *state, size};
  const Report report = run(*probe, tool, start(info, *probe, tool), ticks);
  report.print(points.size());
  return report.touching > 0 ? 0 : 1;
}
