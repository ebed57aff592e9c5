#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "planetree/types.h"

namespace planetree::tools {

/// What the router looks at of an HTTP request. Nothing in it is trusted.
struct ViewRequest {
  std::string_view method;
  std::string_view target;                ///< path and query, as the request line has them
  std::vector<std::string_view> hosts;    ///< values of all Host headers
  std::vector<std::string_view> origins;  ///< values of all Origin headers
};

/// From where a shape is looked at, in the frame of shapes: see ShapeFrame.
struct ShapeView {
  static constexpr std::uint32_t kMaxDiscs = 200'000;

  std::uint32_t discs = 0;  ///< maximum number of discs and triangles together, 1 to kMaxDiscs
  bool has_eye = false;     ///< whether near parts are to be finer than far ones
  Vec3 eye;                 ///< position of the eye
  Vec3 look;                ///< direction in which it looks; any length but zero
  double cosine = -1;       ///< of the half angle of the cone that it sees; -1: all directions

  bool operator==(const ShapeView& other) const;
};

/// A question at a point.
struct PointQuestion {
  Vec3 point;         ///< model units
  double within = 0;  ///< contacts are reported up to this distance; model units, >= 0
};

/// Reads the query part of a target, without the question mark. Each parameter is named once, in
/// any order, and none may lack or be unknown. Numbers are finite decimals without blanks, signs
/// of '+' or escapes.
///
/// return  empty: the text is not such a query
std::optional<ShapeView> parse_shape_view(std::string_view query);
std::optional<PointQuestion> parse_point_question(std::string_view query);

}  // namespace planetree::tools
