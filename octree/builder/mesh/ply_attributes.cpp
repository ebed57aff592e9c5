#include "octree/builder/mesh/ply_attributes.h"

#include <bit>
#include <string_view>
#include <utility>

#include "octree/builder/mesh/stream/attribute_names.h"

namespace planetree::octree {

namespace {

using ColorNames = std::array<std::string_view, 4>;
using UvNames = std::array<std::string_view, 2>;

/// Names of the channels of a colour, the preferred ones first.
constexpr ColorNames kColorNames[] = {
    {"red", "green", "blue", "alpha"},
    {"diffuse_red", "diffuse_green", "diffuse_blue", "diffuse_alpha"},
    {"r", "g", "b", "a"}};
constexpr UvNames kUvNames[] = {
    {"u", "v"}, {"s", "t"}, {"texture_u", "texture_v"}, {"texture_s", "texture_t"}};

/// The number of a name; none if there is no such property, or it is a list.
std::optional<std::size_t> find_number(const PlyElement& element, std::string_view name) {
  for (std::size_t i = 0; i < element.properties.size(); ++i)
    if (element.properties[i].name == name && !element.properties[i].is_list) return i;
  return std::nullopt;
}

/// Appends the properties of the first group of names that an element has. The names from
/// `required` on may be missing.
template <class Group>
bool find_numbers(const PlyElement& element, std::span<const Group> groups, std::size_t required,
                  std::vector<std::size_t>& properties) {
  for (const Group& group : groups) {
    std::vector<std::size_t> found;
    bool is_there = true;
    for (std::size_t i = 0; i < group.size(); ++i) {
      if (const auto number = find_number(element, group[i]))
        found.push_back(*number);
      else
        is_there = is_there && i >= required;
    }
    if (!is_there) continue;
    properties.insert(properties.end(), found.begin(), found.end());
    return true;
  }
  return false;
}

/// The list of texture coordinates of a face.
std::optional<std::size_t> find_uv_list(const PlyElement& element) {
  for (std::size_t i = 0; i < element.properties.size(); ++i)
    if (element.properties[i].name == "texcoord" && element.properties[i].is_list) return i;
  return std::nullopt;
}

/// The names of the properties that are single numbers, `first` in front, with commas. At least one
/// is listed, and then as many as `most` characters hold. The others are counted.
std::string listed_numbers(const PlyElement& element, const std::string& first, std::size_t most) {
  std::vector<std::string> names;
  for (const PlyProperty& property : element.properties) {
    if (property.is_list) continue;
    names.insert(property.name == first ? names.begin() : names.end(), printable(property.name));
  }
  if (names.empty()) return "none";
  std::string text = names.front();
  std::size_t i = 1;
  for (; i < names.size() && text.size() + 2 + names[i].size() <= most; ++i)
    text += ", " + names[i];
  return i < names.size() ? text + " and " + std::to_string(names.size() - i) + " more" : text;
}

/// The error of a PLY whose faces have no number of this name. What there is fits in its text.
Error missing_value(const PlyHeader& header, const std::string& name) {
  constexpr std::size_t kMaxOfFaces = 32, kMaxOfVertices = 20;
  const std::string faces = listed_numbers(header.faces(), name, kMaxOfFaces);
  return make_error(
      ErrorCode::kBadInput, Error::kNowhere, Error::kNowhere,
      "no face property '%s'; faces have %s; vertices have %s; %s", printable(name).c_str(),
      faces.c_str(), listed_numbers(header.vertices(), name, kMaxOfVertices).c_str(),
      faces == "none" ? "build the mesh without --keep value" : "name one of faces by --value");
}

class AttributeFinder {
 public:
  explicit AttributeFinder(const PlyHeader& header) : header_(header) {}

  Result<void> find_color() {
    constexpr std::size_t kChannels = 3;
    const std::span<const ColorNames> names(kColorNames);
    if (find_numbers(header_.vertices(), names, kChannels, found_.vertex_numbers)) {
      found_.of_vertices |= kKeepColor;
      return {};
    }
    if (!header_.has_strips && find_numbers(header_.faces(), names, kChannels, found_.face_color))
      return {};
    return missing_attribute(kKeepColor,
                             "no vertex or face property 'red', 'green', 'blue', nor "
                             "'diffuse_red' and so on, nor 'r', 'g', 'b'");
  }

