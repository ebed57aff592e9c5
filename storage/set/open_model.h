#pragma once

#include <filesystem>
#include <memory>

#include "planetree/error.h"
#include "storage/http/http_options.h"
#include "storage/set/set_source.h"
#include "storage/system/byte_source.h"
#include "storage/system/file_calls.h"

namespace planetree::storage {

/// How to open the bytes of a model.
struct ModelSourceOptions {
  HttpOptions http{};  ///< for URLs
  /// Members of a set that cannot be opened are no error; reading them is.
  bool allows_missing_members = false;
};

/// Opens a set. Members on servers are opened when they are first read.
///
/// path    of its set file, whatever its name, or a URL
/// calls   for files; must outlive the source
/// errors  those of open_source(), SetDescription::read() and SetSource::open_all()
Result<std::unique_ptr<SetSource>> open_set(const std::filesystem::path& path,
                                            const ModelSourceOptions& options = {},
                                            FileCalls& calls = FileCalls::real());

/// Opens the bytes of a model: of a .ptree file, or of a set, which is known by its name. Either
/// may be a file of this machine, or what a URL of HTTP names.
///
/// calls   for files; must outlive the source
/// errors  those of open_source() or open_set()
Result<std::unique_ptr<ByteSource>> open_model_source(const std::filesystem::path& path,
                                                      const ModelSourceOptions& options = {},
                                                      FileCalls& calls = FileCalls::real());

}  // namespace planetree::storage
