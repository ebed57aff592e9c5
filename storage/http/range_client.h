#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <vector>

#include "planetree/error.h"
#include "storage/http/http_options.h"
#include "storage/http/object_identity.h"

namespace planetree::storage {

/// One range to get from a server.
struct RangeRequest {
  std::uint64_t offset = 0;
  /// Where the bytes go, one part after the other. The range is as long as all parts.
  std::vector<std::span<std::byte>> parts;
  Result<void> result{};  ///< set by RangeClient::fetch()
  bool is_done = false;   ///< set by RangeClient::fetch()

  std::uint64_t bytes() const noexcept {
    std::uint64_t sum = 0;
    for (const auto part : parts) sum += part.size();
    return sum;
  }
};

/// Gets ranges of one object by HTTP. Connections are kept between calls.
///
/// threads  any number at once; each call that runs has connections of its own
class RangeClient {
 public:
  /// Maximum number of connections of one call.
  static constexpr long kMaxConnections = 12;
  static constexpr std::chrono::milliseconds kNoLimit = std::chrono::milliseconds::max();

  RangeClient(std::string url, const HttpLimits& limits);
  ~RangeClient();
  RangeClient(const RangeClient&) = delete;
  RangeClient& operator=(const RangeClient&) = delete;

  /// Gets the first bytes of the object, and learns which object it is. Call it first and once.
  ///
  /// out      the first bytes; those behind the end of a shorter object stay as they are
  /// errors   kNotFound, kPermission; kUnsupported: the server gives no ranges, or an encoded
  ///          object; kNotPlanetree: the object is empty; kReadFailed; kNoMemory
  Result<ObjectIdentity> open(std::span<std::byte> out);

  /// Gets ranges, several at once. Repeats a request that fails for a reason that may pass, such as
  /// a lost connection, with pauses that double. Sets `result` of each:
  ///
  /// max_time  of all attempts, if that is less than HttpLimits::max_total; then the requests that
  ///           are on the way are given up
  /// errors    kReadFailed; kNotFound, kPermission; after an object that differs from the one of
  ///           open(), every later request has the same error and is not sent
  void fetch(std::span<RangeRequest> requests,
             std::chrono::milliseconds max_time = kNoLimit) noexcept;

  std::uint64_t request_count() const noexcept {
    return request_count_.load(std::memory_order_relaxed);
  }
  std::uint64_t byte_count() const noexcept { return byte_count_.load(std::memory_order_relaxed); }
  /// Number of requests that were sent one after the reply of another, at most: those at once count
  /// as one, as far as kMaxConnections allows.
  std::uint64_t round_count() const noexcept {
    return round_count_.load(std::memory_order_relaxed);
  }

 private:
  struct Lane;      // connections of one call
  struct Transfer;  // one attempt of one request
  class LaneLoan;

  void fetch_in(Lane& lane, std::span<RangeRequest> requests, std::chrono::milliseconds max_time,
                ObjectIdentity* opened);
  void end_round(std::uint64_t round) noexcept;
  void run(Lane& lane, std::span<const std::unique_ptr<Transfer>> transfers,
           std::chrono::milliseconds max_time);
  void send(Lane& lane, Transfer& transfer, std::chrono::milliseconds max_time);
  void judge(Transfer& transfer, bool is_last);
  Error changed();
  std::unique_ptr<Lane> take_lane();

  const HttpLimits limits_;
  ObjectIdentity identity_;  // set by open()
  std::mutex mutex_;         // guards the members below
  std::vector<std::unique_ptr<Lane>> idle_lanes_;
  std::atomic<bool> has_changed_{false};
  std::atomic<std::uint64_t> request_count_{0};
  std::atomic<std::uint64_t> byte_count_{0};
  std::atomic<std::uint64_t> round_count_{0};
};

}  // namespace planetree::storage
