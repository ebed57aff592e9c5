#include "storage/file/header_choice.h"

#include <algorithm>
#include <cinttypes>
#include <cstdio>
#include <cstring>
#include <string_view>

#include "storage/file/checksum.h"
#include "storage/file/header_faults.h"

namespace planetree::storage {
namespace {

struct KnownStart {
  std::string_view bytes;
  const char* what;
};

constexpr KnownStart kKnownStarts[] = {
    {"ply\n", "a PLY mesh: build a .ptree file from it first"},
    {"ply\r", "a PLY mesh: build a .ptree file from it first"},
    {"OFF", "an OFF mesh: build a .ptree file from it first"},
    {"solid", "an STL mesh: build a .ptree file from it first"},
    {"\x1f\x8b", "a gzip archive: unpack it first"},
    {"\x28\xb5\x2f\xfd", "a Zstandard archive: unpack it first"},
    {"PK\x03\x04", "a zip archive: unpack it first"},
};

bool is_whole(std::span<const std::byte> bytes, FileHeader& header) noexcept {
  if (bytes.size() != kHeaderBytes) return false;
  std::memcpy(&header, bytes.data(), kHeaderBytes);
  return std::memcmp(header.magic, kMagic, sizeof kMagic) == 0 &&
         header.header_hash == header_hash(header);
}

std::string_view as_text(std::span<const std::byte> bytes) noexcept {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

Error not_planetree(const char* what) noexcept {
  return make_error(ErrorCode::kNotPlanetree, Error::kNowhere, 0,
                    "this is not a .ptree file but %s", what);
}

Error explain_foreign(std::span<const std::byte> leading) noexcept {
  const std::string_view text = as_text(leading);
  // A transfer in text mode changes the first and last bytes of the magic, but not the letters.
  if (text.substr(0, 10).find("PTREE") != std::string_view::npos) {
    return make_error(ErrorCode::kDamaged, Error::kNowhere, 0,
                      "the file's first bytes are damaged, as by a transfer in text mode; "
                      "transfer it again in binary or build it again");
  }
  for (const KnownStart& known : kKnownStarts) {
    if (text.starts_with(known.bytes)) return not_planetree(known.what);
  }
  char what[64] = "one that starts with";
  std::size_t length = std::strlen(what);
  for (const std::byte byte : leading.first(std::min<std::size_t>(leading.size(), 8))) {
    std::snprintf(what + length, sizeof what - length, " %02x", static_cast<unsigned>(byte));
    length += 3;
  }
  return not_planetree(what);
}

// Explains as far as possible why neither header is usable.
Error explain(std::span<const std::byte> leading, std::uint64_t actual_bytes) noexcept {
  if (leading.empty()) return not_planetree("an empty one: build it again");
  const std::size_t known_bytes = std::min(leading.size(), sizeof kMagic);
  if (std::memcmp(leading.data(), kMagic, known_bytes) != 0) return explain_foreign(leading);
  if (leading.size() < kHeaderBytes) {
    return make_error(ErrorCode::kTruncated, Error::kNowhere, actual_bytes,
                      "the file should have at least %zu bytes and has %" PRIu64
                      "; restore it from a copy or build it again",
                      2 * kHeaderBytes, actual_bytes);
  }
  std::uint16_t version;
  std::memcpy(&version, leading.data() + offsetof(FileHeader, version), sizeof version);
  // Another version may have another header layout, so the version is reported without a check of
  // the hash.
  if (!is_known_version(version)) return unknown_version(version);
  return make_error(ErrorCode::kDamaged, Error::kNowhere, 0,
                    "neither of the file's two headers has the right checksum; restore it from a "
                    "copy or build it again");
}

}  // namespace

Result<HeaderChoice> choose_header(std::span<const std::byte> leading,
                                   std::span<const std::byte> trailing,
                                   std::uint64_t actual_bytes) noexcept {
  FileHeader first;
  FileHeader last;
  const bool first_whole = is_whole(leading, first);
  const bool last_whole = is_whole(trailing, last);
  if (first_whole) {
    const bool same = last_whole && std::memcmp(&first, &last, sizeof first) == 0;
    return HeaderChoice{first, !same};
  }
  if (last_whole) return HeaderChoice{last, true};
  return explain(leading, actual_bytes);
}

}  // namespace planetree::storage
