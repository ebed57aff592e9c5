#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "planetree/error.h"

namespace planetree::tools {

/// The extension of a file's name with its dot, in small letters: ".ply" of "scan.PLY". Empty if
/// there is none.
[[nodiscard]] inline std::string lower_extension(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c | 0x20) : c; });
  return extension;
}

/// A stream of bytes that is owned and closed, or borrowed.
class InputFile {
 public:
  /// Opens a file that the destructor closes.
  ///
  /// errors  as storage::file_error()
  static Result<InputFile> open(const std::string& path);
  /// Borrows a stream, which must outlive this.
  static InputFile borrow(std::FILE* stream) { return InputFile(stream, false); }

  /// Reads until `out` is full or the file ends. Returns the number of bytes read.
  ///
  /// errors  as storage::file_error()
  Result<std::size_t> read(std::span<std::byte> out);

  /// The next `bytes` bytes, or all that are left. read() still returns them. Called once, before
  /// read(). Valid until the next call of read().
  ///
  /// errors  as storage::file_error()
  Result<std::string_view> front(std::size_t bytes);

 private:
  struct Close {
    bool owned = false;
    void operator()(std::FILE* stream) const {
      if (owned) std::fclose(stream);
    }
  };
  InputFile(std::FILE* stream, bool owned) : stream_(stream, Close{owned}) {}

  Result<std::size_t> read_stream(std::span<std::byte> out);

  std::unique_ptr<std::FILE, Close> stream_;
  std::vector<char> front_;
  std::size_t front_read_ = 0;  // bytes of front_ that read() has returned
};

/// Reads a stream line by line. Each of "\n", "\r\n" and "\r" ends a line, in any mixture. Lines
/// are at most kMaxLineBytes long.
class LineReader {
 public:
  static constexpr std::size_t kMaxLineBytes = std::size_t{1} << 16;

  explicit LineReader(InputFile file) : file_(std::move(file)), buffer_(2 * kMaxLineBytes) {}

  /// Advances to the next line. False at the end.
  ///
  /// errors  kBadInput for a line that is too long; kReadFailed.
  Result<bool> next();

  /// The current line without its end. Valid until next().
  std::string_view line() const { return line_; }
  /// Number of the current line, from 1.
  std::uint64_t number() const { return number_; }

 private:
  Result<void> refill();
  /// Finds the end of the first line of the buffer. False if more bytes must be read first.
  bool find_line_end();

  InputFile file_;
  std::vector<char> buffer_;
  std::size_t begin_ = 0;  // of the bytes not yet returned
  std::size_t end_ = 0;
  std::size_t newline_ = 0;    // of the first '\n' from begin_ on; end_ if there is none
  std::size_t line_end_ = 0;   // of the first line
  std::size_t next_line_ = 0;  // where the second begins
  bool ended_ = false;
  std::string_view line_;
  std::uint64_t number_ = 0;
};

}  // namespace planetree::tools
