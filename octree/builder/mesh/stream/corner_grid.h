#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace planetree::octree {

/// Points of a plane, sorted into the cells of a grid, about one a cell.
class CornerGrid {
 public:
  static constexpr std::uint32_t kNone = ~std::uint32_t{0};

  struct Position {
    double u = 0, v = 0;
  };
  /// A closed box.
  struct Box {
    Position lower, upper;

    void extend(const Position& p) {
      lower = {std::min(lower.u, p.u), std::min(lower.v, p.v)};
      upper = {std::max(upper.u, p.u), std::max(upper.v, p.v)};
    }
    [[nodiscard]] bool contains(const Position& p) const {
      return lower.u <= p.u && p.u <= upper.u && lower.v <= p.v && p.v <= upper.v;
    }
  };

  /// Empties the grid and divides `box` into about `points` cells.
  void start(const Box& box, std::size_t points);
  /// Adds a point within the box.
  ///
  /// number  below `numbers`, each once.
  void add(std::uint32_t number, std::uint32_t numbers, const Position& position);

  /// Calls visit(number) for the points of all cells that meet a triangle, and for others nearby,
  /// until it returns true.
  ///
  /// steps   increased by the number of cells and points that were looked at.
  /// return  whether visit() returned true.
  template <class Visit>
  bool any_near(const std::array<Position, 3>& triangle, std::uint64_t& steps,
                const Visit& visit) const {
    Box box{triangle[0], triangle[0]};
    box.extend(triangle[1]);
    box.extend(triangle[2]);
    const std::size_t last_row = row(box.upper.v);
    for (std::size_t at = row(box.lower.v); at <= last_row; ++at) {
      const Columns columns = columns_of(triangle, box, at);
      for (std::size_t column = columns.first; column <= columns.last; ++column) {
        ++steps;
        for (std::uint32_t k = first_[at * across_ + column]; k != kNone; k = next_[k]) {
          ++steps;
          if (visit(k)) return true;
        }
      }
    }
    return false;
  }

 private:
  /// Columns from first to last.
  struct Columns {
    std::size_t first, last;
  };

  // Rounding keeps the order of positions, so that a box has all cells of the points within it.
  [[nodiscard]] std::size_t cell(double offset, double scale) const {
    return std::min(static_cast<std::size_t>(offset * scale), across_ - 1);
  }
  [[nodiscard]] std::size_t column(double u) const {
    return cell(std::max(u - lower_.u, 0.0), scale_u_);
  }
  [[nodiscard]] std::size_t row(double v) const {
    return cell(std::max(v - lower_.v, 0.0), scale_v_);
  }

  /// Columns in which a triangle meets a row, and one more to either side.
  [[nodiscard]] Columns columns_of(const std::array<Position, 3>& triangle, const Box& box,
                                   std::size_t row) const;

  Position lower_;
  double scale_u_ = 0, scale_v_ = 0;
  std::size_t across_ = 1;
  std::vector<std::uint32_t> first_;  ///< first point of each cell
  std::vector<std::uint32_t> next_;   ///< next point of the same cell, by number
};

}  // namespace planetree::octree
