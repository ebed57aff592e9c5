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
  const auto capacity = std::as_writable_bytes(std::span(buffer_).subspan(end_));
  const auto bytes = file_.read(capacity);
  if (!bytes) return bytes.error();
  ended_ = *bytes < capacity.size();
  end_ += *bytes;
  return {};
}

Result<bool> LineReader::next() {
  const char* newline = nullptr;
  for (;;) {
    const char* start = buffer_.data() + begin_;
    newline = static_cast<const char*>(std::memchr(start, '\n', end_ - begin_));
    if (newline != nullptr || ended_ || end_ - begin_ > kMaxLineBytes) break;
    if (const auto filled = refill(); !filled) return filled.error();
  }
  if (newline == nullptr && begin_ == end_) return false;
  ++number_;
  const char* start = buffer_.data() + begin_;
  const std::size_t length =
      newline != nullptr ? static_cast<std::size_t>(newline - start) : end_ - begin_;
  if (length > kMaxLineBytes)
    return make_error(ErrorCode::kBadInput, Error::kNowhere, Error::kNowhere,
                      "line %" PRIu64 " is longer than %zu bytes; give one point a line", number_,
                      kMaxLineBytes);
  line_ = {start, length};
  begin_ += length + (newline != nullptr ? 1 : 0);
  if (line_.ends_with('\r')) line_.remove_suffix(1);
  return true;
}

}  // namespace planetree::tools
