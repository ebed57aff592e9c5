#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "storage/file/checksum.h"
#include "storage/http/reply_head.h"

namespace planetree::storage {

/// Which object a URL named when it was opened. Bytes of two objects are never mixed.
struct ObjectIdentity {
  std::string url;
  std::string etag;           ///< see ReplyHead::etag(); empty: the server gives none
  std::string last_modified;  ///< likewise
  std::uint64_t size_bytes = 0;

  /// Whether the server says by which a later object could be told from this one.
  bool has_validator() const noexcept { return !etag.empty() || !last_modified.empty(); }
  /// Whether the entity tag stands for equal bytes. A weak one does not.
  bool has_strong_etag() const noexcept { return etag.starts_with(kQuote); }
  /// Whether a reply is one of another object.
  bool differs(const ReplyHead& head) const noexcept {
    if (head.range() && head.range()->total != size_bytes) return true;
    if (!etag.empty() || !head.etag().empty()) return head.etag() != etag;
    return head.last_modified() != last_modified;
  }
  /// Hash of all of it, without what follows `?` in the URL: signatures of requests are there.
  Hash128 key() const;
};

}  // namespace planetree::storage
