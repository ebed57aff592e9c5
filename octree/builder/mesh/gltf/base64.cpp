#include "octree/builder/mesh/gltf/base64.h"

#include <cstddef>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "octree/builder/mesh/gltf/gltf_error.h"
#include "octree/builder/mesh/stream/mesh_window.h"

// Source: RFC 4648, section 4.
namespace planetree::octree {

namespace {

constexpr std::size_t kWriteBytes = std::size_t{256} << 10;

/// The six bits that a character stands for, or -1.
int bits_of(char c) {
  if (c >= 'A' && c <= 'Z') return c - 'A';
  if (c >= 'a' && c <= 'z') return c - 'a' + 26;
  if (c >= '0' && c <= '9') return c - '0' + 52;
  if (c == '+') return 62;
  return c == '/' ? 63 : -1;
}

class Base64Decoder {
 public:
  explicit Base64Decoder(MeshScratch& scratch) : target_(std::make_unique<ScratchFile>(scratch)) {}

  Result<void> add(char c, std::uint64_t offset) {
    if (c == '=') {
      ++fill_;
      return {};
    }
    const int bits = bits_of(c);
    if (bits < 0 || fill_ > 0) return gltf_error_at(offset, "no base64 within an embedded buffer");
    group_ = group_ << 6 | static_cast<unsigned>(bits);
    if (++count_ < 4) return {};
    for (const unsigned shift : {16U, 8U, 0U}) put(shift);
    count_ = group_ = 0;
    return decoded_.size() < kWriteBytes ? Result<void>() : write();
  }

  Result<MeshFile> finish(std::uint64_t offset) {
    // Two characters make one byte and three make two. The rest may be filled up with '='.
    if (count_ == 1 || (fill_ > 0 && count_ + fill_ != 4))
      return gltf_error_at(offset, "the base64 of an embedded buffer is not whole");
    group_ <<= 6 * (4 - count_);
    if (count_ >= 2) put(16);
    if (count_ == 3) put(8);
    if (const auto written = write(); !written) return written.error();
    const std::uint64_t bytes = target_->spill().size_bytes();
    return MeshFile(std::move(target_), bytes);
  }

 private:
  void put(unsigned shift) { decoded_.push_back(static_cast<std::byte>(group_ >> shift & 0xFF)); }
  Result<void> write() {
    if (decoded_.empty()) return {};
    const auto put = target_->spill().append(decoded_);
    decoded_.clear();
    if (!put) return put.error();
    return {};
  }

  std::unique_ptr<ScratchFile> target_;
  std::vector<std::byte> decoded_;  ///< not written yet
  unsigned group_ = 0;              ///< bits of the characters since the last group
  unsigned count_ = 0;              ///< of these characters
  unsigned fill_ = 0;               ///< number of '='
};

}  // namespace

Result<MeshFile> decode_base64(const MeshFile& file, const FileRange& range, MeshScratch& scratch) {
  if (const auto room = scratch.make_room(range.bytes() / 4 * 3); !room) return room.error();
  MeshWindow window(file, static_cast<std::size_t>(scratch.window_bytes()));
  Base64Decoder decoder(scratch);
  for (std::uint64_t at = range.begin; at < range.end; ++at) {
    const std::byte* const byte = window.at(at, 1);
    if (byte == nullptr) return window.failure();
    const char c = static_cast<char>(*byte);
    if (c == '\\') continue;
    if (const auto added = decoder.add(c, at); !added) return added.error();
  }
  return decoder.finish(range.end);
}

}  // namespace planetree::octree
