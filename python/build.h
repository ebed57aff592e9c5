#pragma once

#include <pybind11/pybind11.h>

namespace planetree::python {

/// Adds the functions that build files, and BuildReport.
void define_build(pybind11::module_& module);

}  // namespace planetree::python
