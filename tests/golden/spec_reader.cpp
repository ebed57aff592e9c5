#include "tests/golden/spec_reader.h"

#include <lz4.h>
#include <xxhash.h>

#include <bit>
#include <cmath>
#include <cstring>
#include <utility>

#include "tests/golden/spec_page.h"
#include "tests/golden/spec_streams.h"

namespace planetree::golden {
namespace {

using Bytes = std::span<const std::byte>;

template <class T>
T get(Bytes bytes, std::size_t offset) {
  T value;
  require(offset + sizeof value <= bytes.size(), "beyond the end");
  std::memcpy(&value, bytes.data() + offset, sizeof value);
  return value;
}

std::uint64_t hash64(Bytes bytes, std::uint64_t seed) {
  return XXH3_64bits_withSeed(bytes.data(), bytes.size(), seed);
}

bool is_whole(Bytes header) {
  constexpr unsigned char kMagic[8] = {0x89, 'P', 'T', 'R', 'E', 'E', 0x0d, 0x0a};
  return std::memcmp(header.data(), kMagic, 8) == 0 &&
         hash64(header.first(752), 0) == get<std::uint64_t>(header, 752);
}

// "Region": sides within the mesh's box are walls.
void read_region(Bytes model, SpecHeader& read) {
  read.input_triangles = get<std::uint64_t>(model, 384);
  read.region_winding = get<std::int64_t>(model, 440);
  require(!read.without_sides || read.region_winding == 0, "winding of a file without sides");
  read.wall_lower.fill(-INFINITY);
  read.wall_upper.fill(INFINITY);
  if (read.input_triangles == 0) return;
  const auto lower = get<SpecPoint>(model, 392), upper = get<SpecPoint>(model, 416);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (lower[axis] > read.box_lower[axis])
      read.wall_lower[axis] = std::ldexp(lower[axis], read.scale_exponent);
    if (upper[axis] < read.box_upper[axis])
      read.wall_upper[axis] = std::ldexp(upper[axis], read.scale_exponent);
  }
}

void read_caps(Bytes model, SpecHeader& read) {
  read.unbalanced_edges = get<std::uint64_t>(model, 168);
  read.cap_count = get<std::uint64_t>(model, 512);
  read.cap_node_count = get<std::uint64_t>(model, 520);
  read.cap_block_count = get<std::uint64_t>(model, 528);
  read.cap_area = get<double>(model, 536);
  read.cap_pages = get<std::uint32_t>(model, 544);
  read.cap_root_link = get<std::uint32_t>(model, 548);
  read.cap_height = get<std::uint8_t>(model, 552);
  const auto without_sides = get<std::uint8_t>(model, 570);
  require(without_sides <= 1, "mark of a file without sides");
  read.without_sides = without_sides == 1;
  require(!read.without_sides || read.mask_pages == 0, "mask of a file without sides");
  const bool needs_caps = read.unbalanced_edges > 0 && !read.without_sides;
  for (const bool has_some : {read.cap_pages > 0, read.cap_block_count > 0, needs_caps})
    require(has_some == (read.cap_count > 0), "caps");
  require((read.cap_node_count > 0) == (read.cap_count > 16), "nodes of caps");
  for (std::size_t at = 553; at < 560; ++at)
    require(get<std::uint8_t>(model, at) == 0, "reserved bytes of caps");
}

void read_field(Bytes model, SpecHeader& read) {
  read.field_lower = get<SpecPoint>(model, 576);
  read.field_step = get<double>(model, 600);
  read.field_quantum = get<double>(model, 608);
  read.field_size = get<std::array<std::uint32_t, 3>>(model, 616);
  read.field_pages = get<std::uint32_t>(model, 628);
  const std::uint64_t in_page = read.page_bytes / 8;
  require(read.field_pages == (read.field_points() + in_page - 1) / in_page, "pages of the field");
}

void read_attributes(Bytes model, SpecHeader& read) {
  read.attribute_pages = get<std::uint32_t>(model, 632);
  read.attributes = get<std::uint8_t>(model, 636);
  read.value_kind = get<std::uint8_t>(model, 637);
  require(read.attributes == 0 || read.has_attribute(0), "attributes without links");
  require(read.attributes < 16, "an unknown attribute");
  require(read.value_kind <= (read.has_attribute(3) ? 2u : 0u), "kind of values");
  require(get<std::uint16_t>(model, 638) == 0, "reserved bytes of attributes");
  std::uint64_t pages = 0;
  if (read.attributes != 0) {
    const std::uint64_t in_page = read.attribute_page_triangles();
    pages = read.indices() / in_page + (read.indices() % in_page > 0 ? 1 : 0);
  }
  require(read.attribute_pages == pages, "pages of attributes");
}

SpecHeader read_header(Bytes header) {
  const Bytes model = header.subspan(80, 640);
  SpecHeader read{};
  read.page_bytes = get<std::uint32_t>(header, 12);
  require(
      std::has_single_bit(read.page_bytes) && read.page_bytes >= 4096 && read.page_bytes <= 262144,
      "page size");
  for (std::size_t at = 720; at < 752; ++at)
    require(get<std::uint8_t>(header, at) == 0, "reserved bytes of the header");
  read.page_count = get<std::uint32_t>(header, 64);
  read.triangle_count = get<std::uint64_t>(model, 0);
  read.skipped_count = get<std::uint64_t>(model, 8);
  read.node_count = get<std::uint64_t>(model, 32);
  read.block_count = get<std::uint64_t>(model, 40);
  read.box_lower = get<SpecPoint>(model, 48);
  read.box_upper = get<SpecPoint>(model, 72);
  read.core_lower = get<SpecPoint>(model, 448);
  read.core_upper = get<SpecPoint>(model, 472);
  read.stray_count = get<std::uint64_t>(model, 496);
  read.stray_edge = get<double>(model, 504);
  read.openness = get<double>(model, 560);
  read.by_surface = get<std::uint8_t>(model, 568) == 1;
  read.side_is_chosen = get<std::uint8_t>(model, 569) == 1;
  read.centre = get<SpecPoint>(model, 96);
  read.sample = get<SpecPoint>(model, 120);
  read.sample_triangle = get<std::uint64_t>(model, 144);
  read.scale_exponent = get<std::int32_t>(model, 152);
  read.root_link = get<std::uint32_t>(model, 156);
  read.float64 = get<std::uint8_t>(model, 160) == 1;
  read.wide_ids = get<std::uint8_t>(model, 161) == 8;
  read.height = get<std::uint8_t>(model, 162);
  read.mask_cells = get<std::uint64_t>(model, 368);
  read.mask_pages = get<std::uint32_t>(model, 376);
  read.mask_levels = get<std::uint8_t>(model, 380);
  read_caps(model, read);
  read_field(model, read);
  read_region(model, read);
  read_attributes(model, read);
  require(
      std::uint64_t{read.cap_pages} + read.field_pages + read.attribute_pages + read.mask_pages <
          read.page_count,
      "no distance page");
  return read;
}

}  // namespace

