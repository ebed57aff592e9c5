#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "planetree/contact.h"
#include "planetree/error.h"
#include "planetree/export.h"
#include "planetree/model.h"
#include "planetree/types.h"

namespace planetree {

namespace query {
class ProbeState;
}

/// One thread's access to a Model. It keeps coherence: data that a query reuses from earlier
/// queries nearby.
///
/// Queries do not throw or print. They do not allocate memory, except for a batch that runs on more
/// than one thread.
///
/// - A blocking query (Wait::kForPages) reads missing pages from the file. It may wait for the
///   disk.
/// - A real-time query (Wait::kNever) makes no system call and takes no lock. It causes no page
///   fault if the arena is locked (see Locking). It visits at most QueryOptions::max_work records,
///   4096 by default.
///
/// The model must outlive the probe. Each call saves the floating-point mode of the thread, sets
/// the mode that it needs, and restores the thread's mode. So callers need not set a mode.
///
/// threads  one at a time. If another thread is to use the probe, the caller synchronises the
///          hand-over, for example by a mutex. Different probes may be used at the same time.
class PLANETREE_API Probe {
 public:
  /// Makes a probe of a model.
  ///
  /// errors   kBadArgument: the model already has OpenOptions::max_probes probes. kNoMemory.
  /// threads  any, but not real-time threads: allocates memory. Does not wait for the disk.
  [[nodiscard]] static Result<Probe> create(const Model& model);

  /// Moves another probe here. That one may then only be assigned to or destroyed.
  Probe(Probe&&) noexcept;
  /// Destroys this probe and moves another one here, which may be of another model.
  Probe& operator=(Probe&&) noexcept;
  /// Destroys the probe. A later probe may have the same index (see PageAccess::probe).
  ~Probe();

  /// Returns the surface point nearest to the query point, a certified interval of the distance,
  /// the side of the query point, and the contact normal.
  ///
  /// With default options the answer is exact, with these exceptions: a page is unreadable, a wait
  /// for a page exceeds OpenOptions::wait_limit_ms, or a wall of a region is nearer to the query
  /// point than the surface is (see ModelInfo::has_region). An exact answer is a function of the
  /// file, the query point and the options. It has the same bits for any thread, memory budget,
  /// order of queries and processor.
  ///
  /// query    query point, model units. A coordinate that is NaN or infinite gives kBadQuery.
  /// options  a value out of range gives kBadQuery.
  ClosestPoint closest_point(Vec3 query, const QueryOptions& options = {}) noexcept;

  /// Returns the side of the query point. A side that is not kUnknown is right, however near the
  /// surface the point is. Coordinates that are smaller than about 2^-1022 times the model's
  /// longest edge are rounded first.
  ///
  /// By SideRule::kSurface this searches the nearest triangle, as closest_point() does.
  ///
  /// The side is kUnknown, and the status kDegraded, if pages or work are missing, or if the point
  /// is beyond a wall of the file's region (see ModelInfo::has_region). If the surface is not
  /// watertight, it is also kUnknown if the magnitude of the winding number differs from 1/2 by
  /// less than about 2^-45 times the number of caps (ModelInfo::caps).
  ///
  /// query    query point, model units. A coordinate that is NaN or infinite gives kBadQuery.
  /// options  only `wait`, `max_work` and `side_rule` have an effect. A value of any option that is
  /// out of range
  ///          gives kBadQuery.
  Containment contains(Vec3 query, const QueryOptions& options = {}) noexcept;

  /// Finds the triangles nearest to the query point: as many as fit into `found`, by distance and,
  /// where distances are equal, by index.
  ///
  /// Each answer is about one triangle: its distance with the interval, the nearest point on it,
  /// and with kNormal in `parts` its own unit normal, as the mesh orients it, or (0, 0, 1) if it
  /// has no area. With kSide, each has the side of the query point. The status is kExact if no
  /// triangle that lacks can come before this one, and the side is known or not requested; else
  /// kDegraded.
  ///
  /// query    query point, model units. A coordinate that is NaN or infinite, or so large that it
  ///          overflows, finds nothing.
  /// found    receives the answers, the nearest first.
  /// options  `wait`, `max_distance`, `max_work`, `parts` and `side_rule` have an effect. A value
  ///          out of range finds nothing.
  /// return   how many were found. `complete` says that no other triangle belongs to them. If
  ///          not, pages or work lacked, or the triangles of the file's region do not suffice. A
  ///          real-time query then requests the pages for the nearest 256 triangles, or for all
  ///          within `max_distance` if more were asked for.
  Found nearest_triangles(Vec3 query, std::span<ClosestPoint> found,
                          const QueryOptions& options = {}) noexcept;
  /// Finds all triangles within a radius of the query point; else as nearest_triangles(). If there
  /// are more than fit into `found`, these are the nearest, and the set is not complete.
  ///
  /// radius  model units, >= 0, may be infinite. Another value finds nothing.
  Found triangles_within(Vec3 query, double radius, std::span<ClosestPoint> found,
                         const QueryOptions& options = {}) noexcept;

