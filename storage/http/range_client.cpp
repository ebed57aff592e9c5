// Requests by libcurl. No other file of the project uses it.

#include "storage/http/range_client.h"

#include <curl/curl.h>

#include <algorithm>
#include <chrono>
#include <new>
#include <string_view>
#include <thread>
#include <utility>

#include "storage/http/range_reply.h"

namespace planetree::storage {
namespace {

using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;

constexpr long kMaxRedirects = 5;
// Longest wait that a server may ask for.
constexpr milliseconds kMaxRetryAfter{10'000};

// The library has to be started once, and by one thread.
bool start_curl() noexcept {
  static const bool is_started = curl_global_init(CURL_GLOBAL_DEFAULT) == CURLE_OK;
  return is_started;
}

Error no_memory_for_requests() noexcept {
  return make_error(ErrorCode::kNoMemory, Error::kNowhere, Error::kNowhere,
                    "no memory for requests to the server; free some and try again");
}

// Failures that another attempt would meet again.
bool is_final_failure(CURLcode code) noexcept {
  switch (code) {
    case CURLE_UNSUPPORTED_PROTOCOL:
    case CURLE_URL_MALFORMAT:
    case CURLE_TOO_MANY_REDIRECTS:
    case CURLE_PEER_FAILED_VERIFICATION:
    case CURLE_SSL_CACERT_BADFILE:
    case CURLE_SSL_CERTPROBLEM:
      return true;
    default:
      return false;
  }
}

}  // namespace

// One attempt of one request. It does not move, because libcurl has its address.
struct RangeClient::Transfer {
  Transfer(RangeRequest& its_request, const ObjectIdentity* identity)
      : request(its_request), reply(its_request, identity) {}
  Transfer(const Transfer&) = delete;

  static std::size_t take_line(char* line, std::size_t size, std::size_t count, void* self) {
    try {
      static_cast<Transfer*>(self)->reply.add_line({line, size * count});
    } catch (const std::bad_alloc&) {
      return 0;
    }
    return size * count;
  }
  static std::size_t take_bytes(char* bytes, std::size_t size, std::size_t count, void* self) {
    const std::span<const char> taken(bytes, size * count);
    return static_cast<Transfer*>(self)->reply.add(std::as_bytes(taken)) ? taken.size() : 0;
  }

  RangeRequest& request;
  RangeReply reply;
  CURLcode code = CURLE_FAILED_INIT;
  AttemptOutcome outcome = AttemptOutcome::kRetry;
};

struct RangeClient::Lane {
  Lane() : multi(curl_multi_init()) {
    if (multi) curl_multi_setopt(multi, CURLMOPT_MAX_TOTAL_CONNECTIONS, kMaxConnections);
  }
  ~Lane() {
    for (CURL* const easy : easies) curl_easy_cleanup(easy);
    curl_multi_cleanup(multi);
    curl_slist_free_all(fields);
  }
  Lane(const Lane&) = delete;

  // Returns an idle handle. Throws std::bad_alloc.
  CURL* take_easy() {
    if (used == easies.size()) {
      CURL* const made = curl_easy_init();
      if (!made) throw std::bad_alloc();
      easies.push_back(made);
    }
    return easies[used++];
  }

  CURLM* multi;
  curl_slist* fields = nullptr;  // of the head of each request but the first
  std::vector<CURL*> easies;     // the first `used` are in `multi`
  std::size_t used = 0;
};

// A lane of a client for one call.
class RangeClient::LaneLoan {
 public:
  explicit LaneLoan(RangeClient& client) : client_(client), lane_(client.take_lane()) {}
  ~LaneLoan() {
    const std::lock_guard lock(client_.mutex_);
    // Within the capacity, since a destructor must not throw.
    if (client_.idle_lanes_.size() < client_.idle_lanes_.capacity())
      client_.idle_lanes_.push_back(std::move(lane_));
  }
  Lane& lane() { return *lane_; }

