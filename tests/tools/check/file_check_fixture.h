#pragma once

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <functional>
#include <set>
#include <span>
#include <string>

#include "tests/storage/system/temporary_directory.h"
#include "tests/tools/check/sample_tree.h"
#include "tools/check/file_check.h"
#include "tools/report/file_survey.h"

/// Shared by the tests of file_check: a file in memory and a sample to forge.
namespace planetree::tools {

using storage::Bytes;
using Codes = std::set<std::string>;

/// A file in memory. Reads at one offset can be made to fail.
class MemoryFile final : public storage::FileCalls {
 public:
  explicit MemoryFile(std::span<const std::byte> bytes) : bytes_(bytes) {}
  void fail_reads_at(std::uint64_t offset) { failing_ = offset; }

  int openat(int, const char*, int, mode_t) noexcept override { return 1000; }
  int close(int) noexcept override { return 0; }
  int fstat(int, struct stat* status) noexcept override {
    *status = {};
    status->st_mode = S_IFREG;
    status->st_size = static_cast<off_t>(bytes_.size());
    return 0;
  }
  ssize_t pread(int, void* out, std::size_t bytes, off_t offset) noexcept override {
    const auto begin = std::min(static_cast<std::size_t>(offset), bytes_.size());
    if (begin == failing_) {
      errno = EIO;
      return -1;
    }
    const std::size_t count = std::min(bytes, bytes_.size() - begin);
    std::memcpy(out, bytes_.data() + begin, count);
    return static_cast<ssize_t>(count);
  }

 private:
  std::span<const std::byte> bytes_;
  std::uint64_t failing_ = ~std::uint64_t{0};
};

inline CheckReport check(storage::FileCalls& calls, bool full = true) {
  auto parts = FileParts::open("file", calls);
  EXPECT_TRUE(parts);
  return check_file(*parts, full);
}

/// Checks a file of these bytes. The proof of a mask opens it again, so that it must exist.
inline CheckReport check(std::span<const std::byte> bytes, bool full = true) {
  const storage::TemporaryDirectory folder;
  storage::write_bytes(folder / "file", bytes);
  auto parts = FileParts::open(folder / "file");
  EXPECT_TRUE(parts);
  return check_file(*parts, full);
}

inline Codes codes_of(const CheckReport& report) {
  Codes codes;
  for (const Issue& issue : report.issues.kept()) {
    codes.insert(std::string(issue_name(issue.code)));
    EXPECT_FALSE(issue.message.empty());
    EXPECT_EQ(issue.message.find('\n'), std::string::npos);
  }
  return codes;
}

class FileCheck : public testing::Test {
 protected:
  static constexpr unsigned kSide = 16;

  void SetUp() override {
    write_mesh(folder_ / "mesh.obj", kSide);
    build_sample(folder_ / "mesh.obj", tree_);
    bytes_ = storage::read_bytes(tree_);
  }
  storage::FileImage image() const { return storage::FileImage(bytes_); }

  Codes codes_of_forgery(const Forgery& forgery, bool full = true) {
    forge(tree_, folder_ / "forged.ptree", forgery);
    return codes_of(check(storage::read_bytes(folder_ / "forged.ptree"), full));
  }
  Codes codes_of_model(const std::function<void(storage::ModelRecord&)>& change) {
    Forgery forgery;
    forgery.model = change;
    return codes_of_forgery(forgery);
  }

  storage::TemporaryDirectory folder_;
  std::filesystem::path tree_ = folder_ / "tree.ptree";
  Bytes bytes_;
};

}  // namespace planetree::tools
