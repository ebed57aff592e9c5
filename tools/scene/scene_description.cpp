#include "tools/scene/scene_description.h"

#include <fmt/format.h>

#include <algorithm>
#include <cinttypes>
#include <cmath>
#include <initializer_list>
#include <nlohmann/json.hpp>
#include <utility>

#include "octree/builder/mesh/stream/mesh_text.h"
#include "octree/geometry/rigid_transform.h"
#include "tools/cli/input_file.h"
#include "tools/cli/layer_words.h"
#include "tools/cli/size_text.h"

namespace planetree::tools {
namespace {

// In the order of the file: models and messages follow it.
using Json = nlohmann::ordered_json;

constexpr std::size_t kMaxFileBytes = std::size_t{64} << 20;

Error bad_input(const std::string& text) {
  return make_error(ErrorCode::kBadInput, Error::kNowhere, Error::kNowhere, "%s", text.c_str());
}

// Reads one object of a scene file and remembers the first complaint.
class ObjectReader {
 public:
  /// where  such as "instances[3]", for messages; empty: the file itself
  ObjectReader(const Json& object, std::string where) : object_(object), where_(std::move(where)) {
    if (!object.is_object()) complain("is not an object");
  }

  /// Complains about keys that are not among these.
  void allow(std::initializer_list<std::string_view> keys) {
    if (!object_.is_object()) return;
    for (const auto& [key, value] : object_.items())
      if (std::find(keys.begin(), keys.end(), key) == keys.end())
        complain(
            fmt::format("has a key '{}', which the format does not know", octree::printable(key)));
  }
  /// The value of a key; null if there is none.
  const Json* find(const char* key) const {
    if (!object_.is_object()) return nullptr;
    const auto found = object_.find(key);
    return found == object_.end() ? nullptr : &*found;
  }
  const Json* require(const char* key) {
    const Json* const value = find(key);
    if (!value) complain(fmt::format("has no key '{}'", key));
    return value;
  }
  std::string text(const Json* value, const char* key) {
    if (!value) return {};
    if (value->is_string()) return value->get<std::string>();
    complain(fmt::format("has a '{}' that is not a text", key));
    return {};
  }
  /// Numbers of a fixed count; they stay as they are if there is no such key.
  void numbers(const char* key, std::initializer_list<double*> targets) {
    const Json* const value = find(key);
    if (!value) return;
    const bool is_list = value->is_array() && value->size() == targets.size();
    std::size_t i = 0;
    for (double* const target : targets) {
      if (!is_list || !(*value)[i].is_number() || !std::isfinite((*value)[i].get<double>()))
        return complain(
            fmt::format("has a '{}' that is not a list of {} finite numbers", key, targets.size()));
      *target = (*value)[i++].get<double>();
    }
  }
  void complain(const std::string& what) {
    if (complaint_.empty())
      complaint_ = fmt::format("{} {}", where_.empty() ? "the file" : where_, what);
  }
  const std::string& complaint() const { return complaint_; }

