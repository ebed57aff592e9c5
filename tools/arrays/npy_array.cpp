#include "tools/arrays/npy_array.h"

#include <fmt/format.h>

#include <cassert>
#include <limits>
#include <string_view>

namespace planetree::tools {
namespace {

using namespace std::string_view_literals;

constexpr std::string_view kNpyBegin = "\x93NUMPY\1\0"sv;
constexpr std::size_t kNpyAlignment = 64;

std::string_view npy_type(NumberType type) {
  switch (type) {
    case NumberType::kFloat64:
      return "<f8";
    case NumberType::kInt64:
      return "<i8";
    case NumberType::kUint8:
      return "|u1";
    case NumberType::kBool:
      break;
  }
  return "|b1";
}

std::string npy_fields(const std::vector<Column>& columns) {
  std::string text;
  const auto add = [&text](const std::string& name, NumberType type) {
    text += fmt::format("('{}', '{}'), ", name, npy_type(type));
  };
  for (const Column& column : columns) {
    if (column.parts.empty()) add(column.name, column.type);
    for (const std::string& part : column.parts) add(part, column.type);
  }
  return text;
}

}  // namespace

std::string npy_header_text(const std::vector<Column>& columns, std::uint64_t rows) {
  const auto dictionary = [fields = npy_fields(columns)](std::uint64_t count) {
    return fmt::format("{{'descr': [{}], 'fortran_order': False, 'shape': ({},), }}", fields,
                       count);
  };
  // Room for any number of rows, the two bytes of the length, and the newline at the end.
  std::size_t bytes =
      kNpyBegin.size() + 2 + dictionary(std::numeric_limits<std::uint64_t>::max()).size() + 1;
  bytes = (bytes + kNpyAlignment - 1) / kNpyAlignment * kNpyAlignment;
  const std::size_t length = bytes - kNpyBegin.size() - 2;
  assert(length <= std::numeric_limits<std::uint16_t>::max());
  std::string text(kNpyBegin);
  text += static_cast<char>(length & 0xff);
  text += static_cast<char>(length >> 8);
  text += dictionary(rows);
  text.resize(bytes - 1, ' ');
  return text + '\n';
}

}  // namespace planetree::tools
