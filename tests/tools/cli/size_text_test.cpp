#include "tools/cli/size_text.h"

#include <gtest/gtest.h>

#include <limits>
#include <string>

namespace planetree::tools {
namespace {

constexpr std::uint64_t kMax = std::numeric_limits<std::uint64_t>::max();

std::uint64_t count_of(std::string_view text) {
  const auto count = parse_count(text);
  EXPECT_TRUE(count) << text;
  return count ? *count : 0;
}

std::uint64_t bytes_of(std::string_view text) {
  const auto bytes = parse_bytes(text);
  EXPECT_TRUE(bytes) << text;
  return bytes ? *bytes : 0;
}

TEST(SizeText, ReadsDecimalCounts) {
  EXPECT_EQ(count_of("0"), 0U);
  EXPECT_EQ(count_of("12"), 12U);
  EXPECT_EQ(count_of("20K"), 20'000U);
  EXPECT_EQ(count_of("1M"), 1'000'000U);
  EXPECT_EQ(count_of("1m"), 1'000'000U);
  EXPECT_EQ(count_of("2G"), 2'000'000'000U);
  EXPECT_EQ(count_of("3T"), 3'000'000'000'000U);
  EXPECT_EQ(count_of("1.5M"), 1'500'000U);
  EXPECT_EQ(count_of("1.000"), 1U);
  EXPECT_EQ(count_of("0.123456789012T"), 123'456'789'012U);
  EXPECT_EQ(count_of("18446744073709551615"), kMax);
}

TEST(SizeText, ReadsBinaryBytes) {
  EXPECT_EQ(bytes_of("4096"), 4096U);
  EXPECT_EQ(bytes_of("64k"), 65'536U);
  EXPECT_EQ(bytes_of("256M"), 268'435'456U);
  EXPECT_EQ(bytes_of("1.5G"), 1'610'612'736U);
  EXPECT_EQ(bytes_of("2T"), 2'199'023'255'552U);
}

TEST(SizeText, ReadsUnitsOfBytesInBothSystems) {
  EXPECT_EQ(bytes_of("1GiB"), std::uint64_t{1} << 30);
  EXPECT_EQ(bytes_of("64kib"), 65'536U);
  EXPECT_EQ(bytes_of("1.5MiB"), 1'572'864U);
  EXPECT_EQ(bytes_of("1GB"), 1'000'000'000U);
  EXPECT_EQ(bytes_of("2.5kB"), 2'500U);
  EXPECT_EQ(bytes_of("4096B"), 4096U);
  EXPECT_EQ(bytes_of("1TB"), 1'000'000'000'000U);
  for (const char* text : {"1B", "1KB", "1KiB", "1GiB"}) EXPECT_FALSE(parse_count(text)) << text;
  for (const char* text : {"1GBB", "1GiBi", "1Gi", "1PB", "1PiB", "1iK"})
    EXPECT_FALSE(parse_bytes(text)) << text;
}

TEST(SizeText, ReadsExponents) {
  EXPECT_EQ(count_of("1e6"), 1'000'000U);
  EXPECT_EQ(bytes_of("1E+06"), 1'000'000U);
  EXPECT_EQ(count_of("1.25e2"), 125U);
  EXPECT_EQ(count_of("18446744073.709551615e9"), kMax);
  for (const char* text : {"1e", "1e+", "1e-3", "1e3K", "1.25e1", "1e20", "1e999", "2e19", "e6"}) {
    EXPECT_FALSE(parse_count(text)) << text;
    EXPECT_FALSE(parse_bytes(text)) << text;
  }
}

TEST(SizeText, RefusesMalformedNumbers) {
  for (const char* text :
       {"",   "K",   ".5M", "1.",  "1.K",  "1.5",   "1.0001K", "-1",    "+1",  " 1",
        "1 ", "1 K", "1 B", "1iB", "0x10", "1,000", "1P",      "1..5M", "nan", "1K2"}) {
    const auto count = parse_count(text);
    ASSERT_FALSE(count) << text;
    EXPECT_EQ(count.error().code, ErrorCode::kBadArgument);
    EXPECT_FALSE(parse_bytes(text)) << text;
  }
  EXPECT_FALSE(parse_bytes("1.3K"));
  EXPECT_FALSE(parse_count(std::string_view("1\0", 2)));
}

TEST(SizeText, RefusesOverflow) {
  EXPECT_FALSE(parse_count("18446744073709551616"));
  EXPECT_FALSE(parse_count("99999999999999999999999999"));
  EXPECT_FALSE(parse_count("18446745T"));
  EXPECT_FALSE(parse_count("18446744.073709551616T"));
  EXPECT_EQ(count_of("18446744.073709551615T"), kMax);
  EXPECT_FALSE(parse_bytes("16777216T"));
  EXPECT_EQ(bytes_of("16777215T"), 16'777'215ULL << 40);
}

TEST(SizeText, ErrorQuotesTheTextAndTheRemedy) {
  const auto count = parse_count("many");
  ASSERT_FALSE(count);
  const std::string text = count.error().text;
  EXPECT_NE(text.find("'many'"), std::string::npos);
  EXPECT_NE(text.find("1.5M"), std::string::npos);
  const auto endless = parse_count(std::string(10'000, 'x'));
  ASSERT_FALSE(endless);
  EXPECT_NE(std::string(endless.error().text).find("1.5M"), std::string::npos);
}

TEST(SizeText, FormatsCountsAndBytes) {
  EXPECT_EQ(grouped_count(0), "0");
  EXPECT_EQ(grouped_count(999), "999");
  EXPECT_EQ(grouped_count(1000), "1,000");
  EXPECT_EQ(grouped_count(1234567), "1,234,567");
  EXPECT_EQ(grouped_count(kMax), "18,446,744,073,709,551,615");
  EXPECT_EQ(short_count(0), "0.0");
  EXPECT_EQ(short_count(950), "950");
  EXPECT_EQ(short_count(999.6), "1.00 K");
  EXPECT_EQ(short_count(3.214e6), "3.21 M");
  EXPECT_EQ(short_count(45.64e9), "45.6 G");
  EXPECT_EQ(short_count(999.7e3), "1.00 M");
  EXPECT_EQ(short_bytes(512), "512 B");
  EXPECT_EQ(short_bytes(1024), "1.00 KiB");
  EXPECT_EQ(short_bytes(1'610'612'736), "1.50 GiB");
  EXPECT_EQ(short_bytes(kMax), "16.0 EiB");
}

}  // namespace
}  // namespace planetree::tools