 private:
  RangeClient& client_;
  std::unique_ptr<Lane> lane_;
};

RangeClient::RangeClient(std::string url, const HttpLimits& limits) : limits_(limits) {
  identity_.url = std::move(url);
  constexpr std::size_t kMaxIdleLanes = 64;
  idle_lanes_.reserve(kMaxIdleLanes);
}

RangeClient::~RangeClient() = default;

std::unique_ptr<RangeClient::Lane> RangeClient::take_lane() {
  if (!start_curl()) throw std::bad_alloc();
  const std::lock_guard lock(mutex_);
  if (!idle_lanes_.empty()) {
    auto lane = std::move(idle_lanes_.back());
    idle_lanes_.pop_back();
    return lane;
  }
  auto lane = std::make_unique<Lane>();
  if (!lane->multi) throw std::bad_alloc();
  return lane;
}

Error RangeClient::changed() {
  has_changed_.store(true, std::memory_order_relaxed);
  return make_error(
      ErrorCode::kReadFailed, Error::kNowhere, Error::kNowhere,
      "the server has another file under this URL since it was opened; open it again");
}

Result<ObjectIdentity> RangeClient::open(std::span<std::byte> out) {
  try {
    RangeRequest request;
    request.parts.push_back(out);
    ObjectIdentity opened = identity_;
    {
      LaneLoan loan(*this);
      fetch_in(loan.lane(), {&request, 1}, limits_.max_total, &opened);
    }
    if (!request.result) return request.result.error();
    identity_ = opened;
    return opened;
  } catch (const std::bad_alloc&) {
    return no_memory_for_requests();
  }
}

void RangeClient::fetch(std::span<RangeRequest> requests, milliseconds max_time) noexcept {
  try {
    LaneLoan loan(*this);
    fetch_in(loan.lane(), requests, std::min(max_time, limits_.max_total), nullptr);
  } catch (const std::bad_alloc&) {
    for (RangeRequest& request : requests)
      if (!request.is_done) request.result = no_memory_for_requests();
  }
}

// Sends all requests, then those again that failed for a reason that may pass.
void RangeClient::fetch_in(Lane& lane, std::span<RangeRequest> requests, milliseconds max_time,
                           ObjectIdentity* opened) {
  const Clock::time_point end = Clock::now() + max_time;
  milliseconds pause = limits_.first_pause;
  for (unsigned attempt = 1;; ++attempt) {
    std::vector<std::unique_ptr<Transfer>> transfers;
    for (RangeRequest& request : requests) {
      if (has_changed_.load(std::memory_order_relaxed) && !request.is_done) {
        request.result = changed();
        request.is_done = true;
      }
      if (!request.is_done)
        transfers.push_back(std::make_unique<Transfer>(request, opened ? nullptr : &identity_));
    }
    if (transfers.empty()) return;
    const auto left = std::chrono::duration_cast<milliseconds>(end - Clock::now());
    const std::uint64_t round =
        round_count() + (transfers.size() + kMaxConnections - 1) / kMaxConnections;
    run(lane, transfers, std::max(left, milliseconds(1)));
    end_round(round);
    milliseconds wanted_pause = pause;
    for (const auto& transfer : transfers) {
      judge(*transfer, attempt >= limits_.attempts);
      const milliseconds asked = std::chrono::seconds(transfer->reply.head().retry_after_seconds());
      wanted_pause = std::max(wanted_pause, std::min(asked, kMaxRetryAfter));
      if (opened && transfer->outcome == AttemptOutcome::kDone) {
        opened->etag = transfer->reply.head().etag();
        opened->last_modified = transfer->reply.head().last_modified();
        opened->size_bytes = transfer->reply.head().range()->total;
      }
    }
    const bool is_over =
        std::all_of(requests.begin(), requests.end(), [](const auto& it) { return it.is_done; });
    if (is_over || Clock::now() + wanted_pause >= end) return;
    std::this_thread::sleep_for(wanted_pause);
    pause *= 2;
  }
}

// Notes that requests of a round have ended: every later one follows them.
void RangeClient::end_round(std::uint64_t round) noexcept {
  std::uint64_t last = round_count();
  while (last < round &&
         !round_count_.compare_exchange_weak(last, round, std::memory_order_relaxed)) {
  }
}

void RangeClient::run(Lane& lane, std::span<const std::unique_ptr<Transfer>> transfers,
                      milliseconds max_time) {
  for (const auto& transfer : transfers) send(lane, *transfer, max_time);
  int running = 1;
  while (running > 0) {
    if (curl_multi_perform(lane.multi, &running) != CURLM_OK) break;
    int left = 0;
    while (const CURLMsg* const message = curl_multi_info_read(lane.multi, &left)) {
      if (message->msg != CURLMSG_DONE) continue;
      char* owner = nullptr;
      curl_easy_getinfo(message->easy_handle, CURLINFO_PRIVATE, &owner);
      reinterpret_cast<Transfer*>(owner)->code = message->data.result;
    }
    constexpr int kMaxPollMs = 1000;
    if (running > 0) curl_multi_poll(lane.multi, nullptr, 0, kMaxPollMs, nullptr);
  }
  for (std::size_t i = 0; i < lane.used; ++i) curl_multi_remove_handle(lane.multi, lane.easies[i]);
  lane.used = 0;
}

void RangeClient::send(Lane& lane, Transfer& transfer, milliseconds max_time) {
  CURL* const easy = lane.take_easy();
  curl_easy_reset(easy);
  const RangeRequest& request = transfer.request;
  const std::string range =
      std::to_string(request.offset) + '-' + std::to_string(request.offset + request.bytes() - 1);
  const auto set = [easy](CURLoption option, auto value) { curl_easy_setopt(easy, option, value); };
  set(CURLOPT_URL, identity_.url.c_str());
  set(CURLOPT_RANGE, range.c_str());
  set(CURLOPT_PROTOCOLS_STR, "http,https");
  set(CURLOPT_REDIR_PROTOCOLS_STR, "http,https");
  set(CURLOPT_FOLLOWLOCATION, 1L);
  set(CURLOPT_MAXREDIRS, kMaxRedirects);
  set(CURLOPT_NOSIGNAL, 1L);
  set(CURLOPT_USERAGENT, "planetree");
  set(CURLOPT_CONNECTTIMEOUT_MS, static_cast<long>(limits_.max_connect.count()));
  set(CURLOPT_TIMEOUT_MS, static_cast<long>(max_time.count()));
  set(CURLOPT_LOW_SPEED_LIMIT, 1L);
  set(CURLOPT_LOW_SPEED_TIME,
      std::max(1L, static_cast<long>(limits_.max_stall / std::chrono::seconds(1))));
  set(CURLOPT_HEADERFUNCTION, &Transfer::take_line);
  set(CURLOPT_HEADERDATA, static_cast<void*>(&transfer));
  set(CURLOPT_WRITEFUNCTION, &Transfer::take_bytes);
  set(CURLOPT_WRITEDATA, static_cast<void*>(&transfer));
  set(CURLOPT_PRIVATE, static_cast<void*>(&transfer));
  if (!lane.fields && identity_.has_validator()) {
    const std::string field = identity_.has_strong_etag()
                                  ? "If-Match: " + identity_.etag
                                  : "If-Unmodified-Since: " + identity_.last_modified;
    if (identity_.has_strong_etag() || !identity_.last_modified.empty())
      lane.fields = curl_slist_append(nullptr, field.c_str());
  }
  if (lane.fields) set(CURLOPT_HTTPHEADER, lane.fields);
  request_count_.fetch_add(1, std::memory_order_relaxed);
  curl_multi_add_handle(lane.multi, easy);
}

void RangeClient::judge(Transfer& transfer, bool is_last) {
  byte_count_.fetch_add(transfer.reply.received(), std::memory_order_relaxed);
  const char* const failure =
      transfer.code == CURLE_OK ? nullptr : curl_easy_strerror(transfer.code);
  Error why;
  transfer.outcome = transfer.reply.judge(failure, is_final_failure(transfer.code), why);
  RangeRequest& request = transfer.request;
  request.is_done = is_last || transfer.outcome != AttemptOutcome::kRetry;
  switch (transfer.outcome) {
    case AttemptOutcome::kDone:
      request.result = {};
      break;
    case AttemptOutcome::kChanged:
      request.result = changed();
      break;
    default:
      request.result = why;
  }
}

}  // namespace planetree::storage
