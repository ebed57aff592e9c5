#include "storage/system/file_error.h"

#include <gtest/gtest.h>

#include <cerrno>
#include <string>

namespace planetree::storage {
namespace {

TEST(FileError, MapsErrnoToErrorCode) {
  struct Known {
    int number;
    ErrorCode code;
  };
  constexpr Known kKnown[] = {{ENOENT, ErrorCode::kNotFound},   {EEXIST, ErrorCode::kAlreadyExists},
                              {EACCES, ErrorCode::kPermission}, {EPERM, ErrorCode::kPermission},
                              {EROFS, ErrorCode::kPermission},  {ENOSPC, ErrorCode::kNoSpace},
                              {EDQUOT, ErrorCode::kNoSpace},    {EFBIG, ErrorCode::kNoSpace},
                              {ENOMEM, ErrorCode::kNoMemory}};
  for (const Known& known : kKnown) {
    for (const FileAction action : {FileAction::kRead, FileAction::kWrite}) {
      EXPECT_EQ(file_error(known.number, action, "try").code, known.code) << known.number;
    }
  }
  EXPECT_EQ(file_error(EIO, FileAction::kRead, "try").code, ErrorCode::kReadFailed);
  EXPECT_EQ(file_error(EIO, FileAction::kWrite, "try").code, ErrorCode::kWriteFailed);
}

TEST(FileError, NamesCauseRemedyPageAndOffset) {
  const Error error = file_error(ENOSPC, FileAction::kWrite, "write the file", 7, 4096);
  EXPECT_STREQ(error.text,
               "cannot write the file: No space left on device; free some space or choose another "
               "device");
  EXPECT_EQ(error.page, 7u);
  EXPECT_EQ(error.offset, 4096u);
}

TEST(FileError, TextFitsForEveryErrno) {
  for (int number = -1; number < 200; ++number) {
    const std::string text = file_error(number, FileAction::kRead, "open the file").text;
    EXPECT_TRUE(text.starts_with("cannot open the file: ")) << number;
    EXPECT_NE(text.find("; "), std::string::npos) << number;
    EXPECT_LT(text.size() + 1, sizeof Error{}.text) << number;
  }
}

}  // namespace
}  // namespace planetree::storage
