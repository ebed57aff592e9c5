#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <vector>

#include "planetree/trace.h"

namespace planetree::tools {

/// A set of page numbers.
class PageSet {
 public:
  void insert(std::uint32_t page) {
    if (page / 64 >= words_.size()) words_.resize(page / 64 + 1, 0);
    words_[page / 64] |= std::uint64_t{1} << page % 64;
  }
  void erase(std::uint32_t page) {
    if (page / 64 < words_.size()) words_[page / 64] &= ~(std::uint64_t{1} << page % 64);
  }
  bool contains(std::uint32_t page) const {
    return page / 64 < words_.size() && (words_[page / 64] >> page % 64 & 1) != 0;
  }
  void merge(const PageSet& other);
  std::size_t size() const;

 private:
  std::vector<std::uint64_t> words_;
};

/// What happened in the parts of a trace: windows of equal length, of which there are at most
/// kMaxWindows. They are joined in pairs when the trace is longer than they are.
class TraceTimeline {
 public:
  static constexpr std::size_t kMaxWindows = 96;

  struct Window {
    PageSet looked_up;           ///< pages that queries looked up
    PageSet resident;            ///< pages that were in memory at some time
    std::uint64_t lookups = 0;   ///< by queries
    std::uint64_t misses = 0;    ///< lookups that needed a page that was not in memory
    std::uint64_t degraded = 0;  ///< degraded answers
  };

  /// Adds a record. Times must not descend by more than a window.
  void add(const PageAccess& access);

  const std::vector<Window>& windows() const { return windows_; }
  std::uint64_t window_ns() const { return window_ns_; }
  /// Shares of pages in one of the sets of each window. Pages are ordered by section and octcode
  /// and put together in at most `rows` rows.
  ///
  /// return  0 to 1: row by row, a value for each window
  std::vector<float> shares(PageSet Window::*set, std::size_t rows) const;
  /// Number of different pages.
  std::size_t pages() const { return ordered_.size(); }
  /// Number of rows that shares() makes.
  std::size_t rows(std::size_t most) const;

 private:
  Window& window_at(std::uint64_t time_ns);

  std::uint64_t window_ns_ = 1'000'000;
  std::vector<Window> windows_;
  PageSet resident_;
  // By section and octcode; the ordinal of pages of one octcode is that of their numbers.
  std::map<std::pair<std::uint64_t, std::uint64_t>, std::vector<std::uint32_t>> order_;
  PageSet ordered_;
};

}  // namespace planetree::tools
