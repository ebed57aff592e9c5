#include "tools/points/npy_header.h"

#include <algorithm>
#include <bit>
#include <charconv>
#include <limits>
#include <optional>
#include <string>

namespace planetree::tools {
namespace {

using namespace std::string_view_literals;
using octree::ScalarType;

constexpr std::string_view kMagic = "\x93NUMPY"sv;

Error damaged(const char* what) {
  return make_error(ErrorCode::kBadInput, Error::kNowhere, 0,
                    "the header of the NumPy array %s; write it again by numpy.save", what);
}

Error unsuitable(const RowShape& shape, const char* what, std::string_view got) {
  std::string numbers = std::to_string(shape.required);
  if (shape.count > shape.required) numbers += " or " + std::to_string(shape.count);
  return make_error(ErrorCode::kBadInput, Error::kNowhere, 0,
                    "the NumPy array has %s %.*s; save %ss as a C-contiguous array of numbers with "
                    "%s of them in each row",
                    what, static_cast<int>(std::min<std::size_t>(got.size(), 40)), got.data(),
                    shape.noun, numbers.c_str());
}

// Returns what follows a key and its colon in the text of a dictionary.
std::optional<std::string_view> value_of(std::string_view text, std::string_view key) {
  const std::size_t at = text.find("'" + std::string(key) + "'");
  if (at == std::string_view::npos) return std::nullopt;
  text.remove_prefix(at + key.size() + 2);
  const std::size_t first = text.find_first_not_of(": ");
  return first == std::string_view::npos ? std::string_view() : text.substr(first);
}

struct Kind {
  std::string_view name;  // behind the byte order
  ScalarType type;
};
constexpr Kind kKinds[] = {
    {"f8", ScalarType::kFloat64}, {"f4", ScalarType::kFloat32}, {"i1", ScalarType::kInt8},
    {"u1", ScalarType::kUint8},   {"i2", ScalarType::kInt16},   {"u2", ScalarType::kUint16},
    {"i4", ScalarType::kInt32},   {"u4", ScalarType::kUint32},  {"i8", ScalarType::kInt64},
    {"u8", ScalarType::kUint64},
};

// Reads a type such as '<f8'.
bool parse_type(std::string_view value, NpyHeader& header) {
  if (value.size() < 5 || value[0] != '\'' || value[4] != '\'') return false;
  const char order = value[1];
  for (const Kind& kind : kKinds) {
    if (value.substr(2, 2) != kind.name) continue;
    header.type = kind.type;
    header.swap = order == '>' && std::endian::native == std::endian::little;
    return order == '<' || order == '>' || order == '|' || order == '=';
  }
  return false;
}

// Reads a shape such as (10, 3). Returns false if it is none, or more rows than can be counted.
bool parse_shape(std::string_view value, NpyHeader& header) {
  if (!value.starts_with('(')) return false;
  value.remove_prefix(1);
  header.rows = 1;
  bool has_length = false;
  for (;;) {
    while (!value.empty() && (value[0] == ' ' || value[0] == ',')) value.remove_prefix(1);
    if (value.starts_with(')')) break;
    std::uint64_t length = 0;
    const auto [end, fault] = std::from_chars(value.data(), value.data() + value.size(), length);
    if (fault != std::errc() || end == value.data()) return false;
    value.remove_prefix(static_cast<std::size_t>(end - value.data()));
    if (has_length && __builtin_mul_overflow(header.rows, header.numbers, &header.rows))
      return false;
    if (length > std::numeric_limits<std::uint32_t>::max() * std::uint64_t{1024}) return false;
    header.numbers = length;
    has_length = true;
  }
  return has_length;
}

std::string_view up_to(std::string_view value, char end) {
  const std::size_t at = value.find(end);
  return at == std::string_view::npos ? value : value.substr(0, at + 1);
}

}  // namespace

bool is_npy(std::string_view front) noexcept { return front.starts_with(kMagic); }

Result<NpyHeader> parse_npy_header(std::string_view front, const RowShape& shape) {
  constexpr std::size_t kVersionAt = 6, kLengthAt = 8;
  if (front.size() < kLengthAt + 4) return damaged("is cut off");
  const auto byte = [front](std::size_t at) {
    return static_cast<std::size_t>(static_cast<unsigned char>(front[at]));
  };
  const bool is_short = byte(kVersionAt) == 1;
  if (byte(kVersionAt) == 0 || byte(kVersionAt) > 3) return damaged("has an unknown version");
  std::size_t length = byte(kLengthAt) | byte(kLengthAt + 1) << 8;
  if (!is_short) length |= byte(kLengthAt + 2) << 16 | byte(kLengthAt + 3) << 24;
  const std::size_t begin = kLengthAt + (is_short ? 2 : 4);
  if (length > front.size() - begin) return damaged("is cut off or longer than an array's");

  NpyHeader header;
  header.bytes = begin + length;
  const std::string_view text = front.substr(begin, length);
  const auto type = value_of(text, "descr"), order = value_of(text, "fortran_order"),
             lengths = value_of(text, "shape");
  if (!type || !order || !lengths) return damaged("lacks its type, order or shape");
  if (!parse_type(*type, header)) return unsuitable(shape, "the type", up_to(*type, ','));
  if (!parse_shape(*lengths, header)) return damaged("has no readable shape");
  const bool fits = header.numbers == shape.required || header.numbers == shape.count;
  if (!fits) return unsuitable(shape, "the shape", up_to(*lengths, ')'));
  if (!order->starts_with("False") && header.rows > 1)
    return unsuitable(shape, "its numbers in the order of", "Fortran");
  return header;
}

}  // namespace planetree::tools
