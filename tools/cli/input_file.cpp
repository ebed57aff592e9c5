#include "tools/cli/input_file.h"

#include <algorithm>
#include <cerrno>
#include <cinttypes>
#include <cstring>

#include "storage/system/file_error.h"

namespace planetree::tools {

Result<InputFile> InputFile::open(const std::string& path) {
  std::FILE* stream = std::fopen(path.c_str(), "rbe");
  if (stream == nullptr) return storage::file_error(errno, storage::FileAction::kRead, "open it");
  return InputFile(stream, true);
}

Result<std::size_t> InputFile::read(std::span<std::byte> out) {
  if (front_read_ == front_.size()) return read_stream(out);
  const std::size_t bytes = std::min(out.size(), front_.size() - front_read_);
  std::memcpy(out.data(), front_.data() + front_read_, bytes);
  front_read_ += bytes;
  if (bytes == out.size()) return bytes;
  const auto more = read_stream(out.subspan(bytes));
  if (!more) return more;
  return bytes + *more;
}

Result<std::string_view> InputFile::front(std::size_t bytes) {
  constexpr std::size_t kFirstBytes = 4096;
  for (std::size_t wanted = std::min(kFirstBytes, bytes);; wanted = std::min(4 * wanted, bytes)) {
    const std::size_t before = front_.size();
    front_.resize(wanted);
    const auto read = read_stream(std::as_writable_bytes(std::span(front_).subspan(before)));
    front_.resize(before + (read ? *read : 0));
    if (!read) return read.error();
    if (front_.size() < wanted || wanted == bytes)
      return std::string_view(front_.data(), front_.size());
  }
}

Result<std::size_t> InputFile::read_stream(std::span<std::byte> out) {
  const std::size_t bytes = std::fread(out.data(), 1, out.size(), stream_.get());
  if (bytes < out.size() && std::ferror(stream_.get()) != 0)
    return storage::file_error(errno, storage::FileAction::kRead, "read it");
  return bytes;
}

Result<void> LineReader::refill() {
  std::copy(buffer_.begin() + static_cast<std::ptrdiff_t>(begin_),
            buffer_.begin() + static_cast<std::ptrdiff_t>(end_), buffer_.begin());
  end_ -= begin_;
  begin_ = 0;
  newline_ = 0;
  const auto capacity = std::as_writable_bytes(std::span(buffer_).subspan(end_));
  const auto bytes = file_.read(capacity);
  if (!bytes) return bytes.error();
  ended_ = *bytes < capacity.size();
  end_ += *bytes;
  return {};
}

bool LineReader::find_line_end() {
  const char* const bytes = buffer_.data();
  const auto find = [bytes](char c, std::size_t from, std::size_t to) {
    const void* const found = std::memchr(bytes + from, c, to - from);
    return found == nullptr ? to
                            : static_cast<std::size_t>(static_cast<const char*>(found) - bytes);
  };
  if (newline_ <= begin_) newline_ = find('\n', begin_, end_);
  line_end_ = find('\r', begin_, newline_);
  next_line_ = std::min(line_end_ + 1, end_);
  if (line_end_ == newline_) return newline_ < end_ || ended_;
  // A '\n' behind the '\r' may not be in the buffer yet.
  if (next_line_ == end_) return ended_;
  if (next_line_ == newline_) ++next_line_;
  return true;
}

Result<bool> LineReader::next() {
  while (!find_line_end() && line_end_ - begin_ <= kMaxLineBytes)
    if (const auto filled = refill(); !filled) return filled.error();
  if (begin_ == end_) return false;
  ++number_;
  const std::size_t length = line_end_ - begin_;
  if (length > kMaxLineBytes)
    return make_error(ErrorCode::kBadInput, Error::kNowhere, Error::kNowhere,
                      "line %" PRIu64 " is longer than %zu bytes; give one point a line", number_,
                      kMaxLineBytes);
  line_ = {buffer_.data() + begin_, length};
  begin_ = next_line_;
  return true;
}

}  // namespace planetree::tools
