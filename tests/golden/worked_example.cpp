#include "tests/golden/worked_example.h"

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstring>

#include "tests/golden/format_fields.h"

namespace planetree::golden {
namespace {

constexpr std::size_t kBytesPerLine = 16;

template <class T>
T get(std::span<const std::byte> bytes, std::size_t offset) {
  T value;
  std::memcpy(&value, bytes.data() + offset, sizeof value);
  return value;
}

// Lists bytes field by field.
class Listing {
 public:
  explicit Listing(std::span<const std::byte> bytes) : bytes_(bytes) {}

  std::size_t at() const { return at_; }
  const std::string& text() const { return text_; }

  void field(std::size_t size, const std::string& meaning) {
    for (std::size_t done = 0; done < size; done += kBytesPerLine)
      line(std::min(size - done, kBytesPerLine), done == 0 ? meaning : "");
  }

  /// Lists all fields of a struct. A field that is a record is listed field by field too.
  void record(const FormatStruct& format) {
    const std::size_t start = at_;
    for (const FormatField& field_of : format.fields) {
      if (field_of.encoding == "record")
        record(format_struct("Model record"));
      else
        field(field_of.size, field_of.name + value(field_of, start + field_of.offset));
    }
  }

 private:
  void line(std::size_t size, const std::string& meaning) {
    char part[16];
    std::snprintf(part, sizeof part, "%04zx ", at_);
    std::string line = part;
    for (std::size_t i = 0; i < size; ++i) {
      std::snprintf(part, sizeof part, " %02x", static_cast<unsigned>(bytes_[at_ + i]));
      line += part;
    }
    line.resize(std::max<std::size_t>(line.size(), 6 + 3 * kBytesPerLine), ' ');
    line += "  " + meaning;
    text_ += line.substr(0, line.find_last_not_of(' ') + 1) + "\n";
    at_ += size;
  }

  // The value of a field as text; empty for bytes and hashes.
  std::string value(const FormatField& field, std::size_t offset) const {
    const auto whole = [&]<class T>(T number) { return " = " + std::to_string(number); };
    const bool is_hash = field.name == "check" || field.name.ends_with("_hash");
    if (is_hash || field.name == "octcode") return "";
    if (field.encoding == "u8") return whole(get<std::uint8_t>(bytes_, offset));
    if (field.encoding == "u16") return whole(get<std::uint16_t>(bytes_, offset));
    if (field.encoding == "u32") return whole(get<std::uint32_t>(bytes_, offset));
    if (field.encoding == "i32") return whole(get<std::int32_t>(bytes_, offset));
    if (field.encoding == "u64") return whole(get<std::uint64_t>(bytes_, offset));
    if (field.encoding != "f64 x 3") return "";
    char text[96];
    std::snprintf(text, sizeof text, " = %g %g %g", get<double>(bytes_, offset),
                  get<double>(bytes_, offset + 8), get<double>(bytes_, offset + 16));
    return text;
  }

  std::span<const std::byte> bytes_;
  std::size_t at_ = 0;
  std::string text_;
};

// A length of 15 in the token continues in further bytes, up to the first below 255.
std::size_t read_length(std::span<const std::byte> file, unsigned nibble, std::size_t& at) {
  std::size_t length = nibble;
  if (nibble < 15) return length;
  for (unsigned more = 255; more == 255; length += more) more = static_cast<unsigned>(file[at++]);
  return length;
}

void list_sequences(std::span<const std::byte> file, Listing& listing, std::size_t end) {
  while (listing.at() < end) {
    std::size_t at = listing.at();
    const auto token = static_cast<unsigned>(file[at++]);
    const std::size_t literals = read_length(file, token >> 4, at);
    at += literals;
    std::string meaning = std::to_string(literals) + " literals";
    if (at < end) {
      const unsigned back = get<std::uint16_t>(file, at);
      at += 2;
      const std::size_t match = 4 + read_length(file, token & 15, at);
      meaning += ", " + std::to_string(match) + " bytes from " + std::to_string(back) + " back";
    }
    listing.field(at - listing.at(), meaning);
  }
}

}  // namespace

std::string list_file(std::span<const std::byte> file) {
  Listing listing(file);
  const FormatStruct& entry = format_struct("Directory");
  const auto page_count = get<std::uint32_t>(file, 104);
  listing.record(format_struct("Header"));
  for (std::uint32_t page = 0; page < page_count; ++page) listing.record(entry);
  for (std::uint32_t page = 0; page < page_count; ++page) {
    const std::size_t entry_at = 1024 + std::size_t{24} * page;
    list_sequences(file, listing, listing.at() + get<std::uint32_t>(file, entry_at + 16));
  }
  listing.record(format_struct("Header"));
  return listing.text();
}

std::string list_page(std::span<const std::byte> raw) {
  Listing listing(raw);
  listing.record(format_struct("Distance page"));
  const std::size_t blocks = get<std::uint16_t>(raw, 18);
  const std::size_t vertices = get<std::uint16_t>(raw, 26);
  const std::size_t triangles = get<std::uint16_t>(raw, 30);
  const auto sum_from_here = [&](auto part) {
    std::size_t sum = 0;
    for (std::size_t i = 0; i < blocks; ++i) sum += part(i);
    return sum;
  };
  const std::size_t counts = listing.at();
  const std::size_t corners = sum_from_here([&](std::size_t i) {
    const auto triangle_count = static_cast<std::size_t>(raw[counts + i] & std::byte{0x3f});
    const auto vertex_count = static_cast<std::size_t>(raw[counts + blocks + i]);
    return (3 * triangle_count * (vertex_count <= 16 ? 4 : vertex_count <= 32 ? 5 : 6) + 7) / 8;
  });
  listing.field(blocks, "triangle counts");
  listing.field(blocks, "vertex counts");
  listing.field(blocks, "new counts");
  listing.field(std::size_t{2} * get<std::uint16_t>(raw, 28), "vertex refs");
  listing.field(corners, "corners");
  for (const char* byte : {"lowest", "second", "third", "highest"})
    listing.field(3 * vertices, std::string("vertices, ") + byte + " bytes");
  listing.field(4 * blocks, "first ids");
  const std::size_t steps = triangles - blocks;
  for (const char* byte : {"lowest", "second", "third", "highest"})
    listing.field(steps, std::string("id steps, ") + byte + " bytes");
  return listing.text();
}

}  // namespace planetree::golden
