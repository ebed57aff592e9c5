#include "storage/file/metadata.h"

#include <algorithm>
#include <string_view>

namespace planetree::storage {
namespace {

constexpr std::size_t kMaxKeyBytes = 64;
constexpr std::size_t kMaxBytes = 65536;
constexpr std::string_view kSeparator = ": ";

bool is_key(std::string_view key) {
  return !key.empty() && key.size() <= kMaxKeyBytes && std::ranges::all_of(key, [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_';
  });
}

// Length of the UTF-8 sequence at the start of the text, or 0 if it is none. Long forms, surrogates
// and numbers above U+10FFFF are none.
std::size_t sequence_length(std::string_view text) {
  const auto byte = [text](std::size_t at) {
    return at < text.size() ? static_cast<unsigned char>(text[at]) : 0U;
  };
  const auto follows = [&byte](std::size_t at) { return (byte(at) & 0xc0) == 0x80; };
  const unsigned first = byte(0);
  if (first < 0x80) return 1;
  if (first >= 0xc2 && first < 0xe0) return follows(1) ? 2 : 0;
  if (first >= 0xe0 && first < 0xf0) {
    const bool is_long = first == 0xe0 && byte(1) < 0xa0;
    const bool is_surrogate = first == 0xed && byte(1) >= 0xa0;
    return follows(1) && follows(2) && !is_long && !is_surrogate ? 3 : 0;
  }
  if (first < 0xf0 || first > 0xf4) return 0;
  const bool is_long = first == 0xf0 && byte(1) < 0x90;
  const bool is_above = first == 0xf4 && byte(1) >= 0x90;
  return follows(1) && follows(2) && follows(3) && !is_long && !is_above ? 4 : 0;
}

bool is_value(std::string_view value) {
  if (value.empty()) return false;
  while (!value.empty()) {
    const std::size_t length = sequence_length(value);
    const auto first = static_cast<unsigned char>(value.front());
    if (length == 0 || first < 32 || first == 127) return false;
    value.remove_prefix(length);
  }
  return true;
}

std::size_t line_bytes(const Metadata::value_type& entry) {
  return entry.first.size() + kSeparator.size() + entry.second.size() + 1;
}

Error damaged_metadata(const char* cause) {
  return make_error(ErrorCode::kDamaged, Error::kNowhere, Error::kNowhere,
                    "the metadata cannot be read: %s; build the file again", cause);
}

}  // namespace

Result<void> check_metadata(const Metadata& metadata) {
  std::size_t bytes = 0;
  for (const auto& entry : metadata) {
    if (!is_key(entry.first))
      return make_error(ErrorCode::kBadArgument, Error::kNowhere, Error::kNowhere,
                        "a key of the metadata is not one; give 1 to 64 of a to z, 0 to 9 and _");
    if (!is_value(entry.second))
      return make_error(ErrorCode::kBadArgument, Error::kNowhere, Error::kNowhere,
                        "the metadata %s is not a line of UTF-8 text; give one without control "
                        "characters",
                        entry.first.c_str());
    bytes += line_bytes(entry);
  }
  if (bytes <= kMaxBytes) return {};
  return make_error(ErrorCode::kBadArgument, Error::kNowhere, Error::kNowhere,
                    "the metadata has %zu bytes; give at most %zu", bytes, kMaxBytes);
}

std::vector<Extension> extensions_of(const Metadata& metadata) {
  if (metadata.empty()) return {};
  std::string lines;
  for (const auto& [key, value] : metadata)
    lines.append(key).append(kSeparator).append(value).append(1, '\n');
  Extension extension;
  extension.name = kMetadataName;
  const auto bytes = std::as_bytes(std::span(lines));
  extension.bytes.assign(bytes.begin(), bytes.end());
  return {extension};
}

Result<Metadata> read_metadata(const PageFile& file) {
  for (const ExtensionRecord& record : file.extensions()) {
    if (name_of(record) != kMetadataName) continue;
    if (record.bytes > kMaxBytes) return damaged_metadata("it is too long");
    const auto bytes = file.read_extension(record);
    return bytes ? parse_metadata(*bytes) : bytes.error();
  }
  return Metadata{};
}

Result<Metadata> parse_metadata(std::span<const std::byte> bytes) {
  std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  if (text.size() > kMaxBytes) return damaged_metadata("it is too long");
  Metadata metadata;
  while (!text.empty()) {
    const std::size_t end = text.find('\n');
    if (end == std::string_view::npos) return damaged_metadata("its last line has no end");
    const std::string_view line = text.substr(0, end);
    const std::size_t colon = std::min(line.find(kSeparator), line.size());
    const std::string_view key = line.substr(0, colon);
    const std::string_view value = line.substr(std::min(colon + kSeparator.size(), line.size()));
    if (!is_key(key)) return damaged_metadata("a key has other letters than a to z, 0 to 9 and _");
    if (!is_value(value)) return damaged_metadata("a value is not a line of UTF-8 text");
    if (!metadata.empty() && !(metadata.rbegin()->first < key))
      return damaged_metadata("its keys do not ascend");
    metadata.emplace_hint(metadata.end(), key, value);
    text.remove_prefix(end + 1);
  }
  return metadata;
}

}  // namespace planetree::storage
