#include <cstdint>

#include "python/fields.h"
#include "python/inputs.h"

namespace planetree::python {

namespace py = pybind11;

namespace {

[[noreturn]] void refuse(const std::string& name, const std::string& what) {
  throw py::value_error("'" + name + "' " + what);
}

bool is_aligned(const py::array& array) {
  return (array.flags() & py::detail::npy_api::NPY_ARRAY_ALIGNED_) != 0;
}

bool is_contiguous(const py::array& array) {
  return (array.flags() & py::detail::npy_api::NPY_ARRAY_C_CONTIGUOUS_) != 0;
}

py::dtype dtype_of(char kind) {
  switch (kind) {
    case 'd':
      return py::dtype::of<double>();
    case 'f':
      return py::dtype::of<float>();
    case 'L':
      return py::dtype::of<std::uint64_t>();
    case 'I':
      return py::dtype::of<std::uint32_t>();
    default:
      return py::dtype::of<std::uint8_t>();
  }
}

void check_type(const std::string& name, const py::array& array, char kind) {
  const py::dtype wanted = dtype_of(kind);
  if (!array.dtype().equal(wanted))
    refuse(name, "has numbers of the type " +
                     py::cast<std::string>(py::str(py::handle(array.dtype()))) + "; it needs " +
                     py::cast<std::string>(py::str(py::handle(wanted))));
}

}  // namespace

std::byte* checked_rows(const std::string& name, const py::handle& object, char kind,
                        std::size_t width, std::size_t count) {
  if (!py::isinstance<py::array>(object)) refuse(name, "is no array");
  auto array = py::reinterpret_borrow<py::array>(object);
  check_type(name, array, kind);
  if (!is_contiguous(array) || !is_aligned(array) || !array.writeable())
    refuse(name, "must be a C-contiguous, aligned and writable array");
  if (static_cast<std::size_t>(array.size()) != count * width)
    refuse(name, "has " + std::to_string(array.size()) + " numbers; " +
                     std::to_string(count * width) + " are needed");
  return static_cast<std::byte*>(array.mutable_data());
}

Rows::Rows(const std::string& name, const py::array& array, std::size_t width)
    : first_(static_cast<const std::byte*>(array.data())), step_(0), count_(0) {
  check_type(name, array, 'd');
  if (!is_aligned(array)) refuse(name, "must be an aligned array");
  const bool is_flat = width == 1 && array.ndim() == 1;
  const bool is_table = array.ndim() == 2 && array.shape(1) == static_cast<py::ssize_t>(width) &&
                        (width == 1 || array.strides(1) == sizeof(double));
  if (!is_flat && !is_table)
    refuse(name, "must have the shape (count, " + std::to_string(width) + ")");
  step_ = array.strides(0);
  count_ = static_cast<std::size_t>(array.shape(0));
}

void check_triples(const std::string& name, const py::array& array, char kind) {
  check_type(name, array, kind);
  if (array.ndim() != 2 || array.shape(1) != 3) refuse(name, "must have the shape (count, 3)");
  if (!is_contiguous(array) || !is_aligned(array))
    refuse(name, "must be a C-contiguous and aligned array");
}

void check_count(const std::string& name, std::size_t count, std::size_t wanted) {
  if (count != wanted)
    refuse(name,
           "has " + std::to_string(count) + " rows; " + std::to_string(wanted) + " are needed");
}

}  // namespace planetree::python
