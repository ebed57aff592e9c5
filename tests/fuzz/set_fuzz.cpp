#include <cmath>
#include <cstdint>
#include <span>
#include <string_view>

#include "storage/set/member_address.h"
#include "storage/set/set_description.h"
#include "tests/fuzz/expectation.h"

/// Reads arbitrary bytes as a set file. What is accepted is written and read again, and leads from
/// a server to that server only.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  using namespace planetree;
  using namespace planetree::storage;
  const auto set = SetDescription::parse(std::as_bytes(std::span(bytes, size)));
  if (!set) {
    const std::string_view text = set.error().text;
    expect(!text.empty() && text.find('\n') == std::string_view::npos);
    return 0;
  }
  expect(!set->members.empty() && set->members.size() <= SetDescription::kMaxMembers);
  for (const SetMember& member : set->members) {
    expect(member.bytes > 0 && !member.address.empty());
    for (std::size_t axis = 0; member.box && axis < 3; ++axis)
      expect(std::isfinite(member.box->lower[axis]) && std::isfinite(member.box->upper[axis]));
    const auto path = member_path("http://host/folder/a.ptreeset", member.address);
    if (!path) continue;
    const std::string_view url = path->native();
    expect(url.starts_with("http") && url.find("://") != std::string_view::npos);
  }
  const std::string text = set->text();
  const auto again = SetDescription::parse(std::as_bytes(std::span(text)));
  expect(static_cast<bool>(again) && again->text() == text && again->bytes() == set->bytes());
  return 0;
}
