#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "planetree/probe.h"
#include "tools/thickness/wall_cone.h"

namespace planetree::tools {

/// What is proven of a thickness.
enum class ThicknessStatus : std::uint8_t {
  kExact,     ///< the interval is as narrow as rounding allows
  kBounded,   ///< it is wider
  kDegraded,  ///< pages could not be read, or the normal is not proven; the interval
              ///< holds
  kBeyond,    ///< no wall within the maximum thickness
  kBadPoint   ///< the point is not finite
};
inline constexpr std::size_t kThicknessStatuses = 5;
/// The word for it in all outputs.
const char* name_of(ThicknessStatus status);

/// The thickness of a wall at a point of the surface: the diameter of the greatest ball that
/// touches the surface there from inside and reaches no surface in the cone (WallCone).
struct WallThickness {
  double thickness = 0;  ///< model units; infinite for kBeyond, NaN for kBadPoint
  double lower = 0;      ///< certified ends of its interval
  double upper = 0;
  Vec3 at;  ///< the surface point where it was measured
  bool has_contact = false;
  Vec3 contact;  ///< the surface point that the ball reaches
  ThicknessStatus status = ThicknessStatus::kBadPoint;
};

/// How walls are measured.
struct ThicknessOptions {
  double sine = 0.5;         ///< of the least angle of WallCone
  double max_thickness = 0;  ///< model units, finite and > 0
  double scale = 1;          ///< greatest coordinate of the model
  SideRule side_rule = SideRule::kOfFile;
};

/// Measures thickness by shrinking balls. A ball begins with the maximum thickness. While the
/// surface point nearest to its centre is within it and in the cone, it shrinks to that point. In
/// the end the nearest point is beside the apex, or the ball is empty. The depth of that point in
/// the ball bounds from below the radius of all that it hides, but for points near the apex. A
/// chain of smaller balls looks for these.
///
/// Where that leaves an interval of more than 5 %, the triangles within the ball that are nearest
/// to its centre are listed. Those that have their nearest point in the cone shrink the ball
/// further. If all could be listed, their planes bound the radius from below too.
///
/// source  Ma, Bae & Choi 2012, "3D medial axis point approximation using nearest neighbors and the
///         normal field", for the shrinking.
class ThicknessSearch {
 public:
  /// probe  must outlive this
  ThicknessSearch(Probe& probe, const ThicknessOptions& options);

  /// Measures at the points of the surface that are nearest to `points`.
  ///
  /// results  as many as points
  void measure(std::span<const Vec3> points, std::span<WallThickness> results);

 private:
  // A ball that shrinks. Then smaller balls are tried, for what the surface near the apex hides.
  struct Ball {
    WallCone cone;
    std::size_t index;  // of the result
    double radius;      // so far
    double tried;       // radius of the ball to be tried next
    double least = 0;   // lower bound of the radius if smaller balls hide nothing; 0: none yet
    double hidden = 0;  // radius up to which the ball tried last hides points
  };

  void begin(std::span<const Vec3> points, std::span<WallThickness> results);
  void shrink(std::span<WallThickness> results);
  bool shrink_to(Ball& ball, const Vec3& contact, WallThickness& result) const;
  bool step(Ball& ball, const ClosestPoint& answer, WallThickness& result) const;
  bool shrink_by_list(Ball& ball, WallThickness& result);
  double least_radius_of_list(const Ball& ball) const;
  void list_and_finish(Ball& ball, WallThickness& result);
  void finish(const Ball& ball, WallThickness& result) const;

  Probe& probe_;
  const ThicknessOptions options_;
  std::vector<Ball> open_, listed_;
  std::vector<Vec3> centres_;
  std::vector<ClosestPoint> answers_;
  // The list made last: triangles near the centre of a ball.
  std::vector<ClosestPoint> list_;
  Found found_;
  double listed_radius_ = 0;
};

}  // namespace planetree::tools
