#include "storage/http/range_reply.h"

#include <algorithm>
#include <cinttypes>
#include <cstring>

namespace planetree::storage {
namespace {

// Maximum number of bytes that are read of an error page, so that its connection can be kept.
constexpr std::uint64_t kMaxIgnored = 16384;

constexpr int kPartialContent = 206;

Error reply_error(ErrorCode code, std::uint64_t offset, const char* text) noexcept {
  return make_error(code, Error::kNowhere, offset, "%s", text);
}

}  // namespace

bool RangeReply::add(std::span<const std::byte> bytes) noexcept {
  if (head_.status() != kPartialContent) {
    ignored_ += bytes.size();
    return head_.status() != 200 && ignored_ <= kMaxIgnored;
  }
  std::uint64_t before = 0;  // bytes of the parts so far
  for (const std::span<std::byte> part : request_->parts) {
    if (bytes.empty()) break;
    if (received_ < before + part.size()) {
      const auto at = static_cast<std::size_t>(received_ - before);
      const std::size_t count = std::min(part.size() - at, bytes.size());
      std::memcpy(part.data() + at, bytes.data(), count);
      received_ += count;
      bytes = bytes.subspan(count);
    }
    before += part.size();
  }
  is_too_long_ = !bytes.empty();
  return !is_too_long_;
}

std::uint64_t RangeReply::expected_bytes() const noexcept {
  // The first request may ask for more than there is.
  const std::uint64_t left =
      head_.range()->total - std::min(request_->offset, head_.range()->total);
  return identity_ ? request_->bytes() : std::min(request_->bytes(), left);
}

AttemptOutcome RangeReply::judge(const char* failure, bool is_final, Error& why) const noexcept {
  const int status = head_.status();
  if (status != 0 && status != kPartialContent) return judge_status(why);
  if (status == kPartialContent) {
    if (identity_ && identity_->differs(head_)) return AttemptOutcome::kChanged;
    const AttemptOutcome outcome = judge_range(why);
    if (outcome != AttemptOutcome::kDone) return outcome;
    if (received_ == expected_bytes() && !is_too_long_) return AttemptOutcome::kDone;
  }
  why = make_error(ErrorCode::kReadFailed, Error::kNowhere, request_->offset,
                   "the server cannot be read: %s; check the URL and the network",
                   failure ? failure : "its reply is shorter or longer than it says");
  return is_final ? AttemptOutcome::kFailed : AttemptOutcome::kRetry;
}

AttemptOutcome RangeReply::judge_range(Error& why) const noexcept {
  if (head_.is_encoded()) {
    why =
        reply_error(ErrorCode::kUnsupported, request_->offset,
                    "the server encodes the file, as by gzip; let it serve the bytes as they are");
    return AttemptOutcome::kFailed;
  }
  const auto& range = head_.range();
  if (range && range->first == request_->offset &&
      range->last - range->first + 1 == expected_bytes())
    return AttemptOutcome::kDone;
  why = reply_error(ErrorCode::kReadFailed, request_->offset,
                    "the server sent another range than it was asked for; check the server and "
                    "the proxies before it");
  return AttemptOutcome::kRetry;
}

AttemptOutcome RangeReply::judge_status(Error& why) const noexcept {
  const int status = head_.status();
  const auto says = [&](ErrorCode code, const char* cause, const char* remedy) {
    why = make_error(code, Error::kNowhere, request_->offset, "the server %s (status %d); %s",
                     cause, status, remedy);
  };
  switch (status) {
    case 200:
      // With If-Match, a server that ignores ranges sends a changed object whole.
      if (identity_ && identity_->differs(head_)) return AttemptOutcome::kChanged;
      says(ErrorCode::kUnsupported, "sends whole files, not ranges",
           "use a server that serves ranges of bytes, or download the file");
      return AttemptOutcome::kFailed;
    case 401:
    case 403:
      says(ErrorCode::kPermission, "refuses access", "check the URL and its signature");
      return AttemptOutcome::kFailed;
    case 404:
    case 410:
      says(ErrorCode::kNotFound, "has no such file", "check the URL");
      return AttemptOutcome::kFailed;
    case 412:
      if (identity_) return AttemptOutcome::kChanged;
      break;
    case 416:
      if (identity_) return AttemptOutcome::kChanged;
      says(ErrorCode::kNotPlanetree, "has an empty file", "check the URL");
      return AttemptOutcome::kFailed;
    default:
      break;
  }
  says(ErrorCode::kReadFailed, "does not give the file", "check the server and try again later");
  const bool may_pass = status == 408 || status == 425 || status == 429 || status >= 500;
  return may_pass ? AttemptOutcome::kRetry : AttemptOutcome::kFailed;
}

}  // namespace planetree::storage
