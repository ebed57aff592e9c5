#pragma once

#include <unistd.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "octree/builder/mesh/mesh_reader.h"

/// Helpers for the tests of mesh readers.
namespace planetree::octree {

/// A file that exists as long as this object.
class TemporaryFile {
 public:
  TemporaryFile(std::string_view bytes, const std::string& extension) {
    static int serial = 0;
    path_ =
        std::filesystem::temp_directory_path() / ("planetree_mesh_" + std::to_string(::getpid()) +
                                                  "_" + std::to_string(serial++) + extension);
    std::ofstream file(path_, std::ios::binary);
    file.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  }
  ~TemporaryFile() {
    std::error_code ignored;
    std::filesystem::remove(path_, ignored);
  }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

/// Records every call as one line, with all digits:
///   0: 0 0 0, 1 0 0, 0 1 0
///     #000102ff 0 0, #030405ff 0.5 1, #060708ff 0 1, value 17
///   1+2 aside: face 1: vertex 9 is not finite
class RecordingSink : public TriangleSink {
 public:
  Result<void> triangle(std::uint64_t index, const std::array<Vec3, 3>& corners) override {
    char line[256];
    const auto& [a, b, c] = corners;
    std::snprintf(
        line, sizeof line, "%llu: %.17g %.17g %.17g, %.17g %.17g %.17g, %.17g %.17g %.17g",
        static_cast<unsigned long long>(index), a.x, a.y, a.z, b.x, b.y, b.z, c.x, c.y, c.z);
    log += std::string(line) + "\n";
    if (index == refuse_index) {
      return make_error(ErrorCode::kNoSpace, Error::kNowhere, Error::kNowhere, "refused");
    }
    return {};
  }
  Result<void> attributes(const TriangleAttributes& attributes) override {
    log += "  ";
    for (std::size_t k = 0; k < 3; ++k) {
      const Color& c = attributes.colors[k];
      const TextureCoordinate& t = attributes.uvs[k];
      char corner[96];
      std::snprintf(corner, sizeof corner, "#%02x%02x%02x%02x %.9g %.9g, ", c.red, c.green, c.blue,
                    c.alpha, static_cast<double>(t.u), static_cast<double>(t.v));
      log += corner;
    }
    log += "value " + std::to_string(attributes.value) + "\n";
    return {};
  }
  void skipped(std::uint64_t first_index, std::uint64_t count, const SkippedRecord& why) override {
    log +=
        std::to_string(first_index) + "+" + std::to_string(count) + " aside: " + why.text() + "\n";
  }
  Result<void> progress(std::uint64_t bytes_done, std::uint64_t bytes_total) override {
    reports.emplace_back(bytes_done, bytes_total);
    return {};
  }

  std::string log;
  std::vector<std::pair<std::uint64_t, std::uint64_t>> reports;
  std::uint64_t refuse_index = ~std::uint64_t{0};
};

/// Result of reading a mesh.
struct Reading {
  std::string log;
  std::optional<MeshSummary> summary;
  std::string error;  ///< text of the error, or empty
  ErrorCode code = ErrorCode::kBadArgument;
  std::uint64_t offset = Error::kNowhere;
};

/// The notes of a reading, a line each.
inline std::string notes_of(const Reading& reading) {
  std::string text;
  if (reading.summary)
    for (const std::string& note : reading.summary->notes) text += note + "\n";
  return text;
}

inline Reading read_input(const BuildInput& input, MeshScratch& scratch,
                          const MeshOptions& options = {}) {
  RecordingSink recorder;
  const Result<MeshSummary> summary = read_mesh(input, recorder, scratch, options);
  Reading reading;
  reading.log = recorder.log;
  if (summary) {
    reading.summary = *summary;
  } else {
    reading.error = summary.error().text;
    reading.code = summary.error().code;
    reading.offset = summary.error().offset;
  }
  return reading;
}

inline Reading read_path(const std::filesystem::path& path, MeshScratch& scratch) {
  return read_input(path, scratch);
}

inline Reading read_path(const std::filesystem::path& path,
                         std::uint64_t memory_bytes = MeshScratch::kMemoryBytes) {
  MeshScratch scratch(memory_bytes);
  return read_path(path, scratch);
}

inline Reading read_bytes(std::string_view bytes, const std::string& extension = "",
                          std::uint64_t memory_bytes = MeshScratch::kMemoryBytes) {
  const TemporaryFile file(bytes, extension);
  return read_path(file.path(), memory_bytes);
}

/// Reads a mesh with the attributes that `keep` names.
inline Reading read_kept(std::string_view bytes, const std::string& extension, std::uint32_t keep,
                         std::uint64_t memory_bytes = MeshScratch::kMemoryBytes) {
  const TemporaryFile file(bytes, extension);
  MeshScratch scratch(memory_bytes);
  return read_input(file.path(), scratch, {.keep = keep});
}

/// Reads with much memory and with little, and expects the same.
inline Reading read_kept_twice(std::string_view bytes, const std::string& extension,
                               std::uint32_t keep, std::uint64_t little_bytes = 0) {
  const Reading reading = read_kept(bytes, extension, keep);
  const Reading other = read_kept(bytes, extension, keep, little_bytes);
  EXPECT_EQ(reading.log, other.log);
  EXPECT_EQ(reading.error, other.error);
  EXPECT_EQ(notes_of(reading), notes_of(other));
  return reading;
}

/// Bytes of numbers in a given byte order.
class Bytes {
 public:
  explicit Bytes(std::endian order = std::endian::little) : order_(order) {}

  Bytes& text(std::string_view text) {
    bytes_ += text;
    return *this;
  }
  template <class T, class... More>
  Bytes& put(T value, More... more) {
    char raw[sizeof(T)];
    std::memcpy(raw, &value, sizeof(T));
    if (order_ != std::endian::native) std::reverse(raw, raw + sizeof(T));
    bytes_.append(raw, sizeof(T));
    if constexpr (sizeof...(more) > 0) put(more...);
    return *this;
  }
  template <class T>
  Bytes& put_all(const std::vector<T>& values) {
    for (const T value : values) put(value);
    return *this;
  }
  [[nodiscard]] const std::string& str() const { return bytes_; }

 private:
  std::endian order_;
  std::string bytes_;
};

inline std::string ply_format_name(std::endian order) {
  return order == std::endian::little ? "binary_little_endian" : "binary_big_endian";
}

}  // namespace planetree::octree
