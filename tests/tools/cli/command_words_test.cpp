// Errors of the library on the command line: they speak of its options, with values that suffice.

#include "tools/cli/command_words.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <regex>
#include <string>
#include <vector>

#include "tests/tools/cli/command_fixture.h"

namespace planetree::tools {
namespace {

class CommandWords : public Command {
 protected:
  // Runs a command with too little memory. Returns the memory that its error says to give.
  static std::string memory_for(std::vector<std::string> arguments) {
    arguments.insert(arguments.end(), {"--memory", "3000"});
    const Outcome result = run(arguments, "1,2,3\n");
    EXPECT_EQ(result.status, 3) << result.errors;
    std::smatch found;
    const std::regex cause("--memory of 3000 bytes is too small: give at least (\\d+) bytes\n");
    EXPECT_TRUE(std::regex_search(result.errors, found, cause)) << result.errors;
    return found.size() > 1 ? found[1].str() : "0";
  }
  // Whether the command succeeds with this memory.
  static bool suffices(const std::string& memory, std::vector<std::string> arguments) {
    arguments.insert(arguments.end(), {"--memory", memory, "--force"});
    return run(arguments, "1,2,3\n").status == 0;
  }
};

/// Whether only blanks and a word such as PRIu64 are between two texts, which then are one.
bool is_joint(std::string between) {
  std::erase_if(between, [](char c) { return c == ' ' || c == '\n'; });
  return between.empty() || between.starts_with("PRI");
}

/// The texts of a source, with their quotes.
std::vector<std::string> texts_in(const std::string& source) {
  std::vector<std::string> texts;
  std::size_t last = 0;
  for (std::size_t at = source.find('"'); at != std::string::npos; at = source.find('"', at)) {
    std::size_t end = source.find('"', at + 1);
    while (end != std::string::npos && source[end - 1] == '\\') end = source.find('"', end + 1);
    if (end == std::string::npos) break;
    const std::string text = source.substr(at, ++end - at);
    if (!texts.empty() && is_joint(source.substr(last, at - last)))
      texts.back().replace(texts.back().size() - 1, 1, text.substr(1));
    else
      texts.push_back(text);
    at = last = end;
  }
  return texts;
}

/// Whether a text names a member or a constant of C++, or what --memory is called there.
bool names_cpp(const std::string& text) {
  static const std::regex name("\\bk[A-Z]\\w+|\\w+::\\w+|\\b[a-z]+_[a-z_]+\\b|memory budget");
  return std::regex_search(text, name);
}

/// Texts that no command shows, because it sets these options itself or checks them before.
bool is_unseen(const std::string& text) {
  static const std::vector<std::string> kUnseen = {"the limit of %u probes is reached",
                                                   "an empty cell must",
                                                   "layers are 0x%x",
                                                   "attributes are 0x%x",
                                                   "the scene frames of %u",
                                                   "of a scene is",
                                                   "the scene has %u instances already"};
  return std::ranges::any_of(
      kUnseen, [&](const std::string& part) { return text.find(part) != std::string::npos; });
}

TEST_F(CommandWords, AreThoseOfTheCommand) {
  EXPECT_EQ(
      in_command_words(
          "a memory budget of 10 bytes is too small: give at least 20 bytes, or lower max_probes"),
      "--memory of 10 bytes is too small: give at least 20 bytes");
  EXPECT_EQ(in_command_words("page 3 is damaged; build the file again"),
            "page 3 is damaged; build the file again");
}

TEST_F(CommandWords, AreKnownForEveryTextOfTheLibrary) {
  EXPECT_EQ(texts_in("f(\"one %\" PRIu64\n  \" two\", \"x\");"),
            (std::vector<std::string>{"\"one % two\"", "\"x\""}));
  EXPECT_TRUE(names_cpp("lower max_probes") && names_cpp("see Stats::frames"));
  std::size_t reworded = 0;
  for (const char* folder : {"storage", "cache", "query", "octree"})
    for (const auto& entry :
         fs::recursive_directory_iterator(fs::path(PLANETREE_SOURCE_DIR) / folder)) {
      const std::string path = entry.path().generic_string();
      // Readers of meshes name what files have, such as "vertex_indices".
      if (entry.path().extension() != ".cpp" ||
          path.find("octree/builder/mesh/") != std::string::npos)
        continue;
      const std::string source = text_of(entry.path());
      for (const std::string& text : texts_in(source)) {
        const std::string words = in_command_words(text);
        reworded += words != text;
        if (text.find(' ') == std::string::npos) continue;
        EXPECT_TRUE(!names_cpp(words) || is_unseen(words)) << path << ": " << text;
      }
    }
  EXPECT_GT(reworded, 6u);
}

TEST_F(CommandWords, TellTheMemoryThatSuffices) {
  const std::vector<std::vector<std::string>> commands = {
      {"query", "tree.ptree", "-o", "a.csv", "--quiet"},
      {"query", "tree.ptree", "-o", "a.csv", "--trace", "a.trace", "--quiet"},
      {"compare", "tree.ptree", "-", "-o", "a.ply", "--quiet"},
      {"thickness", "tree.ptree", "-", "-o", "b.ply", "--quiet"},
      {"touch", "tree.ptree", "--seconds", "1", "--deterministic", "--trace", "b.trace"}};
  for (const auto& arguments : commands) {
    const std::string memory = memory_for(arguments);
    EXPECT_TRUE(suffices(memory, arguments)) << arguments[0] << ' ' << memory;
    EXPECT_FALSE(suffices(std::to_string(std::stoull(memory) - 1), arguments)) << arguments[0];
  }
}

TEST_F(CommandWords, TellTheMemoryThatASceneLacks) {
  write("scene.json", R"({"format": "planetree-scene", "version": 1,
    "models": {"mesh": {"file": "tree.ptree"}}, "instances": [{"model": "mesh"}]})");
  const std::uint64_t empty = std::stoull(memory_for({"scene", "scene.json"}));
  const Outcome little = run({"scene", "scene.json", "--memory", std::to_string(empty)});
  EXPECT_EQ(little.status, 3);
  std::smatch found;
  const std::regex cause("tree.ptree: (\\d+) bytes are lacking .*: raise --memory by them\n");
  ASSERT_TRUE(std::regex_search(little.errors, found, cause)) << little.errors;
  const std::uint64_t enough = empty + std::stoull(found[1].str());
  EXPECT_EQ(run({"scene", "scene.json", "--memory", std::to_string(enough)}).status, 0);
}

}  // namespace
}  // namespace planetree::tools
