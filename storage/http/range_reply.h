#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "planetree/error.h"
#include "storage/http/object_identity.h"
#include "storage/http/range_client.h"
#include "storage/http/reply_head.h"

namespace planetree::storage {

/// What became of one attempt of a request.
enum class AttemptOutcome : std::uint8_t {
  kDone,     ///< the bytes are there
  kRetry,    ///< another attempt may succeed
  kFailed,   ///< another attempt would fail as well
  kChanged,  ///< the server has another object now
};

/// Takes the reply to a request for a range: its head, then its bytes, which go into the parts of
/// the request. Checks that they are those that were asked for.
class RangeReply {
 public:
  /// request   must outlive this
  /// identity  of the object; null: this is the first request, which learns it
  RangeReply(const RangeRequest& request, const ObjectIdentity* identity) noexcept
      : request_(&request), identity_(identity) {}

  void add_line(std::string_view line) { head_.add_line(line); }
  /// Takes bytes of the reply. Returns false if no more are wanted: the reply is no range, or it
  /// is too long.
  bool add(std::span<const std::byte> bytes) noexcept;

  /// Judges the reply after its end.
  ///
  /// failure  why the transfer failed, as a phrase; null: it did not
  /// is_final the failure would be the same again
  /// why      set unless the outcome is kDone
  AttemptOutcome judge(const char* failure, bool is_final, Error& why) const noexcept;

  const ReplyHead& head() const noexcept { return head_; }
  std::uint64_t received() const noexcept { return received_; }

 private:
  AttemptOutcome judge_status(Error& why) const noexcept;
  AttemptOutcome judge_range(Error& why) const noexcept;
  std::uint64_t expected_bytes() const noexcept;

  const RangeRequest* request_;
  const ObjectIdentity* identity_;
  ReplyHead head_;
  std::uint64_t received_ = 0;  // bytes in the parts
  std::uint64_t ignored_ = 0;   // bytes of a reply that is no range
  bool is_too_long_ = false;
};

}  // namespace planetree::storage
