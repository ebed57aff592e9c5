#pragma once

#include <cstdint>
#include <filesystem>
#include <limits>
#include <memory>
#include <span>

#include "planetree/contact.h"
#include "planetree/error.h"
#include "planetree/eviction_policy.h"
#include "planetree/export.h"
#include "planetree/layers.h"
#include "planetree/model.h"
#include "planetree/pose.h"
#include "planetree/stats.h"
#include "planetree/types.h"

/// @file
/// Scenes: many models under one memory budget, each in one or more places, that move.
///
/// units  those of the models, which must agree. The world frame is that of the poses.

namespace planetree {

namespace query {
class SceneProbeState;
class SceneState;
}  // namespace query

/// A model that stands somewhere in a scene. Values are not used again after Scene::remove.
enum class InstanceId : std::uint64_t {};
/// Value of an InstanceId that is that of no instance.
inline constexpr InstanceId kNoInstance{std::numeric_limits<std::uint64_t>::max()};

/// How a rigid body moves, in the world's axes. SceneProbe::first_contact takes it into account,
/// and it tells which pages moving probes will need.
struct Twist {
  Vec3 linear;   ///< velocity of the body's origin, model units per second
  Vec3 angular;  ///< axis of rotation times its speed, radians per second
};

/// Options of Scene::create.
struct SceneOptions {
  /// Budget: maximum memory in bytes of the scene, its models, its threads and its probes, as
  /// OpenOptions::memory_budget_bytes is for one model. Frames take what nothing else needs: a
  /// model that is added takes the memory of its tables from them, and one that is removed gives it
  /// back.
  std::uint64_t memory_budget_bytes = std::uint64_t{256} << 20;
  /// Number of fetch threads, which serve all models; 1 to OpenOptions::kMaxFetchThreads.
  unsigned fetch_threads = 1;
  unsigned max_probes = 4;            ///< maximum number of probes, 1 to OpenOptions::kMaxProbes
  std::uint32_t max_instances = 256;  ///< maximum number of instances, 1 to kMaxInstances
  /// Maximum number of contacts that SceneProbe::contacts finds, 1 to kMaxContacts. Each probe
  /// takes some 200 bytes for each.
  std::uint32_t max_contacts = 64;
  /// Size of a frame in bytes: a power of two, 4 KiB to 256 KiB. A file with greater pages
  /// (ModelInfo::page_bytes) cannot be added; one with smaller pages takes a whole frame for each.
  std::uint32_t max_page_bytes = 65536;
  /// Maximum size in bytes of the coarse field of a model in memory. A larger one is thinned: every
  /// second, third or further point along each axis is kept, at least some 10 along the longest.
  /// Exact answers do not depend on it. Intervals of other answers are wider.
  std::uint64_t max_field_bytes = std::uint64_t{640} << 10;
  Locking locking = Locking::kTry;                 ///< as OpenOptions::locking
  EvictionPolicy policy = EvictionPolicy::kClock;  ///< as OpenOptions::policy
  unsigned wait_limit_ms = 10'000;                 ///< as OpenOptions::wait_limit_ms
  bool use_io_uring = true;                        ///< as OpenOptions::use_io_uring

  static constexpr std::uint32_t kMaxInstances = std::uint32_t{1} << 20;  ///< limit of the member
  static constexpr std::uint32_t kMaxContacts = 4096;                     ///< limit of the member
};

/// State and counters of a scene. Counters start at 0 when it is created and cover all its models,
/// those that were removed too.
struct SceneStats {
  std::uint32_t instances = 0;    ///< in the scene now
  std::uint32_t models = 0;       ///< open now: instances of one file and the same layers share one
  std::uint64_t page_hits = 0;    ///< as Stats::page_hits
  std::uint64_t page_misses = 0;  ///< as Stats::page_misses
  std::uint64_t pages_read = 0;   ///< as Stats::pages_read
  std::uint64_t pages_evicted = 0;      ///< as Stats::pages_evicted, with those of removed files
  std::uint64_t quarantined_pages = 0;  ///< as Stats::quarantined_pages
  std::uint64_t waits_given_up = 0;     ///< as Stats::waits_given_up
  std::uint64_t fetch_requests_served = 0;  ///< as Stats::fetch_requests_served
  std::uint64_t pages_prefetched = 0;       ///< as Stats::pages_prefetched
  std::uint64_t frames = 0;                 ///< maximum number of pages in memory, of all models
  std::uint64_t arena_bytes = 0;            ///< memory of the frames
  std::uint64_t model_bytes = 0;            ///< memory of the models besides their pages
  std::uint64_t table_bytes = 0;            ///< all other memory
  std::uint64_t budget_bytes = 0;  ///< memory_budget_bytes; at least the sum of these three
};

/// What one model of a scene holds besides its pages, in bytes of the budget.
struct ModelMemory {
  std::uint64_t total = 0;      ///< sum of all members below
  std::uint64_t directory = 0;  ///< where the file's pages are
  std::uint64_t side_grid = 0;  ///< grids of the side layer
  std::uint64_t field = 0;      ///< coarse field: the field layer
  std::uint64_t probes = 0;     ///< coherence and fetch requests of all probes and fetch threads
  std::uint64_t other = 0;      ///< the rest
};

/// Models in places. Any number of threads may query a scene, each with a SceneProbe of its own,
/// while others move its instances, and while one adds and removes some. The functions say which
/// threads may call them.
///
/// A process made by fork() must not use the scene.
class PLANETREE_API Scene {
 public:
  /// Makes an empty scene: claims and locks its memory, and starts its threads.
  ///
  /// errors   kUnsupported, kNoMemory: as Model::open. kBadArgument: an option is out of range.
  /// threads  any, but not real-time threads.
  [[nodiscard]] static Result<Scene> create(const SceneOptions& options = {});

