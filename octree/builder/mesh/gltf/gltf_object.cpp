#include "octree/builder/mesh/gltf/gltf_object.h"

#include <array>
#include <cmath>

#include "octree/builder/mesh/gltf/gltf_error.h"

namespace planetree::octree {

namespace {

using Json = nlohmann::json;

/// The integer from 0 that a value is. Some programs write 3 as 3.0.
std::optional<std::uint64_t> integer_of(const Json& value) {
  constexpr double kMax = 9007199254740992.0;  // 2^53
  if (value.is_number_unsigned()) return value.get<std::uint64_t>();
  if (!value.is_number_float()) return std::nullopt;
  const auto real = value.get<double>();
  if (!(real >= 0 && real <= kMax) || real != std::floor(real)) return std::nullopt;
  return static_cast<std::uint64_t>(real);
}

}  // namespace

Error GltfObject::error(const std::string& cause) const { return gltf_error(name_ + ' ' + cause); }

const Json* GltfObject::find(const char* key) const {
  if (!json_.is_object()) throw GltfFault(error("is not an object"));
  const auto found = json_.find(key);
  return found == json_.end() ? nullptr : &*found;
}

bool GltfObject::is_list(const char* key) const {
  const Json* const value = find(key);
  return value != nullptr && value->is_array();
}

bool GltfObject::has_extension(const char* extension) const {
  const Json* const extensions = find("extensions");
  return extensions != nullptr && extensions->is_object() && extensions->contains(extension);
}

std::optional<std::uint64_t> GltfObject::number(const char* key) const {
  const Json* const value = find(key);
  if (value == nullptr) return std::nullopt;
  const std::optional<std::uint64_t> integer = integer_of(*value);
  if (!integer) throw GltfFault(error('\'' + std::string(key) + "' is not an integer from 0"));
  return integer;
}

std::uint64_t GltfObject::count(const char* key) const {
  const std::optional<std::uint64_t> value = number(key);
  if (!value) throw GltfFault(error("has no '" + std::string(key) + '\''));
  return *value;
}

std::uint64_t GltfObject::count_or(const char* key, std::uint64_t missing) const {
  return number(key).value_or(missing);
}

std::vector<std::uint64_t> GltfObject::counts(const char* key) const {
  std::vector<std::uint64_t> made;
  const Json* const value = find(key);
  if (value == nullptr) return made;
  const Error wrong = error('\'' + std::string(key) + "' is not a list of integers from 0");
  if (!value->is_array()) throw GltfFault(wrong);
  for (const Json& element : *value) {
    const std::optional<std::uint64_t> integer = integer_of(element);
    if (!integer) throw GltfFault(wrong);
    made.push_back(*integer);
  }
  return made;
}

bool GltfObject::flag(const char* key) const {
  const Json* const value = find(key);
  if (value == nullptr) return false;
  if (!value->is_boolean()) throw GltfFault(error('\'' + std::string(key) + "' is not a boolean"));
  return value->get<bool>();
}

std::string GltfObject::text(const char* key) const {
  const Json* const value = find(key);
  if (value == nullptr || !value->is_string())
    throw GltfFault(error("has no text '" + std::string(key) + '\''));
  return value->get<std::string>();
}

std::vector<std::string> GltfObject::texts(const char* key) const {
  std::vector<std::string> made;
  const Json* const value = find(key);
  if (value == nullptr || !value->is_array()) return made;
  for (const Json& element : *value)
    if (element.is_string()) made.push_back(element.get<std::string>());
  return made;
}

GltfObject GltfObject::part(const char* key) const {
  const Json* const value = find(key);
  if (value == nullptr || !value->is_object())
    throw GltfFault(error("has no object '" + std::string(key) + '\''));
  return {*value, name_ + ", '" + key + "',"};
}

template <std::size_t kCount>
bool GltfObject::reals(const char* key, std::array<double, kCount>& values) const {
  const Json* const value = find(key);
  if (value == nullptr) return false;
  const Error wrong =
      error('\'' + std::string(key) + "' is not a list of " + std::to_string(kCount) + " numbers");
  if (!value->is_array() || value->size() != kCount) throw GltfFault(wrong);
  for (std::size_t i = 0; i < kCount; ++i) {
    if (!(*value)[i].is_number()) throw GltfFault(wrong);
    values[i] = (*value)[i].get<double>();
  }
  return true;
}

GltfTransform GltfObject::transform() const {
  GltfTransform made;
  std::array<double, 16> columns = {};
  if (reals("matrix", columns)) {
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = 0; j < 4; ++j) made.rows[i][j] = columns[4 * j + i];
    if (columns[3] != 0 || columns[7] != 0 || columns[11] != 0 || columns[15] != 1)
      throw GltfFault(error("has a 'matrix' that is not affine"));
  } else {
    std::array<double, 3> translation = {0, 0, 0}, scale = {1, 1, 1};
    std::array<double, 4> rotation = {0, 0, 0, 1};
    const bool is_moved = reals("translation", translation);
    const bool is_turned = reals("rotation", rotation);
    const bool is_scaled = reals("scale", scale);
    if (is_moved || is_turned || is_scaled)
      made = transform_of({translation[0], translation[1], translation[2]}, rotation,
                          {scale[0], scale[1], scale[2]});
  }
  if (!made.is_finite()) throw GltfFault(error("has a transform that is not finite"));
  return made;
}

}  // namespace planetree::octree
