#include "tests/differential/tree_pages.h"

#include <cstdio>
#include <cstdlib>
#include <new>

#include "octree/page/page_decoder.h"
#include "storage/file/page_file.h"

namespace planetree::oracle {
namespace {

template <class T>
T need(Result<T> result) {
  if (result) return std::move(*result);
  std::fprintf(stderr, "oracle: %s\n", result.error().text);
  std::abort();
}

void need(const Result<void>& result) {
  if (result) return;
  std::fprintf(stderr, "oracle: %s\n", result.error().text);
  std::abort();
}

}  // namespace

TreePages::TreePages(const std::filesystem::path& path) {
  const storage::PageFile file = need(storage::PageFile::open(path));
  const storage::FileHeader& header = file.header();
  model_ = header.model;
  shape_.float64 = model_.vertex_kind == storage::VertexKind::kFloat64;
  shape_.wide_ids = model_.triangle_id_bytes == 8;
  links_ = octree::LinkFormat(header.page_bytes, shape_.links);
  root_link_ = octree::root_link_of(header.page_bytes, shape_.links, 0, model_.node_count);
  std::vector<std::byte> stored(header.max_stored_bytes), raw(header.max_raw_bytes);
  for (std::uint32_t page = 0; page < header.first_cap_page(); ++page) {
    const storage::PageEntry entry = need(file.entry(page));
    const std::span<std::byte> bytes(raw.data(), entry.raw_bytes);
    need(file.read_page(page, stored, bytes));
    octree::PageInfo info;
    info.page_bytes = header.page_bytes;
    info.page_count = header.first_cap_page();
    info.shape = shape_;
    info.page_number = page;
    info.octcode = entry.octcode;
    auto* frame = new (std::align_val_t{64}) std::byte[header.page_bytes];
    frames_.emplace_back(frame);
    need(octree::decode_page(bytes, info, {frame, header.page_bytes}));
  }
}

const std::byte* TreePages::record(std::uint32_t link) const {
  return frames_[links_.page(link)].get() + links_.record(link) * octree::kSlotBytes;
}

const octree::Node& TreePages::node(std::uint32_t link) const {
  return *reinterpret_cast<const octree::Node*>(record(link));
}

octree::BlockView TreePages::block(std::uint32_t link) const { return {record(link), shape_}; }

void TreePages::each_node(const std::function<void(const octree::Node&)>& visit) const {
  std::vector<std::uint32_t> links{root_link()};
  while (!links.empty()) {
    const std::uint32_t link = links.back();
    links.pop_back();
    if (octree::LinkFormat::is_leaf(link)) continue;
    visit(node(link));
    for (unsigned child = 0; child < node(link).child_count; ++child)
      links.push_back(node(link).link[child]);
  }
}

std::vector<octree::Triangle> TreePages::triangles(std::uint32_t link) const {
  std::vector<octree::Triangle> found;
  std::vector<std::uint32_t> links{link};
  while (!links.empty()) {
    const std::uint32_t next = links.back();
    links.pop_back();
    if (octree::LinkFormat::is_leaf(next)) {
      const octree::BlockView view = block(next);
      for (unsigned i = 0; i < view.triangle_count(); ++i) found.push_back(view.triangle(i));
      continue;
    }
    for (unsigned child = 0; child < node(next).child_count; ++child)
      links.push_back(node(next).link[child]);
  }
  return found;
}

}  // namespace planetree::oracle
