#include "storage/set/open_model.h"

#include <algorithm>
#include <new>
#include <utility>

#include "storage/http/cluster_memory.h"
#include "storage/http/http_url.h"
#include "storage/http/open_source.h"
#include "storage/set/member_address.h"
#include "storage/set/set_description.h"

namespace planetree::storage {
namespace {

bool is_remote(const std::filesystem::path& set, const SetDescription& description) {
  return is_http_url(set.native()) ||
         std::any_of(description.members.begin(), description.members.end(),
                     [](const SetMember& member) { return is_http_url(member.address); });
}

Error no_memory() {
  return make_error(ErrorCode::kNoMemory, Error::kNowhere, Error::kNowhere,
                    "no memory to open the set; free some and try again");
}

// Many members get less memory each.
HttpOptions options_of_members(HttpOptions http, std::size_t members) {
  http.clusters = std::max(http.clusters / members, ClusterMemory::kMinSlots);
  return http;
}

Result<std::unique_ptr<SetSource>> read_set(const std::filesystem::path& path,
                                            const ModelSourceOptions& options, FileCalls& calls) {
  const auto file = open_source(path, options.http, calls);
  if (!file) return file.error();
  auto description = SetDescription::read(**file);
  if (!description) return description.error();
  const bool remote = is_remote(path, *description);
  const HttpOptions http = options_of_members(options.http, description->members.size());
  const auto open = [path, http,
                     &calls](const std::string& address) -> Result<std::unique_ptr<ByteSource>> {
    // Queries, which do not throw, open members too.
    try {
      const auto member = member_path(path, address);
      if (!member) return member.error();
      return open_source(*member, http, calls);
    } catch (const std::bad_alloc&) {
      return no_memory();
    }
  };
  auto set = std::make_unique<SetSource>(*std::move(description), remote ? memory_of_url(http) : 0,
                                         std::string((*file)->name()), open);
  if (!remote && !options.allows_missing_members)
    if (const auto opened = set->open_all(); !opened) return opened.error();
  return set;
}

}  // namespace

Result<std::unique_ptr<SetSource>> open_set(const std::filesystem::path& path,
                                            const ModelSourceOptions& options, FileCalls& calls) {
  try {
    return read_set(path, options, calls);
  } catch (const std::bad_alloc&) {
    return no_memory();
  }
}

Result<std::unique_ptr<ByteSource>> open_model_source(const std::filesystem::path& path,
                                                      const ModelSourceOptions& options,
                                                      FileCalls& calls) {
  if (!is_set_name(path.native())) return open_source(path, options.http, calls);
  auto set = open_set(path, options, calls);
  if (!set) return set.error();
  return std::unique_ptr<ByteSource>(*std::move(set));
}

}  // namespace planetree::storage
