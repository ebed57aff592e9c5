// Compares real-time answers with those of blocking queries.
// usage: check_real_time MODEL.ptree [QUERIES]
//
// Runs budgets of 5, 10, 25 and 50 % of the memory of the whole model (of a small model, those that
// it opens with), each motion of a tip, and a disk that is healthy, stalls or fails, while another
// probe causes pages to be read and evicted. Every interval must hold the true distance, and an
// exact answer must have the bits of the exact one. Exit status 1 if any answer is wrong.

#include <atomic>
#include <cerrno>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include "planetree/model.h"
#include "planetree/probe.h"
#include "query/model_state.h"
#include "tests/oracle/limited_queries.h"
#include "tools/session/session_path.h"

namespace planetree::oracle {
namespace {

using tools::TouchMotion;

struct Count {
  std::size_t queried = 0, degraded = 0, wrong = 0;
};

enum class Health { kWell, kStalls, kFails };
constexpr Health kAllHealths[] = {Health::kWell, Health::kStalls, Health::kFails};

const char* name_of(Health health) {
  return health == Health::kWell ? "well" : health == Health::kStalls ? "stalls" : "fails";
}

// A disk that, once hindered, has no bytes in the system's memory; in one of every kEvery stretches
// its reads stall or fail.
class Disk final : public storage::FileCalls {
 public:
  explicit Disk(Health health) : health_(health) {}
  std::atomic<bool> is_hindered{false};

  ssize_t preadv2(int descriptor, const iovec* parts, int part_count, off_t offset,
                  int flags) noexcept override {
    if (!is_hindered) return FileCalls::preadv2(descriptor, parts, part_count, offset, flags);
    errno = EAGAIN;
    return -1;
  }
  ssize_t pread(int descriptor, void* out, std::size_t bytes, off_t offset) noexcept override {
    const bool here = is_hindered && offset / kStretch % kEvery == 1;
    if (here && health_ == Health::kStalls)
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    if (!here || health_ != Health::kFails) return FileCalls::pread(descriptor, out, bytes, offset);
    errno = EIO;
    return -1;
  }

 private:
  static constexpr off_t kStretch = 32 << 10, kEvery = 16;

  const Health health_;
};

// Makes blocking queries of some points at random until it is destroyed.
class Rival {
 public:
  Rival(const Model& model, const std::vector<Vec3>& points)
      : thread_([this, &points, probe = Probe::create(model)]() mutable {
          std::mt19937_64 random(7);
          while (!stops_) probe->closest_point(points[random() % points.size()]);
        }) {}
  ~Rival() {
    stops_ = true;
    thread_.join();
  }
  Rival(const Rival&) = delete;
  Rival& operator=(const Rival&) = delete;

 private:
  std::atomic<bool> stops_{false};
  std::thread thread_;  // last: it uses the members above
};

// Makes no queries if the model does not open with so little memory.
Count check(const std::string& file, std::uint64_t budget_bytes, Health health,
            const std::vector<Vec3>& path, const std::vector<ClosestPoint>& exact) {
  OpenOptions options;
  options.memory_budget_bytes = budget_bytes;
  options.max_probes = 2;
  Disk disk(health);
  const auto model = query::ModelState::open_model(file, options, {disk});
  if (!model && model.error().code == ErrorCode::kNoMemory) return {};
  if (!model) {
    std::fprintf(stderr, "%s: %s\n", file.c_str(), model.error().text);
    std::exit(1);
  }
  auto probe = Probe::create(*model);
  disk.is_hindered = health != Health::kWell;
  const Rival rival(*model, path);
  Count count;
  for (std::size_t i = 0; i < path.size(); ++i) {
    const ClosestPoint answer = probe->closest_point(path[i], {.wait = Wait::kNever});
    ++count.queried;
    count.degraded += answer.status == Status::kDegraded;
    count.wrong += !agrees(answer, exact[i]);
  }
  return count;
}

int run(const std::string& file, std::size_t queries) {
  OpenOptions spacious;
  spacious.memory_budget_bytes = ~std::uint64_t{0} / 2;
  spacious.locking = Locking::kNever;
  const auto model = Model::open(file, spacious);
  if (!model) {
    std::fprintf(stderr, "%s: %s\n", file.c_str(), model.error().text);
    return 1;
  }
  auto probe = Probe::create(*model);
  const std::uint64_t whole = model->stats().arena_bytes + model->stats().table_bytes;
  std::size_t queried = 0, wrong = 0;
  for (const TouchMotion motion : tools::kAllTouchMotions) {
    const std::vector<Vec3> path = tools::touch_path(*model, *probe, motion, queries / 36);
    std::vector<ClosestPoint> exact(path.size());
    probe->closest_points(path, exact);
    for (const Health health : kAllHealths)
      for (const unsigned percent : {5u, 10u, 25u, 50u}) {
        const Count count = check(file, whole * percent / 100, health, path, exact);
        std::printf("%-9s the disk %-7s %3u %% of memory: %zu queries, %zu degraded, %zu wrong\n",
                    name_of(motion), name_of(health), percent, count.queried, count.degraded,
                    count.wrong);
        queried += count.queried;
        wrong += count.wrong;
      }
  }
  if (queried == 0)
    std::fprintf(stderr, "%s: too small to be queried with less memory\n", file.c_str());
  return wrong > 0 || queried == 0;
}

}  // namespace
}  // namespace planetree::oracle

int main(int argc, char** argv) {
  if (argc < 2 || argc > 3) {
    std::fprintf(stderr, "usage: check_real_time MODEL.ptree [QUERIES]\n");
    return 2;
  }
  return planetree::oracle::run(argv[1], argc > 2 ? std::strtoull(argv[2], nullptr, 10) : 1000000);
}
