#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <vector>

#include "octree/builder/tree/page_encoder.h"
#include "octree/builder/tree/split_pages.h"
#include "octree/page/mask_streams.h"
#include "octree/page/page_streams.h"
#include "planetree/error.h"
#include "storage/spill/spill_file.h"

namespace planetree::octree {

/// A page of a chunk or of a sector, spilled until all pages have their numbers. Its links to other
/// pages name them by their indices in the chunk or sector.
struct SpilledPage {
  std::uint64_t octcode = 0;
  std::uint64_t offset = 0;  ///< offset of its raw bytes in the SpillFile
  std::uint32_t raw_bytes = 0;
  std::uint32_t links_at = 0;    ///< offset in them of the linked pages' numbers, byte-split
  std::uint32_t link_count = 0;  ///< number of those links
};

inline Result<SpilledPage> spill_page(std::uint64_t octcode, const EncodedPage& page,
                                      storage::SpillFile& file) {
  const auto offset = file.append(page.bytes);
  if (!offset) return offset.error();
  return SpilledPage{octcode, *offset, static_cast<std::uint32_t>(page.bytes.size()), page.links_at,
                     page.link_count};
}

/// Reads the raw bytes back, and replaces the page number and those of linked pages.
///
/// number     page number in the file.
/// number_of  number_of(p) is what links call the page that spilled links call p.
template <class NumberOf>
Result<std::vector<std::byte>> read_spilled_page(const SpilledPage& page,
                                                 const storage::SpillFile& file,
                                                 std::uint32_t number, const NumberOf& number_of) {
  std::vector<std::byte> raw(page.raw_bytes);
  if (const auto read = file.read(page.offset, raw); !read) return read.error();
  static_assert(offsetof(PageHead, page_number) == 0 && offsetof(MaskPageHead, page_number) == 0);
  std::memcpy(raw.data(), &number, sizeof number);
  replace_pages(raw.data() + page.links_at, page.link_count, number_of);
  return raw;
}

}  // namespace planetree::octree