  Result<void> find_uv() {
    if (find_numbers(header_.vertices(), std::span<const UvNames>(kUvNames), 2,
                     found_.vertex_numbers)) {
      found_.of_vertices |= kKeepUv;
      return {};
    }
    if (!header_.has_strips) found_.face_uvs = find_uv_list(header_.faces());
    if (found_.face_uvs) return {};
    return missing_attribute(kKeepUv,
                             "no vertex property 'u', 'v', nor 's', 't', 'texture_u' or "
                             "'texture_s', and no face list 'texcoord'");
  }

  Result<void> find_value(const std::string& name) {
    if (header_.has_strips) return missing_attribute(kKeepValue, "triangle strips have none");
    found_.value = find_number(header_.faces(), name);
    if (!found_.value) return missing_value(header_, name);
    found_.value_kind = kind_of(header_.faces().properties[*found_.value].type);
    return {};
  }

  PlyAttributes take(std::uint32_t keep) {
    found_.keep = keep;
    return std::move(found_);
  }

 private:
  const PlyHeader& header_;
  PlyAttributes found_;
};

std::uint8_t channel_of(ScalarType type, double number) {
  constexpr double kPerByte = 257;  // 65535 / 255
  if (!is_integer(type)) return to_channel(number * 255);
  return to_channel(type == ScalarType::kUint16 ? number / kPerByte : number);
}

}  // namespace

Result<PlyAttributes> find_attributes(const PlyHeader& header, std::uint32_t keep,
                                      const std::string& value_property) {
  AttributeFinder finder(header);
  Result<void> found;
  if ((keep & kKeepColor) != 0) found = finder.find_color();
  if (found && (keep & kKeepUv) != 0) found = finder.find_uv();
  if (found && (keep & kKeepValue) != 0) found = finder.find_value(value_property);
  if (!found) return found.error();
  return finder.take(keep & kMeshAttributes);
}

Color color_of(const PlyElement& element, std::span<const std::size_t> properties,
               std::span<const double> numbers) {
  Color color;
  std::uint8_t* const channels[] = {&color.red, &color.green, &color.blue, &color.alpha};
  for (std::size_t i = 0; i < properties.size(); ++i)
    *channels[i] = channel_of(element.properties[properties[i]].type, numbers[i]);
  return color;
}

CornerAttributes vertex_attributes(const PlyHeader& header, const PlyAttributes& attributes,
                                   std::span<const double> numbers) {
  CornerAttributes made;
  const bool has_uv = (attributes.of_vertices & kKeepUv) != 0;
  const std::size_t channels = numbers.size() - (has_uv ? 2 : 0);
  if ((attributes.of_vertices & kKeepColor) != 0)
    made.color = color_of(header.vertices(), std::span(attributes.vertex_numbers).first(channels),
                          numbers.first(channels));
  if (has_uv)
    made.uv = {static_cast<float>(numbers[channels]), static_cast<float>(numbers[channels + 1])};
  return made;
}

ValueKind kind_of(ScalarType type) {
  switch (type) {
    case ScalarType::kUint8:
    case ScalarType::kUint16:
    case ScalarType::kUint32:
    case ScalarType::kUint64:
      return ValueKind::kUnsigned;
    case ScalarType::kFloat32:
    case ScalarType::kFloat64:
      return ValueKind::kReal;
    default:
      return ValueKind::kSigned;
  }
}

std::uint64_t load_value(ScalarType type, const std::byte* at, bool swap) {
  if (!is_integer(type)) return std::bit_cast<std::uint64_t>(load_real(type, at, swap));
  if (type == ScalarType::kUint64) return load<std::uint64_t>(at, swap);
  return std::bit_cast<std::uint64_t>(load_integer(type, at, swap));
}

void add_uv_note(const RecordNote& wrong, std::vector<std::string>& notes) {
  if (!wrong) return;
  notes.push_back(counted(wrong.count(), "face") +
                  " whose 'texcoord' has not two numbers for each corner, the first face " +
                  std::to_string(wrong.first()) + ", taken with zeros");
}

}  // namespace planetree::octree
