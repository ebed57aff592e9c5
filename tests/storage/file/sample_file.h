#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <vector>

#include "storage/file/page_codec.h"
#include "storage/file/page_file.h"
#include "storage/file/page_writer.h"
#include "tests/storage/file/file_image.h"

/// Small files for tests, with pages that LZ4 shrinks and pages that it does not.
namespace planetree::storage {

/// Returns the same bytes for the same arguments: noise, in which even pages use four values only.
inline Bytes sample_page(std::uint32_t page, std::size_t bytes, std::uint64_t seed = 1) {
  Bytes raw(bytes);
  std::uint64_t state = seed * 0x9e3779b97f4a7c15u + page + 1;
  for (std::byte& byte : raw) {
    state = state * 6364136223846793005u + 1442695040888963407u;
    const std::uint64_t noise = state >> 56;
    byte = static_cast<std::byte>(page % 2 == 0 ? noise % 4 : noise);
  }
  return raw;
}

inline ModelRecord sample_model() {
  ModelRecord model{};
  model.triangle_count = 20;
  model.first_skipped = kNoTriangle;
  model.vertex_count = 8;
  model.node_count = 1;
  model.block_count = 2;
  for (int axis = 0; axis < 3; ++axis) {
    model.box_lower[axis] = -1.0;
    model.box_upper[axis] = 1.0 + axis;
    model.core_lower[axis] = model.box_lower[axis];
    model.core_upper[axis] = model.box_upper[axis];
    model.sample[axis] = 0.5;
  }
  model.triangle_id_bytes = 4;
  model.height = 1;
  return model;
}

struct SampleFile {
  std::uint32_t page_count = 3;
  std::size_t page_bytes = 120;  ///< bytes of page 0; each further page is 7 bytes longer
  std::uint64_t seed = 1;
  std::vector<Extension> extensions{};

  Bytes raw(std::uint32_t page) const { return sample_page(page, page_bytes + 7 * page, seed); }

  Result<FileHeader> write(const std::filesystem::path& path, bool replace = false,
                           FileCalls& calls = FileCalls::real()) const {
    Result<PageWriter> writer = PageWriter::create(path, page_count, extensions, replace, calls);
    if (!writer) return writer.error();
    for (std::uint32_t page = 0; page < page_count; ++page) {
      const Bytes bytes = raw(page);
      const Result<void> appended =
          writer->append(page / 2, static_cast<std::uint32_t>(bytes.size()), compress_page(bytes));
      if (!appended) return appended.error();
    }
    return writer->finish(sample_model(), kMinPageBytes);
  }
};

/// Reads one page into buffers of exactly the sizes required.
inline Result<Bytes> read_page(const PageFile& file, std::uint32_t page) {
  Bytes scratch(file.header().max_stored_bytes);
  const Result<PageEntry> entry = file.entry(page);
  if (!entry) return entry.error();
  Bytes raw(entry->raw_bytes);
  const Result<void> read = file.read_page(page, scratch, raw);
  if (!read) return read.error();
  return raw;
}

/// Opens a file and reads all its pages. Returns them, or the first error.
inline Result<std::vector<Bytes>> read_all(const std::filesystem::path& path,
                                           FileCalls& calls = FileCalls::real()) {
  const Result<PageFile> file = PageFile::open(path, calls);
  if (!file) return file.error();
  std::vector<Bytes> pages;
  for (std::uint32_t page = 0; page < file->page_count(); ++page) {
    Result<Bytes> raw = read_page(*file, page);
    if (!raw) return raw.error();
    pages.push_back(*std::move(raw));
  }
  return pages;
}

}  // namespace planetree::storage
