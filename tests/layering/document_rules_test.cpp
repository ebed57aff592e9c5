// Rules for the Markdown documents: what they name exists.

#include "tests/layering/document_text.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <string>

namespace planetree::layering {
namespace {

namespace fs = std::filesystem;

const std::string kSourceRoot = PLANETREE_SOURCE_DIR;

const std::vector<Document>& documents() {
  static const std::vector<Document> all = read_documents(kSourceRoot);
  return all;
}

const KnownNames& known_names() {
  static const KnownNames all = read_known_names(kSourceRoot);
  return all;
}

/// The document with what may name things of the past left out: old names in the glossary's table.
Document without_retired_words(const Document& document) {
  return {document.path, document.text.substr(0, document.text.find("\n## Retired words\n"))};
}

/// Whether a document tells of the past: changes, and dated experiments.
bool is_history(const Document& document) {
  return document.path.ends_with("CHANGELOG.md") || document.path.starts_with("docs/experiments/");
}

TEST(Document, FindsLinksSpansAndAnchors) {
  const Document document{"a.md",
                          "# A *title*, x_1\ntext [b\nc](d.md#e) `f.h` and [g](https://h)\n"
                          "#no heading\n## What is 1/2?\n`i` `j k`\n"};
  EXPECT_EQ(document.links(), std::vector<std::string>{"d.md#e"});
  EXPECT_EQ(document.code_spans(), (std::vector<std::string>{"f.h", "i", "j k"}));
  EXPECT_EQ(document.anchors(), (std::set<std::string>{"a-title-x_1", "what-is-12"}));
}

TEST(Document, TellsPathsAndIdentifiersFromOtherSpans) {
  const KnownNames known{{"octree", "octree/page", "octree/page/frame.h"}, {}};
  EXPECT_TRUE(known.has_path("octree/page/") && known.has_path("page/frame.h"));
  EXPECT_FALSE(known.has_path("age/frame.h") || known.has_path("frame"));
  EXPECT_TRUE(is_path("frame.h", known) && is_path("octree/none", known) && is_path("a/", known));
  EXPECT_FALSE(is_path("-inl.h", known) || is_path("1/2", known) || is_path("a b.h", known));
  EXPECT_EQ(identifier_words("PageFile::unpack"), (std::vector<std::string>{"PageFile", "unpack"}));
  EXPECT_EQ(identifier_words("help()"), std::vector<std::string>{"help"});
  EXPECT_EQ(identifier_words("build"), std::vector<std::string>{});
  EXPECT_EQ(identifier_words("--max-error"), std::vector<std::string>{});
}

TEST(DocumentRules, FindsDocuments) {
  EXPECT_TRUE(std::ranges::count(documents(), "README.md", &Document::path) == 1);
  EXPECT_TRUE(std::ranges::count(documents(), "docs/architecture.md", &Document::path) == 1);
}

TEST(DocumentRules, LinksLeadToFilesAndHeadings) {
  std::map<std::string, const Document*> by_path;
  for (const Document& document : documents()) by_path.emplace(document.path, &document);
  for (const Document& document : documents()) {
    for (const std::string& link : document.links()) {
      const std::size_t hash = std::min(link.find('#'), link.size());
      const std::string name = link.substr(0, hash);
      const fs::path beside = fs::path(document.path).parent_path() / name;
      std::string path = name.empty() ? document.path : beside.lexically_normal().generic_string();
      if (path.ends_with('/')) path.pop_back();
      EXPECT_TRUE(known_names().paths.contains(path)) << document.path << ": no file " << link;
      if (hash == link.size() || !by_path.contains(path)) continue;
      EXPECT_TRUE(by_path.at(path)->anchors().contains(link.substr(hash + 1)))
          << document.path << ": no heading " << link;
    }
  }
}

TEST(DocumentRules, PathsExist) {
  for (const Document& whole : documents()) {
    if (whole.path.ends_with("CHANGELOG.md")) continue;
    for (const std::string& span : without_retired_words(whole).code_spans())
      if (is_path(span, known_names())) {
        EXPECT_TRUE(known_names().has_path(span)) << whole.path << ": no file " << span;
      }
  }
}

// The specification defines its own names.
TEST(DocumentRules, IdentifiersExist) {
  for (const Document& whole : documents()) {
    if (is_history(whole) || whole.path.starts_with("format-spec/")) continue;
    for (const std::string& span : without_retired_words(whole).code_spans()) {
      if (is_path(span, known_names())) continue;
      for (const std::string& word : identifier_words(span))
        EXPECT_TRUE(known_names().words.contains(word))
            << whole.path << ": nothing is named " << span;
    }
  }
}

TEST(DocumentRules, EveryDocumentOfDocsIsInItsIndex) {
  const auto index = std::ranges::find(documents(), "docs/README.md", &Document::path);
  ASSERT_TRUE(index != documents().end());
  const std::vector<std::string> links = index->links();
  for (const Document& document : documents()) {
    if (!document.path.starts_with("docs/") || document.path == index->path) continue;
    if (document.path.starts_with("docs/experiments/")) continue;
    EXPECT_TRUE(std::ranges::count(links, document.path.substr(5)) > 0) << document.path;
  }
}

}  // namespace
}  // namespace planetree::layering
