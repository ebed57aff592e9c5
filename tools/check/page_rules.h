#pragma once

#include <cstdint>

#include "octree/page/page_streams.h"
#include "tools/check/frame_view.h"

namespace planetree::tools {

/// Checks the rules for a distance page or a cap page that decoding leaves out, because no answer
/// depends on them: sections 4.3, 5.2, 5.7 and 6.2 of the specification. Returns what is wrong, or
/// null.
///
/// streams, frame  those of one page, which has been decoded
/// ordinal         rank of the page among those of its kind that have its octcode
const char* fault_of_rules(const octree::RawStreams& streams, const FrameView& frame,
                           std::uint32_t ordinal);

}  // namespace planetree::tools
