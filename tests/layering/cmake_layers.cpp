#include "tests/layering/cmake_layers.h"

#include "tests/layering/source_text.h"

#include <iterator>
#include <sstream>
#include <vector>

namespace planetree::layering {
namespace {

namespace fs = std::filesystem;

/// The words of a planetree_add_layer() call, or none.
std::vector<std::string> call_words(const std::string& text) {
  const std::string call = "planetree_add_layer(";
  const std::size_t begin = text.find(call);
  if (begin == std::string::npos) return {};
  const std::size_t first = begin + call.size();
  std::istringstream stream(text.substr(first, text.find(')', first) - first));
  return {std::istream_iterator<std::string>(stream), {}};
}

bool is_keyword(const std::string& word) {
  return word == "EXCEPT" || word == "DEPENDS" || word == "HEADERS" || word == "HEADERS_OF";
}

CMakeLayer layer_of_words(const std::vector<std::string>& words) {
  CMakeLayer layer{words.front(), {}};
  bool in_depends = false;
  for (const std::string& word : words) {
    if (is_keyword(word)) in_depends = word == "DEPENDS";
    if (in_depends && word.starts_with("planetree_")) layer.depends.insert(word);
  }
  return layer;
}

}  // namespace

std::map<std::string, CMakeLayer> read_cmake_layers(const fs::path& root) {
  std::map<std::string, CMakeLayer> layers;
  fs::recursive_directory_iterator entry(root);
  for (; entry != fs::recursive_directory_iterator(); ++entry) {
    const bool is_build_tree = entry.depth() == 0 && (entry->path().filename() == "build" ||
                                                      entry->path().filename() == ".git");
    if (is_build_tree) entry.disable_recursion_pending();
    if (entry->path().filename() != "CMakeLists.txt") continue;
    const std::vector<std::string> words = call_words(read_text(entry->path()));
    if (words.empty()) continue;
    const fs::path folder = entry->path().parent_path().lexically_relative(root);
    layers.emplace(folder.generic_string(), layer_of_words(words));
  }
  return layers;
}

}  // namespace planetree::layering
