#pragma once

#include <cstdint>
#include <string>
#include <string_view>

/// Lines, words and numbers of text meshes. Nothing here depends on the locale.
namespace planetree::octree {

/// The beginning of a line, or of a record within a line.
struct TextPosition {
  std::uint64_t offset = 0;   ///< byte in the file
  std::uint64_t line = 1;     ///< counted from 1
  std::uint64_t records = 0;  ///< records that end on this line before it; 0 where the line begins
};

/// What ends a line. With kAny each of "\n", "\r\n" and "\r" does, in any mixture. The others are
/// for text that binary data follows.
enum class LineEnd : std::uint8_t { kAny, kNewline, kCarriageReturn };

/// Whether a '#' begins a comment, which ends with its line. A '#' behind a '.' does not: some
/// libraries print a NaN as "1.#IND".
enum class LineComment : std::uint8_t { kNone, kHash };

/// Position where the text of a file begins: behind a byte order mark, if there is one.
/// file  front of the file.
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

  /// The current line, without its comment and its line end.
  [[nodiscard]] std::string_view line() const noexcept { return line_; }
  /// Position where the current line begins.
  [[nodiscard]] TextPosition position() const noexcept { return position_; }
  /// Position where the next line begins.
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

/// Whether a character separates words.
constexpr bool is_space(char c) noexcept {
  return c == ' ' || c == '\t' || c == '\r' || c == '\n' || c == '\v' || c == '\f';
}

/// Removes white space from the front of `rest`.
inline void skip_blanks(std::string_view& rest) noexcept {
  std::size_t begin = 0;
  while (begin < rest.size() && is_space(rest[begin])) ++begin;
  rest.remove_prefix(begin);
}

/// Removes the first word from `rest` and returns it; empty if there is none.
std::string_view take_word(std::string_view& rest) noexcept;

/// Whether `word` equals `lower`, which is in lower case, if case is ignored.
bool is_same_word(std::string_view word, std::string_view lower) noexcept;

/// Parses all of `word` as a number, correctly rounded to T. A number too large for T gives
/// infinity, as do "inf" and its variants. "nan" gives NaN, as does what old Microsoft libraries
/// print ("-1.#IND"). False if `word` is none of these.
bool parse_real(std::string_view word, float& value) noexcept;
bool parse_real(std::string_view word, double& value) noexcept;
/// As parse_real(word, value), and gives the double that is nearest to the number.
bool parse_real(std::string_view word, float& value, double& nearest) noexcept;

/// Whether a number has more than nine digits that count, and they are not those of the float that
/// is nearest to it, as programs print it: what a float cannot hold is lost.
///
/// nearest  the double that is nearest to the number.
bool exceeds_float(std::string_view word, float value, double nearest) noexcept;

/// Removes a decimal integer from the front of `word`. One that is too large gives the nearest that
/// fits. False if there is none.
bool take_integer(std::string_view& word, std::int64_t& value) noexcept;

/// Makes `word` fit to be quoted in a one-line message: short and printable.
std::string printable(std::string_view word);

}  // namespace planetree::octree
