#include <cinttypes>
#include <cstdint>
#include <string>
#include <vector>

#include "octree/builder/mesh/stl_reader.h"
#include "octree/builder/mesh/stream/fan_emitter.h"
#include "octree/builder/mesh/stream/mesh_lines.h"
#include "octree/builder/mesh/stream/mesh_text.h"

namespace planetree::octree {

namespace {

/// Reads line by line. The keywords that a line may have depend on the depth:
///   kFile  -> solid -> kSolid -> facet -> kFacet -> outer loop -> kLoop
/// endsolid, endfacet and endloop lead back. A file that ends at another depth than kFile was cut
/// off.
class StlAscii {
 public:
  StlAscii(const MeshFile& file, TriangleSink& sink)
      : lines_(file, {}), emitter_(sink, RecordKind::kFacet, file.size_bytes()) {}

  Result<MeshSummary> read() {
    while (lines_.next_filled()) {
      if (Result<void> taken = take_line(); !taken) return taken.error();
      if (const auto told = emitter_.advance(lines_.after().offset); !told) return told.error();
    }
    if (lines_.failure()) return *lines_.failure();
    if (depth_ != Depth::kFile) {
      return error_at(lines_.after(), "the file ends in front of 'endsolid': it is truncated");
    }
    emitter_.set_vertex_count(vertex_count_);
    return emitter_.finish(false);
  }

 private:
  enum class Depth { kFile, kSolid, kFacet, kLoop };

  Result<void> take_line() {
    std::string_view rest = lines_.line();
    const std::string_view keyword = take_word(rest);
    switch (depth_) {
      case Depth::kFile:
        if (is_same_word(keyword, "solid")) return enter(Depth::kSolid);
        break;
      case Depth::kSolid:
        if (is_same_word(keyword, "facet")) return begin_facet();
        if (is_same_word(keyword, "endsolid")) return enter(Depth::kFile);
        break;
      case Depth::kFacet:
        if (is_same_word(keyword, "outer")) return begin_loop();
        if (is_same_word(keyword, "endfacet")) return end_facet();
        break;
      case Depth::kLoop:
        if (is_same_word(keyword, "vertex")) return take_vertex(rest);
        if (is_same_word(keyword, "endloop")) return enter(Depth::kFacet);
        break;
    }
    return error("'" + printable(keyword) + "' is not expected here");
  }

  Result<void> enter(Depth depth) {
    depth_ = depth;
    return {};
  }

  Result<void> begin_facet() {
    corners_.clear();
    has_loop_ = false;
    return enter(Depth::kFacet);
  }

  Result<void> begin_loop() {
    // The corners of two loops are not one polygon.
    if (has_loop_) return error("a facet with a second loop");
    has_loop_ = true;
    return enter(Depth::kLoop);
  }

  Result<void> take_vertex(std::string_view rest) {
    Vec3 position;
    for (double* value : {&position.x, &position.y, &position.z}) {
      const std::string_view word = take_word(rest);
      if (word.empty()) return error("a vertex of fewer than three numbers");
      if (!parse_real(word, *value)) return error("'" + printable(word) + "' is not a number");
    }
    if (!take_word(rest).empty()) return error("a vertex of more than three numbers");
    corners_.push_back(position);
    ++vertex_count_;
    return {};
  }

  Result<void> end_facet() {
    depth_ = Depth::kSolid;
    return emitter_.polygon(facet_count_++, corners_.size(), [this](std::uint64_t k) {
      return MeshCorner{corners_[k], static_cast<std::int64_t>(k), true};
    });
  }

  [[nodiscard]] Error error(const std::string& cause) const {
    return error_at(lines_.position(), cause);
  }

  [[nodiscard]] static Error error_at(const TextPosition& position, const std::string& cause) {
    return make_error(ErrorCode::kBadInput, Error::kNowhere, position.offset,
                      "line %" PRIu64 ": %s; copy or export the STL again", position.line,
                      cause.c_str());
  }

  MeshLines lines_;
  FanEmitter emitter_;
  Depth depth_ = Depth::kFile;
  bool has_loop_ = false;
  std::vector<Vec3> corners_;  ///< corners of the facet being read
  std::uint64_t facet_count_ = 0;
  std::uint64_t vertex_count_ = 0;
};

}  // namespace

Result<MeshSummary> read_stl_ascii(const MeshFile& file, TriangleSink& sink) {
  return StlAscii(file, sink).read();
}

}  // namespace planetree::octree
