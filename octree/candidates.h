#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>

#include "octree/frontier.h"

namespace planetree::octree {

/// A triangle that float cannot rule out: to be evaluated in double once nothing
/// nearer is likely to be found.
struct Candidate {
  FrontierEntry block;
  std::uint32_t index;  ///< within the block
  float extent;         ///< of the block
  float squared;        ///< filter value, see octree/bounds.h
};

/// A short list of them.
class Candidates {
 public:
  bool full() const { return size_ == kMost; }
  void add(const Candidate& candidate) { list_[size_++] = candidate; }

  /// Drops those for which `still` is false.
  template <class Still>
  void keep_if(Still still) {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < size_; ++i)
      if (still(list_[i])) list_[kept++] = list_[i];
    size_ = kept;
  }

  /// Calls judge(candidate) for all, the one of least filter value first, and forgets them.
  template <class Judge>
  void settle(Judge judge) {
    std::size_t least = 0;
    for (std::size_t i = 1; i < size_; ++i)
      least = list_[i].squared < list_[least].squared ? i : least;
    if (size_ > 0) std::swap(list_[0], list_[least]);
    for (std::size_t i = 0; i < size_; ++i) judge(list_[i]);
    size_ = 0;
  }

 private:
  static constexpr std::size_t kMost = 32;
  std::size_t size_ = 0;
  Candidate list_[kMost];
};

}  // namespace planetree::octree
