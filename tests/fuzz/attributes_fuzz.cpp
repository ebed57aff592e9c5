#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <span>
#include <vector>

#include "octree/attributes/attribute_page.h"
#include "octree/page/frame.h"

/// Decodes arbitrary bytes as an attribute page and reads every triangle. Input by offset:
///
///   0  kinds of attributes beside links, in the low 3 bits; number of triangles in the others
///   1  the page
///
/// The page number and key are set to the expected ones, because few inputs would pass that
/// comparison.
namespace planetree::octree {
namespace {

constexpr std::uint32_t kPage = 7, kTreePages = 3, kPageBytes = 4096;

void read_all(const std::byte* frame, AttributeShape shape) {
  const AttributeView view(frame, shape);
  const LinkFormat links = LinkFormat::numbered(kPageBytes);
  std::uint64_t sum = 0;
  for (std::uint32_t i = 0; i < view.count(); ++i) {
    const std::uint32_t link = view.link(i);
    if (link != kNoLink && (!LinkFormat::is_leaf(link) || links.page(link) >= kTreePages ||
                            links.record(link) >= max_page_blocks(kPageBytes)))
      std::abort();
    if (shape.has_colors()) sum += view.colors(i)[2].alpha;
    if (shape.has_uvs()) sum += view.uvs(i)[2].v < 0 ? 1 : 0;
    if (shape.has_values()) sum += view.value(i);
  }
  [[maybe_unused]] volatile std::uint64_t used = sum;
}

void run(std::span<const std::byte> bytes) {
  if (bytes.size() < 1 + sizeof(AttributePageHead)) return;
  const auto choice = static_cast<std::uint32_t>(bytes[0]);
  const AttributeShape shape{kKeepTriangles | (choice & 7) << 1};
  const std::uint32_t count = 1 + choice / 8 * 2;
  if (count > shape.triangles_per_page(kPageBytes)) std::abort();
  std::vector<std::byte> raw(bytes.begin() + 1, bytes.end());
  AttributePageHead head;
  std::memcpy(&head, raw.data(), sizeof head);
  head.page_number = kPage;
  head.ordinal = 2;
  head.octcode = 0;
  std::memcpy(raw.data(), &head, sizeof head);
  PageInfo info;
  info.page_bytes = kPageBytes;
  info.page_number = kPage;
  info.first_page = kPage - 2;
  info.page_count = 4;
  info.tree_pages = kTreePages;
  std::vector<std::byte> frame(kPageBytes);
  if (decode_attribute_page(raw, info, shape, count, frame)) read_all(frame.data(), shape);
}

}  // namespace
}  // namespace planetree::octree

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  planetree::octree::run({reinterpret_cast<const std::byte*>(data), size});
  return 0;
}