  /// Moves another scene here. That one may then only be assigned to or destroyed.
  Scene(Scene&&) noexcept;
  /// Closes this scene, as the destructor does, and moves another one here.
  Scene& operator=(Scene&&) noexcept;
  /// Closes all files, ends the threads and releases the memory. Destroy all probes before.
  ~Scene();

  /// Puts a model into the scene. If the scene has an instance of the same content (see
  /// ModelInfo::content_id) with the same layers, the new one shares its file, tables and pages.
  /// Otherwise the file is opened, as Model::open does.
  ///
  /// pose     of the model in the world: maps its model units to the world's
  /// layers   as OpenOptions::layers. Attributes of triangles are not read in scenes.
  /// errors   those of Model::open. kBadArgument: the pose is not valid, there are
  ///          SceneOptions::max_instances already, or the file's pages are greater than
  ///          SceneOptions::max_page_bytes. kNoMemory: the text says how much is lacking.
  /// threads  any, but not real-time threads; one at a time with remove().
  Result<InstanceId> add(const std::filesystem::path& path, const Pose& pose = {},
                         std::uint32_t layers = kAllLayers);
  /// Takes an instance out of the scene. If it is the last one of its file, closes the file. Waits
  /// for the queries that run.
  ///
  /// errors   kBadArgument: there is no such instance.
  /// threads  any, but not real-time threads; one at a time with add(). Not while another thread is
  ///          in set_pose() for this instance.
  Result<void> remove(InstanceId instance);

  /// Moves an instance. Takes a fixed time, waits for nothing and makes no system call. A query
  /// that begins later sees this pose or a later one.
  ///
  /// errors   kBadArgument: there is no such instance, the pose is not valid, or the twist is not
  ///          finite.
  /// threads  any, also real-time threads; for one instance one at a time.
  Result<void> set_pose(InstanceId instance, const Pose& pose, const Twist& twist = {}) noexcept;

  /// Returns what a file says of its model. The reference is valid until the last instance of the
  /// file is removed.
  ///
  /// errors   kBadArgument: there is no such instance.
  /// threads  any; one at a time with remove().
  Result<const ModelInfo*> info(InstanceId instance) const noexcept;
  /// Returns the memory of an instance's model besides its pages. Instances that share a model
  /// share this memory.
  ///
  /// errors   kBadArgument: there is no such instance.
  /// threads  any; one at a time with remove().
  Result<ModelMemory> memory(InstanceId instance) const noexcept;
  /// Returns state and counters.
  ///
  /// threads  any, but not real-time threads; one at a time with add() and remove().
  SceneStats stats() const noexcept;

 private:
  friend class SceneProbe;
  explicit Scene(std::unique_ptr<query::SceneState> state) noexcept;
  std::unique_ptr<query::SceneState> state_;
};

/// The answer to a closest-point query of a scene: positions, normal and distances in the world
/// frame. Triangle, barycentric coordinates, feature and side are those of the instance.
struct SceneClosestPoint : ClosestPoint {
  InstanceId instance = kNoInstance;  ///< kNoInstance if there is no nearest point
};

/// The answer to a query of a scene for the side alone.
struct SceneContainment : Containment {
  /// Of the instances that contain the point, the one added first; or one that has it on its
  /// surface; else kNoInstance.
  InstanceId instance = kNoInstance;
};

/// The first contact of a moving ball with any instance: positions and normal in the world frame.
struct SceneFirstContact : FirstContact {
  InstanceId instance = kNoInstance;  ///< kNoInstance if no contact was found
};

/// The first triangle of any instance that a ray passes through: point and normal in the world
/// frame.
struct SceneRayHit : RayHit {
  InstanceId instance = kNoInstance;  ///< kNoInstance if there is no hit
};

/// One thread's access to a scene. It keeps coherence with each model.
///
/// Queries are those of Probe, and make the same promises: with Wait::kNever no allocation, lock,
/// system call or, if memory is locked, page fault. Answers are in the world frame. A query sees
/// one pose of each instance. Positions are rounded on the way into the frame of an instance; the
/// intervals of answers contain that error. An instance whose pose is the default one is not
/// rounded: a scene of one such instance answers as its model does, bit for bit.
///
/// threads  one at a time, as for Probe.
class PLANETREE_API SceneProbe {
 public:
  /// Makes a probe of a scene, of the models that it has and of those that it will have.
  ///
  /// errors   kBadArgument: the scene has SceneOptions::max_probes probes. kNoMemory.
  /// threads  any, but not real-time threads.
  [[nodiscard]] static Result<SceneProbe> create(const Scene& scene);

