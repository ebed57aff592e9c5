#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "octree/builder/mesh/stream/mesh_text.h"

namespace planetree::octree {

/// "3 curves", or "1 curve".
inline std::string counted(std::uint64_t count, const std::string& noun,
                           const std::string& plural_end = "s") {
  return std::to_string(count) + ' ' + noun + (count == 1 ? "" : plural_end);
}

/// Counts one kind of thing that a reader passes over, or takes in another way than it is written,
/// and remembers the first.
class MeshNote {
 public:
  /// line  of the thing, from 1; 0 in a binary file.
  /// word  by which it can be recognised.
  void add(std::uint64_t line, std::string_view word = {}) {
    if (count_++ > 0) return;
    line_ = line;
    word_ = printable(word);
  }

  [[nodiscard]] std::uint64_t count() const { return count_; }
  [[nodiscard]] explicit operator bool() const { return count_ > 0; }

  [[nodiscard]] std::string counted(const std::string& noun) const {
    return octree::counted(count_, noun);
  }
  /// "the first 'surf' in line 12", or without the word where there is none.
  [[nodiscard]] std::string first() const {
    return "the first " + (word_.empty() ? std::string() : '\'' + word_ + "' ") + "in line " +
           std::to_string(line_);
  }

 private:
  std::uint64_t count_ = 0;
  std::uint64_t line_ = 0;
  std::string word_;
};

/// Counts records of one kind. A record is counted once, though the file may be read again from an
/// earlier record on.
class RecordNote {
 public:
  /// record  from 0; ascends until reading begins again.
  void add(std::uint64_t record) {
    if (record < next_) return;
    if (count_++ == 0) first_ = record;
    next_ = record + 1;
  }

  [[nodiscard]] std::uint64_t count() const { return count_; }
  [[nodiscard]] std::uint64_t first() const { return first_; }
  [[nodiscard]] explicit operator bool() const { return count_ > 0; }

 private:
  std::uint64_t count_ = 0, first_ = 0;
  std::uint64_t next_ = 0;  ///< the first record that was not read yet
};

}  // namespace planetree::octree
