#include "tools/tune/lookup_export.h"

#include <fmt/format.h>

#include <iterator>
#include <string>
#include <unordered_map>

#include "tools/tune/trace_analysis.h"

namespace planetree::tools {
namespace {

constexpr std::size_t kPieceBytes = std::size_t{1} << 20;

void append_little_endian(std::uint64_t value, int bytes, std::string& text) {
  for (int i = 0; i < bytes; ++i) text += static_cast<char>(value >> 8 * i & 0xff);
}

}  // namespace

void LookupExport::add(const PageAccess& access) {
  if (!is_counted_lookup(access) || access.page == References::kRootPage) return;
  lookups_.push_back({static_cast<std::uint32_t>(access.time_ns / 1'000'000'000),
                      static_cast<std::uint32_t>(access.time_ns / 1000 % 1'000'000), access.page});
}

Result<void> LookupExport::write(
    Format format, std::uint64_t page_bytes,
    const std::function<Result<void>(std::span<const std::byte>)>& sink) const {
  std::vector<std::int64_t> next(lookups_.size());
  std::unordered_map<std::uint32_t, std::int64_t> next_of;
  for (std::size_t i = lookups_.size(); i-- > 0;) {
    const auto [found, is_last] = next_of.try_emplace(lookups_[i].page, -1);
    next[i] = found->second;
    found->second = static_cast<std::int64_t>(i);
  }
  std::string piece = format == Format::kCsv ? "time_s,page,bytes\n" : "";
  for (std::size_t i = 0; i < lookups_.size(); ++i) {
    const Lookup& lookup = lookups_[i];
    if (format == Format::kCsv) {
      fmt::format_to(std::back_inserter(piece), "{}.{:06},{},{}\n", lookup.seconds,
                     lookup.microseconds, lookup.page, page_bytes);
    } else {
      append_little_endian(lookup.seconds, 4, piece);
      append_little_endian(lookup.page, 8, piece);
      append_little_endian(page_bytes, 4, piece);
      append_little_endian(static_cast<std::uint64_t>(next[i]), 8, piece);
    }
    if (piece.size() < kPieceBytes && i + 1 < lookups_.size()) continue;
    if (const auto written = sink(std::as_bytes(std::span(piece))); !written) return written;
    piece.clear();
  }
  if (piece.empty()) return {};
  return sink(std::as_bytes(std::span(piece)));
}

}  // namespace planetree::tools
