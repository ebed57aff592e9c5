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

/// A stream of bytes, from a file that it closes or from one that it borrows.
class InputFile {
 public:
  /// errors  as storage::file_error()
  static Result<InputFile> open(const std::string& path);
  /// `stream` must outlive this.
  static InputFile borrow(std::FILE* stream) { return InputFile(stream, false); }

  /// Reads until `out` is full or the file ends; returns how many bytes.
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

/// The lines of a stream, each at most kMaxLineBytes long.
class LineReader {
 public:
  static constexpr std::size_t kMaxLineBytes = std::size_t{1} << 16;

  explicit LineReader(InputFile file) : file_(std::move(file)), buffer_(2 * kMaxLineBytes) {}

  /// Steps to the next line; false at the end.
  /// errors  kBadInput for a line that is too long; kReadFailed.
  Result<bool> next();

  /// The current line without what ends it ("\n" or "\r\n"); good until next().
  std::string_view line() const { return line_; }
  /// Counted from 1.
  std::uint64_t number() const { return number_; }

 private:
  Result<void> refill();

  InputFile file_;
  std::vector<char> buffer_;
  std::size_t begin_ = 0;  // of what is not yet a line
  std::size_t end_ = 0;
  bool ended_ = false;
  std::string_view line_;
  std::uint64_t number_ = 0;
};

}  // namespace planetree::tools
