#include "octree/builder/mesh/gltf/gltf_parser.h"

#include <algorithm>
#include <string>
#include <string_view>
#include <utility>

#include "octree/builder/mesh/gltf/gltf_error.h"
#include "octree/builder/mesh/gltf/gltf_extensions.h"
#include "octree/builder/mesh/gltf/gltf_object.h"
#include "octree/builder/mesh/gltf/gltf_text.h"
#include "octree/builder/mesh/stream/mesh_text.h"

namespace planetree::octree {

namespace {

using Json = nlohmann::json;

/// Number of records of all kinds, so that a small file cannot take much memory.
constexpr std::uint64_t kMaxRecords = std::uint64_t{1} << 20;

/// Makes the document of the values of the JSON as they are complete. The callback of nlohmann-json
/// gets each value with its depth, and drops it if that returns false: so only one record is in
/// memory as JSON.
class GltfParser {
 public:
  explicit GltfParser(GltfText& text) : text_(text) {}

  GltfDocument parse() {
    const Json rest = Json::parse(GltfText::Iterator(text_), GltfText::Iterator(),
                                  [this](int depth, Json::parse_event_t event, Json& value) {
                                    return take(depth, event, value);
                                  });
    finish(rest);
    return std::move(document_);
  }

 private:
  /// Depth of values: the document is at 0, its lists at 1, their records at 2.
  static constexpr int kListDepth = 1, kRecordDepth = 2, kPartDepth = 4;

  using Take = void (GltfParser::*)(const GltfObject& object);
  struct List {
    std::string_view name;
    std::string_view record;  ///< what a record is called
    Take take;
  };
  static constexpr std::string_view kPlainKeys[] = {"asset", "scene", "extensionsRequired"};

  static const List* list_named(std::string_view name) {
    static constexpr List kLists[] = {{"buffers", "buffer", &GltfParser::take_buffer},
                                      {"bufferViews", "bufferView", &GltfParser::take_view},
                                      {"accessors", "accessor", &GltfParser::take_accessor},
                                      {"meshes", "mesh", &GltfParser::take_mesh},
                                      {"nodes", "node", &GltfParser::take_node},
                                      {"scenes", "scene", &GltfParser::take_scene}};
    const auto* const found = std::ranges::find(kLists, name, &List::name);
    return found == std::end(kLists) ? nullptr : found;
  }

  bool take(int depth, Json::parse_event_t event, Json& value) {
    switch (event) {
      case Json::parse_event_t::key:
        return take_key(depth, value.get_ref<const std::string&>());
      case Json::parse_event_t::object_end:
        return !take_record(depth, value);
      case Json::parse_event_t::value:
      case Json::parse_event_t::array_end:
        if (depth == kRecordDepth && list_ != nullptr) refuse_record();
        if (depth == kPartDepth && is_primitive()) refuse_record();
        return true;
      default:
        return true;
    }
  }

  /// Returns whether the value of the key is needed.
  bool take_key(int depth, const std::string& key) {
    if (depth == kListDepth) {
      list_ = list_named(key);
      record_number_ = 0;
      return list_ != nullptr || std::ranges::find(kPlainKeys, key) != std::end(kPlainKeys);
    }
    if (depth == kRecordDepth + 1) is_in_primitives_ = key == "primitives";
    return key != "extras";
  }

  /// Takes an object that is a record, or a primitive within one. False if it is part of another.
  bool take_record(int depth, const Json& value) {
    if (list_ == nullptr) return false;
    if (depth == kListDepth) throw GltfFault(gltf_error(quoted(list_->name) + " is not a list"));
    if (depth == kPartDepth && is_primitive()) {
      take_primitive(GltfObject(value, "a primitive of mesh " + std::to_string(record_number_)));
      return true;
    }
    if (depth != kRecordDepth) return false;
    count_records(1);
    (this->*list_->take)(
        GltfObject(value, std::string(list_->record) + ' ' + std::to_string(record_number_)));
    ++record_number_;
    return true;
  }

  /// Whether a value at the depth of parts is a primitive.
  [[nodiscard]] bool is_primitive() const {
    return is_in_primitives_ && list_ != nullptr && list_->name == "meshes";
  }

  [[noreturn]] void refuse_record() const {
    throw GltfFault(gltf_error(std::string(list_->record) + ' ' + std::to_string(record_number_) +
                               ", or a part of it, is not an object"));
  }

  void count_records(std::uint64_t count) {
    records_ += count;
    if (records_ > kMaxRecords)
      throw GltfFault(gltf_error("more than 1048576 nodes, meshes, accessors and references",
                                 "join meshes before you export it"));
  }

  void take_buffer(const GltfObject& object) {
    GltfBuffer buffer;
    buffer.bytes = object.count("byteLength");
    buffer.is_fallback = has_meshopt(object);
    if (object.has("uri")) {
      std::string uri = object.text("uri");
      if (uri.starts_with("data:")) {
        buffer.embedded = embedded_number(object, uri);
      } else {
        buffer.uri = std::move(uri);
      }
    }
    document_.buffers.push_back(std::move(buffer));
  }

  /// The number that GltfText put in place of the data.
  static std::uint64_t embedded_number(const GltfObject& object, std::string_view uri) {
    std::string_view number = uri.substr(std::min(uri.size(), uri.find(',') + 1));
    std::int64_t value = 0;
    if (uri.find(";base64,") == std::string_view::npos || !take_integer(number, value))
      throw GltfFault(object.error("embeds data that is not in base64"));
    return static_cast<std::uint64_t>(value);
  }

