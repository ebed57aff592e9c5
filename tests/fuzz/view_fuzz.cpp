#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "octree/geometry/tree_limits.h"
#include "tests/fuzz/expectation.h"
#include "tests/tools/view/sample_source.h"
#include "tools/view/shape_reader.h"
#include "tools/view/view_router.h"

namespace planetree::tools {
namespace {

/// The shape of two samples of the format, one of them in two places that are turned and scaled.
ShapeReader sample_shapes() {
  const std::filesystem::path folder = PLANETREE_SAMPLES;
  std::vector<FileParts> files;
  for (const char* name : {"sphere.ptree", "tube.ptree"}) {
    auto parts = ShapeReader::open_file(folder / name);
    expect(static_cast<bool>(parts));
    files.push_back(*std::move(parts));
  }
  const ShapeFrame ball = ShapeFrame::of(*files[0].header()),
                   tube = ShapeFrame::of(*files[1].header()), all{{1, 2, 3}, 0.5};
  std::vector<ShapeInstance> instances = {
      {0, ShapePlace({}, ball, all)},
      {1, ShapePlace({{0, 1, 0, 0}, {2, 0, 0}}, tube, all)},
      {0, ShapePlace({{0, 0, 0.6, 0.8}, {0, 9, 0}}, ball, all)}};
  return {std::move(files), std::move(instances)};
}

/// A source that checks that only what the addresses may say reaches it, and reads shapes as a
/// scene does.
class CheckedSource final : public ViewSource {
 public:
  std::string info() override { return "{}"; }
  Result<std::string> shape(const ShapeView& view) override {
    expect(view.discs >= 1 && view.discs <= ShapeView::kMaxDiscs);
    expect(std::isfinite(view.eye.x) && std::isfinite(view.look.z));
    expect(view.cosine >= -1 && view.cosine <= 1);
    const auto shape = shapes_.read(view, std::chrono::milliseconds(20));
    expect(static_cast<bool>(shape));
    const std::size_t least = 3 * std::size_t{octree::kMaxBlockTriangles};  // of the three roots
    expect((*shape)->size() >= 3 && (*shape)->size() <= std::max<std::size_t>(view.discs, least));
    for (const ShapePiece& piece : (*shape)->pieces) expect(piece.instance < 3);
    return shape_bytes(**shape);
  }
  std::string answer(const PointQuestion& question) override {
    expect(std::isfinite(question.point.x) && std::isfinite(question.point.y) &&
           std::isfinite(question.point.z) && std::isfinite(question.within) &&
           question.within >= 0);
    return "{}";
  }
  std::string stats() override { return "{}"; }
  std::string pages() override { return {}; }
  std::string timeline() override { return "null"; }

 private:
  ShapeReader shapes_ = sample_shapes();
};

/// Takes a line off a text.
std::string_view next_line(std::string_view& text) {
  const std::size_t end = text.find('\n');
  const std::string_view line = text.substr(0, end);
  text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
  return line;
}

void expect_sound(const ViewReply& reply) {
  expect(reply.status == 200 || reply.status == 400 || reply.status == 403 || reply.status == 404 ||
         reply.status == 405 || reply.status == 414);
  expect(reply.type.find_first_of("\r\n") == std::string_view::npos);
}

}  // namespace
}  // namespace planetree::tools

/// Reads lines as method, host, origin and target of a request. `T` at the beginning of the target
/// stands for the token.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  using namespace planetree;
  using namespace planetree::tools;
  static CheckedSource source;
  static const ViewRouter router(kSampleToken, {"127.0.0.1", "::1"}, 80, kSampleFiles, source);
  static const ViewRouter open_router(kSampleToken, {"::"}, 80, kSampleFiles, source);
  std::string_view text(reinterpret_cast<const char*>(bytes), size);
  ViewRequest request;
  request.method = next_line(text);
  request.hosts = {next_line(text)};
  if (const std::string_view origin = next_line(text); !origin.empty()) request.origins = {origin};
  const bool has_token = text.starts_with('T');
  const std::string target =
      has_token ? "/" + std::string(kSampleToken) + std::string(text.substr(1)) : std::string(text);
  request.target = target;
  const ViewReply reply = router.respond(request);
  expect_sound(reply);
  expect_sound(open_router.respond(request));
  if (reply.status != 200) return 0;
  expect(request.method == "GET" && has_token == (target.find(kSampleToken) == 1));
  expect(target.find(kSampleToken) == 1 && target.size() <= ViewRouter::kMaxTargetBytes);
  expect(router.respond({request.method, target, {}, {}}).status == 403);
  return 0;
}
