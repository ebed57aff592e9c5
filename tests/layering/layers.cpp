#include "tests/layering/layers.h"

#include <algorithm>
#include <set>

namespace planetree::layering {
namespace {

// Headers of the system. What calls it says so in its row.
constexpr std::string_view kSystem[] = {"fcntl.h", "linux/", "pthread.h", "sched.h",
                                        "stdio.h", "sys/",   "unistd.h"};

bool begins_with_any(std::string_view name, const Names& beginnings) {
  return std::ranges::any_of(
      beginnings, [name](std::string_view beginning) { return name.starts_with(beginning); });
}

bool contains(const Names& names, std::string_view name) {
  return std::ranges::find(names, name) != names.end();
}

bool is_free(std::string_view folder) {
  return folder == "bench" || (folder.starts_with("tests") && folder != "tests/public_api");
}

std::string_view folder_of(std::string_view path) {
  const std::size_t slash = path.rfind('/');
  return slash == std::string_view::npos ? std::string_view() : path.substr(0, slash);
}

bool is_ours(std::string_view include) {
  return layer_of(folder_of(include)) || include.starts_with("tests/") ||
         include.starts_with("bench/");
}

bool is_allowed_by_row(const Layer& layer, std::string_view include) {
  if (is_standard_header(include)) return true;
  // Storage and cache know neither questions nor answers.
  const bool is_cache = layer.folder.starts_with("cache");
  const bool is_low = layer.folder.starts_with("storage/") || is_cache;
  if (include.starts_with("planetree/"))
    return !is_low || include == "planetree/error.h" ||
           (is_cache && include == "planetree/eviction_policy.h");
  const std::string_view folder = folder_of(include);
  if (is_ours(include)) return folder == layer.folder || contains(layer.includes, folder);
  return begins_with_any(include, layer.libraries);
}

bool is_allowed_includer(const SourceText& source, std::string_view include) {
  return std::ranges::all_of(restricted_headers(), [&](const RestrictedHeader& kept) {
    return !include.starts_with(kept.beginning) || begins_with_any(source.path, kept.includers);
  });
}

void collect_reach(const SourceText& source, const std::map<std::string, SourceText>& sources,
                   std::set<std::string>& reached) {
  for (const std::string& include : includes_of(source.text)) {
    const auto found = sources.find(include);
    if (found != sources.end() && reached.insert(include).second)
      collect_reach(found->second, sources, reached);
  }
}

Names with_system(Names others) {
  others.insert(others.end(), std::begin(kSystem), std::end(kSystem));
  return others;
}

}  // namespace

const std::vector<Layer>& layers() {
  static const std::vector<Layer> all = {
      {"include/planetree", {}, {}, {"Eigen/Core", "stdbool.h", "stddef.h", "stdint.h"}},
      {"storage/system", {}, {}, with_system({"liburing.h"})},
      {"storage/file", {"storage/system"}, {}, with_system({"lz4", "xxhash.h"})},
      {"storage/spill", {"storage/file", "storage/system"}, {}, with_system({})},
      {"cache/policy", {}, {}, {}},
      {"cache", {"cache/policy"}, {}, {"sys/mman.h", "unistd.h"}},
      {"octree/geometry", {}, {}, {"Eigen", "boost/multiprecision", "hwy"}},
      {"octree/page", {"octree/geometry"}, {}, {"hwy"}},
      {"octree/field", {"octree/page", "octree/geometry"}, {}, {"Eigen"}},
      {"octree/attributes", {"octree/page", "octree/geometry"}, {}, {}},
      {"octree/traversal", {"octree/page", "octree/geometry"}, {}, {"hwy"}},
      {"octree/nearest",
       {"octree/traversal", "octree/field", "octree/page", "octree/geometry"},
       {},
       {"Eigen", "hwy"}},
      {"octree/winding", {"octree/traversal", "octree/page", "octree/geometry"}, {}, {"hwy"}},
      {"octree/mask",
       {"octree/winding", "octree/traversal", "octree/page", "octree/geometry"},
       {},
       {"hwy"}},
      {"octree/builder/job",
       {"octree/geometry", "storage/file", "storage/system"},
       {},
       with_system({"Eigen", "tbb"})},
      {"octree/builder/mesh/stream",
       {"octree/geometry", "storage/spill", "storage/system"},
       {},
       with_system({"zlib.h", "zstd"})},
      {"octree/builder/mesh/gltf",
       {"octree/builder/mesh/stream", "octree/geometry"},
       {"storage/spill", "storage/system"},
       {"nlohmann"}},
      {"octree/builder/mesh/obj",
       {"octree/builder/mesh/stream"},
       {"storage/spill", "storage/system"},
       {}},
      {"octree/builder/mesh",
       {"octree/builder/mesh/gltf", "octree/builder/mesh/obj", "octree/builder/mesh/stream",
        "storage/system"},
       {"storage/spill"},
       {}},
      {"octree/builder/sort",
       {"octree/builder/mesh", "octree/builder/mesh/stream", "octree/builder/job",
        "octree/attributes", "octree/geometry", "storage/spill"},
       {"octree/page", "storage/file", "storage/system"},
       {}},
      {"octree/builder/surface",
       {"octree/builder/sort", "octree/builder/job", "octree/geometry", "storage/spill",
        "storage/file"},
       {"octree/builder/mesh", "octree/builder/mesh/stream", "storage/system"},
       {}},
      {"octree/builder/tree",
       {"octree/builder/sort", "octree/builder/job", "octree/traversal", "octree/page",
        "octree/geometry", "storage/spill", "storage/file"},
       {"octree/builder/mesh", "octree/builder/mesh/stream", "storage/system"},
       {"Eigen"}},
      {"octree/builder/mask",
       {"octree/builder/tree", "octree/builder/surface", "octree/builder/sort",
        "octree/builder/job", "octree/mask", "octree/winding", "octree/nearest", "octree/traversal",
        "octree/page", "octree/geometry", "storage/spill"},
       {"octree/builder/mesh", "octree/builder/mesh/stream", "octree/field", "storage/file",
        "storage/system"},
       {"Eigen", "hwy", "tbb"}},
      {"octree/builder/field",
       {"octree/builder/mask", "octree/builder/tree", "octree/builder/job", "octree/field",
        "octree/nearest", "octree/traversal", "octree/page", "octree/geometry", "storage/file"},
       {"octree/builder/mesh", "octree/builder/mesh/stream", "octree/builder/sort",
        "octree/builder/surface", "octree/mask", "octree/winding", "storage/spill",
        "storage/system"},
       {"tbb"}},
      {"octree/builder/attributes",
       {"octree/builder/tree", "octree/builder/sort", "octree/builder/job", "octree/attributes",
        "octree/page", "octree/geometry", "storage/spill", "storage/file"},
       {"octree/builder/mesh", "octree/builder/mesh/stream", "octree/traversal", "storage/system"},
       {}},
      {"octree/builder",
       {"octree/builder/attributes", "octree/builder/field", "octree/builder/mask",
        "octree/builder/tree", "octree/builder/surface", "octree/builder/sort",
        "octree/builder/mesh", "octree/builder/mesh/stream", "octree/builder/job",
        "octree/attributes", "octree/page", "octree/geometry", "storage/spill", "storage/file",
        "storage/system"},
       {"octree/mask", "octree/traversal", "octree/field"},
       with_system({"tbb"})},
      {"query/file",
       {"octree/attributes", "octree/field", "octree/page", "octree/geometry", "storage/file"},
       {"storage/system"},
       {}},
      {"query/answer",
       {"query/file", "octree/mask", "octree/winding", "octree/nearest", "octree/traversal",
        "octree/attributes", "octree/field", "octree/geometry", "storage/file"},
       {"octree/page"},
       {}},
      {"query/serve",
       {"query/file", "octree/traversal", "octree/geometry", "cache", "storage/file",
        "storage/system"},
       {"cache/policy", "octree/page", "octree/attributes", "octree/field"},
       {"hwy/contrib/sort", "tbb", "pthread.h", "sched.h"}},
      {"query",
       {"query/answer", "query/serve", "query/file", "octree/geometry", "cache", "storage/file",
        "storage/system"},
       {"cache/policy", "octree/mask", "octree/nearest", "octree/traversal", "octree/attributes",
        "octree/field", "octree/page"},
       {}},
      {"query/shell", {"query", "octree/geometry"}, {}, {}},
      {"query/scene",
       {"query/shell", "query", "query/answer", "query/serve", "query/file", "octree/nearest",
        "octree/geometry", "cache", "storage/file", "storage/system"},
       {"cache/policy", "octree/mask", "octree/traversal", "octree/attributes", "octree/field",
        "octree/page"},
       {}},
      {"tools/cli",
       {"octree/builder/mesh/stream", "octree/geometry", "storage/system"},
       {},
       with_system({"CLI", "fmt", "nlohmann", "openssl/evp.h"})},
      {"tools/html", {"tools/cli"}, {}, {"fmt", "nlohmann"}},
      {"tools/picture",
       {"tools/html", "tools/cli", "octree/builder/mesh/stream"},
       {},
       {"fmt", "openssl/evp.h", "png.h"}},
      {"tools/arrays", {"storage/spill"}, {"storage/file", "storage/system"}, {"fmt"}},
      {"tools/answers",
       {"tools/arrays", "tools/cli", "storage/system"},
       {"storage/spill", "storage/file"},
       {"fmt"}},
      {"tools/points",
       {"tools/cli", "octree/builder/mesh", "octree/builder/mesh/stream", "storage/system"},
       {},
       with_system({"fmt"})},
      {"tools/manual", {"tools/cli"}, {}, {"CLI", "fmt"}},
      {"tools/shapes", {"tools/cli"}, {}, {"fmt"}},
      {"tools/trace_file", {"tools/cli", "storage/file"}, {"storage/system"}, {}},
      {"tools/session",
       {"tools/trace_file", "tools/answers", "tools/html", "tools/cli"},
       {"storage/file", "storage/system"},
       with_system({"fmt", "nlohmann"})},
      // A session on a simulated disk replaces the seams of the engine.
      {"tools/simulation",
       {"tools/session", "tools/trace_file", "tools/cli", "query", "query/serve", "octree/geometry",
        "storage/system"},
       {"query/answer", "query/file", "cache", "cache/policy", "octree/mask", "octree/nearest",
        "octree/winding", "octree/traversal", "octree/attributes", "octree/field", "octree/page",
        "storage/file"},
       with_system({})},
      // inspect and verify look into damaged files, below what the queries see.
      {"tools/check",
       {"query", "query/answer", "query/serve", "query/file", "octree/builder/mask",
        "octree/builder/surface", "octree/mask", "octree/winding", "octree/nearest",
        "octree/traversal", "octree/attributes", "octree/field", "octree/page", "octree/geometry",
        "storage/file", "storage/system"},
       {"cache", "cache/policy"},
       with_system({"fmt", "nlohmann"})},
      {"tools/report",
       {"tools/check", "tools/answers", "tools/html", "tools/cli", "query", "query/answer",
        "query/serve", "query/file", "octree/builder/mesh/stream", "octree/nearest",
        "octree/attributes", "octree/field", "octree/page", "storage/file"},
       {"cache", "cache/policy", "octree/mask", "octree/traversal", "octree/geometry",
        "storage/system"},
       {"fmt", "nlohmann"}},
      {"tools/slice",
       {"tools/picture", "tools/check", "tools/trace_file", "tools/cli", "query/file",
        "octree/builder/mesh/stream", "octree/geometry", "storage/file"},
       {"query", "query/answer", "octree/page", "octree/attributes", "octree/field",
        "octree/traversal", "octree/mask", "octree/winding", "octree/nearest", "storage/system"},
       {"fmt", "nlohmann"}},
      {"tools/trade",
       {"tools/session", "tools/check", "tools/html", "tools/cli", "query/file", "octree/geometry"},
       {"query", "query/answer", "octree/page", "octree/attributes", "octree/field",
        "octree/traversal", "octree/mask", "octree/winding", "octree/nearest", "storage/file",
        "storage/system"},
       {"fmt", "nlohmann"}},
      {"tools/tune",
       {"tools/simulation", "tools/session", "tools/trace_file", "tools/html", "tools/cli", "query",
        "cache/policy", "octree/geometry"},
       {"query/answer", "query/serve", "query/file", "cache", "octree/mask", "octree/winding",
        "octree/nearest", "octree/traversal", "octree/attributes", "octree/field", "octree/page",
        "storage/file", "storage/system"},
       {"fmt", "nlohmann"}},
      {"tools/mesh",
       {"tools/check", "tools/points", "octree/builder/mesh", "octree/builder/mesh/stream",
        "query/file", "octree/geometry"},
       {"tools/cli", "octree/page", "octree/attributes", "octree/field", "storage/spill",
        "storage/file", "storage/system"},
       {}},
      {"tools/values",
       {"tools/html", "tools/arrays", "tools/cli", "storage/spill"},
       {"storage/file", "storage/system"},
       {"fmt"}},
      {"tools/compare",
       {"tools/values", "tools/mesh", "tools/answers", "tools/points", "tools/html", "tools/cli",
        "storage/spill"},
       {"storage/file", "storage/system"},
       {"fmt", "nlohmann"}},
      {"tools/thickness",
       {"tools/values", "tools/mesh", "tools/answers", "tools/points", "tools/html", "tools/cli"},
       {},
       {"fmt", "nlohmann"}},
      {"tools/scene",
       {"tools/report", "tools/check", "tools/answers", "tools/cli", "octree/builder/mesh/stream",
        "storage/file"},
       {},
       {"fmt", "nlohmann"}},
      {"tools",
       {"tools/scene",
        "tools/thickness",
        "tools/compare",
        "tools/values",
        "tools/mesh",
        "tools/tune",
        "tools/trade",
        "tools/slice",
        "tools/report",
        "tools/check",
        "tools/simulation",
        "tools/session",
        "tools/trace_file",
        "tools/shapes",
        "tools/answers",
        "tools/points",
        "tools/manual",
        "tools/cli",
        "octree/builder/mesh/stream",
        "storage/file"},
       {"tools/html", "tools/arrays", "tools/picture", "storage/spill", "query/answer",
        "query/file", "cache/policy", "octree/nearest", "octree/mask", "octree/traversal",
        "octree/attributes", "octree/field", "octree/page", "octree/geometry", "storage/system"},
       with_system({"CLI", "fmt", "nlohmann"})},
      {"c", {}, {}, {}},
      {"examples", {}, {}, {}},
      {"python", {}, {}, with_system({"pybind11"})},
      {"tests/public_api", {}, {}, {"gtest", "Eigen/Core"}},
  };
  return all;
}

const Layer* layer_of(std::string_view folder) {
  const auto layer = std::ranges::find(layers(), folder, &Layer::folder);
  return layer == layers().end() ? nullptr : &*layer;
}

std::vector<std::string> forbidden_includes(const SourceText& source) {
  const std::string_view folder = folder_of(source.path);
  const Layer* layer = layer_of(folder);
  std::vector<std::string> found;
  if (!layer && !is_free(folder)) found.push_back(source.path + " lies in a folder without a row");
  for (const std::string& include : includes_of(source.text)) {
    if ((!layer || is_allowed_by_row(*layer, include)) && is_allowed_includer(source, include))
      continue;
    found.push_back(source.path + " may not include " + include);
  }
  return found;
}

std::vector<std::string> forbidden_reach(const SourceText& source,
                                         const std::map<std::string, SourceText>& sources) {
  const Layer* layer = layer_of(folder_of(source.path));
  if (!layer) return {};
  std::set<std::string> reached;
  collect_reach(source, sources, reached);
  std::set<std::string> found;
  for (const std::string& path : reached) {
    const std::string_view folder = folder_of(path);
    if (folder != layer->folder && folder != "include/planetree" && folder != "planetree" &&
        !contains(layer->includes, folder) && !contains(layer->sees, folder))
      found.insert(source.path + " reaches " + std::string(folder));
  }
  return {found.begin(), found.end()};
}

std::vector<std::string> arrows_back_up(const std::vector<Layer>& rows) {
  std::vector<std::string> found;
  Names before;
  for (const Layer& row : rows) {
    for (const Names& names : {row.includes, row.sees})
      for (const std::string_view name : names)
        if (!contains(before, name))
          found.push_back(std::string(row.folder) + " is above or beside " + std::string(name));
    before.push_back(row.folder);
  }
  return found;
}

}  // namespace planetree::layering
