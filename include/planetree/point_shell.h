#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>

#include "planetree/error.h"
#include "planetree/export.h"
#include "planetree/model.h"
#include "planetree/pose.h"
#include "planetree/probe.h"
#include "planetree/types.h"

/// @file
/// Force and torque between a model and a rigid tool in any pose: haptics in six degrees of
/// freedom. The surface of the tool is represented by points.
///
/// source  McNeely, Puterbaugh & Troy 1999, "Six degree-of-freedom haptic rendering using voxel
///         sampling"; Barbic & James 2008, "Six-DoF haptic rendering of contact between
///         geometrically complex reduced deformable models".

namespace planetree {

namespace query {
class ShellMemory;
class SphereTree;
}  // namespace query

/// A point of the surface of a tool.
struct ShellPoint {
  Vec3 position;         ///< in the tool's frame, model units; coordinates at most 2^500
  Vec3 normal{0, 0, 1};  ///< into the tool; the squared length is 1 within 2^-20
};

/// What counts as depth.
enum class DepthRule : std::uint8_t {
  /// The model is a solid. The depth of a point is `margin` less its signed distance, so that it
  /// grows on the way from outside through the surface into the solid.
  kSolid,
  /// The model is a wall without thickness, such as an open sheet. The depth of a point is `margin`
  /// less its distance, on either side. No side is computed. `margin` must be above the way that a
  /// point moves in a tick, since a point that passes the surface is pushed on.
  kTwoSided,
};

/// Direction of the force on a point in contact.
enum class ForceDirection : std::uint8_t {
  /// The point's normal, into the tool, as in the method of McNeely et al. It is known whatever is
  /// known of the model, it turns smoothly with the tool, and it does not jump where the nearest
  /// point does: in corners, at edges and on rough scans. So the error of the wrench is that of the
  /// distances.
  kToolNormal,
  /// The contact normal of the model (ClosestPoint::normal), which fits blunt tools whose normals
  /// say little. By DepthRule::kTwoSided it points to the point's side of the surface. Where the
  /// answer is not exact the direction is not known, and the error of the wrench covers all.
  kModelNormal,
};

/// Options of PointShell::wrench. A value out of range gives Status::kBadQuery.
struct ShellOptions {
  double stiffness = 1;  ///< force per depth of each point, >= 0, finite
  /// Distance from the surface at which contact begins. Model units, >= 0, finite.
  double margin = 0;
  /// Depth above which the force of a point does not grow. Model units, >= 0, may be infinite.
  double max_depth = std::numeric_limits<double>::infinity();
  DepthRule depth_rule = DepthRule::kSolid;                      ///< what counts as depth
  ForceDirection force_direction = ForceDirection::kToolNormal;  ///< direction of a point's force
  SideRule side_rule = SideRule::kOfFile;  ///< how sides are decided, by DepthRule::kSolid
  Wait wait = Wait::kForPages;             ///< blocking or real-time queries
  /// Maximum work of the call, in the units of QueryOptions::max_work; a query takes at least one.
  /// Coarse spheres come first, then the points whose depth may have changed most since they were
  /// queried. With 0, one query of limited work bounds all points. kNoLimit, the default, means no
  /// limit for Wait::kForPages and kRealTimeWork for Wait::kNever.
  std::uint32_t max_work = QueryOptions::kNoLimit;
  /// Point that the torque is about, in the tool's frame. Coordinates at most 2^500.
  Vec3 reference{};

  /// Default of `max_work` for Wait::kNever.
  static constexpr std::uint32_t kRealTimeWork = 8192;
};

/// Force and torque of the model on the tool, in the model's axes. Let d be the depth of point i,
/// between 0 and max_depth, and n its direction of force. Its force is stiffness * d * n. The
/// torque is the sum of the cross products of (position - reference) and force. No member is ever
/// NaN.
struct Wrench {
  Vec3 force;   ///< sum of the forces
  Vec3 torque;  ///< about ShellOptions::reference
  /// Certified: the force for the true distances differs from `force` by at most this, as the
  /// length of a vector. It covers distances, sides that are not known, the pose and all rounding.
  /// May be infinite.
  double force_error = std::numeric_limits<double>::infinity();
  /// The same of the torque.
  double torque_error = std::numeric_limits<double>::infinity();
  std::size_t contacts = 0;   ///< points of a depth above 0, as best known
  std::size_t undecided = 0;  ///< points whose depth, or direction of force, is not proven
  std::size_t listed = 0;     ///< points that may be in contact: those that `contacts` receives
  std::size_t queries = 0;    ///< queries of the model
  std::uint64_t work = 0;     ///< work, as limited by ShellOptions::max_work
  /// kExact if every point is proven: force, torque and their errors are then a function of the
  /// file, the shell, the pose and the options alone, with the same bits for any history, thread
  /// and processor. kDegraded if points are undecided, or if force or torque overflows, which is 0
  /// then. kBadQuery if the pose is not valid or an option is out of range; force and torque are
  /// then 0 and their errors infinite.
  Status status = Status::kBadQuery;
};

/// A point of the shell that may be in contact.
struct ShellContact {
  std::size_t point = 0;              ///< position in the points of PointShell::create
  Vec3 position;                      ///< of the point, model units, model's frame
  Vec3 direction{0, 0, 1};            ///< of the force on the tool, length 1
  double depth = 0;                   ///< as best known, model units
  double depth_lower = 0;             ///< certified lower bound of the depth
  double depth_upper = 0;             ///< certified upper bound of the depth; may be infinite
  Status status = Status::kDegraded;  ///< kExact or kDegraded
};

class PointShellState;
class SceneProbe;
class SceneShellState;
struct SceneShellContact;

/// The points of a tool's surface, with a tree of spheres around them. Immutable, shared by
/// threads. Takes about 100 bytes a point. It must outlive its states.
class PLANETREE_API PointShell {
 public:
  /// Maximum number of points.
  static constexpr std::size_t kMaxPoints = std::size_t{1} << 24;

