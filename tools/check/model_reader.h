#pragma once

#include <filesystem>
#include <memory>

#include "planetree/error.h"
#include "query/model_state.h"

namespace planetree::tools {

/// A model opened below the public interface, and a reader of its pages.
///
/// memory  up to 256 MiB, or what the model needs if that is more
struct ModelReader {
  /// errors  as Model::open
  static Result<ModelReader> open(const std::filesystem::path& path);

  std::unique_ptr<query::ModelState> model;
  cache::Reader reader;
};

}  // namespace planetree::tools
