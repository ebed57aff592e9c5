#pragma once

#include <gtest/gtest.h>

#include <cstring>
#include <functional>
#include <limits>

#include "storage/file/page_file.h"
#include "tests/storage/file/sample_file.h"
#include "tests/storage/system/temporary_directory.h"

/// Files whose hashes are right and whose content is wrong. Each test breaks rules of
/// storage/file/header_check.h, directory_check.h and extension.h one at a time.
namespace planetree::storage {

inline constexpr double kInfinity = std::numeric_limits<double>::infinity();
inline constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

class PageFileRefusal : public testing::Test {
 protected:
  void SetUp() override {
    ASSERT_TRUE(SampleFile().write(directory_ / "good.ptree"));
    good_ = read_bytes(directory_ / "good.ptree");
  }

  FileImage good() const { return FileImage(good_); }

  Error refusal_of(FileImage image) {
    write_bytes(directory_ / "bad.ptree", image.bytes());
    const Result<PageFile> file = PageFile::open(directory_ / "bad.ptree");
    return file ? Error{} : file.error();
  }

  void expect_refused(const FileImage& image, ErrorCode code, const char* said) {
    const Error error = refusal_of(image);
    EXPECT_EQ(error.code, code) << said << " got: " << error.text;
    EXPECT_NE(std::strstr(error.text, said), nullptr) << said << " got: " << error.text;
  }

  void expect_header_refused(const std::function<void(FileHeader&)>& change, ErrorCode code,
                             const char* said) {
    FileImage image = good();
    image.change_header(change);
    image.seal_header();
    expect_refused(image, code, said);
  }

  void expect_model_refused(const std::function<void(ModelRecord&)>& change, const char* said) {
    expect_header_refused([&](FileHeader& header) { change(header.model); }, ErrorCode::kDamaged,
                          said);
  }

  using ModelChange = std::function<void(ModelRecord&)>;
  void expect_model_accepted(const ModelChange& make) {
    FileImage image = good();
    image.change_header([&](FileHeader& header) { make(header.model); });
    image.seal_header();
    EXPECT_EQ(refusal_of(image).text[0], 0);
  }
  // The model that `make` makes is refused once `change` has changed it.
  void expect_changed_model_refused(const ModelChange& make, const ModelChange& change,
                                    const char* said) {
    expect_model_refused(
        [&](ModelRecord& model) {
          make(model);
          change(model);
        },
        said);
  }

  void expect_entry_refused(std::uint32_t page, const std::function<void(DirectoryPage&)>& change,
                            const char* said) {
    FileImage image = good();
    image.change_entry(page, change);
    image.seal();
    expect_refused(image, ErrorCode::kDamaged, said);
  }

  TemporaryDirectory directory_;
  Bytes good_;
};

}  // namespace planetree::storage
