// Heads of replies, which a server may have made of anything.

#include <gtest/gtest.h>

#include <cstdint>
#include <string>

#include "storage/http/object_identity.h"
#include "storage/http/reply_head.h"

namespace planetree::storage {
namespace {

TEST(ReplyHead, TakesFieldsInAnyCase) {
  ReplyHead head;
  head.add_line("HTTP/1.1 206 Partial Content\r\n");
  head.add_line("eTaG:  \"a-b\" \r\n");
  head.add_line("LAST-MODIFIED: Fri, 27 Nov 2026 00:00:00 GMT\r\n");
  head.add_line("content-range: Bytes 10-19/100\r\n");
  head.add_line("Retry-After: 7\r\n");
  head.add_line("\r\n");
  EXPECT_EQ(head.status(), 206);
  EXPECT_EQ(head.etag(), "\"a-b\"");
  EXPECT_EQ(head.last_modified(), "Fri, 27 Nov 2026 00:00:00 GMT");
  ASSERT_TRUE(head.range());
  EXPECT_EQ(head.range()->first, 10u);
  EXPECT_EQ(head.range()->last, 19u);
  EXPECT_EQ(head.range()->total, 100u);
  EXPECT_EQ(head.retry_after_seconds(), 7u);
  EXPECT_FALSE(head.is_encoded());
}

TEST(ReplyHead, AStatusLineStartsANewHead) {
  ReplyHead head;
  head.add_line("HTTP/1.1 302 Found");
  head.add_line("ETag: \"of the redirect\"");
  head.add_line("HTTP/2 206");
  EXPECT_EQ(head.status(), 206);
  EXPECT_TRUE(head.etag().empty());
}

TEST(ReplyHead, MalformedFieldsAreAbsent) {
  for (const char* line : {"ETag: none",
                           "ETag: \"",
                           "ETag: \"a\"b\"",
                           "ETag: \"a b\"",
                           "ETag: W/",
                           "ETag:",
                           "Content-Range: bytes 10-9/100",
                           "Content-Range: bytes 10-100/100",
                           "Content-Range: bytes */100",
                           "Content-Range: bytes 0-9/*",
                           "Content-Range: bytes 0-9/10x",
                           "Content-Range: lines 0-9/10",
                           "Content-Range: bytes0-9/10",
                           "Content-Range: bytes -9/10",
                           "Content-Range: bytes 0-9/99999999999999999999999",
                           "Content-Range: bytes +0-9/10",
                           "Content-Encoding: identity",
                           "Retry-After: Fri, 27 Nov 2026",
                           "Last-Modified: \x01",
                           ":",
                           "no field"}) {
    ReplyHead head;
    head.add_line(line);
    EXPECT_TRUE(head.etag().empty()) << line;
    EXPECT_FALSE(head.range()) << line;
    EXPECT_FALSE(head.is_encoded()) << line;
    EXPECT_TRUE(head.last_modified().empty()) << line;
    EXPECT_EQ(head.retry_after_seconds(), 0u) << line;
  }
  for (const char* line : {"HTTP/1.1", "HTTP/1.1 abc", "HTTP/1.1 20", "HTTP/1.1 99999999999"}) {
    ReplyHead head;
    head.add_line(line);
    EXPECT_EQ(head.status(), 0) << line;
  }
}

TEST(ReplyHead, LongFieldsAreAbsent) {
  ReplyHead head;
  head.add_line("ETag: \"" + std::string(1 << 20, 'a') + "\"");
  head.add_line("Last-Modified: " + std::string(1 << 20, 'a'));
  EXPECT_TRUE(head.etag().empty());
  EXPECT_TRUE(head.last_modified().empty());
}

// Whatever the lines are, what is taken of them can be sent back, and ranges are ranges.
TEST(ReplyHead, SurvivesRandomLines) {
  const std::string pieces[] = {"HTTP/1.1 ", "206",
                                "ETag: ",    "\"",
                                "W/",        "Content-Range: ",
                                "bytes ",    "0",
                                "-",         "9",
                                "/",         "18446744073709551615",
                                "\r\n",      "\0",
                                "\x80\xff",  "Last-Modified: ",
                                " ",         ":"};
  std::uint64_t state = 1;
  const auto random = [&state](std::uint64_t below) {
    state = state * 6364136223846793005u + 1442695040888963407u;
    return (state >> 33) % below;
  };
  for (int round = 0; round < 100'000; ++round) {
    ReplyHead head;
    for (std::uint64_t lines = random(4) + 1; lines > 0; --lines) {
      std::string line;
      for (std::uint64_t count = random(9); count > 0; --count)
        line += pieces[random(std::size(pieces))];
      head.add_line(line);
    }
    ASSERT_EQ(head.etag().find_first_of("\r\n"), std::string::npos);
    ASSERT_EQ(head.last_modified().find_first_of("\r\n"), std::string::npos);
    if (!head.range()) continue;
    ASSERT_LE(head.range()->first, head.range()->last);
    ASSERT_LT(head.range()->last, head.range()->total);
  }
}

TEST(ObjectIdentity, ItsKeyFollowsFromAllOfIt) {
  const ObjectIdentity object{"http://host/a", "\"1\"", "", 100};
  ObjectIdentity other = object;
  EXPECT_EQ(other.key(), object.key());
  other.etag = "\"2\"";
  EXPECT_NE(other.key(), object.key());
  other = object;
  other.size_bytes = 101;
  EXPECT_NE(other.key(), object.key());
  other = object;
  other.url = "http://host/b";
  EXPECT_NE(other.key(), object.key());
  other.url = "http://host/a?signature=1";
  EXPECT_EQ(other.key(), object.key());
}

}  // namespace
}  // namespace planetree::storage
