#include "storage/spill/record_packing.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <random>
#include <vector>

namespace planetree::storage {
namespace {

using Bytes = std::vector<std::byte>;

// Records whose first bytes are alike, and whose last `random_bytes` are not.
Bytes records_of(std::size_t count, std::size_t record_bytes, std::size_t random_bytes) {
  std::mt19937 random(5);
  Bytes records(count * record_bytes);
  for (std::size_t i = 0; i < records.size(); ++i)
    records[i] = i % record_bytes < record_bytes - random_bytes
                     ? static_cast<std::byte>(i % record_bytes)
                     : static_cast<std::byte>(random());
  return records;
}

TEST(RecordPacking, GivesBackEveryByte) {
  for (const std::size_t record_bytes : {1u, 24u, 52u, 88u})
    for (const std::size_t count : {1u, 2u, 255u, 256u, 1000u})
      for (const std::size_t random_bytes : {std::size_t{0}, record_bytes / 2, record_bytes}) {
        const Bytes records = records_of(count, record_bytes, random_bytes);
        const Bytes packed = pack_records(records, record_bytes);
        EXPECT_LE(packed.size(), records.size());
        Bytes unpacked(records.size());
        ASSERT_TRUE(unpack_records(packed, record_bytes, unpacked));
        EXPECT_EQ(unpacked, records);
      }
}

TEST(RecordPacking, IsShortWhereBytesAreAlike) {
  const Bytes records = records_of(256, 52, 20);
  EXPECT_LT(pack_records(records, 52).size(), 256u * 22);
}

TEST(RecordPacking, RefusesOtherBytes) {
  const Bytes records = records_of(256, 52, 20);
  const Bytes packed = pack_records(records, 52);
  Bytes out(records.size());
  for (std::size_t length = 0; length < packed.size(); ++length) {
    const auto part = unpack_records(std::span(packed).first(length), 52, out);
    ASSERT_FALSE(part) << length;
    EXPECT_EQ(part.error().code, ErrorCode::kDamaged);
  }
  Bytes longer = packed;
  longer.resize(records.size() + 1);
  EXPECT_FALSE(unpack_records(longer, 52, out));
  Bytes fewer(out.size() - 52), more(out.size() + 52);
  EXPECT_FALSE(unpack_records(packed, 52, fewer));
  EXPECT_FALSE(unpack_records(packed, 52, more));
}

// Whatever the bytes are, nothing is written outside of the records; the sanitizers report it.
TEST(RecordPacking, SurvivesEveryByteChanged) {
  const Bytes records = records_of(64, 52, 20);
  const Bytes packed = pack_records(records, 52);
  Bytes out(records.size());
  std::size_t refused = 0;
  for (std::size_t at = 0; at < packed.size(); ++at)
    for (const unsigned change : {0x01u, 0x80u, 0xffu}) {
      Bytes changed = packed;
      changed[at] ^= static_cast<std::byte>(change);
      refused += unpack_records(changed, 52, out) ? 0 : 1;
    }
  EXPECT_GT(refused, 0u);
}

}  // namespace
}  // namespace planetree::storage
