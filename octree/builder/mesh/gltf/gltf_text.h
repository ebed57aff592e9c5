#pragma once

#include <cstddef>
#include <cstdint>
#include <iterator>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "octree/builder/mesh/gltf/gltf_file.h"
#include "octree/builder/mesh/stream/mesh_file.h"
#include "octree/builder/mesh/stream/mesh_window.h"
#include "planetree/error.h"

namespace planetree::octree {

/// The JSON of a glTF file, character by character, without what may be long in it: the data of a
/// string "data:...;base64,DATA" is replaced by its number in embedded(), other long strings are
/// cut, and white space is one blank. So a document is small, however large its buffers are.
class GltfText {
 public:
  /// Length of the text that is given at most, and of a string in it.
  static constexpr std::uint64_t kMaxBytes = std::uint64_t{64} << 20;
  static constexpr std::uint64_t kMaxString = 4096;

  /// `file` must outlive this.
  GltfText(const MeshFile& file, const FileRange& json)
      : window_(file), at_(json.begin), end_(json.end) {}

  /// The next character, or kEnd. It ends early if the text is too long or cannot be read: see
  /// failure().
  int next();
  static constexpr int kEnd = -1;

  /// Position in the file.
  [[nodiscard]] std::uint64_t offset() const { return at_; }
  [[nodiscard]] const std::optional<Error>& failure() const { return failure_; }
  /// Where the data of strings is in the file.
  [[nodiscard]] const std::vector<FileRange>& embedded() const { return embedded_; }

  /// An input iterator over the characters.
  class Iterator;

 private:
  enum class State : std::uint8_t { kOutside, kBlank, kString, kData, kCut };

  int read();
  int in_string(char c);
  /// Passes over the rest of a string. Returns the character that ends it.
  int skip_string();
  bool begins_data(char c);

  MeshWindow window_;
  std::uint64_t at_;
  const std::uint64_t end_;
  std::uint64_t given_bytes_ = 0;
  State state_ = State::kOutside;
  bool is_escaped_ = false;
  std::uint64_t string_bytes_ = 0;
  std::uint64_t since_escape_ = 0;
  std::string head_;     ///< beginning of the string
  std::string pending_;  ///< to be given next, last character first
  std::vector<FileRange> embedded_;
  std::optional<Error> failure_;
};

class GltfText::Iterator {
 public:
  using iterator_category = std::input_iterator_tag;
  using value_type = char;
  using difference_type = std::ptrdiff_t;
  using pointer = const char*;
  using reference = char;

  Iterator() = default;  // the end
  explicit Iterator(GltfText& text) : text_(&text), current_(text.next()) {}

  char operator*() const { return static_cast<char>(current_); }
  Iterator& operator++() {
    current_ = text_->next();
    return *this;
  }
  bool operator==(const Iterator& other) const { return current_ == other.current_; }

 private:
  GltfText* text_ = nullptr;
  int current_ = kEnd;
};

}  // namespace planetree::octree