  void take_view(const GltfObject& object) {
    document_.views.push_back({object.count("buffer"), object.count_or("byteOffset", 0),
                               object.count("byteLength"), object.count_or("byteStride", 0),
                               has_meshopt(object)});
  }

  void take_accessor(const GltfObject& object) {
    GltfAccessor accessor;
    accessor.elements = elements_of(object, object.number("bufferView"));
    accessor.count = object.count("count");
    const std::string type = object.text("type");
    accessor.width = type == "SCALAR" ? 1
                     : type == "VEC2" ? 2
                     : type == "VEC3" ? 3
                     : type == "VEC4" ? 4
                                      : 0;
    accessor.is_normalized = object.flag("normalized");
    if (object.has("sparse")) {
      const GltfObject sparse = object.part("sparse");
      const GltfObject indices = sparse.part("indices"), values = sparse.part("values");
      accessor.sparse_count = sparse.count("count");
      accessor.sparse_indices = elements_of(indices, indices.count("bufferView"));
      accessor.sparse_values = {values.count("bufferView"), values.count_or("byteOffset", 0),
                                accessor.elements.type};
    }
    document_.accessors.push_back(accessor);
  }

  static GltfElements elements_of(const GltfObject& object, std::optional<std::uint64_t> view) {
    GltfElements elements{view, object.count_or("byteOffset", 0), ScalarType::kFloat32};
    switch (object.count("componentType")) {
      case 5120:
        elements.type = ScalarType::kInt8;
        break;
      case 5121:
        elements.type = ScalarType::kUint8;
        break;
      case 5122:
        elements.type = ScalarType::kInt16;
        break;
      case 5123:
        elements.type = ScalarType::kUint16;
        break;
      case 5125:
        elements.type = ScalarType::kUint32;
        break;
      case 5126:
        break;
      default:
        throw GltfFault(object.error("has an unknown 'componentType'"));
    }
    return elements;
  }

  void take_primitive(const GltfObject& object) {
    count_records(1);
    GltfPrimitive primitive;
    primitive.mode = static_cast<unsigned>(std::min<std::uint64_t>(object.count_or("mode", 4), 7));
    primitive.indices = object.number("indices");
    const GltfObject attributes = object.part("attributes");
    primitive.positions = attributes.number("POSITION");
    primitive.colors = attributes.number("COLOR_0");
    primitive.uvs = attributes.number("TEXCOORD_0");
    primitive.has_targets = object.has("targets");
    primitive.is_draco = object.has_extension(kDraco);
    document_.primitives.push_back(primitive);
  }

  void take_mesh(const GltfObject& object) {
    if (!object.is_list("primitives")) throw GltfFault(object.error("has no list of 'primitives'"));
    const std::uint64_t end = document_.primitives.size();
    document_.meshes.push_back({primitives_taken_, end - primitives_taken_});
    primitives_taken_ = end;
  }

  void take_node(const GltfObject& object) {
    GltfNode node;
    node.local = object.transform();
    node.mesh = object.number("mesh");
    node.children = take_links(object, "children");
    node.has_skin = object.has("skin");
    node.has_instances = object.has_extension(kInstancing);
    document_.nodes.push_back(node);
  }

  void take_scene(const GltfObject& object) {
    document_.scenes.push_back(take_links(object, "nodes"));
  }

  GltfSlice take_links(const GltfObject& object, const char* key) {
    const std::vector<std::uint64_t> links = object.counts(key);
    count_records(links.size());
    const GltfSlice slice{document_.links.size(), links.size()};
    document_.links.insert(document_.links.end(), links.begin(), links.end());
    return slice;
  }

  /// What is at the depth of the lists and is none, when all is read.
  void finish(const Json& rest) {
    const GltfObject root(rest, "the document");
    const GltfObject asset = root.part("asset");
    const std::string version = asset.text("version");
    if (!version.starts_with("2."))
      throw GltfFault(gltf_error("a glTF of version '" + printable(version) + "', not 2",
                                 "export it as glTF 2.0"));
    for (const char* name : {"buffers", "bufferViews", "accessors", "meshes", "nodes", "scenes"})
      if (root.has(name) && !root.is_list(name))
        throw GltfFault(gltf_error(quoted(name) + " is not a list"));
    document_.scene = root.number("scene");
    document_.embedded = text_.embedded();
    check_extensions(root);
  }

  static std::string quoted(std::string_view name) { return '\'' + std::string(name) + '\''; }

  GltfText& text_;
  GltfDocument document_;
  const List* list_ = nullptr;  ///< that is read
  std::uint64_t record_number_ = 0;
  bool is_in_primitives_ = false;
  std::uint64_t primitives_taken_ = 0;
  std::uint64_t records_ = 0;
};

}  // namespace

Result<GltfDocument> parse_gltf(const MeshFile& file, const GltfParts& parts) {
  GltfText text(file, parts.json);
  try {
    return GltfParser(text).parse();
  } catch (const GltfFault& fault) {
    return fault.error;
  } catch (const Json::exception&) {
    // Other kinds than damaged JSON are prevented by GltfObject.
    if (text.failure()) return *text.failure();
    return gltf_error_at(text.offset(), "the JSON is damaged or ends here");
  }
}

}  // namespace planetree::octree
