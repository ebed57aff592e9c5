#include "query/file/scene_frames.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <utility>

namespace planetree::query {
namespace {

TEST(SceneFrames, TakeRawPagesThatAreLongerByUpToAHalf) {
  storage::FileHeader header{};
  header.page_bytes = 65536;
  for (const auto& [raw_bytes, frame_bytes] : {std::pair<std::uint32_t, std::uint32_t>{1, 65536},
                                               {65537, 65536},
                                               {98304, 65536},
                                               {98305, 131072},
                                               {1048576, 1048576}}) {
    header.max_raw_bytes = raw_bytes;
    EXPECT_EQ(frame_bytes_for(header), frame_bytes) << raw_bytes;
  }
}

}  // namespace
}  // namespace planetree::query
