#include "storage/file/page_codec.h"

#include <gtest/gtest.h>

#include <cstring>
#include <thread>

#include "tests/storage/file/sample_file.h"

namespace planetree::storage {
namespace {

ErrorCode code_of(const Result<void>& result) {
  EXPECT_FALSE(result);
  return result ? ErrorCode{} : result.error().code;
}

TEST(PageCodec, DecodesWhatItEncoded) {
  for (const std::size_t length : {1u, 2u, 12u, 13u, 64u, 4096u, 65536u, 200'000u}) {
    for (const std::uint32_t page : {0u, 1u}) {
      const Bytes raw = sample_page(page, length);
      const StoredPage stored = compress_page(raw);
      Bytes restored(length);
      ASSERT_TRUE(decompress_page(stored.codec, stored.bytes, restored)) << length;
      EXPECT_EQ(restored, raw) << length;
      EXPECT_TRUE(lengths_are_plausible(stored.codec, stored.bytes.size(), length)) << length;
    }
  }
}

TEST(PageCodec, CompressesOnlyPagesThatShrink) {
  EXPECT_EQ(compress_page(sample_page(0, 4096)).codec, Codec::kLz4);
  EXPECT_LT(compress_page(sample_page(0, 4096)).bytes.size(), 3000u);
  const Bytes noise = sample_page(1, 4096);
  EXPECT_EQ(compress_page(noise).codec, Codec::kStored);
  EXPECT_EQ(compress_page(noise).bytes, noise);
}

TEST(PageCodec, EncodesTheMostCompressiblePageWithinTheLengthLimit) {
  const Bytes raw(kMaxRawBytes);
  const StoredPage stored = compress_page(raw);
  EXPECT_LE(raw.size(), stored.bytes.size() * 255);
  Bytes restored(raw.size(), std::byte{1});
  ASSERT_TRUE(decompress_page(stored.codec, stored.bytes, restored));
  EXPECT_EQ(restored, raw);
}

TEST(PageCodec, EncodesTheSameBytesInAnyThread) {
  const Bytes raw = sample_page(0, 65536);
  const StoredPage here = compress_page(raw);
  Bytes other[2];
  std::thread first([&] { other[0] = compress_page(raw).bytes; });
  std::thread second([&] { other[1] = compress_page(raw).bytes; });
  first.join();
  second.join();
  EXPECT_EQ(other[0], here.bytes);
  EXPECT_EQ(other[1], here.bytes);
}

TEST(PageCodec, RefusesAWrongRawLength) {
  const Bytes raw = sample_page(0, 500);
  for (const Codec codec : {Codec::kStored, Codec::kLz4}) {
    const Bytes stored = codec == Codec::kLz4 ? compress_page(raw).bytes : raw;
    for (const std::size_t length : {0u, 1u, 499u, 501u, 1000u}) {
      Bytes out(length);
      EXPECT_EQ(code_of(decompress_page(codec, stored, out)), ErrorCode::kDamaged) << length;
    }
  }
}

TEST(PageCodec, RefusesAnExpansionBeyondLz4) {
  EXPECT_TRUE(lengths_are_plausible(Codec::kLz4, 4, 4 * 255));
  EXPECT_FALSE(lengths_are_plausible(Codec::kLz4, 4, 4 * 255 + 1));
  EXPECT_FALSE(lengths_are_plausible(Codec::kLz4, 4, 4));
  EXPECT_FALSE(lengths_are_plausible(Codec::kLz4, ~std::uint64_t{0}, 4));
  EXPECT_FALSE(lengths_are_plausible(Codec::kStored, kMaxRawBytes + 1, kMaxRawBytes + 1));
  EXPECT_FALSE(lengths_are_plausible(Codec::kStored, 0, 0));
  Bytes out(4 * 255 + 1);
  const Result<void> decoded = decompress_page(Codec::kLz4, Bytes(4), out);
  ASSERT_FALSE(decoded);
  EXPECT_NE(std::strstr(decoded.error().text, "length"), nullptr);
}

TEST(PageCodec, RefusesAnUnknownCodec) {
  Bytes out(4);
  EXPECT_EQ(code_of(decompress_page(Codec{2}, Bytes(4), out)), ErrorCode::kDamaged);
}

TEST(PageCodec, DecodesDamagedLz4BlocksWithinBounds) {
  const Bytes raw = sample_page(0, 200);
  const Bytes stored = compress_page(raw).bytes;
  std::size_t refused = 0;
  for (std::size_t bit = 0; bit < stored.size() * 8; ++bit) {
    // Buffers of exactly these sizes, so that a sanitizer detects an access one byte too far.
    Bytes broken = stored;
    broken[bit / 8] ^= static_cast<std::byte>(1u << bit % 8);
    Bytes out(raw.size());
    refused += decompress_page(Codec::kLz4, broken, out) ? 0 : 1;
  }
  for (std::size_t length = 1; length < stored.size(); ++length) {
    Bytes out(raw.size());
    EXPECT_FALSE(decompress_page(
        Codec::kLz4, Bytes(stored.begin(), stored.begin() + static_cast<std::ptrdiff_t>(length)),
        out));
  }
  EXPECT_GT(refused, 0u);
}

}  // namespace
}  // namespace planetree::storage