 private:
  const Json& object_;
  const std::string where_;
  std::string complaint_;
};

std::string read_model(const std::string& name, const Json& json,
                       const std::filesystem::path& folder, ModelDescription& model) {
  ObjectReader reader(json, fmt::format("models.{}", octree::printable(name)));
  reader.allow({"file", "layers"});
  model.name = name;
  const std::string file = reader.text(reader.require("file"), "file");
  if (file.empty()) reader.complain("has no file; give the path of a .ptree file");
  model.file = folder / std::filesystem::path(file);
  const Json* const layers = reader.find("layers");
  if (!layers) return reader.complaint();
  model.layers = layers->is_string() ? layers_of(layers->get<std::string>()) : 0;
  if (model.layers == 0)
    reader.complain(
        "has 'layers' that are not a list of distance, side, field and attributes, with commas");
  return reader.complaint();
}

std::string read_instance(std::size_t index, const Json& json, const SceneDescription& scene,
                          InstanceDescription& instance) {
  ObjectReader reader(json, fmt::format("instances[{}]", index));
  reader.allow({"name", "model", "rotation", "translation", "velocity", "angular_velocity"});
  instance.name = reader.text(reader.find("name"), "name");
  const std::string model = reader.text(reader.require("model"), "model");
  const auto found = std::ranges::find(scene.models, model, &ModelDescription::name);
  if (found == scene.models.end())
    reader.complain(
        fmt::format("names a model '{}', which 'models' does not have", octree::printable(model)));
  instance.model = static_cast<std::size_t>(found - scene.models.begin());
  Quaternion& q = instance.pose.rotation;
  reader.numbers("rotation", {&q.w, &q.x, &q.y, &q.z});
  const double length = std::sqrt(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z);
  if (!(length >= 1e-150 && length <= 1e150))
    reader.complain(
        "has a 'rotation' whose length is not from 1e-150 to 1e150; give a quaternion "
        "w, x, y, z");
  // People write few digits.
  if (length != 1) q = {q.w / length, q.x / length, q.y / length, q.z / length};
  Vec3 &at = instance.pose.translation, &linear = instance.twist.linear,
       &angular = instance.twist.angular;
  reader.numbers("translation", {&at.x, &at.y, &at.z});
  if (!octree::RigidTransform::is_in_range(at))
    reader.complain("has a 'translation' with coordinates above 2^500");
  reader.numbers("velocity", {&linear.x, &linear.y, &linear.z});
  reader.numbers("angular_velocity", {&angular.x, &angular.y, &angular.z});
  return reader.complaint();
}

void read_memory(ObjectReader& reader, SceneDescription& scene) {
  const Json* const memory = reader.find("memory");
  if (!memory) return;
  if (memory->is_number_unsigned()) {
    scene.memory_bytes = memory->get<std::uint64_t>();
    return;
  }
  const auto bytes = parse_bytes(memory->is_string() ? memory->get<std::string>() : std::string());
  if (bytes)
    scene.memory_bytes = *bytes;
  else
    reader.complain("has a 'memory' that is no number of bytes such as \"256M\"");
}

std::string read_description(const Json& json, const std::filesystem::path& folder,
                             SceneDescription& scene) {
  ObjectReader reader(json, "");
  reader.allow({"format", "version", "memory", "models", "instances"});
  if (reader.text(reader.require("format"), "format") != "planetree-scene")
    reader.complain("has another 'format' than planetree-scene");
  const Json* const version = reader.require("version");
  if (version && *version != 1) reader.complain("has a 'version' that is not 1");
  read_memory(reader, scene);
  const Json* const models = reader.require("models");
  const Json* const instances = reader.require("instances");
  if (models && (!models->is_object() || models->empty()))
    reader.complain("has 'models' that are not an object with at least one model");
  if (instances && (!instances->is_array() || instances->empty() ||
                    instances->size() > SceneOptions::kMaxInstances))
    reader.complain("has 'instances' that are not a list of 1 to 1048576");
  if (!reader.complaint().empty()) return reader.complaint();
  for (const auto& [name, model] : models->items()) {
    const std::string complaint = read_model(name, model, folder, scene.models.emplace_back());
    if (!complaint.empty()) return complaint;
  }
  for (std::size_t i = 0; i < instances->size(); ++i) {
    const std::string complaint =
        read_instance(i, (*instances)[i], scene, scene.instances.emplace_back());
    if (!complaint.empty()) return complaint;
  }
  return {};
}

Error not_json(std::string_view text, std::size_t offset) {
  const std::string_view before = text.substr(0, offset);
  const auto lines = static_cast<std::uint64_t>(std::ranges::count(before, '\n'));
  const std::size_t line_begin = before.rfind('\n') + 1;  // 0 in the first line
  return make_error(ErrorCode::kBadInput, Error::kNowhere, offset,
                    "line %" PRIu64
                    ", column %zu: not JSON from here on; a scene file is a JSON "
                    "object",
                    lines + 1, offset - line_begin + 1);
}

}  // namespace

Result<SceneDescription> parse_scene(std::string_view text, const std::filesystem::path& folder) {
  // A text nested deeply would exhaust the stack of the parser's destructor. Scenes have 3 levels.
  constexpr int kMaxDepth = 16;
  bool is_deep = false;
  const auto watch = [&is_deep](int depth, Json::parse_event_t, Json&) {
    is_deep |= depth > kMaxDepth;
    return !is_deep;
  };
  const auto nested_too_deeply = [] {
    return bad_input("its JSON is nested too deeply for a scene");
  };
  try {
    const Json json = Json::parse(text, watch);
    if (is_deep) return nested_too_deeply();
    SceneDescription scene;
    const std::string complaint = read_description(json, folder, scene);
    if (!complaint.empty())
      return bad_input(complaint + "; format-spec/scene-v1/spec.md lists what a scene file has");
    return scene;
  } catch (const Json::parse_error& error) {
    if (is_deep) return nested_too_deeply();
    return not_json(text, error.byte == 0 ? 0 : error.byte - 1);
  } catch (const Json::exception&) {
    return bad_input("a number of its JSON is out of range");
  }
}

Result<SceneDescription> read_scene(const std::filesystem::path& file) {
  auto input = InputFile::open(file.string());
  if (!input) return input.error();
  const auto text = input->front(kMaxFileBytes);
  if (!text) return text.error();
  if (text->size() == kMaxFileBytes)
    return bad_input("it is too large for a scene file: 64 MiB or more");
  return parse_scene(*text, file.parent_path());
}

}  // namespace planetree::tools