  /// Makes a shell of points in any order. Contact is found at the points alone. So their spacing
  /// is the size of the details of the model that the tool feels.
  ///
  /// points   1 to kMaxPoints; are copied.
  /// errors   kBadArgument: no point or too many; or a position or a normal out of range, see
  ///          ShellPoint. kNoMemory.
  /// threads  any, but not real-time threads: allocates memory.
  [[nodiscard]] static Result<PointShell> create(std::span<const ShellPoint> points);

  /// Moves another shell here, which keeps its states. That one may then only be assigned to or
  /// destroyed.
  PointShell(PointShell&&) noexcept;
  /// Destroys this shell and moves another one here.
  PointShell& operator=(PointShell&&) noexcept;
  ~PointShell();

  /// Number of points.
  std::size_t size() const noexcept;

  /// Returns the wrench of the model on the tool in a pose.
  ///
  /// The distance of a sphere's centre proves that all points in the sphere are free, or as deep as
  /// max_depth. The other spheres are divided, and their points queried. What was found in earlier
  /// calls is used as far as the tool's motion since then allows.
  ///
  /// - With Wait::kForPages and no limit, every point is proven, with the exceptions of
  ///   Probe::closest_point. A side beside an open surface is that of the position in doubles.
  /// - With Wait::kNever the call does not allocate memory, take a lock or make a system call.
  /// Pages
  ///   that are missing are requested, and the errors are wider until they are in memory.
  /// - Spheres tell sides only if the surface is watertight and a winding number decides. Otherwise
  ///   each point of DepthRule::kSolid takes a query in each call. kTwoSided does not.
  ///
  /// probe     of the model that the state was made for.
  /// state     of this shell.
  /// contacts  receives the points of a `depth_upper` above 0, in the order of their numbers: as
  ///           many as fit of Wrench::listed.
  /// threads   the thread that uses the probe; a state is used by one thread at a time.
  Wrench wrench(Probe& probe, PointShellState& state, const Pose& pose,
                const ShellOptions& options = {},
                std::span<ShellContact> contacts = {}) const noexcept;

  /// Returns the wrench of all instances of a scene on the tool, in the world's axes: the sum of
  /// those of each instance, as the function above computes them. Instances whose boxes are too far
  /// for contact are not asked.
  ///
  /// - The errors hold the rounding of the poses of tool and instances. What a state knows of an
  ///   instance ages by the motion of the tool relative to it.
  /// - Wrench::contacts and Wrench::undecided count a point once for each instance.
  ///   ShellOptions::max_work is that of all instances together, but for one query of each that is
  ///   near. The nearest box comes first.
  /// - Without a near instance the wrench is 0, without error.
  ///
  /// probe     of the scene. If the pose relative to an instance is out of the range of poses, the
  ///           errors are infinite.
  /// state     of this shell.
  /// contacts  as above, in the world frame, one instance after another.
  Wrench wrench(SceneProbe& probe, SceneShellState& state, const Pose& pose,
                const ShellOptions& options = {},
                std::span<SceneShellContact> contacts = {}) const noexcept;

 private:
  friend class PointShellState;
  friend class SceneShellState;
  explicit PointShell(std::unique_ptr<const query::SphereTree> tree) noexcept;
  std::unique_ptr<const query::SphereTree> tree_;
};

/// The memory of PointShell::wrench: what is known of each sphere and point of one shell in one
/// model, from call to call. Takes about 240 bytes a point.
class PLANETREE_API PointShellState {
 public:
  /// Makes a state that knows nothing.
  ///
  /// shell, model  must outlive the state.
  /// errors        kNoMemory.
  /// threads       any, but not real-time threads: allocates memory and writes to all of it.
  [[nodiscard]] static Result<PointShellState> create(const PointShell& shell, const Model& model);

  /// Moves another state here. That one may then only be assigned to or destroyed.
  PointShellState(PointShellState&&) noexcept;
  /// Destroys this state and moves another one here.
  PointShellState& operator=(PointShellState&&) noexcept;
  ~PointShellState();

  /// Forgets what earlier calls found. Exact results do not depend on it.
  void reset() noexcept;

 private:
  friend class PointShell;
  PointShellState(std::unique_ptr<query::ShellMemory> memory, const ModelInfo& info) noexcept;
  std::unique_ptr<query::ShellMemory> memory_;
  const ModelInfo* info_;
};

}  // namespace planetree
