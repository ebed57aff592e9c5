#include "storage/file/page_writer.h"

#include <algorithm>
#include <cassert>
#include <cinttypes>
#include <cstring>
#include <utility>

#include "storage/file/checksum.h"
#include "storage/file/directory_shape.h"
#include "storage/file/directory_writer.h"
#include "storage/file/header_check.h"

namespace planetree::storage {
namespace {

Error bad_argument(std::uint64_t page, const char* cause) noexcept {
  return make_error(ErrorCode::kBadArgument, page, Error::kNowhere, "%s", cause);
}

// Sorts the extensions. Returns null, or what is wrong with the names.
const char* sort_by_name(std::vector<Extension>& extensions) {
  if (extensions.size() > kMaxExtensions) return "a file has at most 64 extensions";
  std::sort(extensions.begin(), extensions.end(),
            [](const Extension& a, const Extension& b) { return a.name < b.name; });
  for (std::size_t i = 0; i < extensions.size(); ++i) {
    if (!is_extension_name(extensions[i].name))
      return "the name of an extension has 1 to 24 letters, digits, '.', '-' and '_'";
    if (i > 0 && extensions[i].name == extensions[i - 1].name)
      return "two extensions have one name";
  }
  return nullptr;
}

Result<void> check_start(std::uint32_t page_count, std::vector<Extension>& extensions) {
  if (page_count == 0)
    return bad_argument(Error::kNowhere, "a file needs at least one page; give it a model");
  if (const char* fault = sort_by_name(extensions)) return bad_argument(Error::kNowhere, fault);
  return {};
}

}  // namespace

Result<PageWriter> PageWriter::create(const std::filesystem::path& path, std::uint32_t page_count,
                                      std::vector<Extension> extensions, bool replace,
                                      FileCalls& calls) {
  // Before the file is created.
  if (const auto checked = check_start(page_count, extensions); !checked) return checked.error();
  auto output = new_model_file(path, replace, calls);
  if (!output) return output.error();
  return create(*std::move(output), page_count, std::move(extensions));
}

Result<PageWriter> PageWriter::create(std::unique_ptr<ModelOutput> output, std::uint32_t page_count,
                                      std::vector<Extension> extensions) {
  if (const auto checked = check_start(page_count, extensions); !checked) return checked.error();
  PageWriter writer(std::move(output));
  writer.page_count_ = page_count;
  writer.extensions_ = std::move(extensions);
  writer.entries_.reserve(page_count);
  writer.buffer_.reserve(ModelOutput::kMaxWriteBytes);
  writer.buffer_offset_ = directory_start(static_cast<std::uint32_t>(writer.extensions_.size())) +
                          DirectoryShape(page_count).bytes();
  if (const auto begun = writer.output_->begin(writer.buffer_offset_); !begun) return begun.error();
  return writer;
}

Result<void> PageWriter::append(std::uint64_t octcode, std::uint32_t raw_bytes,
                                const StoredPage& stored) {
  if (failure_) return *failure_;
  if (const Result<void> checked = check_next(octcode, raw_bytes, stored); !checked) {
    return fail(checked.error());
  }
  const auto stored_bytes = static_cast<std::uint32_t>(stored.bytes.size());
  entries_.push_back({hash64(stored.bytes), octcode, stored_bytes, raw_bytes});
  return add_bytes(stored.bytes);
}

Result<void> PageWriter::check_next(std::uint64_t octcode, std::uint32_t raw_bytes,
                                    const StoredPage& stored) const noexcept {
  const std::size_t page = entries_.size();
  if (page == page_count_) return bad_argument(page, "more pages than the writer was created for");
  if (!entries_.empty() && page != first_cap_page_ && page != first_field_page_ &&
      page != first_attribute_page_ && page != first_mask_page_ &&
      octcode < entries_.back().octcode) {
    return bad_argument(page, "the page's octcode does not follow the one before");
  }
  if (!lengths_are_plausible(stored.codec, stored.bytes.size(), raw_bytes)) {
    return bad_argument(page, "the page's stored length cannot give its raw length");
  }
  return {};
}

Result<void> PageWriter::add_bytes(std::span<const std::byte> bytes) {
  if (!buffer_.empty() && buffer_.size() + bytes.size() > output_->write_bytes()) {
    if (const Result<void> flushed = flush(); !flushed) return flushed;
  }
  static_assert(kMaxRawBytes <= ModelOutput::kMaxWriteBytes, "a page fits in the empty buffer");
  buffer_.insert(buffer_.end(), bytes.begin(), bytes.end());
  return {};
}

Result<void> PageWriter::flush() {
  if (const Result<void> written = output_->write_at(buffer_offset_, buffer_); !written) {
    return fail(written.error());
  }
  buffer_offset_ += buffer_.size();
  buffer_.clear();
  return {};
}

Result<FileHeader> PageWriter::finish(const ModelRecord& model, std::uint32_t page_bytes) {
  if (failure_) return *failure_;
  if (entries_.size() != page_count_) {
    return fail(bad_argument(entries_.size(), "fewer pages than the writer was created for"));
  }
  const std::uint32_t first_mask_page = first_mask_page_.value_or(page_count_);
  const std::uint32_t first_attribute_page = first_attribute_page_.value_or(first_mask_page);
  const std::uint32_t first_field_page = first_field_page_.value_or(first_attribute_page);
  if (model.mask_page_count != page_count_ - first_mask_page ||
      model.attribute_page_count != first_mask_page - first_attribute_page ||
      model.field_page_count != first_attribute_page - first_field_page ||
      model.cap_page_count != first_field_page - first_cap_page_.value_or(first_field_page)) {
    return fail(
        bad_argument(Error::kNowhere, "a section does not have as many pages as the model states"));
  }
  if (const Result<void> written = write_extensions(); !written) return written.error();
  FileHeader header = make_header(model, page_bytes);
  // The writer must not write a header that a reader would refuse.
  if (const Result<void> checked = check_header(header, header.file_bytes); !checked) {
    Error error = checked.error();
    error.code = ErrorCode::kBadArgument;
    return fail(error);
  }
  if (const Result<void> written = write_out(header); !written) return fail(written.error());
  if (const Result<void> committed = output_->commit(header, entries_); !committed)
    return fail(committed.error());
  fail(bad_argument(Error::kNowhere, "the file is finished; create another writer"));
  return header;
}

Result<void> PageWriter::write_extensions() {
  for (const Extension& extension : extensions_) {
    if (const Result<void> flushed = flush(); !flushed) return flushed;
    extension_records_.push_back(record_of(extension, buffer_offset_));
    const Result<void> written = output_->write_at(buffer_offset_, extension.bytes);
    if (!written) return fail(written.error());
    buffer_offset_ += extension.bytes.size();
  }
  return flush();
}

FileHeader PageWriter::make_header(const ModelRecord& model, std::uint32_t page_bytes) const {
  FileHeader header{};
  std::memcpy(header.magic, kMagic, sizeof kMagic);
  header.version = kFormatVersion;
  header.header_bytes = kHeaderBytes;
  header.page_bytes = page_bytes;
  header.file_bytes = buffer_offset_ + kHeaderBytes;
  header.page_count = page_count_;
  header.extension_count = static_cast<std::uint32_t>(extension_records_.size());
  header.extensions_hash = hash64(std::as_bytes(std::span(extension_records_)));
  header.model = model;
  for (std::uint32_t page = 0; page < page_count_; ++page) {
    const DirectoryPage& entry = entries_[page];
    header.stored_bytes[static_cast<unsigned>(header.kind_of(page))] += entry.stored_bytes;
    header.max_raw_bytes = std::max(header.max_raw_bytes, entry.raw_bytes);
    header.max_stored_bytes = std::max(header.max_stored_bytes, entry.stored_bytes);
  }
  return header;
}

// The leading header is written last, so that an incomplete file is not taken for a .ptree file.
Result<void> PageWriter::write_out(FileHeader& header) {
  DirectoryWriter directory(header, entries_);
  const Hash128 id = directory.content_id();
  header.content_id[0] = id.low;
  header.content_id[1] = id.high;
  header.header_hash = header_hash(header);
  // This program may write an extension that it requires and does not know.
  const Result<void> checked = check_extensions(header, extension_records_);
  assert(checked || checked.error().code == ErrorCode::kUnsupported);
  static_cast<void>(checked);
  if (const Result<void> written =
          output_->write_at(kHeaderBytes, std::as_bytes(std::span(extension_records_)));
      !written) {
    return written;
  }
  for (unsigned level = 0; level < directory.shape().levels(); ++level) {
    const Result<void> written = output_->write_at(
        directory_block_start(header, directory.shape(), level, 0), directory.level(level));
    if (!written) return written;
  }
  const std::span<const std::byte> bytes = std::as_bytes(std::span(&header, 1));
  if (const Result<void> written = output_->write_at(header.file_bytes - kHeaderBytes, bytes);
      !written) {
    return written;
  }
  return output_->write_at(0, bytes);
}

Error PageWriter::fail(const Error& error) noexcept {
  failure_ = error;
  return error;
}

}  // namespace planetree::storage
