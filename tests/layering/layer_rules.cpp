#include <algorithm>
#include <set>

#include "tests/layering/layers.h"

namespace planetree::layering {
namespace {

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
           (layer.folder == "storage/file" && include == "planetree/metadata.h") ||
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

}  // namespace

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
