#pragma once

#include <cstddef>
#include <cstring>
#include <span>
#include <string>
#include <vector>

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

namespace planetree::python {

/// A field of answers as a column: an array with one row for each answer.
template <class Answer>
struct Field {
  const char* name;
  char kind;  ///< of the array's numbers, as NumPy's dtype.char: d double, L uint64, B uint8
  std::size_t width;  ///< numbers of a row
  /// Writes the rows of some answers.
  void (*write)(std::span<const Answer> answers, std::byte* rows) noexcept;

  std::size_t row_bytes() const noexcept { return width * (kind == 'B' ? 1 : 8); }
};

/// Makes a Field whose rows are what get(answer) returns: a trivial type of `width` numbers.
template <class Answer, auto kGet>
constexpr Field<Answer> field(const char* name, char kind, std::size_t width = 1) {
  return {name, kind, width, [](std::span<const Answer> answers, std::byte* rows) noexcept {
            for (const Answer& answer : answers) {
              const auto row = kGet(answer);
              std::memcpy(rows, &row, sizeof row);
              rows += sizeof row;
            }
          }};
}

/// Checks an array that a call writes to: a C-contiguous, writable array of `count` rows. Returns
/// its memory.
///
/// throws  ValueError that names the array
std::byte* checked_rows(const std::string& name, const pybind11::handle& array, char kind,
                        std::size_t width, std::size_t count);

/// Columns that a call fills.
template <class Answer>
class Columns {
 public:
  /// outputs  arrays by name, each of `count` rows
  /// fields   all that there are
  ///
  /// throws   ValueError for a name that no field has, and for an unsuitable array
  template <std::size_t kCount>
  Columns(const pybind11::dict& outputs, const Field<Answer> (&fields)[kCount], std::size_t count) {
    for (const auto& [key, array] : outputs) {
      const auto name = pybind11::cast<std::string>(key);
      const Field<Answer>* found = nullptr;
      for (const Field<Answer>& some : fields)
        if (name == some.name) found = &some;
      if (!found) throw pybind11::value_error("there is no field '" + name + "'");
      columns_.push_back({found, checked_rows(name, array, found->kind, found->width, count)});
    }
  }

  /// Writes the rows of some answers from row `first` on. Needs no lock of Python's.
  void write(std::size_t first, std::span<const Answer> answers) const noexcept {
    for (const Column& column : columns_)
      column.field->write(answers, column.rows + first * column.field->row_bytes());
  }

 private:
  struct Column {
    const Field<Answer>* field;
    std::byte* rows;
  };
  std::vector<Column> columns_;
};

}  // namespace planetree::python
