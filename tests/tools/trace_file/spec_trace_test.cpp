// Reads the sample by format-spec/trace-v1/spec.md alone, without the code that it tests.

#include <gtest/gtest.h>
#include <lz4.h>
#include <xxhash.h>

#include <array>
#include <cstring>
#include <string>
#include <vector>

#include "tests/tools/trace_file/sample_trace.h"

namespace planetree::tools {
namespace {

/// Fields of a string of bytes, from front to back.
class Fields {
 public:
  explicit Fields(std::string bytes) : bytes_(std::move(bytes)) {}

  bool at_end() const { return at_ == bytes_.size(); }
  std::string take(std::size_t count) {
    EXPECT_LE(at_ + count, bytes_.size());
    at_ += count;
    return bytes_.substr(at_ - count, count);
  }
  std::uint64_t number(std::size_t bytes) {
    std::uint64_t value = 0;
    const std::string taken = take(bytes);
    for (std::size_t i = bytes; i-- > 0;) value = value << 8 | static_cast<unsigned char>(taken[i]);
    return value;
  }
  std::uint64_t varint() {
    std::uint64_t value = 0;
    for (unsigned shift = 0;; shift += 7) {
      const std::uint64_t byte = number(1);
      value |= (byte & 127) << shift;
      if (byte < 128) return value;
    }
  }
  std::uint64_t difference() {
    const std::uint64_t coded = varint();
    return coded % 2 == 0 ? coded / 2 : 0 - (coded + 1) / 2;
  }

 private:
  std::string bytes_;
  std::size_t at_ = 0;
};

std::uint64_t bits_of(double value) {
  std::uint64_t bits = 0;
  std::memcpy(&bits, &value, sizeof bits);
  return bits;
}

double double_of(std::uint64_t bits) {
  double value = 0;
  std::memcpy(&value, &bits, sizeof value);
  return value;
}

struct SpecPage {
  std::uint64_t page, octcode, section, stored_bytes;
};

class SpecTrace {
 public:
  explicit SpecTrace(const std::string& file) : fields_(file) {
    const std::string fixed = file.substr(0, 80);
    EXPECT_EQ(fields_.take(8), "pttrace\n");
    EXPECT_EQ(fields_.number(4), 1u);
    const std::uint64_t name_bytes = fields_.number(4);
    fields_.take(2 * 8 + 8 + 8 + 4 + 4);
    rate_hz_ = static_cast<double>(fields_.number(4));
    fields_.take(4 + 1 + 1 + 2 + 4 + 8);
    hash_ = fields_.number(8);
    name = fields_.take(name_bytes);
    const std::string hashed = fixed + name;
    EXPECT_EQ(hash_, XXH3_64bits(hashed.data(), hashed.size()));
    while (read_chunk()) {
    }
    EXPECT_TRUE(fields_.at_end());
  }

  std::string name;
  std::vector<PageAccess> records;
  std::array<std::uint64_t, 3> end{};

 private:
  bool read_chunk() {
    const std::string head = fields_.take(16);
    Fields of_head(head);
    const std::uint64_t kind = of_head.number(4), codec = of_head.number(4);
    const std::uint64_t stored_bytes = of_head.number(4), raw_bytes = of_head.number(4);
    const std::uint64_t hash = fields_.number(8);
    const std::string stored = fields_.take(stored_bytes), hashed = head + stored;
    EXPECT_EQ(hash, XXH3_64bits_withSeed(hashed.data(), hashed.size(), hash_ + chunk_++));
    std::string raw = stored;
    if (codec == 1) {
      raw.resize(raw_bytes);
      EXPECT_EQ(LZ4_decompress_safe(stored.data(), raw.data(), static_cast<int>(stored.size()),
                                    static_cast<int>(raw.size())),
                static_cast<int>(raw_bytes));
    }
    Fields of_raw(raw);
    if (kind == 2)
      for (std::uint64_t& value : end) value = of_raw.number(8);
    else
      read_records(of_raw);
    return kind == 1;
  }

  void read_records(Fields& raw) {
    for (std::uint64_t left = raw.varint(); left > 0; --left) {
      const std::uint64_t page = raw.varint(), octcode = raw.number(8), section = raw.number(1);
      pages_.push_back({page, octcode, section, raw.varint()});
    }
    PageAccess last;
    std::uint64_t index = 0, kind = 0;
    std::array<double, 3> position{};
    bool has_position = false;
    while (!raw.at_end()) {
      const std::uint64_t tag = raw.number(1);
      if ((tag & 32) != 0) {
        last.probe = static_cast<std::uint32_t>(raw.varint());
        kind = raw.number(1);
        last.query += raw.difference();
      }
      if ((tag & 64) != 0) last.time_ns += raw.difference();
      PageAccess access = last;
      access.event = static_cast<PageAccess::Event>(tag & 15);
      access.query_kind = static_cast<PageAccess::Query>(kind & 7);
      access.in_batch = (kind & 8) != 0;
      access.waits = (kind & 16) != 0;
      access.is_upper = (tag & 16) != 0 && (tag & 15) == 5;
      access.needed = (tag & 16) != 0 && (tag & 15) != 5;
      if ((tag & 15) == 9) {
        read_motion(raw, position, has_position, access);
      } else if ((tag & 15) == 8) {
        const auto bits = static_cast<std::uint32_t>(raw.number(4));
        std::memcpy(&access.width, &bits, sizeof bits);
      } else {
        index += raw.difference();
        const SpecPage& page = pages_.at(index);
        access.page = static_cast<std::uint32_t>(page.page);
        access.octcode = page.octcode;
        access.level = static_cast<std::uint8_t>(page.octcode >> 59);
        access.section = static_cast<PageAccess::Section>(page.section);
        access.stored_bytes = static_cast<std::uint32_t>(page.stored_bytes);
      }
      records.push_back(access);
    }
  }

  void read_motion(Fields& raw, std::array<double, 3>& position, bool& has_position,
                   PageAccess& access) const {
    const std::uint64_t lengths = raw.number(3);
    std::array<double, 6> values{};
    for (std::size_t i = 0; i < 6; ++i) {
      double expected = 0;
      if (has_position)
        expected = i < 3 ? position[i] : (values[i - 3] - position[i - 3]) * rate_hz_;
      values[i] = double_of(raw.number(lengths >> 4 * i & 15) ^ bits_of(expected));
    }
    position = {values[0], values[1], values[2]};
    has_position = true;
    access.position = {values[0], values[1], values[2]};
    access.velocity = {values[3], values[4], values[5]};
  }

  Fields fields_;
  double rate_hz_ = 0;
  std::uint64_t hash_ = 0, chunk_ = 0;
  std::vector<SpecPage> pages_;
};

TEST(TraceSpec, SufficesToReadTheSample) {
  const std::string file = file_text(std::filesystem::path(PLANETREE_SOURCE_DIR) /
                                     "format-spec/trace-v1/samples/session.trace");
  ASSERT_EQ(file.size(), 332u);
  const SpecTrace trace(file);
  EXPECT_EQ(trace.name, "statue.ptree");
  const std::vector<PageAccess> expected = sample_records();
  ASSERT_EQ(trace.records.size(), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i)
    EXPECT_EQ(row_of(trace.records[i]), row_of(expected[i])) << i;
  EXPECT_EQ(trace.end, (std::array<std::uint64_t, 3>{expected.size(), 2, 4}));
}

}  // namespace
}  // namespace planetree::tools