  /// Finds the first triangle that a ray passes through: the one of least `t`, as computed, and
  /// where these are equal, of least index.
  ///
  /// ray      a value that is NaN, an infinite one but for t_max, a direction of length zero, or a
  ///          range that is out of order gives kBadQuery.
  /// options  `wait`, `max_distance`, measured along the ray from t_min, and `max_work` have an
  ///          effect. A value out of range gives kBadQuery.
  /// return   kExact: nothing that was not read can come before the hit, or, without a hit, be hit
  ///          at all. kDegraded: pages or work lacked, or missing triangles of the file's region
  ///          may be in the way (see ModelInfo::has_region): no triangle is hit before t_lower, and
  ///          the hit is the first of those read. kBeyondMaxDistance: nothing within max_distance,
  ///          and t_lower is its position.
  RayHit first_hit(const Ray& ray, const QueryOptions& options = {}) noexcept;
  /// Finds the triangles that a ray passes through, by `t` and, where these are equal, by index. If
  /// there are more than fit into `hits`, these are the first, and the set is not complete.
  ///
  /// Each hit is about one triangle: its interval contains the true t. The status is kExact if no
  /// triangle that lacks can come before it, else kDegraded. A bad ray or option finds nothing.
  Found all_hits(const Ray& ray, std::span<RayHit> hits, const QueryOptions& options = {}) noexcept;

  /// Finds the first contact of a moving ball with the surface. Of triangles touched at the same
  /// time, as computed, it is the one of least index; at the start of the motion the nearest one. A
  /// ball that begins in contact has t = 0. A ball of radius 0 touches what its centre passes
  /// through, as the ray of a segment does, the ends included.
  ///
  /// sweep    a value that is NaN or infinite or a negative radius gives kBadQuery.
  /// options  `wait`, `max_distance`, which ends the motion after that length, and `max_work` have
  ///          an effect. A value out of range gives kBadQuery.
  /// return   kExact: nothing that was not read can be touched before. kDegraded: else, and
  ///          kBeyondMaxDistance, as for first_hit(). Before t_lower the ball is free in any case.
  ///          A real-time query requests the pages that lacked.
  FirstContact first_contact(const Sweep& sweep, const QueryOptions& options = {}) noexcept;

  /// Finds the triangles that touch a closed box, without any error; else as triangles_within() of
  /// the box's centre: each answer is about the distance from the centre.
  ///
  /// box  model units; finite, lower <= upper along each axis. Another one finds nothing.
  Found triangles_within(const Box& box, std::span<ClosestPoint> found,
                         const QueryOptions& options = {}) noexcept;

  /// Finds the contacts of a ball about the query point with the surface: the local minima of the
  /// distance from the query point, as many as fit into `found`, the nearest first. A tip in a
  /// groove has one on each wall; over a plane it has one, however finely the plane is cut into
  /// triangles.
  ///
  /// A contact is a surface point from which the distance grows on the way to any nearer point of
  /// the surface, by more than `max_error` and the rounding of the distances. Ways lead over
  /// triangles that share corners, and over gaps no wider than that. So `max_error`, 0 by default,
  /// removes the contacts that come from noise of that height.
  ///
  /// The first contact is the answer of closest_point(). The others have members as described there
  /// for a triangle that is not the nearest. `feature` and `triangle` name what the contact is on.
  /// They stay the same from query to query as long as the contact is on the same face, edge or
  /// vertex. Of the triangles at an edge or vertex it is the one of least index. The positive
  /// members of `barycentric` tell which of its edges or corners.
  ///
  /// The status of a contact is kExact if nothing that lacks can be part of it, and the requested
  /// parts are proven. A contact of status kDegraded may belong to a nearer one.
  ///
  /// query    query point, model units. A coordinate that is NaN or infinite, or so large that it
  ///          overflows, finds nothing.
  /// radius   model units, >= 0, may be infinite. Another value finds nothing.
  /// found    receives the answers, the nearest first.
  /// options  all have an effect. A value out of range finds nothing.
  /// return   how many were found. `complete` says that these are all contacts within the radius.
  ///          If not, more were found than fit, pages or work lacked, or the triangles of the
  ///          file's region do not suffice; or more than 384 triangles meet the sphere about the
  ///          query point through the next contact. A real-time query then requests the pages that
  ///          lack.
  Found contacts(Vec3 query, double radius, std::span<ClosestPoint> found,
                 const QueryOptions& options = {}) noexcept;

