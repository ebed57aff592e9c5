#include "tools/cli/attribute_option.h"

#include <fmt/format.h>

#include <array>

#include "octree/builder/mesh/stream/mesh_text.h"
#include "tools/cli/word_mask.h"

namespace planetree::tools {
namespace {

constexpr std::array<WordBit, 4> kWords = {
    {{"triangles", kKeepTriangles}, {"color", kKeepColor}, {"uv", kKeepUv}, {"value", kKeepValue}}};

std::string complaint_of(const std::string& text) {
  if (attributes_of(text) != 0) return {};
  return fmt::format(
      "'{}' is not a list of attributes; give triangles, color, uv, value or several of them, with "
      "commas",
      octree::printable(text));
}

}  // namespace

std::uint32_t attributes_of(const std::string& text) { return bits_of_words(text, kWords); }

std::vector<std::string> attribute_words(std::uint32_t attributes) {
  return words_of_bits(attributes, kWords);
}

std::string value_kind_text(ValueKind kind) {
  if (kind == ValueKind::kReal) return "real";
  return kind == ValueKind::kSigned ? "signed" : "unsigned";
}

std::string KeepOptions::complaint(std::uint32_t kept) const {
  if (!SubcommandOptions::given(value) || (kept & kKeepValue) != 0) return {};
  return SubcommandOptions::given(keep)
             ? "--value names what --keep value keeps; add value to --keep, or omit --value"
             : "--value names what --keep value keeps; add --keep value, or omit --value";
}

KeepOptions add_keep(SubcommandOptions& subcommand, std::uint32_t& keep,
                     std::string& value_property) {
  KeepOptions options{};
  options.keep = subcommand.text(
      "--keep", "ATTRIBUTES", complaint_of,
      [&keep](const std::string& text) { keep = attributes_of(text); },
      "Keep attributes of triangles in the file, which `query --attributes` and Model::triangle() "
      "read: triangles (corners by index; all others include it), color (of the vertices), uv "
      "(texture coordinates), value (8 bytes a triangle), with commas between them. A mesh without "
      "one of them is refused");
  options.value = subcommand.default_text(
      subcommand.text(
          "--value", "PROPERTY",
          [](const std::string& text) { return text.empty() ? "give the name of a property" : ""; },
          [&value_property](const std::string& text) { value_property = text; },
          "The property of a PLY's faces whose values --keep value keeps"),
      "value");
  return options;
}

}  // namespace planetree::tools
