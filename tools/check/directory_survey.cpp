#include "tools/check/directory_survey.h"

namespace planetree::tools {

Result<void> DirectorySurvey::run() {
  entries.reserve(header_.page_count);
  return visit(storage::DirectoryPlace::root(header_), true);
}

// `is_certain`: the blocks above are sound.
Result<void> DirectorySurvey::visit(const storage::DirectoryPlace& place, bool is_certain) {
  const std::size_t count = shape_.block_entries(place.level, place.block);
  std::vector<std::byte> block(count * storage::kDirectoryEntryBytes);
  const std::uint64_t offset =
      storage::directory_block_start(header_, shape_, place.level, place.block);
  if (const auto read = file_.read_at(offset, block); !read) return read;
  const bool was_certain = is_certain;
  if (is_certain) {
    const auto checked = storage::check_directory_block(header_, shape_, place, block);
    if (!checked) issues.push_back(Issue::from(IssueCode::kDirectory, checked.error()));
    is_certain = static_cast<bool>(checked);
  }
  if (place.level == shape_.page_level()) {
    add_pages(place, block, was_certain);
    return {};
  }
  for (std::size_t i = 0; i < count; ++i)
    if (const auto done = visit(place_below(shape_, place, block, i), is_certain); !done)
      return done;
  return {};
}

void DirectorySurvey::add_pages(const storage::DirectoryPlace& place,
                                std::span<const std::byte> block, bool is_certain) {
  if (is_certain) end_ = place.start;
  for (std::size_t i = 0; i < block.size() / storage::kDirectoryEntryBytes; ++i) {
    const auto page = storage::directory_entry<storage::DirectoryPage>(block, i);
    entries.push_back(storage::page_entry(page, storage::pages_start(header_) + end_));
    end_ += page.stored_bytes;
  }
}

}  // namespace planetree::tools
