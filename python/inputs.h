#pragma once

#include <cstddef>
#include <span>
#include <string>

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include "planetree/types.h"

namespace planetree::python {

/// Rows of doubles of an array of shape (count, width) with any distance between rows. For points
/// from the columns of a larger array, and for one row that stands for all.
class Rows {
 public:
  /// The array must outlive this.
  ///
  /// throws  ValueError that names the array, if it has another shape or numbers
  Rows(const std::string& name, const pybind11::array& array, std::size_t width);

  std::size_t count() const noexcept { return count_; }
  const double* row(std::size_t i) const noexcept {
    return reinterpret_cast<const double*>(first_ + static_cast<std::ptrdiff_t>(i) * step_);
  }
  double number(std::size_t i) const noexcept { return *row(i); }
  Vec3 point(std::size_t i) const noexcept {
    const double* at = row(i);
    return {at[0], at[1], at[2]};
  }

 private:
  const std::byte* first_;
  std::ptrdiff_t step_;
  std::size_t count_;
};

/// Throws ValueError that names the array, unless it is aligned, C-contiguous, of shape (count, 3),
/// and of the kind: as NumPy's dtype.char, in the machine's byte order.
void check_triples(const std::string& name, const pybind11::array& array, char kind);

/// Returns the rows of an array that check_triples() accepts, without a copy.
template <class Row>
std::span<const Row> triples_of(const std::string& name, const pybind11::array& array, char kind) {
  check_triples(name, array, kind);
  return {static_cast<const Row*>(array.data()), static_cast<std::size_t>(array.shape(0))};
}
inline std::span<const Vec3> points_of(const std::string& name, const pybind11::array& array) {
  static_assert(sizeof(Vec3) == 3 * sizeof(double));
  return triples_of<Vec3>(name, array, 'd');
}

/// Throws ValueError unless an array has as many rows as another one.
void check_count(const std::string& name, std::size_t count, std::size_t wanted);

}  // namespace planetree::python
