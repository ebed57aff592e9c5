#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "storage/file/page_file.h"

namespace planetree::query {

/// Finds pages that a page with few nodes leads to, without reading it: those of the cells within
/// its cell, coarse cells first. Such a page has nothing but links to them, so whoever needs it
/// needs one of them next. Each kind of page is in the order of its octcodes (format-spec/v1, 4.3),
/// which the directory tells.
///
/// page     of any kind; nothing is found if it is no distance page, has more than a few nodes, or
///          if parts of the directory are not in memory
/// found    receives the pages, as far as there is room and their stored bytes stay below a limit
/// returns  how many were found
std::size_t find_pages_below(const storage::PageFile& file, std::uint32_t page,
                             std::span<std::uint32_t> found) noexcept;

}  // namespace planetree::query
