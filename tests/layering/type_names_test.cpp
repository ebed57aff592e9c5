#include "tests/layering/type_names.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string_view>

namespace planetree::layering {
namespace {

using Lines = std::vector<std::string>;

constexpr std::string_view kSource = R"(
#include "struct.h"
#define BODY struct Macro {
namespace planetree::tools {
class Console;  // class Comment {
enum class Word : char { kOne };
template <class T, class U = int>
struct alignas(64) Pair final : Base<T> {
  struct Inner {};
};
template <>
struct Pair<int, int> {};
struct Pair<int> *make(struct Given* given) { struct Local {}; return "struct Text {"; }
class [[nodiscard]] PLANETREE_API Scene { char c = '{'; };
struct Scene::State { int n = 1'000; };
namespace {
struct Hidden {};
}  // namespace
namespace fs = std::filesystem;
union Last {};
}
struct Outside {};
)";

TEST(TypeNames, AreThoseOfTypesWithABody) {
  EXPECT_EQ(types_with_bodies(kSource),
            (Lines{"planetree::tools::Word", "planetree::tools::Pair", "planetree::tools::Scene",
                   "planetree::tools::Scene::State", "planetree::tools::Last", "Outside"}));
}

TEST(TypeNames, AreFoundInTwoFiles) {
  const std::string one = "namespace a {\nstruct Counts {};\nnamespace {\nstruct Own {};\n}\n}\n";
  EXPECT_EQ(types_in_several({{"x.cpp", one}, {"y.cpp", one}, {"z.cpp", "struct Counts {};"}}),
            Lines{"a::Counts has a body in x.cpp y.cpp"});
  EXPECT_EQ(types_in_several({{"x.cpp", one + one}, {"y.cpp", "namespace a { class Counts; }"}}),
            Lines{});
}

TEST(TypeNames, AreOfOneFileEach) {
  std::vector<SourceText> sources = read_sources(PLANETREE_SOURCE_DIR);
  std::erase_if(sources, [](const SourceText& source) {
    constexpr std::string_view kFolders[] = {"include/", "storage/", "cache/",
                                             "octree/",  "query/",   "tools/"};
    return std::ranges::none_of(
        kFolders, [&](std::string_view folder) { return source.path.starts_with(folder); });
  });
  std::size_t types = 0;
  for (const SourceText& source : sources) types += types_with_bodies(source.text).size();
  EXPECT_GT(types, 700u);
  for (const std::string& line : types_in_several(sources)) ADD_FAILURE() << line;
}

}  // namespace
}  // namespace planetree::layering
