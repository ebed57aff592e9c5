#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "octree/builder/tree_builder.h"
#include "storage/file/page_codec.h"
#include "storage/file/page_file.h"
#include "storage/file/page_writer.h"
#include "tests/octree/builder/silent_progress.h"
#include "tests/octree/page/raw_mask_page.h"
#include "tests/storage/file/file_image.h"
#include "tools/report/stream_rows.h"

/// Small meshes and trees for tests of the command.
namespace planetree::tools {

/// Writes a bumpy square of side * side * 2 triangles over [0, side] x [0, side].
inline void write_mesh(const std::filesystem::path& path, unsigned side,
                       const std::string& more = {}) {
  std::ofstream mesh(path);
  for (unsigned y = 0; y <= side; ++y)
    for (unsigned x = 0; x <= side; ++x)
      mesh << "v " << x << ' ' << y << ' ' << static_cast<double>((x * 7 + y * 5) % 8) / 8 << '\n';
  for (unsigned y = 0; y < side; ++y)
    for (unsigned x = 0; x < side; ++x) {
      const unsigned a = y * (side + 1) + x + 1, b = a + 1, c = a + side + 1, d = c + 1;
      mesh << "f " << a << ' ' << b << ' ' << d << '\n'
           << "f " << a << ' ' << d << ' ' << c << '\n';
    }
  mesh << more;
}

/// Builds a tree with pages of 4096 bytes.
inline void build_sample(const std::filesystem::path& mesh, const std::filesystem::path& tree) {
  octree::BuildOptions options;
  options.page_bytes = 4096;
  options.replace = true;
  options.threads = 1;
  octree::SilentProgress progress;
  ASSERT_TRUE(octree::build_tree(mesh, tree, options, progress));
}

/// Raw bytes of one page, to be changed stream by stream.
class RawPage {
 public:
  RawPage(std::vector<std::byte> bytes, const octree::BlockShape& shape)
      : bytes_(std::move(bytes)) {
    octree::RawStreams streams;
    EXPECT_EQ(streams.read(bytes_, shape), nullptr);
    rows_ = stream_rows(streams, shape);
  }

  std::uint64_t elements(std::string_view stream) const { return row(stream).elements; }

  template <class T>
  T get(std::string_view stream, std::size_t index) const {
    T value;
    auto* bytes = reinterpret_cast<std::byte*>(&value);
    for (std::size_t k = 0; k < sizeof(T); ++k) bytes[k] = bytes_[position(stream, index, k)];
    return value;
  }
  template <class T>
  void set(std::string_view stream, std::size_t index, T value) {
    const auto* bytes = reinterpret_cast<const std::byte*>(&value);
    for (std::size_t k = 0; k < sizeof(T); ++k) bytes_[position(stream, index, k)] = bytes[k];
  }

  const std::vector<std::byte>& bytes() const { return bytes_; }

 private:
  const StreamRow& row(std::string_view stream) const {
    for (const StreamRow& each : rows_)
      if (each.name == stream) return each;
    std::abort();
  }
  // Streams are byte-stream split.
  std::size_t position(std::string_view stream, std::size_t index, std::size_t byte) const {
    std::size_t offset = 0;
    for (const StreamRow& each : rows_) {
      if (each.name == stream) return offset + byte * each.elements + index;
      offset += each.bytes;
    }
    std::abort();
  }

  std::vector<std::byte> bytes_;
  std::vector<StreamRow> rows_;
};

/// Changes that forge() makes to a tree.
struct Forgery {
  std::function<void(std::uint32_t page, RawPage&)> page = [](std::uint32_t, RawPage&) {};
  /// A page of the caps; numbers start at their first page.
  std::function<void(std::uint32_t page, RawPage&)> caps = [](std::uint32_t, RawPage&) {};
  /// The raw bytes of a field page; numbers start at the first of them.
  std::function<void(std::uint32_t page, std::vector<std::byte>&)> field =
      [](std::uint32_t, std::vector<std::byte>&) {};
  /// The raw bytes of an attribute page; numbers start at the first of them.
  std::function<void(std::uint32_t page, std::vector<std::byte>&)> attributes =
      [](std::uint32_t, std::vector<std::byte>&) {};
  /// A page of the mask; numbers start at its first page.
  std::function<void(std::uint32_t page, octree::RawMaskPage&)> mask = [](std::uint32_t,
                                                                          octree::RawMaskPage&) {};
  std::function<void(storage::ModelRecord&)> model = [](storage::ModelRecord&) {};
  std::function<void(std::uint32_t page, storage::StoredPage&)> stored =
      [](std::uint32_t, storage::StoredPage&) {};
};

/// Copies a tree with changes and right hashes, so that a check finds the changes themselves.
inline void forge(const std::filesystem::path& from, const std::filesystem::path& to,
                  const Forgery& forgery) {
  const auto file = storage::PageFile::open(from);
  ASSERT_TRUE(file);
  auto writer = storage::PageWriter::create(to, file->page_count(), {}, true);
  ASSERT_TRUE(writer);
  octree::BlockShape shape;
  shape.float64 = file->header().model.vertex_kind == storage::VertexKind::kFloat64;
  shape.wide_ids = file->header().model.triangle_id_bytes == 8;
  octree::BlockShape cap_shape = shape;
  cap_shape.moments = true;
  const std::uint32_t first_cap_page = file->header().first_cap_page();
  const std::uint32_t first_field_page = file->header().first_field_page();
  const std::uint32_t first_attribute_page = file->header().first_attribute_page();
  const std::uint32_t first_mask_page = file->header().first_mask_page();
  const auto changed = [&](std::uint32_t page, const std::vector<std::byte>& raw) {
    if (page >= first_field_page && page < first_mask_page) {
      std::vector<std::byte> bytes = raw;
      if (page < first_attribute_page)
        forgery.field(page - first_field_page, bytes);
      else
        forgery.attributes(page - first_attribute_page, bytes);
      return bytes;
    }
    if (page < first_field_page) {
      const bool caps = page >= first_cap_page;
      RawPage of_tree(raw, caps ? cap_shape : shape);
      (caps ? forgery.caps : forgery.page)(caps ? page - first_cap_page : page, of_tree);
      return of_tree.bytes();
    }
    auto mask_page = octree::RawMaskPage::of(raw, shape.float64);
    forgery.mask(page - first_mask_page, mask_page);
    return mask_page.bytes();
  };
  std::vector<std::byte> scratch(file->header().max_stored_bytes);
  for (std::uint32_t page = 0; page < file->page_count(); ++page) {
    const storage::PageEntry entry = *file->entry(page);
    std::vector<std::byte> raw(entry.raw_bytes);
    ASSERT_TRUE(file->read_page(page, scratch, raw));
    if (page == first_cap_page && page < first_field_page) writer->begin_caps();
    if (page == first_field_page && page < first_attribute_page) writer->begin_field();
    if (page == first_attribute_page && page < first_mask_page) writer->begin_attributes();
    if (page == first_mask_page) writer->begin_mask();
    const std::vector<std::byte> bytes = changed(page, raw);
    storage::StoredPage stored = storage::compress_page(bytes);
    forgery.stored(page, stored);
    const auto raw_bytes = static_cast<std::uint32_t>(bytes.size());
    ASSERT_TRUE(writer->append(entry.octcode, raw_bytes, stored));
  }
  storage::ModelRecord model = file->header().model;
  forgery.model(model);
  ASSERT_TRUE(writer->finish(model, file->header().page_bytes));
}

}  // namespace planetree::tools
