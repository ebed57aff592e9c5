#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace planetree::explorer {

/// What happened in one run, to be read when it went wrong.
class Trace {
 public:
  /// `what` is kept by address: a literal.
  struct Line {
    std::uint32_t thread;
    const char* what;
    std::uint64_t number;  ///< of the atomic or plain variable; or any, with a note
    std::uint64_t value;
    const char* how;  ///< the memory order, or nullptr: then there is no value
    std::uint64_t newer_stores;
  };

  void clear() noexcept { lines_.clear(); }
  void add(const Line& line) { lines_.push_back(line); }

  /// One line each; atomics are numbered in the order they were made.
  std::string text() const;

 private:
  std::vector<Line> lines_;
};

}  // namespace planetree::explorer
