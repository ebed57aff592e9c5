#include "octree/builder/mesh/gltf/gltf_reader.h"

#include <algorithm>
#include <optional>
#include <string>
#include <utility>

#include "octree/builder/mesh/gltf/gltf_arrays.h"
#include "octree/builder/mesh/gltf/gltf_attributes.h"
#include "octree/builder/mesh/gltf/gltf_buffers.h"
#include "octree/builder/mesh/gltf/gltf_error.h"
#include "octree/builder/mesh/gltf/gltf_faces.h"
#include "octree/builder/mesh/gltf/gltf_parser.h"
#include "octree/builder/mesh/gltf/gltf_scene.h"
#include "octree/builder/mesh/gltf/gltf_vertices.h"
#include "octree/builder/mesh/stream/attribute_names.h"
#include "octree/builder/mesh/stream/face_vertex_join.h"
#include "octree/builder/mesh/stream/fan_emitter.h"
#include "octree/builder/mesh/stream/mesh_note.h"

namespace planetree::octree {

namespace {

/// A cache of vertices reads blocks of this order.
constexpr std::size_t kVertexWindowBytes = std::size_t{32} << 10;
/// More work than any file has, so that sums of what a damaged file declares do not overflow.
constexpr std::uint64_t kMaxWork = std::uint64_t{1} << 56;

/// A glTF without the bytes of its buffers.
struct GltfOutline {
  GltfParts parts;
  GltfDocument document;
  GltfScene scene;

  static Result<GltfOutline> read(const MeshFile& file) {
    GltfOutline outline;
    const auto parts = find_gltf_parts(file);
    if (!parts) return parts.error();
    outline.parts = *parts;
    auto document = parse_gltf(file, *parts);
    if (!document) return document.error();
    outline.document = std::move(*document);
    auto scene = place_meshes(outline.document);
    if (!scene) return scene.error();
    outline.scene = std::move(*scene);
    return outline;
  }

  /// Calls take(placement, number of the primitive) for each primitive of the scene, until it
  /// returns an error.
  template <class Take>
  Result<void> each_primitive(const Take& take) const {
    for (const GltfPlacement& placement : scene.placements) {
      const GltfSlice& slice = document.meshes[placement.mesh];
      for (std::uint64_t i = 0; i < slice.count; ++i)
        if (const auto taken = take(placement, slice.first + i); !taken) return taken;
    }
    return {};
  }

  /// The accessor of a number; null if there is none.
  [[nodiscard]] const GltfAccessor* accessor(const std::optional<std::uint64_t>& number) const {
    return number && *number < document.accessors.size() ? &document.accessors[*number] : nullptr;
  }
  [[nodiscard]] std::uint64_t corners_of(const GltfPrimitive& primitive) const {
    const GltfAccessor* const named =
        accessor(primitive.indices ? primitive.indices : primitive.positions);
    return named == nullptr ? 0 : std::min(named->count, kMaxWork);
  }
};

bool has_triangles(const GltfPrimitive& primitive) {
  return primitive.mode >= static_cast<unsigned>(GltfMode::kTriangles) &&
         primitive.mode <= static_cast<unsigned>(GltfMode::kFan);
}

class GltfReader {
 public:
  GltfReader(const MeshFile& file, const std::filesystem::path& path, const GltfOutline& outline,
             TriangleSink& sink, MeshScratch& scratch, std::uint32_t keep)
      : outline_(outline),
        scratch_(scratch),
        buffers_(file, path, outline.parts, outline.document, scratch),
        arrays_(outline.document, buffers_),
        emitter_(sink, RecordKind::kFace, work_of(outline)) {
    emitter_.set_keep(keep);
  }

  Result<MeshSummary> run() {
    if (const auto found = expect_attributes(); !found) return found.error();
    const auto read =
        outline_.each_primitive([this](const GltfPlacement& placement, std::uint64_t number) {
          return take(placement, outline_.document.primitives[number]);
        });
    if (!read) return read.error();
    emitter_.set_vertex_count(vertex_count_);
    Result<MeshSummary> summary = emitter_.finish(float32_);
    if (summary) summary->notes = notes();
    return summary;
  }

