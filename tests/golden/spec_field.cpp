#include "tests/golden/spec_field.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <span>

#include "tests/golden/spec_streams.h"
#include "tests/golden/spec_vector.h"

namespace planetree::golden {
namespace {

std::uint16_t step_of(std::uint16_t code) {
  return static_cast<std::uint16_t>(code % 2 == 0 ? code / 2 : 65536 - (code + 1) / 2);
}

}  // namespace

SpecField::SpecField(const SpecFile& file) : header_(file.header()) {
  for (std::uint32_t number = header_.e(); number < header_.a(); ++number) read_page(file, number);
  require(stored_.size() == header_.field_points(), "points of the field");
}

void SpecField::read_page(const SpecFile& file, std::uint32_t number) {
  const std::vector<std::byte> raw = file.raw_page(number);
  StreamReader streams(raw);
  std::array<std::uint32_t, 6> head;
  std::memcpy(head.data(), streams.bytes(24).data(), 24);
  const std::uint64_t left = header_.field_points() - stored_.size();
  const std::uint64_t count = std::min<std::uint64_t>(header_.page_bytes / 8, left);
  require(head[0] == number && head[1] == number - header_.e(), "numbers of a field page");
  require(head[2] == 0 && head[3] == 0 && head[4] == count && head[5] == 0, "head of a field page");
  const std::size_t first = stored_.size();
  stored_.resize(first + count);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    std::uint16_t at = 0;
    std::size_t i = first;
    for (const std::uint16_t code : streams.byte_split<std::uint16_t>(count))
      stored_[i++][axis] = at = static_cast<std::uint16_t>(at + step_of(code));
  }
  require(streams.empty(), "a field page is too long");
}

std::uint64_t SpecField::number_of(const std::array<std::uint32_t, 3>& at) const {
  const auto& size = header_.field_size;
  return (std::uint64_t{at[2]} * size[1] + at[1]) * size[0] + at[0];
}

SpecPoint SpecField::grid_point(std::uint64_t number) const {
  const auto& size = header_.field_size;
  const std::array<std::uint64_t, 3> at{number % size[0], number / size[0] % size[1],
                                        number / size[0] / size[1]};
  SpecPoint point = header_.field_lower;
  for (std::size_t axis = 0; axis < 3; ++axis)
    point[axis] += header_.field_step * static_cast<double>(at[axis]);
  return point;
}

SpecPoint SpecField::stored_point(std::uint64_t number) const {
  SpecPoint point = header_.field_lower;
  for (std::size_t axis = 0; axis < 3; ++axis)
    point[axis] += header_.field_quantum * stored_[number][axis];
  return point;
}

SpecBounds SpecField::bounds(const SpecPoint& point) const {
  const double h = header_.field_step, u = 0.9375 * header_.field_quantum;
  std::array<std::uint32_t, 3> first{};
  SpecPoint t{};
  double outside = 0, spread = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double last = header_.field_size[axis] - 1;
    const double steps = (point[axis] - header_.field_lower[axis]) / h;
    const double within = std::clamp(steps, 0.0, last);
    first[axis] = static_cast<std::uint32_t>(std::min(within, last - 1));
    t[axis] = within - first[axis];
    outside += (steps - within) * (steps - within) * h * h;
    spread += t[axis] * (1 - t[axis]);
  }
  double m = 0, upper = std::numeric_limits<double>::infinity();
  for (std::uint32_t corner = 0; corner < 8; ++corner) {
    std::array<std::uint32_t, 3> at{};
    double w = 1;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const bool far = (corner >> axis & 1) != 0;
      at[axis] = first[axis] + (far ? 1 : 0);
      w *= far ? t[axis] : 1 - t[axis];
    }
    const SpecPoint stored = stored_point(number_of(at));
    const double distance = length(grid_point(number_of(at)) - stored);
    m += w * distance * distance;
    upper = std::min(upper, length(point - stored) + u);
  }
  const double squared = m - 2 * u * std::sqrt(m) - h * h * spread;
  return {std::sqrt(std::max(0.0, squared) + outside), upper};
}

}  // namespace planetree::golden
