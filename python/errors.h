#pragma once

#include <filesystem>
#include <utility>

#include <pybind11/pybind11.h>

#include "planetree/error.h"

namespace planetree::python {

/// A failure of the library on its way to Python, where it becomes a planetree.Error.
struct Failure {
  Error error;
  std::filesystem::path file{};  ///< that the failure concerns; empty: none
};

/// Returns the value of a result, or throws its error as a Failure.
template <class T>
T value_of(Result<T> result, const std::filesystem::path& file = {}) {
  if (!result) throw Failure{result.error(), file};
  return *std::move(result);
}

/// Adds planetree.Error to the module, with the attributes code, page and offset, and makes
/// Failures raise it.
void define_error(pybind11::module_& module);

}  // namespace planetree::python
