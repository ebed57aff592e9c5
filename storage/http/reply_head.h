#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace planetree::storage {

/// The quotation mark around an entity tag.
inline constexpr char kQuote = 0x22;

/// A Content-Range field: `bytes FIRST-LAST/TOTAL`.
struct ContentRange {
  std::uint64_t first = 0;
  std::uint64_t last = 0;   ///< at least `first`, below `total`
  std::uint64_t total = 0;  ///< length of the object

  /// Returns what a field says; empty unless it has this form and all three numbers.
  [[nodiscard]] static std::optional<ContentRange> parse(std::string_view value) noexcept;
};

/// What a server says before the bytes of a reply. A server may send anything: fields that are
/// malformed, or longer than kMaxFieldBytes, count as absent.
class ReplyHead {
 public:
  static constexpr std::size_t kMaxFieldBytes = 256;

  /// Takes one line, with or without its end. A status line starts a new head, as after a redirect.
  ///
  /// throws  std::bad_alloc
  void add_line(std::string_view line);

  int status() const noexcept { return status_; }  ///< 0 before a status line
  /// The entity tag with its quotes, also a weak one (`W/"..."`). Empty: none.
  const std::string& etag() const noexcept { return etag_; }
  const std::string& last_modified() const noexcept { return last_modified_; }
  const std::optional<ContentRange>& range() const noexcept { return range_; }
  /// Whether the bytes are encoded, as by gzip, so that ranges of them are not those of the object.
  bool is_encoded() const noexcept { return is_encoded_; }
  /// Seconds that the server asks to wait before the next attempt; 0: it does not say.
  unsigned retry_after_seconds() const noexcept { return retry_after_seconds_; }

 private:
  int status_ = 0;
  std::string etag_;
  std::string last_modified_;
  std::optional<ContentRange> range_;
  bool is_encoded_ = false;
  unsigned retry_after_seconds_ = 0;
};

}  // namespace planetree::storage
