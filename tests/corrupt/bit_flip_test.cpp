// Flips every bit of a file, one at a time: the file is refused, or the interval of every answer
// holds the true distance.

#include <gtest/gtest.h>

#include <fcntl.h>
#include <unistd.h>

#include <map>
#include <string>
#include <vector>

#include "planetree/probe.h"
#include "tests/query/answer_bits.h"
#include "tests/query/sample_model.h"
#include "tests/storage/file/file_image.h"

namespace planetree {
namespace {

using query::make_probe;
using query::SampleModel;

// Flips bits of a file in place and restores them.
class CorruptibleFile {
 public:
  explicit CorruptibleFile(const std::filesystem::path& path)
      : bytes_(storage::read_bytes(path)), file_(::open(path.c_str(), O_WRONLY | O_CLOEXEC)) {}
  ~CorruptibleFile() { ::close(file_); }
  CorruptibleFile(const CorruptibleFile&) = delete;
  CorruptibleFile& operator=(const CorruptibleFile&) = delete;

  std::size_t size() const { return bytes_.size(); }
  void flip(std::size_t at, unsigned bit) { put(at, bytes_[at] ^ std::byte{1} << bit); }
  void restore(std::size_t at) { put(at, bytes_[at]); }

 private:
  void put(std::size_t at, std::byte byte) {
    ASSERT_EQ(::pwrite(file_, &byte, 1, static_cast<off_t>(at)), 1);
  }
  storage::Bytes bytes_;
  int file_;
};

class StabilityBitFlip : public testing::Test {
 protected:
  StabilityBitFlip()
      : sample_(octree::height_field(12)),
        budget_(sample_.min_budget()),
        queries_(query::random_queries(3, -0.5, 1.5)) {
    const Model model = sample_.open(budget_);
    Probe probe = make_probe(model);
    for (const Vec3& at : queries_) {
      exact_.push_back(probe.closest_point(at));
      EXPECT_TRUE(sample_.interval_holds(exact_.back(), at));
    }
  }

  // The result of opening and querying the file with one bit flipped.
  std::string outcome() {
    OpenOptions options;
    options.memory_budget_bytes = budget_;
    options.max_probes = 1;
    const auto model = Model::open(sample_.path(), options);
    if (!model) {
      EXPECT_NE(model.error().text[0], 0);
      return "refused";
    }
    Probe probe = make_probe(*model);
    bool degraded = false;
    for (std::size_t i = 0; i < queries_.size(); ++i) {
      const ClosestPoint answer = probe.closest_point(queries_[i]);
      EXPECT_LE(answer.lower, exact_[i].upper);
      EXPECT_GE(answer.upper, exact_[i].lower);
      if (answer.status == Status::kExact) {
        EXPECT_EQ(bits_of(answer), bits_of(exact_[i]));
      } else {
        EXPECT_EQ(answer.status, Status::kDegraded);
        degraded = true;
      }
    }
    if (model->stats().header_copy_damaged) return "header copy damaged";
    return degraded ? "degraded" : "unharmed";
  }

  SampleModel sample_;
  std::uint64_t budget_;
  std::vector<Vec3> queries_;
  std::vector<ClosestPoint> exact_;
};

TEST_F(StabilityBitFlip, NeverGivesAWrongInterval) {
  ASSERT_GE(sample_.page_count(), 3u);
  CorruptibleFile file(sample_.path());
  std::map<std::string, std::size_t> outcomes;
  for (std::size_t at = 0; at < file.size(); ++at)
    for (unsigned bit = 0; bit < 8; ++bit) {
      file.flip(at, bit);
      ++outcomes[outcome()];
      file.restore(at);
      ASSERT_FALSE(HasFailure()) << "byte " << at << ", bit " << bit;
    }
  EXPECT_EQ(outcome(), "unharmed");
  // A bit of either header; a bit of the page table or a page read at open; a bit of any other
  // page.
  EXPECT_EQ(outcomes["header copy damaged"], 2u * 8 * storage::kHeaderBytes);
  EXPECT_GT(outcomes["refused"], 1000u);
  EXPECT_GT(outcomes["degraded"], 1000u);
  std::size_t all = 0;
  for (const auto& [name, count] : outcomes) all += count;
  EXPECT_EQ(all, 8 * file.size());
}

}  // namespace
}  // namespace planetree
