#include "storage/file/extension.h"

#include <algorithm>
#include <cstring>

#include "storage/file/checksum.h"
#include "storage/file/directory_shape.h"
#include "storage/file/header_faults.h"

namespace planetree::storage {
namespace {

constexpr std::size_t kMaxNameBytes = sizeof ExtensionRecord::name;

bool is_name_letter(char letter) noexcept {
  return (letter >= 'a' && letter <= 'z') || (letter >= '0' && letter <= '9') || letter == '.' ||
         letter == '-' || letter == '_';
}

Error bad_record(std::size_t index, const char* cause) noexcept {
  return damaged(Error::kNowhere, kHeaderBytes + index * sizeof(ExtensionRecord), cause);
}

const char* fault_of_record(const ExtensionRecord& record) noexcept {
  const std::string_view name = name_of(record);
  const std::string_view rest(record.name + name.size(), kMaxNameBytes - name.size());
  if (!is_extension_name(name) || rest.find_first_not_of('\0') != rest.npos)
    return "the name of an extension has other bytes than letters, digits, '.', '-' and '_'";
  if (record.required > 1 || !all_zero(record.reserved))
    return "the reserved bytes of an extension are not zero";
  if (record.required == 1 && name == kMetadataName) return "the metadata are marked as required";
  return nullptr;
}

Error unknown_extension(const ExtensionRecord& record) noexcept {
  const std::string_view name = name_of(record);
  return make_error(ErrorCode::kUnsupported, Error::kNowhere, kHeaderBytes,
                    "the file needs the extension '%.*s' that this program does not know; update "
                    "planetree or build the file again",
                    static_cast<int>(name.size()), name.data());
}

}  // namespace

std::string_view name_of(const ExtensionRecord& record) noexcept {
  const char* const end = std::find(record.name, record.name + kMaxNameBytes, '\0');
  return {record.name, static_cast<std::size_t>(end - record.name)};
}

bool is_extension_name(std::string_view name) noexcept {
  return !name.empty() && name.size() <= kMaxNameBytes &&
         std::all_of(name.begin(), name.end(), is_name_letter);
}

ExtensionRecord record_of(const Extension& extension, std::uint64_t offset) noexcept {
  ExtensionRecord record{};
  std::memcpy(record.name, extension.name.data(), std::min(extension.name.size(), kMaxNameBytes));
  record.offset = offset;
  record.bytes = extension.bytes.size();
  record.check = hash64(extension.bytes);
  record.required = extension.required ? 1 : 0;
  return record;
}

Result<void> check_extensions(const FileHeader& header,
                              std::span<const ExtensionRecord> records) noexcept {
  if (records.size() != header.extension_count ||
      hash64(std::as_bytes(records)) != header.extensions_hash)
    return bad_record(0, "the hash of the extension records is wrong");
  const std::uint64_t end = header.file_bytes - kHeaderBytes;
  std::uint64_t offset = pages_end(header);
  for (std::size_t i = 0; i < records.size(); ++i) {
    const ExtensionRecord& record = records[i];
    if (const char* cause = fault_of_record(record)) return bad_record(i, cause);
    if (i > 0 && name_of(records[i - 1]) >= name_of(record))
      return bad_record(i, "the extensions are not in the order of their names");
    if (record.offset != offset || record.bytes > end - offset)
      return bad_record(i, "an extension does not start where the bytes before it end");
    offset += record.bytes;
  }
  if (offset != end)
    return bad_record(0, "the pages and extensions do not end where the header's copy starts");
  for (const ExtensionRecord& record : records)
    if (record.required == 1) return unknown_extension(record);
  return {};
}

}  // namespace planetree::storage
