#pragma once

/// @file
/// The interface of the library in C11, for engines and other languages. It is the part of the
/// shared library whose names, structs and values stay the same within a major version.
///
/// Each call is that of the C++ interface with the same name; see planetree/model.h,
/// planetree/probe.h and planetree/build.h for what answers mean. Lengths are in model units.
/// Points are three doubles. No call throws, prints or exits. A null pointer is an error of the
/// caller unless a comment allows it.
///
/// Options begin with `struct_bytes`, which the function that sets the defaults fills in. A later
/// version may add members behind the others, and goes by it.

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
#define PLANETREE_C_API __attribute__((visibility("default")))
#define PLANETREE_C_NOEXCEPT noexcept
extern "C" {
#else
#define PLANETREE_C_API
#define PLANETREE_C_NOEXCEPT
#endif

#define PLANETREE_NO_TRIANGLE UINT64_MAX  ///< index of answers without a triangle
#define PLANETREE_NOWHERE UINT64_MAX      ///< planetree_error::page and offset: none
#define PLANETREE_NO_LIMIT UINT32_MAX     ///< planetree_query_options::max_work: no limit

/// An open file. Any number of threads may share one. It must outlive its probes.
typedef struct planetree_model planetree_model;
/// Runs queries. For one thread at a time.
typedef struct planetree_probe planetree_probe;

/// Kinds of failures, as planetree::ErrorCode.
enum planetree_code {
  PLANETREE_OK = 0,
  PLANETREE_BAD_ARGUMENT = 1,
  PLANETREE_NOT_FOUND = 2,
  PLANETREE_ALREADY_EXISTS = 3,
  PLANETREE_PERMISSION = 4,
  PLANETREE_NO_SPACE = 5,
  PLANETREE_NO_MEMORY = 6,
  PLANETREE_READ_FAILED = 7,
  PLANETREE_WRITE_FAILED = 8,
  PLANETREE_BAD_INPUT = 9,
  PLANETREE_NOT_PLANETREE = 10,
  PLANETREE_UNSUPPORTED = 11,
  PLANETREE_TRUNCATED = 12,
  PLANETREE_DAMAGED = 13,
  PLANETREE_CANCELLED = 14
};

enum planetree_side {
  PLANETREE_INSIDE = 0,
  PLANETREE_OUTSIDE = 1,
  PLANETREE_ON_SURFACE = 2,
  PLANETREE_SIDE_UNKNOWN = 3
};
enum planetree_feature { PLANETREE_FACE = 0, PLANETREE_EDGE = 1, PLANETREE_VERTEX = 2 };
enum planetree_status {
  PLANETREE_EXACT = 0,
  PLANETREE_WITHIN_ERROR = 1,
  PLANETREE_DEGRADED = 2,
  PLANETREE_BEYOND_MAX_DISTANCE = 3,
  PLANETREE_BAD_QUERY = 4
};
enum planetree_part { PLANETREE_DISTANCE = 1, PLANETREE_SIDE = 2, PLANETREE_NORMAL = 4 };
enum planetree_layer {
  PLANETREE_DISTANCE_LAYER = 1,
  PLANETREE_SIDE_LAYER = 2,
  PLANETREE_FIELD_LAYER = 4
};
enum planetree_side_rule {
  PLANETREE_RULE_OF_FILE = 0,
  PLANETREE_RULE_SOLID = 1,
  PLANETREE_RULE_SURFACE = 2
};
enum planetree_normal_rule { PLANETREE_OUTWARD = 0, PLANETREE_TOWARD_QUERY = 1 };

/// A failure: its kind, its place in the file, and its cause and remedy in one line.
typedef struct planetree_error {
  uint32_t code;    ///< a planetree_code
  uint64_t page;    ///< page of the file, or PLANETREE_NOWHERE
  uint64_t offset;  ///< byte of the file, or PLANETREE_NOWHERE
  char text[192];   ///< ended by 0
} planetree_error;

/// Options of planetree_open(), as planetree::OpenOptions.
typedef struct planetree_open_options {
  size_t struct_bytes;
  uint64_t memory_budget_bytes;
  uint32_t fetch_threads;
  uint32_t batch_threads;
  uint32_t max_probes;
  uint32_t layers;         ///< a sum of planetree_layer
  uint32_t wait_limit_ms;  ///< longest wait of a query for one page
  bool requires_locking;   ///< whether memory that cannot be locked is a failure
  bool read_ahead;
  bool uses_io_uring;
} planetree_open_options;

/// Contents of a file, as planetree::ModelInfo.
typedef struct planetree_info {
  uint64_t triangles;
  uint64_t skipped;
  uint64_t vertices;
  uint64_t unbalanced_edges;  ///< 0: the surface is watertight
  double box_lower[3];
  double box_upper[3];
  double core_lower[3];
  double core_upper[3];
  uint32_t side_rule;  ///< a planetree_side_rule
  uint32_t layers;     ///< a sum of planetree_layer
  uint32_t pages;
  uint32_t page_bytes;
  uint64_t file_bytes;
} planetree_info;

/// State and counters of an open file, as planetree::Stats.
typedef struct planetree_stats {
  uint64_t page_hits;
  uint64_t page_misses;
  uint64_t pages_read;
  uint64_t pages_evicted;
  uint64_t quarantined_pages;
  uint64_t degraded_answers;
  uint64_t frames;
  uint64_t budget_bytes;
  uint64_t locked_bytes;
} planetree_stats;

/// Options of a query, as planetree::QueryOptions. Where a call takes a pointer to them, null means
/// the defaults.
typedef struct planetree_query_options {
  size_t struct_bytes;
  uint32_t parts;        ///< a sum of planetree_part
  uint32_t side_rule;    ///< a planetree_side_rule
  uint32_t normal_rule;  ///< a planetree_normal_rule
  uint32_t max_work;     ///< units of work, or PLANETREE_NO_LIMIT
  double max_error;      ///< allowed error of the distance; 0: exact
  double max_distance;   ///< distance to search within
  bool never_waits;      ///< true: a real-time query, which does not wait for pages
} planetree_query_options;

/// The nearest surface point of a query point, as planetree::ClosestPoint.
typedef struct planetree_closest_point {
  double distance;
  double lower;  ///< certified: the true distance is in [lower, upper]
  double upper;
  uint8_t side;  ///< a planetree_side
  double point[3];
  double normal[3];
  uint64_t triangle;
  double barycentric[3];
  uint8_t feature;  ///< a planetree_feature
  uint8_t status;   ///< a planetree_status
} planetree_closest_point;

/// The points origin + t * direction with t_min <= t <= t_max.
typedef struct planetree_ray {
  double origin[3];
  double direction[3];
  double t_min;
  double t_max;
} planetree_ray;

/// A point where a ray passes through a triangle, as planetree::RayHit.
typedef struct planetree_hit {
  double t;  ///< infinite if there is no hit
  double t_lower;
  double t_upper;
  double point[3];
  double normal[3];
  uint64_t triangle;
  double barycentric[3];
  bool entering;
  uint8_t status;  ///< a planetree_status
} planetree_hit;

/// The straight motion of a ball while t goes from 0 to 1.
typedef struct planetree_sweep {
  double from[3];
  double to[3];
  double radius;
} planetree_sweep;

/// The first contact of a moving ball, as planetree::FirstContact.
typedef struct planetree_first_contact {
  double t;
  double t_lower;
  double t_upper;
  planetree_closest_point at;
  bool free;       ///< certainly no contact in all of the motion
  uint8_t status;  ///< a planetree_status
} planetree_first_contact;

/// What a query for several answers found.
typedef struct planetree_found {
  size_t count;   ///< answers written
  bool complete;  ///< whether no other one belongs to the set
} planetree_found;

/// Options of builds, as planetree::BuildOptions.
typedef struct planetree_build_options {
  size_t struct_bytes;
  uint64_t memory_bytes;  ///< maximum memory; 0: a quarter of the machine's
  uint32_t threads;       ///< 0: one for each processor
  uint32_t page_bytes;
  uint32_t layers;             ///< a sum of planetree_layer
  uint32_t side_rule;          ///< PLANETREE_RULE_OF_FILE: as the mesh suggests
  const char* temp_directory;  ///< null: the directory of the output
  bool resume;
  bool strict;
  bool replace;
  /// Called with `context` and the progress of a phase; returns false to cancel the build. Calls
  /// come from any thread, but never two at the same time. May be null.
  bool (*on_progress)(void* context, const char* phase, uint64_t done, uint64_t total);
  void* context;
} planetree_build_options;

/// What was built, as planetree::BuildReport.
typedef struct planetree_build_report {
  uint64_t triangles;
  uint64_t skipped;
  uint64_t unbalanced_edges;
  uint64_t file_bytes;
  uint32_t side_rule;  ///< a planetree_side_rule
  uint32_t layers;
} planetree_build_report;

/// Returns the version of the library, such as "1.2.3".
PLANETREE_C_API const char* planetree_version(void) PLANETREE_C_NOEXCEPT;

/// Set the default options.
PLANETREE_C_API void planetree_default_open_options(planetree_open_options* options)
    PLANETREE_C_NOEXCEPT;
PLANETREE_C_API void planetree_default_query_options(planetree_query_options* options)
    PLANETREE_C_NOEXCEPT;
PLANETREE_C_API void planetree_default_build_options(planetree_build_options* options)
    PLANETREE_C_NOEXCEPT;

/// Builds the .ptree file of a mesh file.
///
/// options        null: the defaults
/// report, error  what was built, and why nothing was; each may be null
/// return         a planetree_code; 0: the file is complete
PLANETREE_C_API uint32_t planetree_build(const char* mesh, const char* output,
                                         const planetree_build_options* options,
                                         planetree_build_report* report,
                                         planetree_error* error) PLANETREE_C_NOEXCEPT;
/// Builds the .ptree file of a mesh in memory; else as planetree_build().
///
/// vertices   three doubles for each vertex
/// triangles  three indices of vertices for each triangle
PLANETREE_C_API uint32_t planetree_build_mesh(const double* vertices, size_t vertex_count,
                                              const uint32_t* triangles, size_t triangle_count,
                                              const char* output,
                                              const planetree_build_options* options,
                                              planetree_build_report* report,
                                              planetree_error* error) PLANETREE_C_NOEXCEPT;

/// Opens a file.
///
/// options  null: the defaults
/// model    receives the model, which planetree_close() closes; null on failure
/// error    may be null
/// return   a planetree_code; 0: the file is open
PLANETREE_C_API uint32_t planetree_open(const char* path, const planetree_open_options* options,
                                        planetree_model** model,
                                        planetree_error* error) PLANETREE_C_NOEXCEPT;
/// Closes a file. Destroy its probes before. Null is allowed.
PLANETREE_C_API void planetree_close(planetree_model* model) PLANETREE_C_NOEXCEPT;
PLANETREE_C_API void planetree_model_info(const planetree_model* model,
                                          planetree_info* info) PLANETREE_C_NOEXCEPT;
PLANETREE_C_API void planetree_model_stats(const planetree_model* model,
                                           planetree_stats* stats) PLANETREE_C_NOEXCEPT;

/// Creates a probe.
///
/// probe   receives the probe, which planetree_destroy_probe() destroys; null on failure
/// error   may be null
/// return  a planetree_code
PLANETREE_C_API uint32_t planetree_create_probe(const planetree_model* model,
                                                planetree_probe** probe,
                                                planetree_error* error) PLANETREE_C_NOEXCEPT;
/// Destroys a probe. Null is allowed.
PLANETREE_C_API void planetree_destroy_probe(planetree_probe* probe) PLANETREE_C_NOEXCEPT;

/// The queries. With `never_waits` they allocate nothing, take no lock and make no system call.
///
/// options  null: the defaults
PLANETREE_C_API void planetree_find_closest_point(
    planetree_probe* probe, const double point[3], const planetree_query_options* options,
    planetree_closest_point* answer) PLANETREE_C_NOEXCEPT;
/// Returns a planetree_side.
PLANETREE_C_API uint32_t planetree_find_side(planetree_probe* probe, const double point[3],
                                             const planetree_query_options* options)
    PLANETREE_C_NOEXCEPT;
PLANETREE_C_API void planetree_find_first_hit(planetree_probe* probe, const planetree_ray* ray,
                                              const planetree_query_options* options,
                                              planetree_hit* hit) PLANETREE_C_NOEXCEPT;
PLANETREE_C_API void planetree_find_first_contact(
    planetree_probe* probe, const planetree_sweep* sweep, const planetree_query_options* options,
    planetree_first_contact* contact) PLANETREE_C_NOEXCEPT;
/// Finds up to `size` hits of a ray, in their order.
PLANETREE_C_API planetree_found planetree_find_all_hits(planetree_probe* probe,
                                                        const planetree_ray* ray,
                                                        const planetree_query_options* options,
                                                        planetree_hit* hits,
                                                        size_t size) PLANETREE_C_NOEXCEPT;
/// Find up to `size` contacts of a ball, triangles nearest to a point, or triangles within a radius
/// of it; the nearest first.
PLANETREE_C_API planetree_found planetree_find_contacts(planetree_probe* probe,
                                                        const double point[3], double radius,
                                                        const planetree_query_options* options,
                                                        planetree_closest_point* answers,
                                                        size_t size) PLANETREE_C_NOEXCEPT;
PLANETREE_C_API planetree_found planetree_find_nearest_triangles(
    planetree_probe* probe, const double point[3], const planetree_query_options* options,
    planetree_closest_point* answers, size_t size) PLANETREE_C_NOEXCEPT;
PLANETREE_C_API planetree_found
planetree_find_triangles_within(planetree_probe* probe, const double point[3], double radius,
                                const planetree_query_options* options,
                                planetree_closest_point* answers, size_t size) PLANETREE_C_NOEXCEPT;

/// The queries of many points, rays and moving balls. Answer i is that of query i.
///
/// points  three doubles for each of `count` points
PLANETREE_C_API void planetree_find_closest_points(
    planetree_probe* probe, const double* points, size_t count,
    const planetree_query_options* options, planetree_closest_point* answers) PLANETREE_C_NOEXCEPT;
PLANETREE_C_API void planetree_find_first_hits(planetree_probe* probe, const planetree_ray* rays,
                                               size_t count, const planetree_query_options* options,
                                               planetree_hit* hits) PLANETREE_C_NOEXCEPT;
PLANETREE_C_API void planetree_find_first_contacts(
    planetree_probe* probe, const planetree_sweep* sweeps, size_t count,
    const planetree_query_options* options, planetree_first_contact* contacts) PLANETREE_C_NOEXCEPT;

/// Tells where the probe moves, units per second, so that pages ahead of it are prefetched.
PLANETREE_C_API void planetree_note_motion(planetree_probe* probe, const double position[3],
                                           const double velocity[3]) PLANETREE_C_NOEXCEPT;

#ifdef __cplusplus
}
#endif
