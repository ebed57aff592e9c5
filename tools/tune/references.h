#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "cache/policy/policy_tables.h"

namespace planetree::tools {

/// The page lookups of a trace in order, in a form that is fast to replay.
///
/// Pages are numbered from 0 in the order of their first lookups. Page 0 of the file is pinned in
/// the engine, so that its lookups always hit and change no policy: they are counted, not stored.
/// Of a run of lookups of one page, kMaxRun are stored. No policy distinguishes further ones
/// without another lookup in between. So misses are those of the whole sequence, to the unit.
class References {
 public:
  static constexpr std::uint32_t kMaxRun = 5;
  static constexpr std::uint32_t kRootPage = 0;
  static constexpr std::uint32_t kNoNumber = ~std::uint32_t{0};

  /// What is known of a page.
  struct Page {
    std::uint32_t file_page;  ///< its number in the file
    cache::PageTier tier;
  };

  /// Begins a query. The lookups until the next are its own.
  void begin_query() { query_begins_.push_back(static_cast<std::uint32_t>(stored_.size())); }
  /// Adds a lookup.
  void add(std::uint32_t file_page);
  /// States that a page links to other pages. Until then it counts as a lower page.
  void set_upper(std::uint32_t file_page);
  /// Ends what the model looked up while it was opened. Pages looked up so far are resident at the
  /// beginning, if they fit, and their lookups are not counted.
  void end_opening();

  /// Numbers of the pages looked up.
  std::span<const std::uint32_t> stored() const { return stored_; }
  /// For each query the position in stored() of its first lookup, if it has any.
  std::span<const std::uint32_t> query_begins() const { return query_begins_; }
  /// Number of elements of stored() that the model looked up while it was opened.
  std::size_t opening() const { return opening_; }
  /// What is counted: all lookups but those of the opening.
  std::uint64_t lookups() const { return lookups_; }
  /// Pages but the root, by number.
  const std::vector<Page>& pages() const { return pages_; }
  /// The root's tier: kUpper if it links to other pages.
  cache::PageTier root_tier() const { return root_tier_; }
  /// Number of a page of the file, or kNoNumber if it is the root or was not looked up.
  std::uint32_t number_of(std::uint32_t file_page) const {
    return file_page < numbers_.size() ? numbers_[file_page] : kNoNumber;
  }
  /// Number of frames that hold all pages that were looked up, the root's included.
  std::uint32_t footprint() const { return static_cast<std::uint32_t>(pages_.size()) + 1; }
  /// The lookups of a sample of the pages: of the pages ordered by their stored lookups, one in
  /// `step`, so that it has its share of those that are looked up often.
  ///
  /// group  which of the `step` disjoint samples
  References sampled(std::uint32_t step, std::uint32_t group = 0) const;

  /// Number of pages whose first lookup is counted: misses of a cache of any size.
  std::uint64_t compulsory() const { return pages_.size() - opening_pages_; }

 private:
  std::vector<std::uint32_t> stored_;
  std::vector<Page> pages_;
  std::vector<std::uint32_t> numbers_;  // by page of the file
  std::vector<bool> is_upper_;          // by page of the file
  std::vector<std::uint32_t> query_begins_;
  std::uint64_t lookups_ = 0;
  std::size_t opening_ = 0;
  std::size_t opening_pages_ = 0;
  std::uint32_t run_ = 0;
  cache::PageTier root_tier_ = cache::PageTier::kLower;
};

}  // namespace planetree::tools
