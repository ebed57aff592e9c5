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

#include "planetree/c_types.h"

#ifdef __cplusplus
#define PLANETREE_C_API __attribute__((visibility("default")))
#define PLANETREE_C_NOEXCEPT noexcept
extern "C" {
#else
#define PLANETREE_C_API
#define PLANETREE_C_NOEXCEPT
#endif

/// Returns the version of the library, such as "1.2.3".
PLANETREE_C_API const char* planetree_version(void) PLANETREE_C_NOEXCEPT;

/// Sets the default options of planetree_open().
PLANETREE_C_API void planetree_default_open_options(planetree_open_options* options)
    PLANETREE_C_NOEXCEPT;
/// Sets the default options of a query.
PLANETREE_C_API void planetree_default_query_options(planetree_query_options* options)
    PLANETREE_C_NOEXCEPT;
/// Sets the default options of a build.
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
/// Returns the contents of the file.
PLANETREE_C_API void planetree_model_info(const planetree_model* model,
                                          planetree_info* info) PLANETREE_C_NOEXCEPT;
/// Returns the state and the counters of the open file.
PLANETREE_C_API void planetree_model_stats(const planetree_model* model,
                                           planetree_stats* stats) PLANETREE_C_NOEXCEPT;

/// Reads triangles of the mesh by their indices, as planetree::Model::triangles(). It may wait for
/// the disk.
///
/// triangles  receives `count` triangles; undefined on failure
/// error      may be null
/// return     a planetree_code
PLANETREE_C_API uint32_t planetree_read_triangles(const planetree_model* model,
                                                  const uint64_t* indices, size_t count,
                                                  planetree_triangle* triangles,
                                                  planetree_error* error) PLANETREE_C_NOEXCEPT;

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

/// Finds the nearest surface point. With `never_waits` this and the other queries allocate nothing,
/// take no lock and make no system call.
///
/// options  of this and the other queries; null: the defaults
PLANETREE_C_API void planetree_find_closest_point(
    planetree_probe* probe, const double point[3], const planetree_query_options* options,
    planetree_closest_point* answer) PLANETREE_C_NOEXCEPT;
/// Finds the side of a point. Returns a planetree_side.
PLANETREE_C_API uint32_t planetree_find_side(planetree_probe* probe, const double point[3],
                                             const planetree_query_options* options)
    PLANETREE_C_NOEXCEPT;
/// Finds the first triangle that a ray passes through.
PLANETREE_C_API void planetree_find_first_hit(planetree_probe* probe, const planetree_ray* ray,
                                              const planetree_query_options* options,
                                              planetree_hit* hit) PLANETREE_C_NOEXCEPT;
/// Finds the first contact of a moving ball.
PLANETREE_C_API void planetree_find_first_contact(
    planetree_probe* probe, const planetree_sweep* sweep, const planetree_query_options* options,
    planetree_first_contact* contact) PLANETREE_C_NOEXCEPT;
/// Finds up to `size` hits of a ray, in their order.
PLANETREE_C_API planetree_found planetree_find_all_hits(planetree_probe* probe,
                                                        const planetree_ray* ray,
                                                        const planetree_query_options* options,
                                                        planetree_hit* hits,
                                                        size_t size) PLANETREE_C_NOEXCEPT;
/// Finds up to `size` contacts of a ball, the nearest first.
PLANETREE_C_API planetree_found planetree_find_contacts(planetree_probe* probe,
                                                        const double point[3], double radius,
                                                        const planetree_query_options* options,
                                                        planetree_closest_point* answers,
                                                        size_t size) PLANETREE_C_NOEXCEPT;
/// Finds up to `size` triangles nearest to a point, the nearest first.
PLANETREE_C_API planetree_found planetree_find_nearest_triangles(
    planetree_probe* probe, const double point[3], const planetree_query_options* options,
    planetree_closest_point* answers, size_t size) PLANETREE_C_NOEXCEPT;
/// Finds up to `size` triangles within a radius of a point, the nearest first.
PLANETREE_C_API planetree_found
planetree_find_triangles_within(planetree_probe* probe, const double point[3], double radius,
                                const planetree_query_options* options,
                                planetree_closest_point* answers, size_t size) PLANETREE_C_NOEXCEPT;

/// Finds the nearest surface points of many points. Answer i is that of point i.
///
/// points  three doubles for each of `count` points
PLANETREE_C_API void planetree_find_closest_points(
    planetree_probe* probe, const double* points, size_t count,
    const planetree_query_options* options, planetree_closest_point* answers) PLANETREE_C_NOEXCEPT;
/// Finds the first hits of rays. Hit i is that of ray i.
PLANETREE_C_API void planetree_find_first_hits(planetree_probe* probe, const planetree_ray* rays,
                                               size_t count, const planetree_query_options* options,
                                               planetree_hit* hits) PLANETREE_C_NOEXCEPT;
/// Finds the first contacts of moving balls. Contact i is that of sweep i.
PLANETREE_C_API void planetree_find_first_contacts(
    planetree_probe* probe, const planetree_sweep* sweeps, size_t count,
    const planetree_query_options* options, planetree_first_contact* contacts) PLANETREE_C_NOEXCEPT;

/// Tells where the probe moves, units per second, so that pages ahead of it are prefetched.
PLANETREE_C_API void planetree_note_motion(planetree_probe* probe, const double position[3],
                                           const double velocity[3]) PLANETREE_C_NOEXCEPT;

#ifdef __cplusplus
}
#endif
