#include "tests/storage/file/page_file_refusal.h"

#include <cstdint>
#include <iterator>

/// Headers whose region or core is not one of the model.
namespace planetree::storage {
namespace {

TEST_F(PageFileRefusal, RefusesBadRegions) {
  const auto make_region = [](ModelRecord& m) {
    m.input_triangles = m.triangle_count;
    for (int axis = 0; axis < 3; ++axis) {
      m.region_lower[axis] = m.box_lower[axis];
      m.region_upper[axis] = m.box_upper[axis];
    }
    m.region_winding = -3;
  };
  const auto expect_region_refused = [&](const auto& change, const char* said) {
    expect_changed_model_refused(make_region, change, said);
  };
  expect_model_accepted(make_region);
  for (int axis = 0; axis < 3; ++axis) {
    for (const double value : {kNan, kInfinity, -kInfinity}) {
      expect_region_refused([&](ModelRecord& m) { m.region_lower[axis] = value; }, "region");
      expect_region_refused([&](ModelRecord& m) { m.region_upper[axis] = value; }, "region");
    }
    expect_region_refused(
        [&](ModelRecord& m) {
          m.region_lower[axis] = 0.5;
          m.region_upper[axis] = 0.25;
        },
        "region");
    for (const double beside : {-9.0, 9.0}) {
      expect_region_refused(
          [&](ModelRecord& m) { m.region_lower[axis] = m.region_upper[axis] = beside; }, "region");
    }
    expect_model_refused([&](ModelRecord& m) { m.region_lower[axis] = 1; }, "region");
    expect_model_refused([&](ModelRecord& m) { m.region_upper[axis] = -0.0; }, "region");
  }
  expect_region_refused([](ModelRecord& m) { m.input_triangles = m.triangle_count - 1; },
                        "more triangles than the input");
  expect_region_refused([](ModelRecord& m) { m.input_triangles = 0; }, "region");
  for (const std::int64_t winding : {std::int64_t{13}, std::int64_t{-13}, INT64_MAX, INT64_MIN}) {
    expect_region_refused([&](ModelRecord& m) { m.region_winding = winding; }, "winding number");
  }
  expect_region_refused(
      [](ModelRecord& m) {
        m.input_triangles = ~std::uint64_t{0};
        m.region_winding = INT64_MIN;
      },
      "winding number");
  expect_model_refused([](ModelRecord& m) { m.region_winding = 1; }, "region");
}

TEST_F(PageFileRefusal, RefusesBadCores) {
  const auto make_core = [](ModelRecord& m) {
    m.stray_count = 1;
    m.stray_edge = 0x1p10;
    for (int axis = 0; axis < 3; ++axis) m.core_upper[axis] = 0;
  };
  const auto expect_core_refused = [&](const auto& change, const char* said) {
    expect_changed_model_refused(make_core, change, said);
  };
  expect_model_accepted(make_core);
  for (int axis = 0; axis < 3; ++axis) {
    for (const double value : {kNan, kInfinity, -kInfinity, -9.0, 9.0}) {
      expect_core_refused([&](ModelRecord& m) { m.core_lower[axis] = value; }, "core");
      expect_core_refused([&](ModelRecord& m) { m.core_upper[axis] = value; }, "core");
    }
    // Without strays, the core is the box.
    expect_model_refused([&](ModelRecord& m) { m.core_lower[axis] = 0; }, "core");
    expect_model_refused([&](ModelRecord& m) { m.core_upper[axis] = 0; }, "core");
  }
  for (const std::uint64_t count : {std::uint64_t{20}, ~std::uint64_t{0}})
    expect_core_refused([&](ModelRecord& m) { m.stray_count = count; }, "strays");
  for (const double edge : {kNan, kInfinity, -1.0, 0x1.8p60})
    expect_core_refused([&](ModelRecord& m) { m.stray_edge = edge; }, "edge of strays");
  expect_model_refused([](ModelRecord& m) { m.stray_edge = 1; }, "edge of strays");
}

}  // namespace
}  // namespace planetree::storage
