#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <span>
#include <string>
#include <tuple>
#include <vector>

#include "tests/oracle/brute_force.h"

namespace planetree::oracle {

/// The local minima of the distance from a point to a soup, in long double, over every triangle,
/// edge and vertex.
///
/// Distances of which the true order is uncertain by rounding are compared with margins: what is a
/// minimum by a wide margin must be found, and what is none at all must not.
class ContactOracle {
 public:
  ContactOracle(const Vec3& query, std::span<const Corners> triangles);

  /// Says what is wrong with contacts that were found; empty if nothing is.
  ///
  /// is_complete  whether all contacts within the radius are claimed to be there
  std::string fault(std::span<const ClosestPoint> found, double radius, bool is_complete) const;

  /// Number of minima within a radius that are certain.
  std::size_t certain_count(double radius) const;

 private:
  using Real = long double;
  using Point = std::array<Real, 3>;
  using Key = std::tuple<double, double, double>;
  struct Part {  // a vertex, edge or triangle
    Real distance = 0;
    Point point{};  // the nearest
  };

  Part vertex_part(const Vec3& corner) const;
  Part edge_part(const Vec3& a, const Vec3& b) const;
  Part triangle_part(std::size_t triangle) const;
  bool is_earlier(std::size_t a, std::size_t b) const;
  std::vector<std::size_t> reached(std::size_t from, Real margin) const;
  bool touches(std::size_t from, std::size_t other, Real margin) const;
  std::size_t earlier_within(std::size_t from, Real margin) const;
  std::size_t root(std::size_t from) const;
  bool is_certain(std::size_t triangle) const;

  const Vec3 query_;
  const std::span<const Corners> triangles_;
  Real scale_ = 0;
  std::vector<Part> parts_;                            // of triangles
  std::vector<std::array<Real, 3>> edges_, vertices_;  // distances, by triangle
  std::map<Key, std::vector<std::size_t>> at_;         // triangles at a vertex
};

}  // namespace planetree::oracle
