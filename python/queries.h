#pragma once

#include <memory>

#include <pybind11/pybind11.h>

#include "python/model_handle.h"

namespace planetree::python {

/// Adds the queries of many points, rays and moving balls to the class of models. Their arguments
/// are arrays of the right types and shapes, which planetree/_model.py makes. Each checks them
/// again, and writes its answers to the arrays in `outputs`, by field.
void define_queries(pybind11::class_<ModelHandle, std::shared_ptr<ModelHandle>>& model);

}  // namespace planetree::python
