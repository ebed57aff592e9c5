#include "query/serve/page_filler.h"

#include <algorithm>
#include <new>
#include <span>
#include <string_view>

#include "query/file/page_decoding.h"

namespace planetree::query {
namespace {

bool stored_fits_frame(const PageFiller::Limits& limits) {
  return limits.max_stored_bytes <= limits.frame_bytes;
}

// The error with the name of its source before the text, if it has one.
Error named(const Error& error, std::string_view name) noexcept {
  if (name.empty()) return error;
  constexpr int kMaxNameBytes = 72;  // leaves room for the text
  return make_error(error.code, error.page, error.offset, "%.*s: %s",
                    std::min(static_cast<int>(name.size()), kMaxNameBytes), name.data(),
                    error.text);
}

}  // namespace

// Bytes that each fetcher needs to unpack a page.
std::uint64_t PageFiller::scratch_bytes(const Limits& limits) noexcept {
  return limits.max_raw_bytes + (stored_fits_frame(limits) ? 0 : limits.max_stored_bytes);
}

std::uint64_t PageFiller::max_read_waits(const Limits& limits) noexcept {
  return limits.use_io_uring ? std::min(limits.fetchers, kMaxReadWaits) : 0;
}

std::uint64_t PageFiller::bytes(const Limits& limits) noexcept {
  return limits.fetchers * (scratch_bytes(limits) + sizeof(FetcherWait)) +
         max_read_waits(limits) * storage::ReadWait::kMappedBytes;
}

Result<std::optional<storage::PageEntry>> PageFiller::entry_of(const storage::PageFile& file,
                                                               std::uint32_t page,
                                                               bool may_block) noexcept {
  if (!may_block) return file.kept_entry(page);
  const auto read = file.entry(page);
  if (!read) return read.error();
  return std::optional(*read);
}

Result<void> PageFiller::claim(const Limits& limits) noexcept {
  limits_ = limits;
  max_wait_ = std::min(limits.wait_limit, kMaxReadWait);
  max_read_waits_ = max_read_waits(limits);
  scratch_.reset(new (std::nothrow) std::byte[limits.fetchers * scratch_bytes(limits)]);
  fetcher_waits_.reset(new (std::nothrow) FetcherWait[limits.fetchers]);
  if (!scratch_ || !fetcher_waits_)
    return make_error(ErrorCode::kNoMemory, Error::kNowhere, Error::kNowhere,
                      "no memory to read pages; free some and try again");
  return {};
}

Result<cache::FillResult> PageFiller::fill(const storage::PageFile& file, std::uint32_t page,
                                           const cache::FillRequest& request) noexcept {
  auto filled = fill_frame(file, page, request);
  if (filled) return filled;
  const Error error = named(filled.error(), file.source().name());
  read_error_.set(error);
  if (file.source().is_remote() && error.code != ErrorCode::kDamaged)
    return cache::FillResult::kLate;
  return error;
}

Result<cache::FillResult> PageFiller::fill_frame(const storage::PageFile& file, std::uint32_t page,
                                                 const cache::FillRequest& request) noexcept {
  const storage::FileHeader& header = file.header();
  const auto found = entry_of(file, page, request.may_block);
  if (!found) return found.error();
  if (!*found) return cache::FillResult::kWouldBlock;
  const storage::PageEntry& entry = **found;
  std::byte* const scratch = scratch_.get() + request.fetcher * scratch_bytes(limits_);
  const std::span<std::byte> raw(scratch, entry.raw_bytes);
  // The frame is written last. Until then it may hold the stored bytes.
  const std::span<std::byte> stored =
      stored_fits_frame(limits_)
          ? request.frame
          : std::span(scratch + limits_.max_raw_bytes, limits_.max_stored_bytes);
  if (request.may_block) {
    if (const auto read = file.read_page(page, stored, raw); !read) return read.error();
  } else {
    const auto read = file.try_read_page(page, stored, raw, read_limits(request));
    if (!read) return read.error();
    if (!*read) return cache::FillResult::kWouldBlock;
  }
  const std::span<std::byte> frame = request.frame.first(header.page_bytes);
  if (const auto decoded = decode_frame(header, page_info(header, entry, page), raw, frame);
      !decoded)
    return decoded.error();
  return leads_to_pages(header, page, frame) ? cache::FillResult::kFilledUpper
                                             : cache::FillResult::kFilled;
}

storage::ReadLimits PageFiller::read_limits(const cache::FillRequest& request) noexcept {
  storage::ReadLimits limits;
  if (max_wait_.count() > 0) limits.wait = read_wait_for(request.fetcher);
  limits.max_wait = max_wait_;
  limits.prefetch_for_write = request.frame;
  return limits;
}

storage::ReadWait* PageFiller::read_wait_for(std::uint32_t fetcher) noexcept {
  FetcherWait& fetcher_wait = fetcher_waits_[fetcher];
  if (!fetcher_wait.is_granted && granted_waits_.load(std::memory_order_relaxed) < max_read_waits_)
    fetcher_wait.is_granted =
        granted_waits_.fetch_add(1, std::memory_order_relaxed) < max_read_waits_;
  return fetcher_wait.is_granted ? &fetcher_wait.wait : nullptr;
}

}  // namespace planetree::query
