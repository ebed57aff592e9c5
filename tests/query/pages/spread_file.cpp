#include "tests/query/pages/spread_file.h"

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <span>
#include <utility>
#include <vector>

#include "octree/attributes/attribute_page.h"
#include "octree/builder/tree/stream_writer.h"
#include "octree/page/byte_split.h"
#include "query/file/page_decoding.h"
#include "storage/file/page_file.h"
#include "storage/file/page_writer.h"
#include "tests/octree/page/raw_mask_page.h"
#include "tests/octree/page/raw_page.h"

namespace planetree::query {
namespace {

using Bytes = std::vector<std::byte>;

template <class T>
T need(Result<T> result) {
  if (result) return std::move(*result);
  std::fprintf(stderr, "spread file: %s\n", result.error().text);
  std::abort();
}
void need(const Result<void>& result) {
  if (result) return;
  std::fprintf(stderr, "spread file: %s\n", result.error().text);
  std::abort();
}

class Spreading {
 public:
  Spreading(const std::filesystem::path& file, const PageGaps& gaps)
      : file_(need(storage::PageFile::open(file))), header_(file_.header()), gaps_(gaps) {}

  void write(const std::filesystem::path& copy) {
    const std::uint32_t count = header_.page_count + gaps_.tree + gaps_.mask;
    auto writer = need(storage::PageWriter::create(copy, count, {}, false));
    for (std::uint32_t page = 0; page < header_.page_count; ++page) {
      if (page == header_.first_cap_page()) writer.begin_caps();
      if (page == header_.first_attribute_page()) writer.begin_attributes();
      if (page == header_.first_mask_page()) writer.begin_mask();
      const std::uint64_t octcode = need(file_.entry(page)).octcode;
      append(writer, octcode, changed(page));
      if (page == 0)
        for (std::uint32_t i = 0; i < gaps_.tree; ++i) append(writer, octcode, Bytes(1));
      // Octcodes of mask pages differ.
      if (page == header_.first_mask_page())
        for (std::uint32_t i = 0; i < gaps_.mask; ++i) append(writer, octcode + 1 + i, Bytes(1));
    }
    storage::ModelRecord model = header_.model;
    model.mask_page_count += gaps_.mask;
    need(writer.finish(model, header_.page_bytes));
  }

 private:
  static void append(storage::PageWriter& writer, std::uint64_t octcode, const Bytes& raw) {
    need(writer.append(octcode, static_cast<std::uint32_t>(raw.size()),
                       storage::compress_page(raw)));
  }

  std::uint32_t number_of_tree_page(std::uint32_t page) const {
    return page == 0 ? 0 : page + gaps_.tree;
  }
  // Within the mask.
  std::uint32_t number_of_mask_page(std::uint32_t page) const {
    return page == 0 ? 0 : page + gaps_.mask;
  }

  // The raw bytes of a page with its new number and those of the pages that it links to.
  Bytes changed(std::uint32_t page) {
    const storage::PageEntry entry = need(file_.entry(page));
    Bytes stored(header_.max_stored_bytes), raw(entry.raw_bytes);
    need(file_.read_page(page, stored, raw));
    if (page >= header_.first_mask_page()) return changed_mask_page(raw, page);
    if (page >= header_.first_attribute_page()) return changed_attribute_page(raw, page);
    octree::RawPage tree = octree::RawPage::of(raw, page_info(header_, entry, page).shape);
    tree.head.page_number = number_of_tree_page(page);
    for (std::uint32_t& link : tree.linked_pages) link = number_of_tree_page(link);
    return tree.bytes();
  }
  Bytes changed_mask_page(std::span<const std::byte> raw, std::uint32_t page) const {
    const std::uint32_t first = header_.first_mask_page();
    octree::RawMaskPage mask = octree::RawMaskPage::of(raw, false);
    mask.head.page_number = first + gaps_.tree + number_of_mask_page(page - first);
    for (std::uint32_t& link : mask.linked_pages) link = number_of_mask_page(link);
    for (std::uint32_t& block : mask.block_pages) block = number_of_tree_page(block);
    return mask.bytes();
  }
  Bytes changed_attribute_page(std::span<const std::byte> raw, std::uint32_t page) const {
    octree::AttributePageHead head;
    std::memcpy(&head, raw.data(), sizeof head);
    head.page_number = page + gaps_.tree;
    octree::StreamReader rest(raw.subspan(sizeof head));
    octree::ByteSplit<std::uint32_t> blocks;
    rest.take(blocks, head.triangle_count);
    std::vector<std::uint32_t> pages;
    for (std::size_t i = 0; i < blocks.size(); ++i)
      pages.push_back(blocks[i] == octree::kNoStoredLink.page ? blocks[i]
                                                              : number_of_tree_page(blocks[i]));
    octree::StreamWriter writer;
    writer.plain(&head, sizeof head);
    writer.byte_split(pages);
    const auto others = raw.subspan(writer.size());
    writer.plain(others.data(), others.size());
    return writer.take();
  }

  const storage::PageFile file_;
  const storage::FileHeader header_;
  const PageGaps gaps_;
};

}  // namespace

void spread_file(const std::filesystem::path& file, const std::filesystem::path& copy,
                 const PageGaps& gaps) {
  Spreading(file, gaps).write(copy);
}

}  // namespace planetree::query
