#pragma once

#include <sys/mman.h>
#include <unistd.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <string>

#include "octree/build/mesh_reader.h"

/// What the mesh readers' fuzzers share.
namespace planetree::octree {

/// Stops the program where a reader breaks a promise of TriangleSink.
class CheckingSink : public TriangleSink {
 public:
  Result<void> triangle(std::uint64_t index, const std::array<Vec3, 3>& corners) override {
    expect(index == next_index_);
    ++next_index_;
    ++triangle_count_;
    for (const Vec3& corner : corners) {
      for (const double value : {corner.x, corner.y, corner.z}) {
        expect(std::isfinite(value) && !(value == 0 && std::signbit(value)));
        float32_ &= value == static_cast<double>(static_cast<float>(value));
      }
    }
    return {};
  }

  void set_aside(std::uint64_t first_index, std::uint64_t count, const SetAside& why) override {
    expect(first_index == next_index_ && count >= 1);
    next_index_ += count;
    expect(!why.text().empty());
  }

  void progress(std::uint64_t bytes_done, std::uint64_t bytes_total) override {
    expect(bytes_done >= bytes_done_ && bytes_done <= bytes_total);
    bytes_done_ = bytes_done;
  }

  void check(const Result<MeshSummary>& summary) const {
    if (!summary) {
      expect(summary.error().code == ErrorCode::kBadInput && summary.error().text[0] != 0);
      return;
    }
    expect(triangle_count_ > 0 && summary->triangle_indices == next_index_);
    expect(float32_ || !summary->float32);
  }

 private:
  static void expect(bool truth) {
    if (!truth) std::abort();
  }

  std::uint64_t next_index_ = 0;
  std::uint64_t triangle_count_ = 0;
  std::uint64_t bytes_done_ = 0;
  bool float32_ = true;  ///< all corners so far are floats
};

/// The fuzzer's bytes as a file in memory.
class MemoryFile {
 public:
  MemoryFile(const std::uint8_t* bytes, std::size_t size)
      : descriptor_(::memfd_create("mesh", MFD_CLOEXEC)) {
    const ssize_t written = ::write(descriptor_, bytes, size);
    if (written != static_cast<ssize_t>(size)) std::abort();
  }
  ~MemoryFile() { ::close(descriptor_); }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;
  [[nodiscard]] std::filesystem::path path() const {
    return "/proc/self/fd/" + std::to_string(descriptor_);
  }

 private:
  int descriptor_;
};

}  // namespace planetree::octree
