#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "octree/builder/mesh/gltf/gltf_transform.h"
#include "planetree/error.h"

namespace planetree::octree {

/// Thrown within the parser of the JSON, whose library reports by exceptions too.
struct GltfFault {
  explicit GltfFault(const Error& fault) : error(fault) {}
  Error error;
};

/// An object of the JSON, with a name for messages. Its functions throw a GltfFault if a value has
/// another type than the specification says.
class GltfObject {
 public:
  /// json  must outlive this.
  GltfObject(const nlohmann::json& json, std::string name) : json_(json), name_(std::move(name)) {}

  [[nodiscard]] bool has(const char* key) const { return find(key) != nullptr; }
  [[nodiscard]] bool is_list(const char* key) const;
  [[nodiscard]] bool has_extension(const char* extension) const;

  /// An integer from 0: required, with a default, or none if the key is missing.
  [[nodiscard]] std::uint64_t count(const char* key) const;
  [[nodiscard]] std::uint64_t count_or(const char* key, std::uint64_t missing) const;
  [[nodiscard]] std::optional<std::uint64_t> number(const char* key) const;
  /// A list of integers from 0; empty if the key is missing.
  [[nodiscard]] std::vector<std::uint64_t> counts(const char* key) const;
  /// False if the key is missing.
  [[nodiscard]] bool flag(const char* key) const;
  /// Required.
  [[nodiscard]] std::string text(const char* key) const;
  /// A list of texts; empty if the key is missing.
  [[nodiscard]] std::vector<std::string> texts(const char* key) const;
  /// An object in this one; required.
  [[nodiscard]] GltfObject part(const char* key) const;
  /// That of a node: a matrix, or a translation, a rotation and a scale.
  [[nodiscard]] GltfTransform transform() const;

  /// An error that begins with the name of the object.
  [[nodiscard]] Error error(const std::string& cause) const;

 private:
  [[nodiscard]] const nlohmann::json* find(const char* key) const;
  /// Sets `values` to those of a list of as many numbers. False if the key is missing.
  template <std::size_t kCount>
  bool reals(const char* key, std::array<double, kCount>& values) const;

  const nlohmann::json& json_;
  const std::string name_;
};

}  // namespace planetree::octree
