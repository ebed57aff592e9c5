#pragma once

#include <cstdint>
#include <string>
#include <string_view>

/// Reading text meshes: lines, words and numbers. Nothing here depends on the
/// locale.
namespace planetree::octree {

/// Where a line begins.
struct TextPosition {
  std::uint64_t offset = 0;  ///< byte in the file
  std::uint64_t line = 1;    ///< counted from 1
};

/// What ends a line. With kAny each of "\n", "\r\n" and "\r" does, in any
/// mixture; the others are for text that binary data follows.
enum class LineEnd : std::uint8_t { kAny, kNewline, kCarriageReturn };

/// Whether a '#' begins a comment, which then goes on to the end of its line.
/// One behind a '.' does not: "1.#IND" is what some print for a NaN.
enum class LineComment : std::uint8_t { kNone, kHash };

/// Where the text of a file begins, of which this is the front: behind a byte order mark, if it has
/// one.
TextPosition text_begin(std::string_view file) noexcept;

/// Steps through the lines of a text.
class LineScanner {
 public:
  explicit LineScanner(std::string_view text, TextPosition start = {},
                       LineEnd line_end = LineEnd::kAny,
                       LineComment comment = LineComment::kNone) noexcept
      : text_(text), line_end_(line_end), comment_(comment), position_(start), after_(start) {}

  /// Steps to the next line; false at the end of the text.
  bool next() noexcept;
  /// Steps to the next line that holds a word; false at the end of the text.
  bool next_filled() noexcept;

  /// The current line without its comment and what ends it.
  [[nodiscard]] std::string_view line() const noexcept { return line_; }
  /// Where the current line begins.
  [[nodiscard]] TextPosition position() const noexcept { return position_; }
  /// Where the line after it begins.
  [[nodiscard]] TextPosition after() const noexcept { return after_; }

 private:
  [[nodiscard]] bool ends_line(char c) const noexcept;

  std::string_view text_;
  LineEnd line_end_;
  LineComment comment_;
  std::string_view line_;
  TextPosition position_;
  TextPosition after_;
};

/// Whether a character parts words.
constexpr bool is_space(char c) noexcept {
  return c == ' ' || c == '\t' || c == '\r' || c == '\n' || c == '\v' || c == '\f';
}

/// Takes the first word off `rest`; empty when there is none.
std::string_view take_word(std::string_view& rest) noexcept;

/// Whether `word` is `lower`, which is in lower case, in any case.
bool is_same_word(std::string_view word, std::string_view lower) noexcept;

/// Reads all of `word` as a number, correctly rounded to T. A number too large
/// for T is infinite, as are "inf" and its kin; "nan" and what old Microsoft
/// libraries print ("-1.#IND") are not a number. False if it is none of these.
bool parse_real(std::string_view word, float& value) noexcept;
bool parse_real(std::string_view word, double& value) noexcept;

/// Reads a decimal integer off the front of `word` and leaves the remainder; a
/// number too large is the nearest that fits. False if there is none.
bool take_integer(std::string_view& word, std::int64_t& value) noexcept;

/// `word`, fit to be quoted in a one-line message: short and printable.
std::string printable(std::string_view word);

}  // namespace planetree::octree