 private:
  /// Bytes of all indices; see GltfFaces::work_bytes().
  static std::uint64_t work_of(const GltfOutline& outline) {
    std::uint64_t work = 0;
    (void)outline.each_primitive([&](const GltfPlacement&, std::uint64_t number) -> Result<void> {
      const GltfPrimitive& primitive = outline.document.primitives[number];
      if (!has_triangles(primitive)) return {};
      const GltfAccessor* const indices = outline.accessor(primitive.indices);
      const ScalarType type = indices == nullptr ? ScalarType::kUint32 : indices->elements.type;
      work = std::min(work + outline.corners_of(primitive) * size_bytes(type), kMaxWork);
      return {};
    });
    return work;
  }

  [[nodiscard]] bool keeps(std::uint32_t attribute) const {
    return (emitter_.keep() & attribute) != 0;
  }

  /// Refuses a scene of which no primitive has an attribute that is kept.
  [[nodiscard]] Result<void> expect_attributes() const {
    bool has_colors = false, has_uvs = false;
    (void)outline_.each_primitive([&](const GltfPlacement&, std::uint64_t number) -> Result<void> {
      const GltfPrimitive& primitive = outline_.document.primitives[number];
      if (!has_triangles(primitive) || !primitive.positions) return {};
      has_colors |= primitive.colors.has_value();
      has_uvs |= primitive.uvs.has_value();
      return {};
    });
    if (keeps(kKeepColor) && !has_colors)
      return missing_attribute(kKeepColor, "no primitive with 'COLOR_0'");
    if (keeps(kKeepUv) && !has_uvs)
      return missing_attribute(kKeepUv, "no primitive with 'TEXCOORD_0'");
    return {};
  }

  /// Finds the attributes of a primitive, and counts those it lacks.
  Result<GltfAttributes> attributes_of(const GltfPrimitive& primitive, std::uint64_t vertices) {
    GltfAttributes attributes;
    attributes.keep = emitter_.keep() & kCornerAttributes;
    if (keeps(kKeepColor)) {
      if (primitive.colors) {
        const auto found = arrays_.colors(*primitive.colors, vertices);
        if (!found) return found.error();
        attributes.colors = *found;
      } else {
        ++without_colors_;
      }
    }
    if (keeps(kKeepUv)) {
      if (primitive.uvs) {
        const auto found = arrays_.uvs(*primitive.uvs, vertices);
        if (!found) return found.error();
        attributes.uvs = *found;
      } else {
        ++without_uvs_;
      }
    }
    return attributes;
  }

  Result<void> take(const GltfPlacement& placement, const GltfPrimitive& primitive) {
    if (!has_triangles(primitive)) {
      if (primitive.mode > static_cast<unsigned>(GltfMode::kFan))
        return gltf_error("a primitive of an unknown 'mode'");
      ++without_triangles_;
      return {};
    }
    if (!primitive.positions) {
      ++without_positions_;
      return {};
    }
    if (primitive.is_draco && !has_data(primitive))
      return gltf_error("a primitive is compressed by Draco (KHR_draco_mesh_compression)",
                        "export it without compression");
    if (primitive.has_targets) ++morphed_;
    const auto positions = arrays_.positions(*primitive.positions);
    if (!positions) return positions.error();
    std::optional<GltfSequence> indices;
    if (primitive.indices) {
      const auto found = arrays_.indices(*primitive.indices);
      if (!found) return found.error();
      indices = *found;
    }
    const auto attributes = attributes_of(primitive, positions->base.count);
    if (!attributes) return attributes.error();
    GltfVertices vertices(*positions, *attributes, placement.transform, kVertexWindowBytes);
    GltfFaces faces(indices, vertices.count(), static_cast<GltfMode>(primitive.mode),
                    placement.transform.mirrors(), scratch_.window_bytes());
    return deliver(vertices, faces);
  }

  /// Whether a primitive is also there without compression.
  [[nodiscard]] bool has_data(const GltfPrimitive& primitive) const {
    const GltfAccessor* const positions = outline_.accessor(primitive.positions);
    return positions != nullptr && positions->elements.view.has_value();
  }

