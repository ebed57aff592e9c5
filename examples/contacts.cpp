// Where a ball touches a model, one contact for each wall of a groove, and the force on it.
//
// contacts MODEL.ptree
//   Lowers a ball onto the middle of the model's top, lets it sink in by a twentieth of its radius,
//   and moves it in a circle. Each contact pushes the ball along its normal, by a spring. The
//   program tells how many contacts there are at a time, and how many of them keep their face, edge
//   or vertex from one place to the next.

#include <planetree/planetree.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <vector>

using planetree::ClosestPoint;
using planetree::Vec3;

namespace {

constexpr int kPlaces = 2000;
constexpr std::size_t kMaxContacts = 8;

Vec3 sum(const Vec3& a, const Vec3& b, double times) {
  return {a.x + b.x * times, a.y + b.y * times, a.z + b.z * times};
}
double length(const Vec3& a) { return std::sqrt(a.x * a.x + a.y * a.y + a.z * a.z); }

// The place of the ball's centre where a ball that falls from above first touches the model.
Vec3 place_to_rest(planetree::Probe& probe, const planetree::ModelInfo& info, const Vec3& over,
                   double radius) {
  const Vec3 from{over.x, over.y, info.core_upper.z + 2 * radius};
  const Vec3 to{over.x, over.y, info.core_lower.z - 2 * radius};
  const planetree::FirstContact contact = probe.first_contact({from, to, radius});
  return sum(from, sum(to, from, -1), std::min(contact.t_lower, 1.0));
}

// A contact moves smoothly while it is on the same face, edge or vertex.
bool is_same(const ClosestPoint& a, const ClosestPoint& b) {
  return a.triangle == b.triangle && a.feature == b.feature;
}

struct Report {
  std::array<int, kMaxContacts + 1> places_by_contacts{};
  int contacts = 0, kept = 0;
  double strongest = 0;

  void add(const std::vector<ClosestPoint>& now, const std::vector<ClosestPoint>& before,
           double force) {
    ++places_by_contacts[now.size()];
    contacts += static_cast<int>(now.size());
    for (const ClosestPoint& contact : now)
      kept += std::any_of(before.begin(), before.end(),
                          [&](const ClosestPoint& other) { return is_same(contact, other); });
    strongest = std::max(strongest, force);
  }
  void print() const {
    for (std::size_t count = 0; count < places_by_contacts.size(); ++count)
      if (places_by_contacts[count] > 0)
        std::printf("%4d places with %zu contacts\n", places_by_contacts[count], count);
    std::printf("%d contacts, of which %d are on the same face, edge or vertex as before\n",
                contacts, kept);
    std::printf("strongest force %.4g\n", strongest);
  }
};

Report run(planetree::Probe& probe, const planetree::ModelInfo& info) {
  const Vec3 size = sum(info.core_upper, info.core_lower, -1);
  const Vec3 middle = sum(info.core_lower, size, 0.5);
  const double radius = 0.03 * length(size);
  planetree::QueryOptions options;
  options.normal_rule = planetree::NormalRule::kTowardQuery;  // forces push the ball out again
  options.max_error = 1e-6 * length(size);                    // scans are not smooth

  std::vector<ClosestPoint> before, now;
  Report report;
  for (int i = 0; i < kPlaces; ++i) {
    const double angle = 6.283185307179586 * i / kPlaces;
    const Vec3 over = sum(middle, {std::cos(angle), std::sin(angle), 0}, 0.5 * radius);
    const Vec3 centre = sum(place_to_rest(probe, info, over, radius), {0, 0, -1}, 0.05 * radius);
    now.resize(kMaxContacts);
    now.resize(probe.contacts(centre, radius, now, options).count);
    Vec3 force;
    for (const ClosestPoint& contact : now)
      force = sum(force, contact.normal, radius - contact.distance);
    report.add(now, before, length(force));
    before.swap(now);
  }
  return report;
}

int fail(const char* what, const planetree::Error& error) {
  std::fprintf(stderr, "contacts: %s: %s\n", what, error.text);
  return 1;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: contacts MODEL.ptree\n");
    return 2;
  }
  const auto model = planetree::Model::open(argv[1]);
  if (!model) return fail(argv[1], model.error());
  auto probe = planetree::Probe::create(*model);
  if (!probe) return fail("probe", probe.error());
  const Report report = run(*probe, model->info());
  report.print();
  return report.contacts > 0 ? 0 : 1;
}