  /// Reports where the device is and how fast it moves. From this a fetch thread predicts four
  /// positions in the next 5 to 600 ms and reads the pages that queries there need. Each call
  /// replaces the motion before. Call it with every query, since a motion is used once.
  ///
  /// The call is a hint: it changes which pages are in memory, and answers in no other way. It
  /// makes no system call and takes no lock.
  ///
  /// position  model units. A prediction that is not finite is ignored.
  /// velocity  model units per second. 0 stops prefetching.
  /// threads   the thread that uses the probe.
  void motion(Vec3 position, Vec3 velocity) noexcept;

  /// Returns the work of all queries of this probe so far, in the units of QueryOptions::max_work.
  /// A program that shares a limit between several queries takes the difference. What the threads
  /// of a batch do is not counted.
  ///
  /// threads  the thread that uses the probe.
  std::uint64_t work_spent() const noexcept;

  /// Answers a batch of query points. An exact answer has the same bits as that of closest_point().
  ///
  /// The queries run in an order that minimises page switches, on OpenOptions::batch_threads
  /// threads. If there is more than one, they are threads of oneTBB, which may allocate memory.
  /// With Wait::kNever the calling thread answers all queries. An answer that is not exact then
  /// depends on the pages that are in memory when its query runs.
  ///
  /// queries  query points, model units. May be empty. A point that is not finite gives kBadQuery
  ///          in its own answer only.
  /// answers  answers[i] is that of queries[i]. answers.size() must equal queries.size(): debug
  ///          builds assert this, and with NDEBUG other sizes are undefined behaviour. The spans
  ///          must not overlap. The call uses `answers` as scratch memory until it returns.
  void closest_points(std::span<const Vec3> queries, std::span<ClosestPoint> answers,
                      const QueryOptions& options = {}) noexcept;
  /// Answers a batch of contains(). The rules of closest_points() apply.
  void contains(std::span<const Vec3> queries, std::span<Containment> answers,
                const QueryOptions& options = {}) noexcept;
  /// Answers a batch of first_hit(). The rules of closest_points() apply.
  void first_hits(std::span<const Ray> rays, std::span<RayHit> hits,
                  const QueryOptions& options = {}) noexcept;
  /// Answers a batch of first_contact(). The rules of closest_points() apply.
  void first_contacts(std::span<const Sweep> sweeps, std::span<FirstContact> contacts,
                      const QueryOptions& options = {}) noexcept;
  /// Answer batches of nearest_triangles(), triangles_within() and contacts(). Each query point has
  /// an equal share of `answers`, in the order of the queries. The rules of closest_points() apply,
  /// except that `found` is the scratch memory.
  ///
  /// answers  room for a whole number of answers of each query point. Of what a query does not
  ///          find, the memory is left as it is.
  /// found    found[i] is what queries[i] found; found.size() must equal queries.size().
  void nearest_triangles(std::span<const Vec3> queries, std::span<ClosestPoint> answers,
                         std::span<Found> found, const QueryOptions& options = {}) noexcept;
  /// See the batch of nearest_triangles().
  void triangles_within(std::span<const Vec3> queries, double radius,
                        std::span<ClosestPoint> answers, std::span<Found> found,
                        const QueryOptions& options = {}) noexcept;
  /// See the batch of nearest_triangles().
  void contacts(std::span<const Vec3> queries, double radius, std::span<ClosestPoint> answers,
                std::span<Found> found, const QueryOptions& options = {}) noexcept;

 private:
  explicit Probe(std::unique_ptr<query::ProbeState> state) noexcept;
  std::unique_ptr<query::ProbeState> state_;
};

}  // namespace planetree
