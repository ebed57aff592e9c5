#include "tests/storage/file/page_file_refusal.h"

namespace planetree::storage {
namespace {

class PageFileAttributes : public PageFileRefusal {};

TEST_F(PageFileAttributes, AreRefusedIfTheyAreBad) {
  expect_model_refused([](ModelRecord& m) { m.attributes = kAttributeLinks; }, "attribute pages");
  expect_model_refused([](ModelRecord& m) { m.attribute_page_count = 1; }, "attribute pages");
  expect_model_refused([](ModelRecord& m) { m.attribute_page_count = ~0u; }, "no page of the tree");
  expect_model_refused([](ModelRecord& m) { m.attributes = kAttributeColors; }, "unknown");
  expect_model_refused([](ModelRecord& m) { m.attributes = 0x11; }, "unknown");
  expect_model_refused([](ModelRecord& m) { m.value_kind = ValueKind::kReal; }, "kind of values");
  expect_model_refused(
      [](ModelRecord& m) {
        m.attributes = kAttributeLinks | kAttributeValues;
        m.value_kind = static_cast<ValueKind>(3);
      },
      "kind of values");
  expect_model_refused([](ModelRecord& m) { m.attribute_reserved[1] = 1; }, "reserved");
}

}  // namespace
}  // namespace planetree::storage
