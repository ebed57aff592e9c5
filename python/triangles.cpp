#include "python/triangles.h"

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <pybind11/numpy.h>

#include "planetree/model.h"
#include "python/chunks.h"
#include "python/errors.h"
#include "python/inputs.h"

namespace planetree::python {
namespace {

namespace py = pybind11;

// Memory of one row in an output; null if the output is not wanted.
//
// row_bytes  bytes of a row
std::byte* rows_of(const py::dict& outputs, const char* name, std::size_t count,
                   std::size_t row_bytes) {
  if (!outputs.contains(name)) return nullptr;
  auto array = py::cast<py::array>(outputs[name]);
  const bool fits = array.writeable() && (array.flags() & py::array::c_style) != 0 &&
                    static_cast<std::size_t>(array.nbytes()) == count * row_bytes;
  if (!fits) throw py::value_error(std::string("'") + name + "' is no array of its rows");
  return static_cast<std::byte*>(array.mutable_data());
}

template <class Value>
void put(std::byte* rows, std::size_t row, const Value& value) {
  if (rows) std::memcpy(rows + row * sizeof value, &value, sizeof value);
}

void triangles(const ModelHandle& handle, const py::array& indices, const py::dict& outputs,
               const py::object& progress) {
  if (indices.dtype().char_() != 'L' || (indices.flags() & py::array::c_style) == 0)
    throw py::value_error("'indices' needs uint64, C-contiguous");
  const auto count = static_cast<std::size_t>(indices.size());
  const std::span all(static_cast<const std::uint64_t*>(indices.data()), count);
  std::byte* const corners = rows_of(outputs, "corners", count, sizeof(MeshTriangle::corners));
  std::byte* const colors = rows_of(outputs, "colors", count, sizeof(MeshTriangle::colors));
  std::byte* const uvs = rows_of(outputs, "uvs", count, sizeof(MeshTriangle::uvs));
  std::byte* const values = rows_of(outputs, "values", count, sizeof(MeshTriangle::value));
  const std::shared_ptr<OpenModel> model = handle.get();
  std::vector<MeshTriangle> found(max_chunk_rows(count, sizeof(MeshTriangle)));
  std::optional<Error> failure;
  in_chunks(count, sizeof(MeshTriangle), progress, [&](std::size_t first, std::size_t end) {
    if (failure) return;
    const auto some = std::span(found).first(end - first);
    const auto read = model->model().triangles(all.subspan(first, end - first), some);
    if (!read) {
      failure = read.error();
      return;
    }
    for (std::size_t i = 0; i < some.size(); ++i) {
      put(corners, first + i, some[i].corners);
      put(colors, first + i, some[i].colors);
      put(uvs, first + i, some[i].uvs);
      put(values, first + i, some[i].value);
    }
  });
  if (failure) throw Failure{*failure};
}

}  // namespace

void define_triangles(py::class_<ModelHandle, std::shared_ptr<ModelHandle>>& model) {
  model.def("triangles", &triangles);
}

}  // namespace planetree::python
