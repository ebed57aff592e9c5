#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>

#include "planetree/error.h"
#include "storage/http/http_options.h"
#include "storage/system/byte_source.h"
#include "storage/system/file_calls.h"

namespace planetree::storage {

/// Opens a file of this machine, or what a URL of HTTP names.
///
/// options  for a URL
/// calls    for a file; must outlive the source
/// errors   those of open_file_source() or HttpSource::open(); kUnsupported: this is a build
/// without
///          libcurl
Result<std::unique_ptr<ByteSource>> open_source(const std::filesystem::path& path,
                                                const HttpOptions& options = {},
                                                FileCalls& calls = FileCalls::real());

/// Memory in bytes that the source of a URL takes.
std::uint64_t memory_of_url(const HttpOptions& options) noexcept;

}  // namespace planetree::storage
