#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "octree/builder/mesh/ply_header.h"
#include "octree/builder/mesh/stream/mesh_file.h"
#include "octree/builder/mesh/stream/mesh_window.h"
#include "octree/builder/mesh/stream/scalar_type.h"
#include "planetree/error.h"

namespace planetree::octree {

/// Walks over the records of a binary PLY body, whose lists give them different lengths.
class PlyRecords {
 public:
  /// file  must outlive this.
  PlyRecords(const MeshFile& file, bool swap, std::size_t window_bytes)
      : file_(file), swap_(swap), window_(file, window_bytes) {}

  [[nodiscard]] bool swap() const { return swap_; }
  /// The bytes of the file. Records that were walked over lately are in it.
  [[nodiscard]] MeshWindow& window() { return window_; }

  /// Refuses a count of records that do not fit in the file behind `begin`.
  [[nodiscard]] Result<void> check_space(const PlyElement& element, std::uint64_t begin) const;

  /// Steps over the record of `element` at `position`. Calls visit(i, offset, count) for each of
  /// its properties, with the offset of the value or of the first item, and the number of items.
  /// errors  kBadInput: the record reaches past the end of the file or has a list of negative
  ///         length. Those of reading the file.
  template <class Visit>
  Result<void> walk(const PlyElement& element, std::uint64_t record, std::uint64_t& position,
                    const Visit& visit) {
    const std::uint64_t begin = position;
    if (window_.record_at(begin) == nullptr) return window_.failure();
    for (std::size_t i = 0; i < element.properties.size(); ++i) {
      const PlyProperty& property = element.properties[i];
      std::uint64_t count = 1;
      if (property.is_list && !take_count(property, position, count))
        return bad_record(element, record, begin);
      const std::uint64_t left = file_.size_bytes() - position;
      const std::uint64_t bytes = std::min(count, left) * size_bytes(property.type);
      if (count > left || bytes > left) return bad_record(element, record, begin);
      visit(i, position, count);
      position += bytes;
    }
    return {};
  }

 private:
  /// Reads the length of a list, and steps over it. False if there is none.
  bool take_count(const PlyProperty& property, std::uint64_t& position, std::uint64_t& count);
  /// The error of a bad record, or of the file if that could not be read.
  [[nodiscard]] Error bad_record(const PlyElement& element, std::uint64_t record,
                                 std::uint64_t offset) const;

  const MeshFile& file_;
  const bool swap_;
  MeshWindow window_;
  bool read_failed_ = false;  ///< a length could not be read, so that its record may not be bad
};

}  // namespace planetree::octree
