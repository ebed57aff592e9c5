#include "tests/layering/layers.h"

#include <algorithm>

namespace planetree::layering {
namespace {

Beginnings with_system(Beginnings others) {
  others.insert(others.end(),
                {"fcntl.h", "linux/", "pthread.h", "sched.h", "stdio.h", "sys/", "unistd.h"});
  return others;
}

bool is_match(std::string_view name, std::string_view beginning) {
  if (!name.starts_with(beginning)) return false;
  if (!beginning.ends_with('/')) return true;
  return name.find('/', beginning.size()) == std::string_view::npos;
}

bool matches_any(std::string_view name, const Beginnings& beginnings) {
  return std::ranges::any_of(
      beginnings, [name](std::string_view beginning) { return is_match(name, beginning); });
}

bool is_allowed_by_layer(const SourceText& source, std::string_view include) {
  const auto layer = std::ranges::find(layers(), source.folder(), &Layer::folder);
  return layer == layers().end() || is_standard_header(include) ||
         matches_any(include, layer->allowed);
}

bool is_allowed_by_keepers(const SourceText& source, std::string_view include) {
  return std::ranges::all_of(kept_headers(), [&](const KeptHeader& kept) {
    return !include.starts_with(kept.beginning) || matches_any(source.path, kept.includers);
  });
}

}  // namespace

const std::vector<Layer>& layers() {
  static const std::vector<Layer> all = {
      {"include/planetree/", {"planetree/"}},
      {"storage/", with_system({"storage/", "planetree/error.h", "liburing.h", "lz4", "xxhash.h"})},
      {"cache/", {"cache/", "planetree/error.h", "sys/mman.h", "unistd.h"}},
      {"octree/", {"octree/", "planetree/", "Eigen", "boost/multiprecision", "hwy"}},
      {"octree/build/", with_system({"octree/build/", "octree/", "storage/", "planetree/", "Eigen",
                                     "boost/multiprecision", "hwy", "oneapi/tbb", "tbb"})},
      {"query/", with_system({"query/", "octree/build/", "octree/", "cache/", "storage/",
                              "planetree/", "Eigen", "hwy/contrib/sort", "tbb"})},
      // inspect and verify read damaged files below the level of queries.
      {"tools/", with_system({"tools/", "query/", "octree/build/", "octree/", "storage/",
                              "planetree/", "CLI", "fmt", "nlohmann", "openssl/evp.h", "png.h"})},
      {"examples/", {"planetree/"}},
  };
  return all;
}

const std::vector<KeptHeader>& kept_headers() {
  static const std::vector<KeptHeader> all = {
      // The reader written from the specification shares no code with the library.
      {"lz4", {"storage/file/page_codec.cpp", "tests/golden/spec_reader.cpp"}},
      {"liburing",
       {"storage/system/file_calls.cpp", "storage/system/read_wait.h", "tests/storage/"}},
      {"xxh", {"storage/file/checksum.cpp", "tests/golden/spec_reader.cpp"}},
      {"CGAL", {"tests/oracle/", "bench/", "bench/peers/"}},
      {"embree", {"tests/oracle/", "bench/", "bench/peers/"}},
  };
  return all;
}

std::vector<std::string> forbidden_includes(const SourceText& source) {
  std::vector<std::string> found;
  for (const std::string& include : includes_of(source.text)) {
    if (is_allowed_by_layer(source, include) && is_allowed_by_keepers(source, include)) continue;
    found.push_back(source.path + " may not include " + include);
  }
  return found;
}

}  // namespace planetree::layering
