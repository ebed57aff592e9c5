#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace planetree::explorer {

/// Records the steps of one run, for the report of a failure.
class Trace {
 public:
  /// `what` and `how` are kept by address: string literals.
  struct Line {
    std::uint32_t thread;
    const char* what;
    std::uint64_t number;  ///< index of the atomic or plain variable; in a note, any number
    std::uint64_t value;
    const char* how;  ///< memory order, or nullptr: the line has no value then
    std::uint64_t newer_stores;
  };

  void clear() noexcept { lines_.clear(); }
  void add(const Line& line) { lines_.push_back(line); }

  /// One line a step; atomics are numbered in the order of their creation.
  std::string text() const;

 private:
  std::vector<Line> lines_;
};

}  // namespace planetree::explorer
