#pragma once

#include <fmt/format.h>

#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "tools/answers/answer_fields.h"
#include "tools/arrays/column.h"

/// The fields of a row of answers in the columns of an array. Both classes here have the members of
/// those in answer_fields.h. Fields that were not requested have no column. A field without a value
/// is NaN, -1 as a count, 0 as an integer or a flag, and kNoWord as a word.
namespace planetree::tools {

inline constexpr std::uint8_t kNoWord = 255;

/// The columns that rows have.
class ColumnFields {
 public:
  explicit ColumnFields(std::vector<Column>& columns) : columns_(columns) {}

  void number(std::string_view name, double, FieldState state = FieldState::kKnown) {
    add(name, NumberType::kFloat64, state);
  }
  void vector(const VectorName& name, const std::array<double, 3>&, FieldState state) {
    add(name.name, NumberType::kFloat64, state);
    if (state != FieldState::kNotRequested)
      columns_.back().parts.assign(name.parts.begin(), name.parts.end());
  }
  void count(std::string_view name, std::uint64_t, FieldState state) {
    add(name, NumberType::kInt64, state);
  }
  void integer(std::string_view name, std::int64_t, FieldState state) {
    add(name, NumberType::kInt64, state);
  }
  void flag(std::string_view name, bool, FieldState state) { add(name, NumberType::kBool, state); }
  void code(std::string_view name, const Word&, double, FieldState state) {
    add(name, NumberType::kUint8, state);
  }
  void word(std::string_view name, const Word&, FieldState state = FieldState::kKnown) {
    add(name, NumberType::kUint8, state);
  }
  void end() {}

 private:
  void add(std::string_view name, NumberType type, FieldState state) {
    if (state != FieldState::kNotRequested) columns_.push_back({std::string(name), type});
  }

  std::vector<Column>& columns_;
};

/// The bytes of a row, one field behind the other without gaps.
class PackedFields {
 public:
  explicit PackedFields(fmt::memory_buffer& bytes) : bytes_(bytes) {}

  void number(std::string_view, double value, FieldState state = FieldState::kKnown) {
    add(value, std::numeric_limits<double>::quiet_NaN(), state);
  }
  void vector(const VectorName&, const std::array<double, 3>& values, FieldState state) {
    for (const double value : values) number({}, value, state);
  }
  void count(std::string_view, std::uint64_t value, FieldState state) {
    add(static_cast<std::int64_t>(value), std::int64_t{-1}, state);
  }
  void integer(std::string_view, std::int64_t value, FieldState state) {
    add(value, std::int64_t{0}, state);
  }
  void flag(std::string_view, bool value, FieldState state) {
    add(static_cast<std::uint8_t>(value), std::uint8_t{0}, state);
  }
  void code(std::string_view, const Word& word, double, FieldState state) {
    add(word.number, kNoWord, state);
  }
  void word(std::string_view, const Word& word, FieldState state = FieldState::kKnown) {
    add(word.number, kNoWord, state);
  }
  void end() {}

 private:
  template <class Value>
  void add(Value value, Value none, FieldState state) {
    static_assert(std::endian::native == std::endian::little, "numbers are written in place");
    if (state == FieldState::kNotRequested) return;
    const auto bytes =
        std::bit_cast<std::array<char, sizeof value>>(state == FieldState::kKnown ? value : none);
    bytes_.append(bytes.data(), bytes.data() + bytes.size());
  }

  fmt::memory_buffer& bytes_;
};

}  // namespace planetree::tools
