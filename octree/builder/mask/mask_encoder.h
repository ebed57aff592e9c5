#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "octree/builder/mask/mask_plan.h"
#include "octree/builder/mask/mask_tree.h"
#include "octree/builder/tree/page_encoder.h"

namespace planetree::octree {

/// Makes the raw bytes of mask pages, as octree/page/page_decoder.h reads them. Any number of
/// threads; the bytes depend on the arguments alone.
class MaskEncoder {
 public:
  /// first_page  number of the mask's first page in the file.
  /// float64     planes are stored in the same type as vertices.
  MaskEncoder(const MaskTree& mask, const MaskPlan& plan, std::uint32_t first_page, bool float64)
      : mask_(mask), plan_(plan), first_page_(first_page), float64_(float64) {}

  /// page  index in the plan.
  EncodedPage encode(std::size_t page) const;

 private:
  const MaskTree& mask_;
  const MaskPlan& plan_;
  std::uint32_t first_page_;
  bool float64_;
};

}  // namespace planetree::octree
