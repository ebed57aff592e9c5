#pragma once

#include <gtest/gtest.h>

#include <chrono>
#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "storage/http/open_source.h"
#include "tests/storage/http/range_server.h"
#include "tests/storage/system/temporary_directory.h"

namespace planetree::storage {

/// An object of several clusters on a server, and options that do not wait long.
class HttpObject : public testing::Test {
 protected:
  static constexpr std::uint64_t kCluster = std::uint64_t{256} << 10;
  static constexpr std::uint64_t kBytes = 20 * kCluster + 1000;

  HttpObject() : object_(make_object(1)), server_(object_) {
    options_.limits.attempts = 3;
    options_.limits.first_pause = std::chrono::milliseconds(1);
    options_.limits.max_total = std::chrono::milliseconds(20'000);
  }

  static std::string make_object(unsigned seed) {
    std::string object(kBytes, '\0');
    std::uint64_t state = seed;
    for (char& byte : object) {
      state = state * 6364136223846793005u + 1442695040888963407u;
      byte = static_cast<char>(state >> 56);
    }
    return object;
  }

  std::unique_ptr<ByteSource> open() {
    auto source = open_source(server_.url(), options_);
    if (!source) ADD_FAILURE() << source.error().text;
    return source ? std::move(*source) : nullptr;
  }
  Error open_error() {
    const auto source = open_source(server_.url(), options_);
    EXPECT_FALSE(source);
    return source ? Error{} : source.error();
  }
  static Result<std::string> read(const ByteSource& source, std::uint64_t offset,
                                  std::size_t bytes) {
    std::string out(bytes, '\0');
    const auto done = source.read_at(offset, std::as_writable_bytes(std::span(out)));
    if (!done) return done.error();
    return out;
  }
  void expect_bytes(const ByteSource& source, std::uint64_t offset, std::size_t bytes) {
    const auto out = read(source, offset, bytes);
    ASSERT_TRUE(out) << out.error().text;
    EXPECT_TRUE(*out == object_.substr(offset, bytes)) << offset;
  }
  Error read_error(const ByteSource& source, std::uint64_t offset) {
    const auto out = read(source, offset, 100);
    EXPECT_FALSE(out);
    return out ? Error{} : out.error();
  }

  std::string object_;
  RangeServer server_;
  HttpOptions options_;
};

}  // namespace planetree::storage
