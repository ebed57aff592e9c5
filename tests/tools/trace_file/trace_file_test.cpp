#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "storage/file/checksum.h"
#include "tests/storage/system/temporary_directory.h"
#include "tests/tools/trace_file/sample_trace.h"
#include "tools/trace_file/trace_layout.h"

namespace planetree::tools {
namespace {

namespace fs = std::filesystem;

class TraceFile : public testing::Test {
 protected:
  fs::path path() const { return folder_ / "session.trace"; }

  void write(const std::vector<PageAccess>& records, const TraceHeader& header = sample_header()) {
    auto writer = TraceWriter::create(path(), true);
    ASSERT_TRUE(writer);
    ASSERT_TRUE(writer->begin(header));
    ASSERT_TRUE(writer->add(records));
    ASSERT_TRUE(writer->finish(4, 2));
  }
  void write_text(const std::string& text) {
    std::ofstream(path(), std::ios::binary | std::ios::trunc) << text;
  }
  TraceContents read() const { return read_trace(path().string()); }

  storage::TemporaryDirectory folder_;
};

void expect_same(const std::vector<PageAccess>& read, const std::vector<PageAccess>& written) {
  ASSERT_EQ(read.size(), written.size());
  for (std::size_t i = 0; i < read.size(); ++i) EXPECT_EQ(row_of(read[i]), row_of(written[i])) << i;
}

TEST_F(TraceFile, ReadsWhatWasWritten) {
  write(sample_records());
  const TraceContents contents = read();
  ASSERT_EQ(contents.error, "");
  expect_same(contents.records, sample_records());
  const TraceHeader header = sample_header();
  EXPECT_EQ(contents.header.model, header.model);
  EXPECT_EQ(contents.header.content_id[1], header.content_id[1]);
  EXPECT_EQ(contents.header.memory_bytes, header.memory_bytes);
  EXPECT_EQ(contents.header.frames, header.frames);
  EXPECT_EQ(contents.header.page_bytes, header.page_bytes);
  EXPECT_EQ(contents.header.pages, header.pages);
  EXPECT_EQ(contents.header.rate_hz, header.rate_hz);
  EXPECT_EQ(contents.header.layers, header.layers);
  EXPECT_EQ(contents.header.latency_ns, header.latency_ns);
  EXPECT_EQ(contents.header.fetch_threads, header.fetch_threads);
  EXPECT_EQ(contents.header.policy, header.policy);
  EXPECT_TRUE(contents.header.is_deterministic);
  EXPECT_EQ(contents.totals.records, contents.records.size());
  EXPECT_EQ(contents.totals.ticks, 4u);
  EXPECT_EQ(contents.totals.lost, 2u);
}

// A path of 20,000 ticks with 12 lookups each, in several chunks.
TEST_F(TraceFile, TakesFewBytesForAReference) {
  std::mt19937_64 random(1);
  std::vector<PageAccess> records;
  Vec3 at{0.1, 0.2, 0.3};
  std::size_t lookups = 0;
  for (std::uint64_t tick = 0; tick < 20'000; ++tick) {
    PageAccess access;
    access.time_ns = 1'000'000 * tick + random() % 1000;
    access.query = tick + 1;
    access.event = PageAccess::Event::kMotion;
    const Vec3 last = at;
    for (double Vec3::*axis : {&Vec3::x, &Vec3::y, &Vec3::z}) {
      at.*axis += static_cast<double>(random() % 1000) * 1e-7;
      access.velocity.*axis = tick == 0 ? 0 : (at.*axis - last.*axis) * 1000;
    }
    access.position = at;
    records.push_back(access);
    access.position = access.velocity = {};
    access.event = PageAccess::Event::kHit;
    for (unsigned i = 0; i < 12; ++i, ++lookups) {
      access.page = static_cast<std::uint32_t>((i * i + tick / 100) % 500);
      access.octcode = std::uint64_t{access.page} * 977;
      access.level = 0;
      access.stored_bytes = 30'000 + access.page;
      records.push_back(access);
    }
  }
  TraceHeader header = sample_header();
  header.pages = 500;
  write(records, header);
  EXPECT_LT(fs::file_size(path()), 8 * lookups);
  EXPECT_GT(fs::file_size(path()), std::uintmax_t{1} << 18);
  const TraceContents contents = read();
  ASSERT_EQ(contents.error, "");
  expect_same(contents.records, records);
}

TEST_F(TraceFile, WritesTheSameBytesAsTheSample) {
  write(sample_records());
  const fs::path sample =
      fs::path(PLANETREE_SOURCE_DIR) / "format-spec/trace-v1/samples/session.trace";
  const TraceContents contents = read_trace(sample.string());
  ASSERT_EQ(contents.error, "");
  expect_same(contents.records, sample_records());
  EXPECT_EQ(file_text(path()), file_text(sample));
}

TEST_F(TraceFile, EveryCutIsSeen) {
  write(sample_records());
  const std::string whole = file_text(path());
  for (std::size_t size = 0; size < whole.size(); ++size) {
    write_text(whole.substr(0, size));
    const TraceContents contents = read();
    ASSERT_NE(contents.error, "") << size;
    EXPECT_EQ(contents.code, size < 8 ? ErrorCode::kNotPlanetree : ErrorCode::kTruncated) << size;
  }
  write_text(whole + "x");
  EXPECT_EQ(read().code, ErrorCode::kTruncated);
}

TEST_F(TraceFile, AFlippedBitOfAnyByteIsSeen) {
  write(sample_records());
  const std::string whole = file_text(path());
  for (std::size_t byte = 0; byte < whole.size(); ++byte) {
    const std::size_t bit = 8 * byte + byte % 8;
    std::string flipped = whole;
    flipped[bit / 8] = static_cast<char>(flipped[bit / 8] ^ 1 << bit % 8);
    write_text(flipped);
    const TraceContents contents = read();
    ASSERT_NE(contents.error, "") << bit;
    EXPECT_EQ(contents.error.find('\n'), std::string::npos);
    EXPECT_NE(contents.error.find(';'), std::string::npos) << contents.error;
  }
}

// Puts other raw bytes under right hashes into a file of one chunk of records.
class ForgedTraceFile : public TraceFile {
 protected:
  void forge(const std::string& raw) {
    write({});
    std::string text = file_text(path()).substr(0, sizeof(TraceHeaderRecord) + 12);
    TraceHeaderRecord header{};
    std::memcpy(&header, text.data(), sizeof header);
    append(text, TraceChunkKind::kRecords, raw, header.hash);
    TraceEndRecord end{1, 0, 0};
    append(text, TraceChunkKind::kEnd, std::string(reinterpret_cast<const char*>(&end), sizeof end),
           header.hash + 1);
    write_text(text);
  }
  static void append(std::string& text, TraceChunkKind kind, const std::string& raw,
                     std::uint64_t seed) {
    TraceChunkRecord chunk{kind, 0, static_cast<std::uint32_t>(raw.size()),
                           static_cast<std::uint32_t>(raw.size()), 0};
    std::string hashed(reinterpret_cast<const char*>(&chunk), offsetof(TraceChunkRecord, hash));
    hashed += raw;
    chunk.hash = storage::hash64(std::as_bytes(std::span(hashed)), seed);
    text.append(reinterpret_cast<const char*>(&chunk), sizeof chunk);
    text += raw;
  }
  // Numbers as bytes.
  static std::string bytes(std::initializer_list<int> values) {
    std::string text;
    for (const int value : values) text += static_cast<char>(value);
    return text;
  }
};

TEST_F(ForgedTraceFile, IsReadIfItsRecordsAreSound) {
  forge(bytes({1, 8, 0, 0, 0, 0, 0, 0, 0, 0, 3, 9}) + bytes({0, 0}));
  const TraceContents contents = read();
  ASSERT_EQ(contents.error, "");
  ASSERT_EQ(contents.records.size(), 1u);
  EXPECT_EQ(contents.records[0].page, 8u);
  EXPECT_EQ(contents.records[0].stored_bytes, 9u);
}

TEST_F(ForgedTraceFile, IsRefusedIfItsRecordsAreNot) {
  const std::string page = bytes({1, 8, 0, 0, 0, 0, 0, 0, 0, 0, 3, 9});
  const std::string wrong[] = {
      bytes({2}) + page.substr(1) + bytes({0, 0}),        // a page is missing
      bytes({1, 9, 0, 0, 0, 0, 0, 0, 0, 0, 3, 9, 0, 0}),  // page beyond the model
      bytes({1, 8, 0, 0, 0, 0, 0, 0, 0, 0, 5, 9, 0, 0}),  // section
      page + bytes({0, 2}),                               // page not described
      page + bytes({10, 0}),                              // event
      page + bytes({128, 0}),                             // tag
      page + bytes({0}),                                  // no page
      page + bytes({32, 0, 5, 0, 0}),                     // query
      page + bytes({32, 0, 32, 0, 0}),                    // kind
      page + bytes({64, 255, 255, 255, 255, 255, 255, 255, 255, 255, 2, 0}),  // long number
      page + bytes({9, 9, 0, 0}),        // length of a coordinate
      page + bytes({9, 8, 0, 0, 1, 2}),  // cut coordinate
      page + bytes({8, 1, 2, 3}),        // cut width
      page + bytes({0, 0, 0, 0}),        // two records
      page};                             // none
  for (const std::string& raw : wrong) {
    forge(raw);
    const TraceContents contents = read();
    EXPECT_EQ(contents.code, ErrorCode::kDamaged) << testing::PrintToString(raw);
    EXPECT_NE(contents.error.find(';'), std::string::npos) << testing::PrintToString(raw);
  }
}

TEST_F(TraceFile, SaysWhatTheFileIsNot) {
  write_text("tick,probe,page,level,access\n1,2,3,4,hit\n");
  EXPECT_EQ(read().error,
            "this is not a page trace; give a file that --trace of touch or query wrote");
  EXPECT_EQ(read_trace((folder_ / "none").string()).code, ErrorCode::kNotFound);
}

TEST_F(TraceFile, ReplacesNoFileUnlessAllowed) {
  write({});
  const auto writer = TraceWriter::create(path(), false);
  ASSERT_FALSE(writer);
  EXPECT_EQ(writer.error().code, ErrorCode::kAlreadyExists);
}

}  // namespace
}  // namespace planetree::tools
