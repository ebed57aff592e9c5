#pragma once

#include <filesystem>
#include <memory>

#include "planetree/error.h"
#include "query/model_state.h"

namespace planetree::tools {

/// A model that is opened to look into it, below a Probe, and who reads it.
///
/// memory  256 MiB of pages at most
struct ModelReader {
  static Result<ModelReader> open(const std::filesystem::path& path);

  std::unique_ptr<query::ModelState> model;
  cache::Reader reader;
};

}  // namespace planetree::tools
