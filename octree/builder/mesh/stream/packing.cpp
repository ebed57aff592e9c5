#include "octree/builder/mesh/stream/packing.h"

#include <algorithm>
#include <array>
#include <cinttypes>
#include <cstring>
#include <memory>
#include <utility>
#include <vector>

#include "octree/builder/mesh/stream/packing_decoders.h"

namespace planetree::octree {
namespace {

constexpr std::size_t kInputBytes = std::size_t{64} << 10;
constexpr std::size_t kOutputBytes = std::size_t{256} << 10;
constexpr std::uint64_t kReportBytes = std::uint64_t{4} << 20;
/// A zstd frame may always have a window of this size, as all but the strongest levels do.
constexpr std::uint64_t kMinWindowBytes = std::uint64_t{8} << 20;
/// Bytes that are written before there must be room for as many again.
constexpr std::uint64_t kRoomBytes = std::uint64_t{64} << 20;

const char* name_of(Packing packing) { return packing == Packing::kGzip ? "gzip" : "zstd"; }

/// Unpacks one file.
class Unpacking {
 public:
  Unpacking(const MeshFile& packed, Packing packing, MeshScratch& scratch, TriangleSink& sink)
      : packed_(packed),
        packing_(packing),
        scratch_(scratch),
        sink_(sink),
        window_bytes_(std::max(scratch.memory_bytes() / 2, kMinWindowBytes)),
        target_(std::make_unique<ScratchFile>(scratch)),
        input_(kInputBytes),
        output_(kOutputBytes) {}

  Result<MeshFile> run() {
    const auto decoder =
        packing_ == Packing::kGzip ? make_gzip_decoder() : make_zstd_decoder(window_bytes_);
    if (!decoder) return no_memory();
    PackingDecoder::Step step;
    for (;;) {
      if (const auto filled = fill(); !filled) return filled.error();
      if (left_.empty() && step.state == PackingDecoder::State::kBetween) break;
      step = decoder->decode(left_, output_);
      left_ = left_.subspan(step.taken);
      if (const auto good = check(step, *decoder); !good) return good.error();
      if (const auto put = write(std::span(output_).first(step.made)); !put) return put.error();
      const bool is_stuck = step.taken == 0 && step.made == 0;
      if (is_stuck && step.state == PackingDecoder::State::kWithin) return ends_too_early();
    }
    const std::uint64_t bytes = target_->spill().size_bytes();
    return MeshFile(std::move(target_), bytes);
  }

 private:
  /// Position of the next byte that is not used yet.
  [[nodiscard]] std::uint64_t offset() const { return read_bytes_ - left_.size(); }

  Result<void> fill() {
    if (!left_.empty() || read_bytes_ == packed_.size_bytes()) return {};
    const std::uint64_t rest = packed_.size_bytes() - read_bytes_;
    const auto part = std::span(input_).first(std::min<std::uint64_t>(rest, kInputBytes));
    if (const auto read = packed_.read(read_bytes_, part); !read) return read;
    read_bytes_ += part.size();
    left_ = part;
    return {};
  }

  Result<void> write(std::span<const std::byte> bytes) {
    if (bytes.empty()) return report(0);
    if (room_bytes_ < bytes.size()) {
      if (const auto room = scratch_.make_room(kRoomBytes); !room) return room;
      room_bytes_ = kRoomBytes;
    }
    room_bytes_ -= bytes.size();
    if (const auto put = target_->spill().append(bytes); !put) return put.error();
    return report(bytes.size());
  }

  /// Reports about every 4 MiB of either file.
  Result<void> report(std::uint64_t written) {
    unreported_bytes_ += written;
    if (unreported_bytes_ < kReportBytes && offset() < reported_offset_ + kReportBytes) return {};
    unreported_bytes_ = 0;
    reported_offset_ = offset();
    return sink_.progress(offset(), packed_.size_bytes());
  }

  Result<void> check(const PackingDecoder::Step& step, const PackingDecoder& decoder) const {
    switch (step.state) {
      case PackingDecoder::State::kDamaged:
        return make_error(ErrorCode::kBadInput, Error::kNowhere, offset(),
                          "byte %" PRIu64 ": the %s data is damaged (%s); get the file again",
                          offset(), name_of(packing_), decoder.cause());
      case PackingDecoder::State::kTooLarge:
        return make_error(ErrorCode::kNoMemory, Error::kNowhere, offset(),
                          "byte %" PRIu64 ": this zstd frame needs a window of more than %" PRIu64
                          " MiB; give more --memory, or compress it without --long and --ultra",
                          offset(), window_bytes_ >> 20);
      case PackingDecoder::State::kNoMemory:
        return no_memory();
      case PackingDecoder::State::kWithin:
      case PackingDecoder::State::kBetween:
        break;
    }
    return {};
  }
  [[nodiscard]] Error ends_too_early() const {
    return make_error(ErrorCode::kBadInput, Error::kNowhere, packed_.size_bytes(),
                      "byte %" PRIu64 ": the %s data ends too early; get the file again",
                      packed_.size_bytes(), name_of(packing_));
  }
  static Error no_memory() {
    return make_error(ErrorCode::kNoMemory, Error::kNowhere, Error::kNowhere,
                      "no memory to unpack the mesh; free some, or unpack it before");
  }

  const MeshFile& packed_;
  const Packing packing_;
  MeshScratch& scratch_;
  TriangleSink& sink_;
  const std::uint64_t window_bytes_;
  std::unique_ptr<ScratchFile> target_;
  std::vector<std::byte> input_, output_;
  std::span<const std::byte> left_;  ///< bytes of the input that are not used yet
  std::uint64_t read_bytes_ = 0;
  std::uint64_t room_bytes_ = kRoomBytes;
  std::uint64_t unreported_bytes_ = 0;
  std::uint64_t reported_offset_ = 0;
};

}  // namespace

Packing packing_of(std::string_view first_bytes) {
  if (first_bytes.starts_with("\x1f\x8b\x08")) return Packing::kGzip;
  if (first_bytes.starts_with("\x28\xb5\x2f\xfd")) return Packing::kZstd;
  return Packing::kNone;
}

Result<std::uint64_t> stated_bytes(const MeshFile& packed, Packing packing) {
  std::array<std::byte, 18> bytes{};
  const auto part = std::span(bytes).first(
      std::min<std::uint64_t>(packing == Packing::kGzip ? 4 : bytes.size(), packed.size_bytes()));
  const std::uint64_t from = packing == Packing::kGzip ? packed.size_bytes() - part.size() : 0;
  if (const auto read = packed.read(from, part); !read) return read.error();
  if (packing == Packing::kZstd) return zstd_stated_bytes(part);
  std::uint64_t stated = 0;
  for (std::size_t k = 0; k < part.size(); ++k)
    stated |= std::to_integer<std::uint64_t>(part[k]) << 8 * k;
  return stated;
}

Result<MeshFile> unpack(const MeshFile& packed, Packing packing, MeshScratch& scratch,
                        TriangleSink& sink) {
  return Unpacking(packed, packing, scratch, sink).run();
}

}  // namespace planetree::octree
