#include "storage/system/device_space.h"

#include <gtest/gtest.h>

#include "tests/storage/system/faulty_calls.h"
#include "tests/storage/system/temporary_directory.h"

namespace planetree::storage {
namespace {

TEST(DeviceSpace, CountsBlocksAvailableToUnprivilegedUsers) {
  const TemporaryDirectory directory;
  FaultyCalls calls;
  calls.device = device_with_free(50, 4096);
  EXPECT_EQ(DeviceSpace::of(directory / ".", calls).free_bytes, 50u * 4096);
  calls.device = device_with_free(~std::uint64_t{0} / 4096 + 1, 4096);
  EXPECT_EQ(DeviceSpace::of(directory / ".", calls).free_bytes, ~std::uint64_t{0});
  calls.device = device_with_free(0);
  EXPECT_EQ(DeviceSpace::of(directory / ".", calls).free_bytes, 0u);
}

TEST(DeviceSpace, AgreesWithStatvfs) {
  struct statvfs device = {};
  const TemporaryDirectory directory;
  ASSERT_EQ(::statvfs((directory / ".").c_str(), &device), 0);
  const auto space = DeviceSpace::of(directory / ".");
  ASSERT_TRUE(space.free_bytes);
  // Other processes write to the device meanwhile.
  EXPECT_LE(*space.free_bytes, std::uint64_t{device.f_blocks} * device.f_frsize);
  EXPECT_TRUE(DeviceSpace::of({}).free_bytes) << "of the working directory";
}

TEST(DeviceSpace, IsUnknownWhereStatvfsReportsNone) {
  const TemporaryDirectory directory;
  EXPECT_FALSE(DeviceSpace::of(directory / "none").free_bytes);
  FaultyCalls calls;
  calls.device = device_with_free(0);
  calls.device->f_blocks = 0;
  EXPECT_FALSE(DeviceSpace::of(directory / ".", calls).free_bytes);
}

TEST(DeviceSpace, RecognisesTheSameDevice) {
  const TemporaryDirectory one, other;
  const auto here = DeviceSpace::of(one / ".");
  EXPECT_TRUE(here.is_same_device(DeviceSpace::of(other / ".")));
  EXPECT_FALSE(here.is_same_device(DeviceSpace::of("/proc")));
  const auto nowhere = DeviceSpace::of(one / "none");
  EXPECT_FALSE(nowhere.is_same_device(nowhere));
}

}  // namespace
}  // namespace planetree::storage
