#pragma once

#include <pybind11/pybind11.h>

namespace planetree::python {

/// Adds Probe, which answers one query at a time, and the values that it takes and returns.
void define_probe(pybind11::module_& module);

}  // namespace planetree::python
