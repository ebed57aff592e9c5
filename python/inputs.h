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

/// Returns the points of a C-contiguous array of shape (count, 3), without a copy.
///
/// throws  ValueError that names the array, if it is another
std::span<const Vec3> points_of(const std::string& name, const pybind11::array& array);

/// Throws ValueError unless an array has as many rows as another one.
void check_count(const std::string& name, std::size_t count, std::size_t wanted);

}  // namespace planetree::python
