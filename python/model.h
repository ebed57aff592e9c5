#pragma once

#include <pybind11/pybind11.h>

namespace planetree::python {

/// Adds Model, an open file, with its contents and counters.
void define_model(pybind11::module_& module);

}  // namespace planetree::python
