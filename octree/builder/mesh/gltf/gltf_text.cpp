#include "octree/builder/mesh/gltf/gltf_text.h"

#include <string_view>

#include "octree/builder/mesh/gltf/gltf_error.h"
#include "octree/builder/mesh/stream/mesh_text.h"

namespace planetree::octree {

namespace {

constexpr std::size_t kMaxHead = 256;
/// Length of the longest escape, a pair of "\uD83D".
constexpr std::uint64_t kEscapeBytes = 12;

}  // namespace

int GltfText::read() {
  if (failure_ || at_ == end_) return kEnd;
  const std::byte* const byte = window_.at(at_, 1);
  if (byte == nullptr) {
    failure_ = window_.failure();
    return kEnd;
  }
  ++at_;
  return static_cast<unsigned char>(*byte);
}

// A character is given as an unsigned one, so that none of them is kEnd.
int GltfText::next() {
  if (++given_bytes_ > kMaxBytes) {
    failure_ = gltf_error(
        "the JSON has more than " + std::to_string(kMaxBytes >> 20) + " MiB without its buffers",
        "join nodes and meshes before you export it");
    return kEnd;
  }
  if (!pending_.empty()) {
    const char c = pending_.back();
    pending_.pop_back();
    return static_cast<unsigned char>(c);
  }
  for (int c = read(); c != kEnd; c = read()) {
    if (state_ == State::kString) return in_string(static_cast<char>(c));
    if (is_space(static_cast<char>(c))) {
      if (state_ == State::kBlank) continue;
      state_ = State::kBlank;
      return ' ';
    }
    state_ = State::kOutside;
    if (c == '"') {
      state_ = State::kString;
      string_bytes_ = since_escape_ = 0;
      head_.clear();
    }
    return c;
  }
  return kEnd;
}

bool GltfText::begins_data(char c) {
  if (head_.size() < kMaxHead) head_.push_back(c);
  return c == ',' && head_.size() < kMaxHead && head_.starts_with("data:") &&
         head_.ends_with(";base64,");
}

int GltfText::in_string(char c) {
  ++string_bytes_;
  ++since_escape_;
  if (is_escaped_ || c == '\\') {
    is_escaped_ = !is_escaped_;
    since_escape_ = 0;
    if (head_.size() < kMaxHead && c != '\\') head_.push_back(c);
    return static_cast<unsigned char>(c);
  }
  if (c == '"') {
    state_ = State::kOutside;
    return c;
  }
  if (begins_data(c)) {
    const std::uint64_t begin = at_;
    const int end = skip_string();
    if (end == kEnd) return kEnd;
    embedded_.push_back({begin, at_ - 1});
    const std::string number = std::to_string(embedded_.size() - 1);
    pending_.assign(1, '"');
    pending_.append(number.rbegin(), number.rend());
    return c;
  }
  // A cut within an escape or a character of UTF-8 would leave no valid string.
  const bool is_ascii = static_cast<unsigned char>(c) < 0x80;
  if (string_bytes_ > kMaxString && is_ascii && since_escape_ > kEscapeBytes) return skip_string();
  return static_cast<unsigned char>(c);
}

int GltfText::skip_string() {
  bool is_escaped = false;
  for (int c = read(); c != kEnd; c = read()) {
    if (c == '"' && !is_escaped) {
      state_ = State::kOutside;
      return c;
    }
    is_escaped = c == '\\' && !is_escaped;
  }
  return kEnd;
}

}  // namespace planetree::octree
