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

std::uint64_t hash64(Bytes bytes) { return XXH3_64bits(bytes.data(), bytes.size()); }

bool is_whole(Bytes header) {
  constexpr unsigned char kMagic[8] = {0x89, 'P', 'T', 'R', 'E', 'E', 0x0d, 0x0a};
  return std::memcmp(header.data(), kMagic, 8) == 0 &&
         hash64(header.first(1016)) == get<std::uint64_t>(header, 1016);
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
  read.cap_height = get<std::uint8_t>(model, 548);
  const auto without_sides = get<std::uint8_t>(model, 570);
  require(without_sides <= 1, "mark of a file without sides");
  read.without_sides = without_sides == 1;
  require(!read.without_sides || read.mask_pages == 0, "mask of a file without sides");
  const bool needs_caps = read.unbalanced_edges > 0 && !read.without_sides;
  for (const bool has_some : {read.cap_pages > 0, read.cap_block_count > 0, needs_caps})
    require(has_some == (read.cap_count > 0), "caps");
  require((read.cap_node_count > 0) == (read.cap_count > 16), "nodes of caps");
  for (std::size_t at = 549; at < 560; ++at)
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
  const Bytes model = header.subspan(120, 640);
  SpecHeader read{};
  read.page_bytes = get<std::uint32_t>(header, 12);
  require(
      std::has_single_bit(read.page_bytes) && read.page_bytes >= 4096 && read.page_bytes <= 262144,
      "page size");
  for (std::size_t at = 760; at < 1016; ++at)
    require(get<std::uint8_t>(header, at) == 0, "reserved bytes of the header");
  read.page_count = get<std::uint32_t>(header, 104);
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
  read.float64 = get<std::uint8_t>(model, 156) == 1;
  read.wide_ids = get<std::uint8_t>(model, 157) == 8;
  read.height = get<std::uint8_t>(model, 158);
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
  require(get<std::uint16_t>(header, 8) / 256 == 1, "another version");
  require(get<std::uint16_t>(header, 10) == 1024, "header length");
  require(get<std::uint64_t>(header, 16) == 0, "unknown features");
  require(get<std::uint64_t>(header, 32) == bytes_.size(), "file length");
  header_ = read_header(header);
  check_directory(header);
}

Bytes SpecFile::choose_header() const {
  const Bytes all(bytes_);
  require(all.size() >= 2073, "too short");
  if (is_whole(all.first(1024))) return all.first(1024);
  require(is_whole(all.last(1024)), "no whole header");
  return all.last(1024);
}

// "Directory", level by level from the root: each block has the hash that is stated of it.
void SpecFile::check_directory(Bytes header) {
  std::vector<std::size_t> levels{header_.page_count};
  while (levels.front() > 512) levels.insert(levels.begin(), (levels.front() + 511) / 512);
  std::size_t at = 1024 + std::size_t{64} * get<std::uint32_t>(header, 108);
  const XXH128_hash_t id = XXH3_128bits(bytes_.data() + at, 24 * levels.front());
  require(id.low64 == get<std::uint64_t>(header, 40) && id.high64 == get<std::uint64_t>(header, 48),
          "content id");
  for (std::size_t level = 0; level + 1 < levels.size(); ++level) {
    const std::size_t below = at + 24 * levels[level];
    for (std::size_t i = 0; i < levels[level]; ++i) {
      const std::size_t count = std::min<std::size_t>(512, levels[level + 1] - 512 * i);
      const Bytes block = Bytes(bytes_).subspan(below + 24 * 512 * i, 24 * count);
      require(hash64(block) == get<std::uint64_t>(Bytes(bytes_), at + 24 * i), "block hash");
    }
    at = below;
  }
  first_entry_ = at;
  find_pages(header);
  check_keys();
}

void SpecFile::find_pages(Bytes header) {
  std::uint64_t end = first_entry_ + std::size_t{24} * header_.page_count;
  for (std::uint32_t k = 0; k < header_.page_count; ++k) {
    offsets_.push_back(end);
    end += get<std::uint32_t>(entry(k), 16);
  }
  const Bytes records = Bytes(bytes_).subspan(1024, 64 * get<std::uint32_t>(header, 108));
  require(hash64(records) == get<std::uint64_t>(header, 56), "hash of extension records");
  for (std::size_t at = 0; at < records.size(); at += 64) {
    require(get<std::uint64_t>(records, at + 24) == end, "extensions do not tile the file");
    const Bytes bytes = Bytes(bytes_).subspan(end, get<std::uint64_t>(records, at + 32));
    require(hash64(bytes) == get<std::uint64_t>(records, at + 40), "hash of an extension");
    const auto* const name = reinterpret_cast<const char*>(records.data() + at);
    extensions_[std::string(name, ::strnlen(name, 24))] = {
        reinterpret_cast<const char*>(bytes.data()), bytes.size()};
    end += bytes.size();
  }
  require(end == bytes_.size() - 1024, "pages and extensions do not tile the file");
}

// "Page keys": octcodes do not descend within each kind of page.
void SpecFile::check_keys() const {
  const std::uint32_t c = header_.c(), e = header_.e(), a = header_.a(), d = header_.d();
  std::uint64_t last = 0;
  for (std::uint32_t k = 0; k < header_.page_count; ++k) {
    const auto octcode = get<std::uint64_t>(entry(k), 8);
    require(k == 0 || k == c || k == e || k == a || k == d || last <= octcode, "order of keys");
    if (k >= e && k < d) require(octcode == 0, "key of a field page or an attribute page");
    last = octcode;
  }
}

Bytes SpecFile::entry(std::uint32_t number) const {
  return Bytes(bytes_).subspan(first_entry_ + std::size_t{24} * number, 24);
}

std::vector<std::byte> SpecFile::raw_page(std::uint32_t number) const {
  const Bytes stored =
      Bytes(bytes_).subspan(offsets_[number], get<std::uint32_t>(entry(number), 16));
  require(hash64(stored) == get<std::uint64_t>(entry(number), 0), "page hash");
  const auto raw_bytes = get<std::uint32_t>(entry(number), 20);
  if (raw_bytes == stored.size()) return {stored.begin(), stored.end()};
  std::vector<std::byte> raw(raw_bytes);
  const int length = LZ4_decompress_safe(
      reinterpret_cast<const char*>(stored.data()), reinterpret_cast<char*>(raw.data()),
      static_cast<int>(stored.size()), static_cast<int>(raw.size()));
  require(length == static_cast<int>(raw_bytes), "raw length");
  return raw;
}

std::string SpecFile::extension(const std::string& name) const {
  const auto found = extensions_.find(name);
  return found == extensions_.end() ? std::string() : found->second;
}

SpecPage SpecFile::page(std::uint32_t number) const {
  SpecPage page = decode_spec_page(raw_page(number), number, header_);
  require(page.octcode == get<std::uint64_t>(entry(number), 8), "the page's octcode");
  return page;
}

}  // namespace planetree::golden
