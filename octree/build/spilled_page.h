#pragma once

#include <cstdint>

#include "octree/build/page_encoder.h"
#include "planetree/error.h"
#include "storage/spill_file.h"

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

}  // namespace planetree::octree
