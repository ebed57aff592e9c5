#include <cstdint>
#include <filesystem>

#include "tests/fuzz/expectation.h"
#include "tests/fuzz/forging_hooks.h"
#include "tests/fuzz/memory_file.h"
#include "tools/check/file_check.h"
#include "tools/report/file_survey.h"

/// Checks and surveys whole files as `planetree verify --full` and `planetree inspect` do. Their
/// hashes are right and their contents are forged.
///
/// Neither may read beyond a page or take long, every issue has a text, and a survey finds no issue
/// in a file in which a check finds none.
namespace planetree::tools {
namespace {

void check_issues(const IssueList& issues) {
  expect(issues.kept().size() <= issues.count());
  for (const Issue& issue : issues.kept()) expect(!issue_text(issue).empty());
}

void check_and_survey(const std::filesystem::path& path) {
  Result<FileParts> parts = FileParts::open(path);
  if (!parts) return;
  const CheckReport report = check_file(*parts, true);
  check_issues(report.issues);
  expect(report.pages <= parts->page_count());
  std::uint32_t rows = 0;
  const FileSurvey survey = survey_file(*parts, [&](const PageRow& row) {
    expect(row.number == rows++);
    return true;
  });
  check_issues(survey.issues);
  expect(rows == parts->page_count() && survey.unreached_pages <= rows);
  // A survey looks at less than a check.
  expect(survey.issues.count() == 0 || report.issues.count() > 0);
}

}  // namespace
}  // namespace planetree::tools

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const planetree::MemoryFile file(data, size);
  planetree::tools::check_and_survey(file.path());
  return 0;
}
