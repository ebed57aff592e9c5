#include "storage/http/open_source.h"

#include "storage/http/http_url.h"
#if PLANETREE_WITH_HTTP
#include "storage/http/http_source.h"
#endif

namespace planetree::storage {

Result<std::unique_ptr<ByteSource>> open_source(const std::filesystem::path& path,
                                                [[maybe_unused]] const HttpOptions& options,
                                                FileCalls& calls) {
  if (!is_http_url(path.native())) return open_file_source(path.c_str(), calls);
#if PLANETREE_WITH_HTTP
  return HttpSource::open(path.native(), options);
#else
  return make_error(ErrorCode::kUnsupported, Error::kNowhere, Error::kNowhere,
                    "this build of planetree does not read URLs; build it with libcurl "
                    "(PLANETREE_HTTP=ON), or download the file");
#endif
}

std::uint64_t memory_of_url([[maybe_unused]] const HttpOptions& options) noexcept {
#if PLANETREE_WITH_HTTP
  return HttpSource::memory_bytes(options);
#else
  return sizeof(HttpOptions);  // none is ever opened
#endif
}

}  // namespace planetree::storage
