#include "octree/builder/mesh/stream/packing_decoders.h"

#define ZLIB_CONST
#include <zlib.h>
#include <zstd.h>
#include <zstd_errors.h>

#include <algorithm>
#include <bit>
#include <limits>
#include <new>

namespace planetree::octree {
namespace {

class GzipDecoder final : public PackingDecoder {
 public:
  GzipDecoder() { is_good_ = ::inflateInit2(&stream_, kGzipOnly) == Z_OK; }
  ~GzipDecoder() override { ::inflateEnd(&stream_); }
  GzipDecoder(const GzipDecoder&) = delete;
  GzipDecoder& operator=(const GzipDecoder&) = delete;

  [[nodiscard]] bool is_good() const { return is_good_; }

  Step decode(std::span<const std::byte> in, std::span<std::byte> out) override {
    // Members may be followed by zeros, which fill a block of a tape.
    const auto zeros = static_cast<std::size_t>(
        is_between_
            ? std::ranges::find_if(in, [](std::byte b) { return b != std::byte{0}; }) - in.begin()
            : 0);
    if (is_between_ && !is_first_ && zeros == in.size()) return {zeros, 0, State::kBetween};
    const std::size_t skipped = is_first_ ? 0 : zeros;
    if (is_between_) ::inflateReset(&stream_);
    is_between_ = is_first_ = false;
    in = in.subspan(skipped);
    stream_.next_in = reinterpret_cast<const Bytef*>(in.data());
    stream_.avail_in = static_cast<uInt>(in.size());
    stream_.next_out = reinterpret_cast<Bytef*>(out.data());
    stream_.avail_out = static_cast<uInt>(out.size());
    const int result = ::inflate(&stream_, Z_NO_FLUSH);
    is_between_ = result == Z_STREAM_END;
    return {skipped + in.size() - stream_.avail_in, out.size() - stream_.avail_out,
            state_of(result)};
  }
  [[nodiscard]] const char* cause() const override {
    return stream_.msg ? stream_.msg : "no gzip member";
  }

 private:
  static constexpr int kGzipOnly = 15 + 16;  // the largest window, with the head of gzip

  static State state_of(int result) {
    if (result == Z_STREAM_END) return State::kBetween;
    if (result == Z_OK || result == Z_BUF_ERROR) return State::kWithin;
    return result == Z_MEM_ERROR ? State::kNoMemory : State::kDamaged;
  }

  z_stream stream_ = {};
  bool is_good_ = false;
  bool is_first_ = true;
  bool is_between_ = true;
};

class ZstdDecoder final : public PackingDecoder {
 public:
  explicit ZstdDecoder(std::uint64_t memory_bytes) : context_(::ZSTD_createDCtx()) {
    const int largest = static_cast<int>(std::bit_width(memory_bytes)) - 1;
    const ZSTD_bounds bounds = ::ZSTD_dParam_getBounds(ZSTD_d_windowLogMax);
    if (context_)
      ::ZSTD_DCtx_setParameter(context_, ZSTD_d_windowLogMax,
                               std::clamp(largest, bounds.lowerBound, bounds.upperBound));
  }
  ~ZstdDecoder() override { ::ZSTD_freeDCtx(context_); }
  ZstdDecoder(const ZstdDecoder&) = delete;
  ZstdDecoder& operator=(const ZstdDecoder&) = delete;

  [[nodiscard]] bool is_good() const { return context_ != nullptr; }

  Step decode(std::span<const std::byte> in, std::span<std::byte> out) override {
    ZSTD_inBuffer input{in.data(), in.size(), 0};
    ZSTD_outBuffer output{out.data(), out.size(), 0};
    const std::size_t result = ::ZSTD_decompressStream(context_, &output, &input);
    return {input.pos, output.pos, state_of(result)};
  }
  [[nodiscard]] const char* cause() const override { return cause_; }

 private:
  State state_of(std::size_t result) {
    if (!::ZSTD_isError(result)) return result == 0 ? State::kBetween : State::kWithin;
    cause_ = ::ZSTD_getErrorName(result);
    switch (::ZSTD_getErrorCode(result)) {
      case ZSTD_error_frameParameter_windowTooLarge:
        return State::kTooLarge;
      case ZSTD_error_memory_allocation:
        return State::kNoMemory;
      default:
        return State::kDamaged;
    }
  }

  ZSTD_DCtx* context_;
  const char* cause_ = "";
};

template <class Decoder>
std::unique_ptr<PackingDecoder> if_good(std::unique_ptr<Decoder> decoder) {
  if (!decoder->is_good()) return nullptr;
  return decoder;
}

}  // namespace

std::unique_ptr<PackingDecoder> make_gzip_decoder() {
  return if_good(std::make_unique<GzipDecoder>());
}

std::unique_ptr<PackingDecoder> make_zstd_decoder(std::uint64_t memory_bytes) {
  return if_good(std::make_unique<ZstdDecoder>(memory_bytes));
}

std::uint64_t zstd_stated_bytes(std::span<const std::byte> head) {
  const unsigned long long bytes = ::ZSTD_getFrameContentSize(head.data(), head.size());
  return bytes == ZSTD_CONTENTSIZE_UNKNOWN || bytes == ZSTD_CONTENTSIZE_ERROR ? 0 : bytes;
}

}  // namespace planetree::octree
