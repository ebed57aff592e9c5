#include "tools/view/shape_reader.h"

#include <algorithm>
#include <cinttypes>
#include <cmath>
#include <limits>
#include <utility>

#include "octree/geometry/tree_limits.h"
#include "query/file/scale.h"

namespace planetree::tools {
namespace {

using std::chrono::steady_clock;

/// A round divides the pieces down to this share of the weight of the round before.
constexpr float kRoundShare = 0.75F;
/// Pieces that look smaller, in radians, are not divided: less than a dot of a screen.
constexpr float kSmallestWeight = 0.0007F;
/// What is not seen may be coarser, by this factor; blocks cost more than nodes, by this one.
constexpr float kUnseenShare = 0.05F, kBlockShare = 0.7F;

/// How long a request for a shape reads pages. Then it gets what there is.
constexpr std::chrono::milliseconds kRequestTime{250};

float half_diagonal(const octree::FloatBox& box) {
  return 0.5F * std::sqrt(box.diagonal_squared());
}

double dot(const Vec3& a, const Vec3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

/// Whether a ball may be seen in the cone of a view.
bool is_seen(const ShapeView& view, const Vec3& from_eye, double distance, double radius) {
  if (distance <= radius) return true;
  const double length = std::sqrt(dot(view.look, view.look));
  const double cosine = std::clamp(dot(view.look, from_eye) / (length * distance), -1.0, 1.0);
  return std::acos(cosine) <= std::acos(view.cosine) + std::asin(radius / distance);
}

}  // namespace

Result<FileParts> ShapeReader::open_file(const std::filesystem::path& path) {
  auto parts = FileParts::open(path);
  if (!parts) return parts.error();
  if (!parts->header() || parts->entries().empty())
    return make_error(ErrorCode::kDamaged, Error::kNowhere, Error::kNowhere,
                      "its header cannot be read; see planetree inspect");
  return parts;
}

Result<ShapeReader> ShapeReader::open(const std::filesystem::path& path) {
  auto parts = open_file(path);
  if (!parts) return parts.error();
  std::vector<FileParts> files;
  files.push_back(*std::move(parts));
  return ShapeReader(std::move(files), {ShapeInstance()});
}

ShapeReader::ShapeReader(std::vector<FileParts> files, std::vector<ShapeInstance> instances)
    : files_(std::move(files)), instances_(std::move(instances)) {}

float ShapeReader::weight_of(const ShapePiece& piece) const {
  const float radius = std::min(half_diagonal(piece.box), piece.disc.radius);
  const float share = octree::LinkFormat::is_leaf(piece.link) ? kBlockShare : 1.0F;
  if (!view_.has_eye)
    return share * radius * static_cast<float>(instances_[piece.instance].place.scale());
  const ShapeView& view = views_[piece.instance];
  const auto centre = piece.box.centre();
  const Vec3 from_eye{double{centre[0]} - view.eye.x, double{centre[1]} - view.eye.y,
                      double{centre[2]} - view.eye.z};
  const double distance = std::sqrt(dot(from_eye, from_eye)),
               reach = double{half_diagonal(piece.box)};
  const double near = std::max(distance - reach, 0.25 * double{radius});
  const double weight = near > 0 ? double{share * radius} / near : 0;
  const double seen = is_seen(view, from_eye, distance, reach) ? 1 : double{kUnseenShare};
  return weight * seen > double{kSmallestWeight} ? static_cast<float>(weight * seen) : 0;
}

/// A piece that is too large for the limit stays, as does one without size.
bool ShapeReader::may_divide(const ShapePiece& piece) const {
  const std::size_t more =
      octree::LinkFormat::is_leaf(piece.link) ? octree::kMaxBlockTriangles : octree::kFanOut;
  const bool is_root = piece.depth == 0;  // has no disc
  return piece.depth <= octree::kMaxHeight && (is_root || count_ + more - 1 <= view_.discs);
}

void ShapeReader::start(const ShapeView& view) {
  view_ = view;
  shape_ = {};
  is_full_ = false;
  threshold_ = std::numeric_limits<float>::max();
  views_.clear();
  for (const ShapeInstance& instance : instances_) {
    views_.push_back(instance.place.view_from(view));
    ShapePiece root;
    root.link = files_[instance.file].root_link();
    root.page = files_[instance.file].links().page(root.link);
    root.instance = static_cast<std::uint32_t>(shape_.pieces.size());
    root.weight = std::numeric_limits<float>::infinity();
    shape_.pieces.push_back(root);
  }
  count_ = shape_.pieces.size();
}

Result<const ViewShape*> ShapeReader::read(const ShapeView& view, std::chrono::milliseconds most) {
  const Time end = steady_clock::now() + most;
  if (!(view == view_)) start(view);
  while (!shape_.is_complete && steady_clock::now() < end) {
    std::vector<ShapePiece> due = take_due();
    if (due.empty()) {
      float largest = 0;
      for (const ShapePiece& piece : shape_.pieces) largest = std::max(largest, piece.weight);
      shape_.is_complete = is_full_ || largest == 0;
      threshold_ = std::min(threshold_, largest) * kRoundShare;
      continue;
    }
    if (const auto divided = divide_all(std::move(due), end); !divided) {
      view_ = {};
      return divided.error();
    }
  }
  return &shape_;
}

Result<std::string> ShapeReader::read_bytes(const ShapeView& view) {
  const auto shape = read(view, kRequestTime);
  if (!shape) return shape.error();
  return shape_bytes(**shape);
}

/// Takes the pieces that this round divides out of the shape, page by page of each file.
std::vector<ShapePiece> ShapeReader::take_due() {
  if (is_full_) return {};
  const auto first = std::stable_partition(
      shape_.pieces.begin(), shape_.pieces.end(),
      [this](const ShapePiece& piece) { return !(piece.weight > threshold_); });
  std::vector<ShapePiece> due(first, shape_.pieces.end());
  shape_.pieces.erase(first, shape_.pieces.end());
  std::stable_sort(due.begin(), due.end(), [this](const ShapePiece& a, const ShapePiece& b) {
    return std::pair(file_of(a), a.page) < std::pair(file_of(b), b.page);
  });
  return due;
}

Result<void> ShapeReader::divide_all(std::vector<ShapePiece> due, Time end) {
  const std::span<const ShapePiece> all(due);
  for (std::size_t first = 0; first < all.size();) {
    std::size_t last = first + 1;
    while (last < all.size() && all[last].page == all[first].page &&
           file_of(all[last]) == file_of(all[first]))
      ++last;
    if (is_full_ || steady_clock::now() >= end) {
      shape_.pieces.insert(shape_.pieces.end(), all.begin() + static_cast<std::ptrdiff_t>(first),
                           all.end());
      return {};
    }
    if (const auto divided = divide_in_page(all.subspan(first, last - first)); !divided)
      return divided;
    first = last;
  }
  return {};
}

/// Divides pieces that lead to one page of one file, and what becomes of them as far as it is in
/// that page.
Result<void> ShapeReader::divide_in_page(std::span<const ShapePiece> due) {
  const std::uint32_t page = due.front().page;
  FileParts& parts = files_[file_of(due.front())];
  if (page >= parts.first_cap_page() || parts.load_page(page))
    return make_error(ErrorCode::kDamaged, page, Error::kNowhere,
                      "page %" PRIu32 " of %s cannot be read; planetree verify says why", page,
                      parts.path().filename().c_str());
  ++shape_.pages_read;
  std::vector<ShapePiece> stack(due.rbegin(), due.rend());
  while (!stack.empty()) {
    const ShapePiece piece = stack.back();
    stack.pop_back();
    if (!has_record(piece))
      return make_error(ErrorCode::kDamaged, page, Error::kNowhere,
                        "a link leads to no record of page %" PRIu32
                        " of %s; planetree verify says more",
                        page, parts.path().filename().c_str());
    if (!may_divide(piece)) {
      is_full_ = true;
      shape_.pieces.push_back(piece);
    } else if (octree::LinkFormat::is_leaf(piece.link)) {
      add_triangles(piece);
    } else {
      add_children(piece, stack);
    }
  }
  return {};
}

bool ShapeReader::has_record(const ShapePiece& piece) const {
  const FileParts& parts = files_[file_of(piece)];
  const FrameView frame = parts.frame();
  const bool is_block = octree::LinkFormat::is_leaf(piece.link);
  return parts.links().record(piece.link) < (is_block ? frame.block_count() : frame.node_count());
}

void ShapeReader::add_children(const ShapePiece& piece, std::vector<ShapePiece>& inner) {
  const FileParts& parts = files_[file_of(piece)];
  const FrameView frame = parts.frame();
  const octree::LinkFormat links = parts.links();
  const octree::Node& node = frame.node(links.record(piece.link));
  count_ += node.child_count - std::size_t{1};
  for (unsigned child = 0; child < node.child_count; ++child) {
    ShapePiece part;
    part.box = octree::child_box(node, child);
    part.disc = child_disc(node, child);
    part.link = node.link[child];
    part.page = links.page(part.link);
    part.depth = static_cast<std::uint16_t>(piece.depth + 1);
    part.instance = piece.instance;
    part.weight = weight_of(part);
    const bool goes_on = part.page == piece.page && part.weight > threshold_ && !is_full_;
    (goes_on ? inner : shape_.pieces).push_back(part);
  }
}

void ShapeReader::add_triangles(const ShapePiece& piece) {
  const FileParts& parts = files_[file_of(piece)];
  const FrameView frame = parts.frame();  // has the layout that the view of the block refers to
  const octree::BlockView block = frame.block(parts.links().record(piece.link));
  const double* const centre = parts.header()->model.centre;
  count_ += block.triangle_count() - std::size_t{1};
  for (unsigned i = 0; i < block.triangle_count(); ++i) {
    const octree::Triangle corners = block.triangle(i);
    ShapeTriangle& triangle =
        shape_.triangles.emplace_back(ShapeTriangle{{}, piece.page, piece.depth, piece.instance});
    for (std::size_t at = 0; at < 9; ++at)
      triangle.corners[at] =
          static_cast<float>(corners[at / 3][static_cast<long>(at % 3)] - centre[at % 3]);
  }
}

}  // namespace planetree::tools
