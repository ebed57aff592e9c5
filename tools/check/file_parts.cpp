#include "tools/check/file_parts.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <utility>

#include "query/file/page_decoding.h"
#include "query/file/tree_header.h"
#include "storage/file/checksum.h"
#include "storage/file/directory_shape.h"
#include "storage/file/extension.h"
#include "storage/file/header_check.h"
#include "storage/file/header_choice.h"
#include "storage/file/header_faults.h"
#include "storage/file/metadata.h"
#include "storage/file/page_codec.h"
#include "storage/set/open_model.h"
#include "tools/check/directory_survey.h"

namespace planetree::tools {
namespace {

IssueCode header_issue(ErrorCode code, IssueCode otherwise) {
  switch (code) {
    case ErrorCode::kNotPlanetree:
      return IssueCode::kNotPlanetree;
    case ErrorCode::kUnsupported:
      return IssueCode::kFormatUnsupported;
    case ErrorCode::kTruncated:
      return IssueCode::kFileLength;
    default:
      return otherwise;
  }
}

Issue page_issue(IssueCode code, std::uint32_t page, std::uint64_t offset, const char* message) {
  return {code, page, offset, message};
}

/// Whether the header suffices to read pages, even if other fields are wrong.
bool can_serve(const storage::FileHeader& header, std::uint64_t actual_bytes) {
  return storage::is_known_version(header.version) &&
         (header.incompatible_features & ~storage::kKnownIncompatibleFeatures) == 0 &&
         std::has_single_bit(header.page_bytes) && header.page_bytes >= storage::kMinPageBytes &&
         header.page_bytes <= storage::kMaxPageBytes && actual_bytes >= storage::kHeaderBytes;
}

}  // namespace

Result<FileParts> FileParts::open(const std::filesystem::path& path, storage::FileCalls& calls,
                                  const storage::HttpOptions& http) {
  FileParts parts;
  parts.path_ = path;
  auto source = storage::open_model_source(path, {http, true}, calls);
  if (!source && source.error().code == ErrorCode::kNotPlanetree) {
    parts.issues_.push_back(Issue::from(IssueCode::kNotPlanetree, source.error()));
    return parts;
  }
  if (!source) return source.error();
  parts.file_ = std::move(*source);
  parts.actual_bytes_ = parts.file_->size_bytes();
  if (const auto loaded = parts.load(); !loaded) return loaded.error();
  return parts;
}

Result<void> FileParts::load() {
  std::byte leading[storage::kHeaderBytes];
  std::byte trailing[storage::kHeaderBytes];
  const auto first = std::span(leading).first(
      static_cast<std::size_t>(std::min<std::uint64_t>(actual_bytes_, storage::kHeaderBytes)));
  const auto last =
      std::span(trailing).first(actual_bytes_ >= 2 * sizeof leading ? sizeof trailing : 0);
  if (const auto read = read_at(0, first); !read) return read;
  if (const auto read = read_at(actual_bytes_ - last.size(), last); !read) return read;
  const auto choice = storage::choose_header(first, last, actual_bytes_);
  if (!choice) {
    const IssueCode code = header_issue(choice.error().code, IssueCode::kHeaderLost);
    issues_.push_back(Issue::from(code, choice.error()));
    return {};
  }
  header_ = choice->header;
  if (choice->copy_damaged)
    issues_.push_back({IssueCode::kHeaderCopy, Error::kNowhere, Error::kNowhere,
                       "one of the file's two headers is damaged; copy the file or build it again "
                       "before the other one is damaged too"});
  check_header();
  if (!can_serve(header_, actual_bytes_)) return {};
  if (const auto checked = query::check_page_limits(header_); !checked) {
    issues_.push_back(Issue::from(IssueCode::kFormatUnsupported, checked.error()));
    return {};
  }
  has_header_ = true;
  frame_.resize(header_.page_bytes);
  if (const auto loaded = load_extensions(); !loaded) return loaded;
  return load_directory();
}

/// Checks the header. Where the file has another length, the other fields are checked all the same.
void FileParts::check_header() {
  auto checked = storage::check_header(header_, actual_bytes_);
  if (!checked && checked.error().code == ErrorCode::kTruncated) {
    issues_.push_back(Issue::from(IssueCode::kFileLength, checked.error()));
    checked = storage::check_header(header_, header_.file_bytes);
  }
  if (checked) return;
  const IssueCode code = header_issue(checked.error().code, IssueCode::kHeaderField);
  issues_.push_back(Issue::from(code, checked.error()));
}

Result<void> FileParts::load_extensions() {
  if (header_.extension_count > storage::kMaxExtensions ||
      storage::directory_start(header_.extension_count) > actual_bytes_)
    return {};  // check_header() has reported it
  extensions_.resize(header_.extension_count);
  const auto records = std::as_writable_bytes(std::span(extensions_));
  if (const auto read = read_at(storage::kHeaderBytes, records); !read) return read;
  const auto checked = storage::check_extensions(header_, extensions_);
  if (checked) {
    for (const storage::ExtensionRecord& record : extensions_)
      if (const auto loaded = load_extension(record); !loaded) return loaded;
    return {};
  }
  issues_.push_back(Issue::from(IssueCode::kExtension, checked.error()));
  extensions_.clear();
  return {};
}

Result<void> FileParts::load_directory() {
  if (header_.extension_count > storage::kMaxExtensions ||
      storage::pages_start(header_) > actual_bytes_)
    return {};  // check_header() has reported it
  // The directory of a truncated file may be whole.
  DirectorySurvey survey(*file_, header_);
  if (const auto read = survey.run(); !read) return read;
  entries_ = std::move(survey.entries);
  issues_.insert(issues_.end(), survey.issues.begin(), survey.issues.end());
  check_lengths();
  return {};
}

/// Checks what concerns the whole directory: the order of octcodes, and what the header states of
/// the lengths of pages. Model::open() does not, because it does not read the whole directory of a
/// large file.
void FileParts::check_lengths() {
  if (!issues_.empty()) return;
  std::uint64_t stored[storage::kPageKinds] = {};
  std::uint32_t max_raw = 0, max_stored = 0;
  for (std::uint32_t page = 0; page < page_count(); ++page) {
    const bool follows = page > 0 && header_.kind_of(page - 1) == header_.kind_of(page);
    const bool strictly = page > header_.first_mask_page();
    if (follows && entries_[page - 1].octcode + strictly > entries_[page].octcode)
      return issues_.push_back({IssueCode::kDirectory, page, Error::kNowhere,
                                "the page's octcode does not follow the one before; build the "
                                "file again"});
    stored[static_cast<unsigned>(header_.kind_of(page))] += entries_[page].stored_bytes;
    max_raw = std::max(max_raw, entries_[page].raw_bytes);
    max_stored = std::max(max_stored, entries_[page].stored_bytes);
  }
  const bool is_right = std::equal(std::begin(stored), std::end(stored), header_.stored_bytes) &&
                        max_raw == header_.max_raw_bytes && max_stored == header_.max_stored_bytes;
  if (!is_right)
    issues_.push_back({IssueCode::kHeaderField, Error::kNowhere,
                       offsetof(storage::FileHeader, stored_bytes),
                       "the lengths of pages that the header states are not those of the "
                       "directory; build the file again"});
}

/// Checks the hash of an extension, and reads the one that this program knows.
Result<void> FileParts::load_extension(const storage::ExtensionRecord& record) {
  constexpr std::size_t kPartBytes = std::size_t{1} << 20;
  storage::Hasher hasher;
  std::vector<std::byte> part;
  for (std::uint64_t at = 0; at < record.bytes; at += part.size()) {
    part.resize(static_cast<std::size_t>(std::min<std::uint64_t>(kPartBytes, record.bytes - at)));
    // That a file is too short is an issue of its length.
    if (const auto read = read_at(record.offset + at, part); !read)
      return read.error().code == ErrorCode::kTruncated ? Result<void>{} : read;
    hasher.add(part);
  }
  const bool is_metadata = storage::name_of(record) == storage::kMetadataName;
  if (hasher.value64() != record.check) {
    issues_.push_back({IssueCode::kExtension, Error::kNowhere, record.offset,
                       "the hash of an extension is wrong; restore the file from a copy or build "
                       "it again"});
  } else if (is_metadata) {
    if (record.bytes > kPartBytes) part.resize(kPartBytes);  // too long in any case
    auto metadata = storage::parse_metadata(part);
    if (metadata)
      metadata_ = *std::move(metadata);
    else
      issues_.push_back(Issue::from(IssueCode::kExtension, metadata.error()));
  }
  return {};
}

Result<void> FileParts::read_at(std::uint64_t offset, std::span<std::byte> out) const {
  return out.empty() ? Result<void>{} : file_->read_at(offset, out);
}

/// Checks a table entry before memory is allocated or bytes are read for it, because the table may
/// be damaged. Null if the entry is plausible.
const char* FileParts::fault_of(const storage::PageEntry& entry) const {
  if (entry.offset > actual_bytes_ || entry.stored_bytes > actual_bytes_ - entry.offset)
    return "the page lies beyond the file's end; restore the file from a copy or build it again";
  if (entry.raw_bytes > storage::kMaxRawBytes ||
      !storage::lengths_are_plausible(entry.codec(), entry.stored_bytes, entry.raw_bytes))
    return "the page's stored length cannot give its raw length; restore the file from a copy or "
           "build it again";
  return nullptr;
}

std::optional<Issue> FileParts::read_page(std::uint32_t page) {
  const storage::PageEntry& entry = entries_[page];
  page_ = page;
  raw_.clear();
  if (const char* fault = fault_of(entry))
    return page_issue(IssueCode::kPageEntry, page, Error::kNowhere, fault);
  stored_.resize(entry.stored_bytes);
  if (const auto read = read_at(entry.offset, stored_); !read) {
    Issue issue = Issue::from(IssueCode::kPageRead, read.error());
    issue.page = page;
    issue.offset = entry.offset;
    return issue;
  }
  if (storage::hash64(stored_) != entry.check)
    return page_issue(IssueCode::kPageChecksum, page, entry.offset,
                      "the page's checksum is wrong; restore the file from a copy or build it "
                      "again");
  raw_.resize(entry.raw_bytes);
  if (const auto decoded = storage::decompress_page(entry.codec(), stored_, raw_); !decoded) {
    raw_.clear();
    return page_issue(IssueCode::kPageCodec, page, entry.offset, decoded.error().text);
  }
  return {};
}

bool FileParts::read(octree::RawStreams& streams) const {
  return streams.read(raw_, shape()) == nullptr;
}

bool FileParts::read(octree::MaskStreams& streams) const {
  return page_ >= first_mask_page() && streams.read(raw_, shape().float64) == nullptr;
}

std::optional<octree::MaskPageHead> FileParts::mask_head() const {
  octree::MaskStreams streams;
  if (!read(streams)) return {};
  return streams.head;
}

std::optional<octree::FieldPageHead> FileParts::field_head() const {
  octree::FieldPageHead head;
  if (!is_field_page(page_) || raw_.size() < sizeof head) return {};
  std::memcpy(&head, raw_.data(), sizeof head);
  return head;
}

std::optional<octree::AttributePageHead> FileParts::attribute_head() const {
  octree::AttributePageHead head;
  if (!is_attribute_page(page_) || raw_.size() < sizeof head) return {};
  std::memcpy(&head, raw_.data(), sizeof head);
  return head;
}

octree::PageInfo FileParts::info_of_page(const storage::PageEntry& entry) const {
  octree::PageInfo info = query::page_info(header_, entry, page_);
  info.shape.links = links().target();
  return info;
}

std::optional<Issue> FileParts::decode_page() {
  const storage::PageEntry& entry = entries_[page_];
  const auto decoded = query::decode_frame(header_, info_of_page(entry), raw_, frame_.span());
  if (decoded) return {};
  return page_issue(IssueCode::kPageStructure, page_, entry.offset, decoded.error().text);
}

}  // namespace planetree::tools
