#include "tools/tune/lookup_export.h"

#include <gtest/gtest.h>

#include <string>

#include "tests/tools/tune/made_accesses.h"

namespace planetree::tools {
namespace {

using Event = PageAccess::Event;

std::string exported(const LookupExport& lookups, LookupExport::Format format) {
  std::string text;
  EXPECT_TRUE(lookups.write(format, 65536, [&](std::span<const std::byte> piece) -> Result<void> {
    for (const std::byte byte : piece) text += static_cast<char>(byte);
    return {};
  }));
  return text;
}

LookupExport sample_lookups() {
  LookupExport lookups;
  lookups.add(own(PageAccess::Query::kOpen, 1, Event::kFetched));
  lookups.add(lookup(0, 0, Event::kHit, 500));  // the root
  lookups.add(lookup(0, 3, Event::kHit, 1'000));
  lookups.add(lookup(0, 7, Event::kFetched, 2'500'000'000));
  lookups.add(lookup(0, 7, Event::kInstalled, 2'500'000'000));
  lookups.add(lookup(1, 9, Event::kMissed, 2'500'000'000));  // not needed
  lookups.add(lookup(1, 3, Event::kHit, 3'000'000'000));
  return lookups;
}

TEST(LookupExport, WritesLines) {
  EXPECT_EQ(exported(sample_lookups(), LookupExport::Format::kCsv),
            "time_s,page,bytes\n0.000001,3,65536\n2.500000,7,65536\n3.000000,3,65536\n");
  EXPECT_EQ(exported(LookupExport(), LookupExport::Format::kCsv), "time_s,page,bytes\n");
}

TEST(LookupExport, WritesRecordsThatNameTheNextLookup) {
  const std::string bytes = exported(sample_lookups(), LookupExport::Format::kOracleGeneral);
  const auto number = [&](std::size_t at, int size) {
    std::uint64_t value = 0;
    for (int i = size; i-- > 0;)
      value = value << 8 | static_cast<unsigned char>(bytes[at + static_cast<std::size_t>(i)]);
    return value;
  };
  ASSERT_EQ(bytes.size(), 3u * 24);
  EXPECT_EQ(number(0, 4), 0u);
  EXPECT_EQ(number(4, 8), 3u);
  EXPECT_EQ(number(12, 4), 65536u);
  EXPECT_EQ(number(16, 8), 2u);
  EXPECT_EQ(number(24, 4), 2u);
  EXPECT_EQ(number(28, 8), 7u);
  EXPECT_EQ(number(40, 8), ~std::uint64_t{0});
  EXPECT_EQ(number(64, 8), ~std::uint64_t{0});
}

TEST(LookupExport, WritesManyLookupsInPieces) {
  LookupExport lookups;
  for (std::uint32_t i = 0; i < 100'000; ++i) lookups.add(lookup(i, 1 + i % 50, Event::kHit, i));
  int pieces = 0;
  std::size_t size = 0;
  EXPECT_TRUE(lookups.write(LookupExport::Format::kOracleGeneral, 65536,
                            [&](std::span<const std::byte> piece) -> Result<void> {
                              ++pieces;
                              size += piece.size();
                              return {};
                            }));
  EXPECT_EQ(pieces, 3);
  EXPECT_EQ(size, 24u * 100'000);
}

}  // namespace
}  // namespace planetree::tools
