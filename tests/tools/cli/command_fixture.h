#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/storage/system/temporary_directory.h"
#include "tests/tools/check/sample_tree.h"
#include "tests/tools/cli/captured_console.h"

/// Shared by the tests of the command: a directory with a mesh and its tree.
namespace planetree::tools {

namespace fs = std::filesystem;
using Json = nlohmann::json;

class Command : public testing::Test {
 protected:
  void SetUp() override {
    before_ = fs::current_path();
    fs::current_path(folder_ / ".");
    write_mesh("mesh.obj", kSide);
    build_sample("mesh.obj", "tree.ptree");
    const auto file = storage::PageFile::open("tree.ptree");
    ASSERT_TRUE(file);
    ASSERT_GT(file->page_count(), 2u);
    for (std::uint32_t page = 0; page < file->page_count(); ++page)
      entries_.push_back(*file->entry(page));
  }
  void TearDown() override { fs::current_path(before_); }

  static void write(const fs::path& path, const std::string& text) {
    std::ofstream(path, std::ios::binary) << text;
  }
  static std::string text_of(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }
  static void flip(const fs::path& path, std::uint64_t offset) {
    auto bytes = storage::read_bytes(path);
    bytes[offset] ^= std::byte{1};
    storage::write_bytes(path, bytes);
  }

  static constexpr unsigned kSide = 14;
  static constexpr std::uint64_t kTriangles = 2 * kSide * kSide;

  storage::TemporaryDirectory folder_;
  fs::path before_;
  std::vector<storage::PageEntry> entries_;
};

}  // namespace planetree::tools
