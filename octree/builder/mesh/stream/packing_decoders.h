#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

/// The libraries that unpack gzip and zstd, behind one interface.
namespace planetree::octree {

/// Unpacks a stream piece by piece.
class PackingDecoder {
 public:
  enum class State : std::uint8_t {
    kWithin,    ///< within a member or frame
    kBetween,   ///< behind one; the stream may end here
    kDamaged,   ///< see cause()
    kNoMemory,  ///< the system refuses memory
    kTooLarge,  ///< needs more memory than it may use
  };
  struct Step {
    std::size_t taken = 0;  ///< bytes of the input that were used
    std::size_t made = 0;   ///< bytes of the output that were written
    State state = State::kBetween;
  };

  virtual ~PackingDecoder() = default;
  /// Unpacks as much as fits. The input is used up, or the output is full, or the state changes.
  virtual Step decode(std::span<const std::byte> in, std::span<std::byte> out) = 0;
  /// What is wrong with a damaged stream, in a few words.
  [[nodiscard]] virtual const char* cause() const = 0;
};

/// Decoder of gzip members; null if there is no memory.
std::unique_ptr<PackingDecoder> make_gzip_decoder();
/// Decoder of zstd frames; null if there is no memory.
///
/// memory_bytes  maximum of a frame's window, at least 1 KiB.
std::unique_ptr<PackingDecoder> make_zstd_decoder(std::uint64_t memory_bytes);
/// Content length that the head of a zstd frame states; 0 if it states none.
std::uint64_t zstd_stated_bytes(std::span<const std::byte> head);

}  // namespace planetree::octree
