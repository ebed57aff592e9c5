#pragma once

#include <memory>

#include <pybind11/pybind11.h>

#include "python/model_handle.h"

namespace planetree::python {

/// Adds triangles() to the class of models: triangles by their indices, with what the file keeps of
/// them. Its arguments are arrays of the right types and shapes, which planetree/_triangles.py
/// makes. It checks them again.
void define_triangles(pybind11::class_<ModelHandle, std::shared_ptr<ModelHandle>>& model);

}  // namespace planetree::python