  /// Moves another probe here. That one may then only be assigned to or destroyed.
  SceneProbe(SceneProbe&&) noexcept;
  /// Destroys this probe and moves another one here.
  SceneProbe& operator=(SceneProbe&&) noexcept;
  ~SceneProbe();

  /// Returns the point nearest to the query point on the surface of any instance. Instances whose
  /// boxes are farther away than that are not asked. If two are equally near as computed, the one
  /// added first answers.
  ///
  /// - kExact means that no other instance can be nearer, and that the answer of this one is exact
  ///   for the query point rounded into its frame.
  /// - The side is that with respect to the nearest instance; see contains() for all of them. It is
  ///   kUnknown, and the status kDegraded, if the surface is nearer than the rounding error of the
  ///   pose. Beside an open surface it is that of the rounded point.
  /// - An empty scene answers kBeyondMaxDistance.
  ///
  /// query    query point, world frame. With coordinates above 2^500 it gives kBadQuery if an
  ///          instance has a pose that is not the default one.
  /// options  max_work is that of all instances together.
  SceneClosestPoint closest_point(Vec3 query, const QueryOptions& options = {}) noexcept;

  /// Returns whether the query point is inside of any instance. It is kOutside if it is outside of
  /// all; kUnknown if it is known to be inside of none, and one does not know.
  ///
  /// query, options  as Probe::contains has them.
  SceneContainment contains(Vec3 query, const QueryOptions& options = {}) noexcept;

  /// Finds the first contact of a moving ball with any instance, as Probe::first_contact does with
  /// a model. Instances may move meanwhile: each from its pose, by its twist, for as long as the
  /// motion of the ball takes.
  ///
  /// - t_lower is certified, also for instances that turn: before it the ball touches nothing. The
  ///   error of the poses, and of the way of a ball beside an instance that turns, which is not
  ///   straight, makes it smaller. That way bends by about an eighth of the angle times the angle
  ///   times the distance from the instance's origin.
  /// - t_upper is certified, and infinite where the contact is not certain.
  /// - `at` is where the contact occurs, at the time t.
  /// - If an instance turns by more than a radian, nothing is known of it: t_lower is 0.
  ///
  /// sweep    of the ball, world frame. With coordinates above 2^500 it gives kBadQuery if an
  ///          instance has a pose that is not the default one.
  /// seconds  that the motion takes, >= 0, finite. With 0 the instances stand still.
  /// options  as Probe::first_contact has them.
  SceneFirstContact first_contact(const Sweep& sweep, double seconds = 0,
                                  const QueryOptions& options = {}) noexcept;

  /// Finds the contacts of a ball about the query point with the instances, as Probe::contacts does
  /// with a model: those of all instances, as many as fit, the nearest first; where distances are
  /// equal, those of the instance added first.
  ///
  /// - Intervals hold the rounding of poses. Whether a contact is within the radius is decided by
  ///   its distance as computed.
  /// - Sides and normals are those with respect to the contact's instance; see closest_point().
  ///
  /// query    as closest_point() has it; a bad one finds nothing.
  /// radius   model units, >= 0, may be infinite. Another value finds nothing.
  /// found    receives the answers; at most SceneOptions::max_contacts.
  /// options  as Probe::contacts has them; max_work is that of all instances together.
  /// return   how many were found. `complete` says that these are all contacts within the radius.
  ///          It is false if `found` is full and other instances are near enough to have more.
  Found contacts(Vec3 query, double radius, std::span<SceneClosestPoint> found,
                 const QueryOptions& options = {}) noexcept;

  /// Finds the first triangle of any instance that a ray passes through, as Probe::first_hit does
  /// in a model: the hit of least `t`, as computed, and where these are equal, of the instance
  /// added first.
  ///
  /// - Which triangles a ray passes through is decided exactly for the ray rounded into the frame
  ///   of an instance. kExact is about that ray.
  /// - t_lower is certified for the ray itself: before it the ray passes through nothing. So it may
  ///   be finite without a hit, where the ray passes by a triangle within the error of the pose.
  /// - t_upper is certified too. For an instance whose pose is not the default one it is finite if
  ///   the point is well inside of a triangle that is not too thin.
  ///
  /// ray      world frame. With coordinates above 2^500 it gives kBadQuery if an instance has a
  ///          pose that is not the default one.
  /// options  as Probe::first_hit has them; max_work is that of all instances together.
  SceneRayHit first_hit(const Ray& ray, const QueryOptions& options = {}) noexcept;

  /// States where the tool is and how it moves, as Probe::motion does. The fetch threads prefetch
  /// pages of the instance that answered last, along the motion relative to it.
  ///
  /// position, velocity  world frame, model units and model units per second.
  void motion(Vec3 position, Vec3 velocity) noexcept;

 private:
  friend class PointShell;
  explicit SceneProbe(std::unique_ptr<query::SceneProbeState> state) noexcept;
  std::unique_ptr<query::SceneProbeState> state_;
};

}  // namespace planetree