  Result<void> deliver(GltfVertices& vertices, GltfFaces& faces) {
    emitter_.set_vertex_count(vertices.count());
    vertex_count_ += vertices.count();
    float32_ &= vertices.float32();
    rest_ += faces.rest();
    FaceVertexJoin join(vertices, 0, scratch_, false, emitter_);
    const FacePosition begin{{work_, 0}, record_, 0};
    const auto end = join.deliver(begin, work_ + faces.work_bytes(),
                                  [&](const FacePosition& from, const auto& next) {
                                    return faces.each(from, work_, emitter_, next);
                                  });
    if (!end) return end.error();
    left_out_ += faces.count() - (end->record - record_);
    record_ = end->record;
    work_ += faces.work_bytes();
    return {};
  }

  [[nodiscard]] std::vector<std::string> notes() const {
    std::vector<std::string> notes = outline_.scene.notes;
    const auto add = [&notes](std::uint64_t count, const std::string& what, const char* text) {
      if (count > 0) notes.push_back(counted(count, what) + text);
    };
    const std::uint64_t scenes = outline_.document.scenes.size();
    add(outline_.parts.surplus, "byte", " behind the end of the GLB not read");
    add(scenes - std::min<std::uint64_t>(1, scenes), "other scene", " not read");
    add(without_triangles_, "primitive", " of points or lines not read");
    add(without_positions_, "primitive", " without positions not read");
    add(morphed_, "primitive", " with morph targets read without them");
    add(without_colors_, "primitive", " without 'COLOR_0' read as white");
    add(without_uvs_, "primitive", " without 'TEXCOORD_0' read with zeros");
    add(left_out_, "triangle", " of strips and fans with two equal vertices left out");
    add(rest_, "corner", " behind the last triangle of a primitive not read");
    return notes;
  }

  const GltfOutline& outline_;
  MeshScratch& scratch_;
  GltfBuffers buffers_;
  GltfArrays arrays_;
  FanEmitter emitter_;
  std::uint64_t work_ = 0, record_ = 0, vertex_count_ = 0;
  bool float32_ = true;
  std::uint64_t without_triangles_ = 0, without_positions_ = 0, morphed_ = 0;  ///< primitives
  std::uint64_t without_colors_ = 0, without_uvs_ = 0;
  std::uint64_t left_out_ = 0, rest_ = 0;
};

}  // namespace

Result<MeshSummary> read_gltf(const MeshFile& file, const std::filesystem::path& path,
                              TriangleSink& sink, MeshScratch& scratch, std::uint32_t keep) {
  if (const auto refused = refuse_attributes("a glTF", keep & kKeepValue); !refused)
    return refused.error();
  const auto outline = GltfOutline::read(file);
  if (!outline) return outline.error();
  return GltfReader(file, path, *outline, sink, scratch, keep).run();
}

Result<GltfSize> size_of_gltf(const MeshFile& file) {
  const auto outline = GltfOutline::read(file);
  if (!outline) return outline.error();
  GltfSize size;
  (void)outline->each_primitive(
      [&](const GltfPlacement& placement, std::uint64_t number) -> Result<void> {
        const GltfPrimitive& primitive = outline->document.primitives[number];
        const GltfAccessor* const positions = outline->accessor(primitive.positions);
        if (!has_triangles(primitive) || positions == nullptr) return {};
        const std::uint64_t corners = outline->corners_of(primitive);
        const bool is_list = primitive.mode == static_cast<unsigned>(GltfMode::kTriangles);
        size.triangles = std::min(size.triangles + (is_list ? corners / 3 : corners), kMaxWork);
        size.vertices = std::min(size.vertices + std::min(positions->count, kMaxWork), kMaxWork);
        size.float64 |=
            !fits_float32(positions->elements.type, positions->is_normalized, placement.transform);
        return {};
      });
  for (const GltfBuffer& buffer : outline->document.buffers)
    if (buffer.embedded && *buffer.embedded < outline->document.embedded.size())
      size.embedded_bytes += outline->document.embedded[*buffer.embedded].bytes() / 4 * 3;
  return size;
}

Result<std::vector<std::filesystem::path>> files_of_gltf(const MeshFile& file,
                                                         const std::filesystem::path& path) {
  const auto outline = GltfOutline::read(file);
  if (!outline) return outline.error();
  std::vector<std::filesystem::path> files;
  for (const GltfBuffer& buffer : outline->document.buffers) {
    if (!buffer.uri) continue;
    const auto named = gltf_buffer_path(path, *buffer.uri);
    if (!named) return named.error();
    files.push_back(*named);
  }
  return files;
}

}  // namespace planetree::octree
