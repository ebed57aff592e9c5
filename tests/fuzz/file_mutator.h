#pragma once

#include <cstddef>

#include "tests/fuzz/forged_file.h"
#include "tests/fuzz/mutation.h"
#include "tests/fuzz/stream_page.h"

namespace planetree::storage {

/// Changes what a file says: fields of the header, keys of pages, counts, links and values of
/// pages. Lengths and hashes are right afterwards, except for one file in some, which lies about
/// them.
class FileMutator {
 public:
  explicit FileMutator(unsigned seed) : choices_(seed) {}

  /// One to four changes, and the file put together.
  Bytes mutate(ForgedFile file);
  /// Takes some pages of `other`, and its model record in one case of some.
  Bytes cross(ForgedFile file, const ForgedFile& other);

 private:
  void change(ForgedFile& file);
  void change_header(FileHeader& header);
  void change_pages(ForgedFile& file);
  void change_key(ForgedPage& page);
  void change_content(ForgedFile& file, std::size_t page);
  void change_streams(const ForgedFile& file, octree::StreamPage& page);
  void change_link(const ForgedFile& file, std::span<std::byte> page, std::span<std::byte> record);
  void number_pages(ForgedFile& file);
  Bytes seal(const ForgedFile& file);

  Choices choices_;
};

}  // namespace planetree::storage
