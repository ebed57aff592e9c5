#pragma once

#include <fmt/format.h>

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <limits>
#include <string_view>

#include "tools/answers/answer_words.h"

/// The fields of a row of answers in each format. All classes here have the same members, so that
/// the fields of an answer are listed once for all formats.
namespace planetree::tools {

/// Whether a field has a value. Without one it is an empty column, or NaN. In JSON it is null, or
/// has no key if it was not requested.
enum class FieldState : std::uint8_t { kKnown, kNone, kNotRequested };

/// Names, for the header of CSV.
class HeaderFields {
 public:
  explicit HeaderFields(fmt::memory_buffer& text) : out_(std::back_inserter(text)) {}

  void number(std::string_view name, double, FieldState = FieldState::kKnown) { add(name); }
  void count(std::string_view name, std::uint64_t, FieldState) { add(name); }
  void integer(std::string_view name, std::int64_t, FieldState) { add(name); }
  void flag(std::string_view name, bool, FieldState) { add(name); }
  void code(std::string_view name, const Word&, double, FieldState) { add(name); }
  void word(std::string_view name, const Word&, FieldState = FieldState::kKnown) { add(name); }
  void end() { fmt::format_to(out_, "\n"); }

 private:
  void add(std::string_view name) {
    fmt::format_to(out_, "{}{}", is_first_ ? "" : ",", name);
    is_first_ = false;
  }

  std::back_insert_iterator<fmt::memory_buffer> out_;
  bool is_first_ = true;
};

class CsvFields {
 public:
  explicit CsvFields(fmt::memory_buffer& text) : out_(std::back_inserter(text)) {}

  void number(std::string_view, double value, FieldState state = FieldState::kKnown) {
    add(value, state);
  }
  void count(std::string_view, std::uint64_t value, FieldState state) { add(value, state); }
  void integer(std::string_view, std::int64_t value, FieldState state) { add(value, state); }
  void flag(std::string_view, bool value, FieldState state) { add(value ? 1 : 0, state); }
  /// A word that has a number in f64.
  void code(std::string_view, const Word& word, double, FieldState state) { add(word.text, state); }
  /// A word that f64 does not have.
  void word(std::string_view, const Word& word, FieldState state = FieldState::kKnown) {
    add(word.text, state);
  }
  void end() { fmt::format_to(out_, "\n"); }

 private:
  template <class Value>
  void add(const Value& value, FieldState state) {
    if (!is_first_) fmt::format_to(out_, ",");
    if (state == FieldState::kKnown) fmt::format_to(out_, "{}", value);
    is_first_ = false;
  }

  std::back_insert_iterator<fmt::memory_buffer> out_;
  bool is_first_ = true;
};

class JsonFields {
 public:
  explicit JsonFields(fmt::memory_buffer& text) : out_(std::back_inserter(text)) {}

  void number(std::string_view name, double value, FieldState state = FieldState::kKnown) {
    // JSON has no infinity.
    const bool is_null = state == FieldState::kKnown && !std::isfinite(value);
    add(name, value, is_null ? FieldState::kNone : state);
  }
  void count(std::string_view name, std::uint64_t value, FieldState state) {
    add(name, value, state);
  }
  void integer(std::string_view name, std::int64_t value, FieldState state) {
    add(name, value, state);
  }
  void flag(std::string_view name, bool value, FieldState state) { add(name, value, state); }
  void code(std::string_view name, const Word& word, double, FieldState state) {
    this->word(name, word, state);
  }
  void word(std::string_view name, const Word& word, FieldState state = FieldState::kKnown) {
    if (!begin(name, state)) return;
    fmt::format_to(out_, "\"{}\"", word.text);
  }
  void end() { fmt::format_to(out_, "}}\n"); }

 private:
  template <class Value>
  void add(std::string_view name, const Value& value, FieldState state) {
    if (begin(name, state)) fmt::format_to(out_, "{}", value);
  }
  /// Returns whether a value follows.
  bool begin(std::string_view name, FieldState state) {
    if (state == FieldState::kNotRequested) return false;
    fmt::format_to(out_, "{}\"{}\":", is_first_ ? '{' : ',', name);
    is_first_ = false;
    if (state == FieldState::kNone) fmt::format_to(out_, "null");
    return state == FieldState::kKnown;
  }

  std::back_insert_iterator<fmt::memory_buffer> out_;
  bool is_first_ = true;
};

class F64Fields {
 public:
  explicit F64Fields(fmt::memory_buffer& text) : text_(text) {}

  void number(std::string_view, double value, FieldState state = FieldState::kKnown) {
    static_assert(std::endian::native == std::endian::little, "f64 rows are written in place");
    if (state != FieldState::kKnown) value = std::numeric_limits<double>::quiet_NaN();
    const auto bytes = std::bit_cast<std::array<char, sizeof value>>(value);
    text_.append(bytes.data(), bytes.data() + bytes.size());
  }
  void count(std::string_view name, std::uint64_t value, FieldState state) {
    number(name, static_cast<double>(value), state);
  }
  void integer(std::string_view name, std::int64_t value, FieldState state) {
    number(name, static_cast<double>(value), state);
  }
  void flag(std::string_view name, bool value, FieldState state) {
    number(name, value ? 1 : 0, state);
  }
  void code(std::string_view name, const Word&, double value, FieldState state) {
    number(name, value, state);
  }
  void word(std::string_view, const Word&, FieldState = FieldState::kKnown) {}
  void end() {}

 private:
  fmt::memory_buffer& text_;
};

/// The names of a vector and of its numbers.
struct VectorName {
  std::string_view name;
  std::array<std::string_view, 3> parts;
};

/// A vector is one field of an array, and three numbers in all other formats.
template <class Fields, class Vector>
void add_vector(Fields& fields, const VectorName& name, const Vector& vector,
                FieldState state = FieldState::kKnown) {
  if constexpr (requires { fields.vector(name, {}, state); }) {
    fields.vector(name, {vector.x, vector.y, vector.z}, state);
  } else {
    fields.number(name.parts[0], vector.x, state);
    fields.number(name.parts[1], vector.y, state);
    fields.number(name.parts[2], vector.z, state);
  }
}

}  // namespace planetree::tools
