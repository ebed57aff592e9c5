#pragma once

#include <filesystem>
#include <memory>

#include "planetree/error.h"
#include "query/model_state.h"

namespace planetree::tools {

/// A model that is opened to hold what its file says against its triangles, and who reads it.
///
/// memory  256 MiB of pages at most
struct ProofModel {
  static Result<ProofModel> open(const std::filesystem::path& path);

  std::unique_ptr<query::ModelState> model;
  cache::Reader reader;
};

}  // namespace planetree::tools
