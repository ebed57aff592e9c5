#include "octree/builder/mesh/stream/mesh_lines.h"

#include <algorithm>
#include <cinttypes>

namespace planetree::octree {

namespace {

/// Length of the whole lines at the front of `text`, which more text follows. A '\r' at its very
/// end may be the first half of "\r\n".
std::size_t whole_lines(std::string_view text) {
  const std::size_t newline = text.rfind('\n');
  if (newline != std::string_view::npos) return newline + 1;
  const std::size_t lone = text.substr(0, text.size() - 1).rfind('\r');
  return lone == std::string_view::npos ? 0 : lone + 1;
}

}  // namespace

bool MeshLines::refill() {
  if (failure_) return false;
  const TextPosition begin = after();
  const std::uint64_t left = size_bytes_ - begin.offset;
  if (left == 0) return false;
  for (std::uint64_t wanted = std::min(window_bytes_, left);;) {
    const std::byte* const bytes = window_.at(begin.offset, wanted);
    if (bytes == nullptr) return fail(window_.failure());
    const std::string_view text(reinterpret_cast<const char*>(bytes),
                                static_cast<std::size_t>(window_.bytes_from(begin.offset)));
    const std::size_t whole = text.size() == left ? text.size() : whole_lines(text);
    if (whole > 0) {
      base_ = begin.offset;
      lines_ = LineScanner(text.substr(0, whole), {0, begin.line}, LineEnd::kAny, comment_);
      return true;
    }
    if (text.size() >= kMaxLineBytes) {
      return fail(make_error(ErrorCode::kBadInput, Error::kNowhere, begin.offset,
                             "line %" PRIu64 ": is longer than %" PRIu64
                             " MiB; write such a mesh as a binary PLY",
                             begin.line, kMaxLineBytes >> 20));
    }
    wanted = std::min(2 * std::uint64_t{text.size()}, left);
  }
}

Result<TextPosition> text_begin(const MeshFile& file) {
  const auto prefix = file.prefix(3);
  if (!prefix) return prefix.error();
  return text_begin(*prefix);
}

}  // namespace planetree::octree
