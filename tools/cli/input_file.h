#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "planetree/error.h"

namespace planetree::tools {

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

 private:
  struct Close {
    bool owned = false;
    void operator()(std::FILE* stream) const {
      if (owned) std::fclose(stream);
    }
  };
  InputFile(std::FILE* stream, bool owned) : stream_(stream, Close{owned}) {}

  std::unique_ptr<std::FILE, Close> stream_;
};

/// Reads a stream line by line. Lines are at most kMaxLineBytes long.
class LineReader {
 public:
  static constexpr std::size_t kMaxLineBytes = std::size_t{1} << 16;

  explicit LineReader(InputFile file) : file_(std::move(file)), buffer_(2 * kMaxLineBytes) {}

  /// Advances to the next line. False at the end.
  ///
  /// errors  kBadInput for a line that is too long; kReadFailed.
  Result<bool> next();

  /// The current line without its end ("\n" or "\r\n"). Valid until next().
  std::string_view line() const { return line_; }
  /// Number of the current line, from 1.
  std::uint64_t number() const { return number_; }

 private:
  Result<void> refill();

  InputFile file_;
  std::vector<char> buffer_;
  std::size_t begin_ = 0;  // of the bytes not yet returned
  std::size_t end_ = 0;
  bool ended_ = false;
  std::string_view line_;
  std::uint64_t number_ = 0;
};

}  // namespace planetree::tools
