#include "octree/builder/model_members.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "octree/geometry/strict_math.h"
#include "storage/set/new_set.h"
#include "storage/set/set_description.h"

namespace planetree::octree {
namespace {

// The box in the coordinates of the input, no smaller for being rounded.
storage::MemberBox input_box(const FloatBox& box, const ModelFrame& frame) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const Point centre = frame.centre();
  storage::MemberBox input{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto i = static_cast<Eigen::Index>(axis);
    const auto unscaled = [&frame](double value) {
      return std::ldexp(value, -frame.scale_exponent);
    };
    const double lower = centre[i] + static_cast<double>(box.lower[axis]);
    const double upper = centre[i] + static_cast<double>(box.upper[axis]);
    input.lower[axis] = std::max(frame.input_lower[i], unscaled(std::nextafter(lower, -kInfinity)));
    input.upper[axis] = std::min(frame.input_upper[i], unscaled(std::nextafter(upper, kInfinity)));
  }
  return input;
}

// So many bytes that a set has few enough members: two in a row are longer than one may be, and no
// page is stored longer than it is decoded.
std::uint64_t member_bytes(const BuildOptions& options, std::uint32_t page_count) {
  constexpr std::uint64_t kSpare = 4;  // before the pages, behind them, and for rounding
  constexpr std::uint64_t kPairs = (storage::SetDescription::kMaxMembers - kSpare) / 2;
  return std::max(options.member_bytes, std::uint64_t{page_count} * options.page_bytes / kPairs);
}

}  // namespace

Result<std::unique_ptr<storage::ModelOutput>> create_output(const ModelMembers& members,
                                                            const std::filesystem::path& output,
                                                            const BuildOptions& options,
                                                            storage::FileCalls& calls) {
  if (options.member_bytes == 0) return storage::new_model_file(output, options.replace, calls);
  storage::SetDivision division;
  division.member_bytes = member_bytes(options, members.page_count);
  division.box_of_pages = [members](std::uint32_t first,
                                    std::uint32_t end) -> std::optional<storage::MemberBox> {
    const auto box = members.pages.box_of(first, end);
    if (!box) return {};
    return input_box(*box, members.frame);
  };
  return storage::NewSet::create(output, std::move(division), options.replace, calls);
}

}  // namespace planetree::octree
