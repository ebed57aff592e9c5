#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <vector>

#include "octree/builder/tree/page_encoder.h"
#include "octree/builder/tree/split_links.h"
#include "octree/page/mask_streams.h"
#include "octree/page/page_streams.h"
#include "planetree/error.h"
#include "storage/spill/spill_file.h"

namespace planetree::octree {

/// A page of a patch or a region, put away until all pages have their numbers.
struct SpilledPage {
  std::uint64_t octcode = 0;
  std::uint64_t offset = 0;  ///< of its raw bytes in the SpillFile
  std::uint32_t raw_bytes = 0;
  std::uint32_t links_at = 0;    ///< of its links to other pages, shuffled, in the raw bytes
  std::uint32_t link_count = 0;  ///< they name pages by their places among those put away
};

inline Result<SpilledPage> put_away(std::uint64_t octcode, const EncodedPage& page,
                                    storage::SpillFile& file) {
  const auto offset = file.append(page.bytes);
  if (!offset) return offset.error();
  return SpilledPage{octcode, *offset, static_cast<std::uint32_t>(page.bytes.size()), page.links_at,
                     page.link_count};
}

/// Gets its raw bytes back, its number and every link to another page replaced.
///
/// number  in the file.
/// link    what link(l) says a link among those put away is in the file.
template <class Link>
Result<std::vector<std::byte>> get_back(const SpilledPage& page, const storage::SpillFile& file,
                                        std::uint32_t number, const Link& link) {
  std::vector<std::byte> raw(page.raw_bytes);
  if (const auto read = file.read(page.offset, raw); !read) return read.error();
  static_assert(offsetof(PageHead, page_number) == 0 && offsetof(MaskPageHead, page_number) == 0);
  std::memcpy(raw.data(), &number, sizeof number);
  replace_links(raw.data() + page.links_at, page.link_count, link);
  return raw;
}

}  // namespace planetree::octree
