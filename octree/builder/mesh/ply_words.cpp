#include "octree/builder/mesh/ply_words.h"

#include <bit>
#include <charconv>
#include <cinttypes>
#include <utility>

#include "octree/builder/mesh/ply_attributes.h"

namespace planetree::octree {

namespace {

/// Whether a line, which has no white space at its front, is a comment.
bool is_comment(std::string_view line) {
  if (line.front() != 'c' && line.front() != 'o') return false;
  const std::string_view word = take_word(line);
  return word == "comment" || word == "obj_info";
}

/// Whether a number may have more than nine digits that count. Fast, since most have not.
bool may_exceed_float(std::string_view word, double value) {
  constexpr std::size_t kDigitsAndPoint = 10;
  if (word.size() <= kDigitsAndPoint) return value >= 1e9;
  const bool has_sign = word.front() == '-' || word.front() == '+';
  const bool has_zero = word[has_sign ? 1 : 0] == '0';
  return word.size() - has_sign - has_zero > kDigitsAndPoint || value >= 1e9 || value <= -1e9;
}

/// Parses all of a word as an integer that fits.
template <class T>
bool parse_whole(std::string_view word, T& value) {
  if (word.starts_with('+')) word.remove_prefix(1);
  const char* const end = word.data() + word.size();
  const auto [behind, failure] = std::from_chars(word.data(), end, value);
  return failure == std::errc() && behind == end && !word.empty();
}

}  // namespace

PlyWords::PlyWords(const MeshFile& file, const TextPosition& begin, PlyLayout& layout)
    : PlyWords(file, State{begin, begin, {}, 0, {}, begin.records > 0}, layout) {}

PlyWords::PlyWords(const MeshFile& file, State state, PlyLayout& layout)
    : layout_(layout),
      lines_(file, state.next, layout.has_hashes ? LineComment::kHash : LineComment::kNone,
             layout.window_bytes, LongLines::kDivided),
      records_on_line_(state.next.records),
      state_(std::move(state)) {
  if (state_.is_within_line && lines_.next()) rest_ = lines_.line();
}

bool PlyWords::next_line() {
  while (lines_.next()) {
    rest_ = lines_.line();
    skip_blanks(rest_);
    if (lines_.continues()) {
      if (!rest_.empty()) return true;
      continue;
    }
    records_on_line_ = 0;
    if (rest_.empty()) continue;
    if (layout_.has_hashes || !is_comment(rest_)) return true;
    while (lines_.is_divided() && lines_.next()) {
    }
  }
  rest_ = {};
  if (lines_.failure()) error_ = lines_.failure();
  return false;
}

/// Whether a further word is on the current line.
bool PlyWords::has_word_on_line() {
  skip_blanks(rest_);
  while (rest_.empty() && lines_.is_divided() && lines_.next()) {
    rest_ = lines_.line();
    skip_blanks(rest_);
  }
  return !rest_.empty();
}

TextPosition PlyWords::position() const {
  const auto in_line = static_cast<std::uint64_t>(rest_.data() - lines_.line().data());
  return {lines_.position().offset + in_line, lines_.position().line, records_on_line_};
}

bool PlyWords::begin_within_line() {
  if (!has_word_on_line()) return false;
  if (!layout_.has_hashes && is_comment(rest_)) {
    while (lines_.is_divided() && lines_.next()) {
    }
    rest_ = {};
    return false;
  }
  state_.begin = position();
  std::string_view rest = rest_;
  state_.first_word = printable(take_word(rest));
  return true;
}

bool PlyWords::begin_record() {
  state_.crossed = 0;
  if (layout_.is_loose) {
    (void)words_left_on_line();
  } else if (records_on_line_ > 0 && begin_within_line()) {
    return true;
  }
  if (!next_line()) return false;
  state_.begin = lines_.position();
  return true;
}

bool PlyWords::integer_on_line(std::int64_t& value) {
  if (!has_word_on_line()) return false;
  std::string_view word = take_word(rest_);
  return take_integer(word, value) && word.empty();
}

std::uint64_t PlyWords::words_left_on_line() {
  std::uint64_t count = 0;
  while (has_word_on_line()) {
    take_word(rest_);
    ++count;
  }
  return count;
}

std::string_view PlyWords::word_of_next_line(const PlyProperty& property) {
  const std::uint64_t line = lines_.position().line;
  if (!next_line()) {
    const bool is_surplus = state_.begin.records > 0 && state_.crossed > 0 && !is_of_stream();
    if (!error_ && is_surplus) error_ = surplus_error();
    if (!error_)
      error_ = error_at({lines_.position().offset, line, 0},
                        "the file ends in front of '" + printable(property.name) + "'");
    return {};
  }
  if (!lines_.continues() && state_.crossed == 0) {
    state_.crossed = line;
    state_.missing = printable(property.name);
  }
  if (lines_.position().offset - state_.begin.offset > max_record_bytes_) {
    fail(error_here("the record is longer than " + std::to_string(MeshLines::kMaxLineBytes >> 20) +
                    " MiB; write such a mesh as a binary PLY"));
    return {};
  }
  return take_word(rest_);
}

// A record that begins a line and ends one is laid out on purpose. So is one that follows others on
// its line, if those are many. Otherwise the records do not have the numbers that they should have.
bool PlyWords::check_crossing() {
  if (layout_.is_loose) return true;
  if (is_of_stream()) {
    layout_.is_stream = true;
    return true;
  }
  if (state_.begin.records > 0) return fail(surplus_error());
  if (!has_word_on_line()) return true;
  return fail(crossing_error());
}

bool PlyWords::integer(const PlyProperty& property, std::int64_t& value) {
  const std::string_view word = this->word(property);
  std::string_view rest = word;
  if (take_integer(rest, value) && rest.empty()) return true;
  return no_number(property, word, "an integer");
}

bool PlyWords::length(const PlyProperty& property, std::int64_t& value) {
  if (!integer(property, value)) return false;
  if (value >= 0) return true;
  return fail(error_here("list '" + printable(property.name) + "' has a negative length"));
}

bool PlyWords::real(const PlyProperty& property, double& value) {
  const std::string_view word = this->word(property);
  if (!fits_float32(property.type)) {
    if (parse_real(word, value)) return true;
    return no_number(property, word, "a number");
  }
  float narrow = 0;
  if (!parse_real(word, narrow, value)) return no_number(property, word, "a number");
  if (value != static_cast<double>(narrow)) {
    if (rounded_ != nullptr && may_exceed_float(word, value) && exceeds_float(word, narrow, value))
      rounded_->add(lines_.position().line, word);
    value = static_cast<double>(narrow);
  }
  return true;
}

bool PlyWords::number(const PlyProperty& property, double& value) {
  MeshNote* const rounded = std::exchange(rounded_, nullptr);
  const bool is_number = real(property, value);
  rounded_ = rounded;
  return is_number;
}

bool PlyWords::value(const PlyProperty& property, std::uint64_t& value) {
  const ValueKind kind = kind_of(property.type);
  if (kind == ValueKind::kReal) {
    double number = 0;
    if (!this->number(property, number)) return false;
    value = std::bit_cast<std::uint64_t>(number);
    return true;
  }
  const std::string_view word = this->word(property);
  if (kind == ValueKind::kUnsigned)
    return parse_whole(word, value) || no_number(property, word, "an unsigned integer");
  std::int64_t number = 0;
  if (!parse_whole(word, number)) return no_number(property, word, "an integer");
  value = std::bit_cast<std::uint64_t>(number);
  return true;
}

bool PlyWords::pass(const PlyProperty& property) {
  std::int64_t count = 1;
  if (property.is_list && !length(property, count)) return false;
  for (std::int64_t i = 0; i < count; ++i) {
    if (!word(property).empty()) continue;
    return false;
  }
  return true;
}

bool PlyWords::pass(const PlyElement& element, std::size_t first, std::size_t end) {
  for (std::size_t i = first; i < end; ++i)
    if (!pass(element.properties[i])) return false;
  return true;
}

bool PlyWords::no_number(const PlyProperty& property, std::string_view word, const char* what) {
  if (error_) return false;
  return fail(error_at(lines_.position(), "'" + printable(word) + "' in '" +
                                              printable(property.name) + "' is not " + what));
}

TextPosition PlyWords::after() {
  if (!layout_.is_loose && records_on_line_ > 0 && has_word_on_line()) return position();
  while (lines_.is_divided() && lines_.next()) {
  }
  return lines_.after();
}

PlyWords::State PlyWords::state() {
  State state = state_;
  state.is_within_line = has_word_on_line();
  state.next = state.is_within_line ? position() : lines_.after();
  return state;
}

bool PlyWords::fail(const Error& error) {
  error_ = error;
  return false;
}

Error PlyWords::ended(const PlyElement& element, std::uint64_t record) {
  if (error_) return *error_;
  return error_at(after(), "the file ends at record " + std::to_string(record) + " of " +
                               std::to_string(element.count) + " '" + printable(element.name) +
                               "'");
}

Error PlyWords::crossing_error() const {
  return error_at({state_.begin.offset, state_.crossed, 0},
                  "the line ends in front of '" + state_.missing + "'");
}

Error PlyWords::error_here(const std::string& cause) const { return error_at(state_.begin, cause); }

Error PlyWords::error_at(const TextPosition& position, const std::string& cause) const {
  return make_error(ErrorCode::kBadInput, Error::kNowhere, position.offset,
                    "line %" PRIu64 ": %s; copy or export the mesh again", position.line,
                    cause.c_str());
}

}  // namespace planetree::octree