bool SpecHeader::has_walls() const {
  bool found = false;
  for (std::size_t axis = 0; axis < 3; ++axis)
    found = found || std::isfinite(wall_lower[axis]) || std::isfinite(wall_upper[axis]);
  return found;
}

std::uint64_t SpecHeader::attribute_page_triangles() const {
  constexpr std::uint64_t kBytes[] = {4, 12, 24, 8};
  std::uint64_t bytes = 0;
  for (unsigned bit = 0; bit < 4; ++bit) bytes += has_attribute(bit) ? kBytes[bit] : 0;
  return (page_bytes - 64) / bytes;
}

SpecFile::SpecFile(std::vector<std::byte> bytes) : bytes_(std::move(bytes)) {
  const Bytes header = choose_header();
  require(get<std::uint16_t>(header, 8) == 14, "another version");
  require(get<std::uint16_t>(header, 10) == 760, "header length");
  require(get<std::uint64_t>(header, 16) == 0, "unknown features");
  require(get<std::uint64_t>(header, 32) == bytes_.size(), "file length");
  header_ = read_header(header);
  content_id_ = get<std::uint64_t>(header, 40);
  check_table(header);
}

Bytes SpecFile::choose_header() const {
  const Bytes all(bytes_);
  require(all.size() >= 1561, "too short");
  if (is_whole(all.first(760))) return all.first(760);
  require(is_whole(all.last(760)), "no whole header");
  return all.last(760);
}

