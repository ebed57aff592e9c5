#include "octree/builder/mesh/triangle_stream.h"

#include <algorithm>
#include <exception>
#include <vector>

#include "octree/builder/mesh/stream/fan_emitter.h"

namespace planetree::octree {
namespace {

constexpr std::size_t kBufferTriangles = 4096;

Error source_error(const char* what) {
  return make_error(ErrorCode::kBadInput, Error::kNowhere, Error::kNowhere,
                    "the callback that gives the triangles threw: %s; return an error instead",
                    what);
}

// The caller's code may throw. Nothing of ours is between it and this.
Result<std::size_t> ask(const TriangleSource& source, std::span<TriangleCorners> buffer) {
  try {
    const Result<std::size_t> given = source(buffer);
    if (!given || *given <= buffer.size()) return given;
    return make_error(ErrorCode::kBadInput, Error::kNowhere, Error::kNowhere,
                      "the callback that gives the triangles says %zu, more than the %zu it was "
                      "asked for; return the number that was written",
                      *given, buffer.size());
  } catch (const std::exception& thrown) {
    return source_error(thrown.what());
  } catch (...) {
    return source_error("no standard exception");
  }
}

}  // namespace

MeshSize size_of_stream(const BuildInput::Stream& stream) {
  return {stream.expected_triangles, stream.expected_triangles / 2, false};
}

Result<MeshSummary> read_stream(const BuildInput::Stream& stream, TriangleSink& sink) {
  FanEmitter emitter(sink, RecordKind::kTriangle,
                     stream.expected_triangles * sizeof(TriangleCorners));
  std::vector<TriangleCorners> buffer(kBufferTriangles);
  std::uint64_t record = 0;
  for (;;) {
    const Result<std::size_t> given = ask(stream.source, buffer);
    if (!given) return given.error();
    if (*given == 0) break;
    for (const TriangleCorners& corners : std::span(buffer).first(*given)) {
      const auto corner_at = [&corners](std::uint64_t k) {
        return MeshCorner{corners[static_cast<std::size_t>(k)], static_cast<std::int64_t>(k), true};
      };
      if (const auto taken = emitter.polygon(record++, 3, corner_at); !taken) return taken.error();
    }
    const std::uint64_t done = record * sizeof(TriangleCorners);
    emitter.expect_more(done - std::min(done, emitter.bytes_total()));
    if (const auto told = emitter.advance(done); !told) return told.error();
  }
  emitter.set_vertex_count(3 * record);
  return emitter.finish(false);
}

}  // namespace planetree::octree
