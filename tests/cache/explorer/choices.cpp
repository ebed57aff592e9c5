#include "tests/cache/explorer/choices.h"

#include <cassert>

namespace planetree::explorer {

std::uint32_t EveryChoice::decide(std::uint32_t count) {
  if (depth_ == path_.size()) path_.push_back({0, count});
  // Runs that chose the same so far are the same.
  assert(path_[depth_].count == count);
  return path_[depth_++].chosen;
}

bool EveryChoice::next_run() {
  depth_ = 0;
  while (!path_.empty() && path_.back().chosen + 1 == path_.back().count) path_.pop_back();
  if (path_.empty()) return false;
  ++path_.back().chosen;
  return true;
}

std::uint32_t RandomChoice::decide(std::uint32_t count) {
  state_ = state_ * 6364136223846793005u + 1442695040888963407u;
  return static_cast<std::uint32_t>((state_ >> 33) % count);
}

bool RandomChoice::next_run() { return --runs_left_ > 0; }

}  // namespace planetree::explorer
