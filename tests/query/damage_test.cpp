// Files that are damaged while they are open.

#include <gtest/gtest.h>

#include <fstream>

#include "planetree/probe.h"
#include "tests/query/sample_model.h"
#include "tests/storage/file/file_image.h"

namespace planetree::query {
namespace {

class DamagedWhileOpen : public testing::Test {
 protected:
  DamagedWhileOpen() : sample_(octree::sphere(4)), queries_(random_queries(200, -1.3, 1.3)) {}

  // Changes one byte of the file in place, as a failing disk would.
  void damage_page(std::uint32_t page) {
    storage::FileImage image(storage::read_bytes(sample_.path()));
    const std::size_t middle = image.offset_of_page(page) + image.entry(page).stored_bytes / 2;
    std::fstream file(sample_.path(), std::ios::in | std::ios::out | std::ios::binary);
    file.seekg(static_cast<std::streamoff>(middle));
    const int byte = file.get();
    file.seekp(static_cast<std::streamoff>(middle));
    file.put(static_cast<char>(byte ^ 0x10));
  }

  struct Outcome {
    std::size_t exact = 0, degraded = 0;
  };
  Outcome query_everything(Probe& probe) {
    Outcome outcome;
    for (const Vec3& query : queries_) {
      const ClosestPoint answer = probe.closest_point(query);
      EXPECT_TRUE(sample_.interval_holds(answer, query));
      if (answer.status == Status::kExact) {
        ++outcome.exact;
        EXPECT_EQ(answer.triangle, sample_.nearest_triangle(query));
      } else {
        ++outcome.degraded;
        EXPECT_EQ(answer.status, Status::kDegraded);
      }
    }
    return outcome;
  }

  SampleModel sample_;
  std::vector<Vec3> queries_;
};

TEST_F(DamagedWhileOpen, DegradesOnlyAnswersThatNeedTheDamagedPage) {
  const Model model = sample_.open();
  Probe probe = make_probe(model);
  damage_page(sample_.page_count() - 1);
  const Outcome outcome = query_everything(probe);
  EXPECT_GT(outcome.degraded, 0u);
  EXPECT_GT(outcome.exact, outcome.degraded);
  EXPECT_EQ(model.stats().quarantined_pages, 1u);
  EXPECT_EQ(model.stats().degraded_answers, outcome.degraded);
}

TEST_F(DamagedWhileOpen, QuarantinesAPageForGood) {
  const Model model = sample_.open();
  Probe probe = make_probe(model);
  damage_page(sample_.page_count() - 1);
  const Outcome first = query_everything(probe);
  damage_page(sample_.page_count() - 1);  // restores the byte
  const Outcome second = query_everything(probe);
  EXPECT_EQ(first.degraded, second.degraded);
  EXPECT_EQ(model.stats().quarantined_pages, 1u);
}

TEST_F(DamagedWhileOpen, AnswersFromResidentPages) {
  const Model model = sample_.open();
  Probe probe = make_probe(model);
  ASSERT_EQ(query_everything(probe).degraded, 0u);
  for (std::uint32_t page = 0; page < sample_.page_count(); ++page) damage_page(page);
  EXPECT_EQ(query_everything(probe).degraded, 0u);
}

TEST_F(DamagedWhileOpen, AnswersWithEveryPageButTheRootLost) {
  const Model model = sample_.open(sample_.min_budget());
  Probe probe = make_probe(model);
  for (std::uint32_t page = 1; page < sample_.page_count(); ++page) damage_page(page);
  const Outcome outcome = query_everything(probe);
  EXPECT_EQ(outcome.exact, 0u);
  EXPECT_GT(model.stats().quarantined_pages, 0u);
}

TEST_F(DamagedWhileOpen, SurvivesATruncatedFile) {
  const Model model = sample_.open(sample_.min_budget());
  Probe probe = make_probe(model);
  std::filesystem::resize_file(sample_.path(), std::filesystem::file_size(sample_.path()) / 2);
  const Outcome outcome = query_everything(probe);
  EXPECT_GT(outcome.degraded, 0u);
  EXPECT_GT(model.stats().quarantined_pages, 0u);
}

TEST_F(DamagedWhileOpen, KeepsTheFileItOpened) {
  const Model model = sample_.open(sample_.min_budget());
  Probe probe = make_probe(model);
  const std::filesystem::path other = sample_.path().string() + ".new";
  std::ofstream(other) << "something else";
  std::filesystem::rename(other, sample_.path());
  EXPECT_EQ(query_everything(probe).degraded, 0u);
}

}  // namespace
}  // namespace planetree::query
