#include "octree/builder/mesh/stream/mesh_lines.h"

#include <algorithm>
#include <cinttypes>
#include <cstddef>
#include <span>
#include <string>

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

constexpr bool is_padding(char c) { return c == '\0' || c == '\x1a'; }

/// Length of `text` without padding and white space at its end.
std::size_t without_end(std::string_view text) {
  std::size_t size = text.size();
  while (size > 0 && (is_padding(text[size - 1]) || is_space(text[size - 1]))) --size;
  return size;
}

/// Length of the words at the front of a part of a line, with white space behind them; 0 if a word
/// fills it. A '\r' at its end may be the first half of "\r\n".
std::size_t whole_words(std::string_view text) { return text.find_last_of(" \t\v\f") + 1; }

}  // namespace

Result<std::uint64_t> text_bytes(const MeshFile& file) {
  constexpr std::uint64_t kBlockBytes = std::uint64_t{64} << 10;
  std::uint64_t end = file.size_bytes(), block = 64;
  bool is_padded = false;
  std::string text;
  while (end > 0) {
    text.resize(static_cast<std::size_t>(std::min(block, end)));
    const auto read = file.read(end - text.size(), std::as_writable_bytes(std::span(text)));
    if (!read) return read.error();
    const std::size_t size = without_end(text);
    is_padded |=
        std::any_of(text.begin() + static_cast<std::ptrdiff_t>(size), text.end(), is_padding);
    end -= text.size() - size;
    if (size > 0 || !is_padded) break;
    block = kBlockBytes;
  }
  return is_padded ? end : file.size_bytes();
}

Result<MeshSummary> with_note_of_padding(const MeshFile& file, Result<MeshSummary> summary) {
  if (!summary) return summary;
  const Result<std::uint64_t> text = text_bytes(file);
  if (!text) return text.error();
  const std::uint64_t bytes = file.size_bytes() - *text;
  // A Ctrl-Z among empty lines is how old systems end a text.
  constexpr std::uint64_t kEndBytes = 8;
  if (bytes > kEndBytes)
    summary->notes.push_back(std::to_string(bytes) +
                             " bytes of zero or Ctrl-Z at the end are not read; if the mesh is not "
                             "whole, copy it again");
  return summary;
}

void MeshLines::set_text(std::string_view text, TextPosition begin) {
  // Behind a part with a comment, the comment goes on to the end of the line.
  if (is_divided() && lines_.line().size() < part_bytes_) {
    const std::size_t end = std::min(text.find_first_of("\r\n"), text.size());
    begin.offset += end;
    text.remove_prefix(end);
  }
  base_ = begin.offset;
  lines_ = LineScanner(text, {0, begin.line, 0}, LineEnd::kAny, comment_);
}

bool MeshLines::refill() {
  if (failure_) return false;
  const TextPosition begin = after();
  const std::uint64_t left = size_bytes_ - begin.offset;
  if (left == 0) return false;
  for (std::uint64_t wanted = std::min(window_bytes_, left);;) {
    const std::byte* const bytes = window_.at(begin.offset, wanted);
    if (bytes == nullptr) return fail(window_.failure());
    const std::uint64_t found = std::min(window_.bytes_from(begin.offset), left);
    const std::string_view text(reinterpret_cast<const char*>(bytes),
                                static_cast<std::size_t>(found));
    const std::size_t whole = text.size() == left ? text.size() : whole_lines(text);
    const bool divides = whole == 0 && long_lines_ == LongLines::kDivided;
    const std::size_t part = divides ? whole_words(text) : 0;
    if (whole + part > 0) {
      set_text(text.substr(0, whole + part), begin);
      continues_ = is_divided();
      part_bytes_ = part;
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