void SpecFile::check_table(Bytes header) const {
  const Bytes table = Bytes(bytes_).subspan(760, std::size_t{40} * header_.page_count);
  require(hash64(table, 0) == get<std::uint64_t>(header, 56), "table hash");
  std::vector<std::uint64_t> page_hashes;
  std::uint64_t end = 760 + table.size();
  for (std::uint32_t k = 0; k < header_.page_count; ++k) {
    page_hashes.push_back(get<std::uint64_t>(entry(k), 8) ^ content_id_);
    require(get<std::uint64_t>(entry(k), 0) == end, "pages do not tile the file");
    end += get<std::uint32_t>(entry(k), 32);
  }
  require(end == bytes_.size() - 760, "pages do not tile the file");
  const XXH128_hash_t id = XXH3_128bits(page_hashes.data(), 8 * page_hashes.size());
  require(id.low64 == content_id_ && id.high64 == get<std::uint64_t>(header, 48), "content id");
  check_keys();
}

// "Page keys": keys ascend within each kind of page.
void SpecFile::check_keys() const {
  using Key = std::pair<std::uint64_t, std::uint32_t>;
  const std::uint32_t c = header_.c(), e = header_.e(), a = header_.a(), d = header_.d();
  Key last_key{};
  for (std::uint32_t k = 0; k < header_.page_count; ++k) {
    const Key key(get<std::uint64_t>(entry(k), 16), get<std::uint32_t>(entry(k), 24));
    require(k == 0 || k == c || k == e || k == a || k == d || last_key < key, "order of keys");
    if (k >= e && k < d)
      require(key == Key(0, k - (k < a ? e : a)), "key of a field page or an attribute page");
    last_key = key;
  }
}

Bytes SpecFile::entry(std::uint32_t number) const {
  return Bytes(bytes_).subspan(760 + std::size_t{40} * number, 40);
}

std::vector<std::byte> SpecFile::raw_page(std::uint32_t number) const {
  const Bytes stored = Bytes(bytes_).subspan(get<std::uint64_t>(entry(number), 0),
                                             get<std::uint32_t>(entry(number), 32));
  const std::uint64_t check = get<std::uint64_t>(entry(number), 8);
  require((hash64(stored, number) ^ content_id_) == check, "page hash");
  const auto raw_bytes = get<std::uint32_t>(entry(number), 36);
  if (get<std::uint32_t>(entry(number), 28) == 0) return {stored.begin(), stored.end()};
  std::vector<std::byte> raw(raw_bytes);
  const int length = LZ4_decompress_safe(
      reinterpret_cast<const char*>(stored.data()), reinterpret_cast<char*>(raw.data()),
      static_cast<int>(stored.size()), static_cast<int>(raw.size()));
  require(length == static_cast<int>(raw_bytes), "raw length");
  return raw;
}

SpecPage SpecFile::page(std::uint32_t number) const {
  SpecPage page = decode_spec_page(raw_page(number), number, header_);
  require(page.octcode == get<std::uint64_t>(entry(number), 16) &&
              page.ordinal == get<std::uint32_t>(entry(number), 24),
          "the page's key");
  return page;
}

std::uint32_t SpecFile::page_of(std::uint32_t link) const {
  return (link & 0x7fffffff) / (header_.page_bytes / 64);
}

}  // namespace planetree::golden
