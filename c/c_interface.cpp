#include "planetree/c.h"

#include <cstddef>
#include <exception>
#include <new>
#include <span>
#include <utility>

#include "c/c_values.h"
#include "planetree/error.h"
#include "planetree/model.h"
#include "planetree/probe.h"

// The handles of the interface.
struct planetree_model {
  planetree::Model model;
};
struct planetree_probe {
  planetree::Probe probe;
};

namespace planetree::c {
namespace {

const Vec3& point_of(const double* at) { return *reinterpret_cast<const Vec3*>(at); }

OpenOptions open_options_of(const planetree_open_options* given) {
  OpenOptions options;
  if (!given) return options;
  options.memory_budget_bytes = given->memory_budget_bytes;
  options.fetch_threads = given->fetch_threads;
  options.batch_threads = given->batch_threads;
  options.max_probes = given->max_probes;
  options.layers = given->layers;
  options.wait_limit_ms = given->wait_limit_ms;
  options.locking = given->requires_locking ? Locking::kRequire : Locking::kTry;
  options.read_ahead = given->read_ahead;
  options.use_io_uring = given->uses_io_uring;
  options.allow_missing_members = given->allows_missing_members;
  if (given->http_cache) options.http_cache = given->http_cache;
  options.http_cache_bytes = given->http_cache_bytes;
  return options;
}

void copy(const Vec3& from, double (&to)[3]) {
  to[0] = from.x;
  to[1] = from.y;
  to[2] = from.z;
}

}  // namespace
}  // namespace planetree::c

using planetree::c::fail;
using planetree::c::options_of;
using planetree::c::point_of;
using planetree::c::written;

void planetree_default_open_options(planetree_open_options* options) noexcept {
  const planetree::OpenOptions defaults;
  *options = {};
  options->struct_bytes = sizeof *options;
  options->memory_budget_bytes = defaults.memory_budget_bytes;
  options->fetch_threads = defaults.fetch_threads;
  options->batch_threads = defaults.batch_threads;
  options->max_probes = defaults.max_probes;
  options->layers = defaults.layers;
  options->wait_limit_ms = defaults.wait_limit_ms;
  options->read_ahead = defaults.read_ahead;
  options->uses_io_uring = defaults.use_io_uring;
  options->allows_missing_members = defaults.allow_missing_members;
  options->http_cache_bytes = defaults.http_cache_bytes;
}

void planetree_default_query_options(planetree_query_options* options) noexcept {
  const planetree::QueryOptions defaults;
  *options = {};
  options->struct_bytes = sizeof *options;
  options->parts = defaults.parts;
  options->max_work = defaults.max_work;
  options->max_error = defaults.max_error;
  options->max_distance = defaults.max_distance;
}

uint32_t planetree_open(const char* path, const planetree_open_options* options,
                        planetree_model** model, planetree_error* error) noexcept {
  *model = nullptr;
  if (!planetree::c::are_set(options)) return planetree::c::fail_for_unset_options(error);
  try {
    auto opened = planetree::Model::open(path, planetree::c::open_options_of(options));
    if (!opened) return fail(opened.error(), error);
    *model = new planetree_model{*std::move(opened)};
    return PLANETREE_OK;
  } catch (const std::exception&) {  // the path, as all that Model::open() does not return
    return planetree::c::fail_without_memory(error);
  }
}

void planetree_close(planetree_model* model) noexcept { delete model; }

void planetree_model_info(const planetree_model* model, planetree_info* info) noexcept {
  const planetree::ModelInfo& of = model->model.info();
  *info = {};
  info->triangles = of.triangles;
  info->skipped = of.skipped;
  info->vertices = of.vertices;
  info->unbalanced_edges = of.unbalanced_edges;
  planetree::c::copy(of.box_lower, info->box_lower);
  planetree::c::copy(of.box_upper, info->box_upper);
  planetree::c::copy(of.core_lower, info->core_lower);
  planetree::c::copy(of.core_upper, info->core_upper);
  info->side_rule = static_cast<uint32_t>(of.side_rule);
  info->layers = of.layers;
  info->pages = of.pages;
  info->page_bytes = of.page_bytes;
  info->file_bytes = of.file_bytes;
  info->attributes = of.attributes;
  info->value_kind = static_cast<uint32_t>(of.value_kind);
}

void planetree_model_stats(const planetree_model* model, planetree_stats* stats) noexcept {
  const planetree::Stats of = model->model.stats();
  *stats = {of.page_hits,     of.page_misses,       of.pages_read,
            of.pages_evicted, of.quarantined_pages, of.degraded_answers,
            of.frames,        of.budget_bytes,      of.locked_bytes};
}

uint32_t planetree_read_triangles(const planetree_model* model, const uint64_t* indices,
                                  size_t count, planetree_triangle* triangles,
                                  planetree_error* error) noexcept {
  const auto read =
      model->model.triangles(std::span(indices, count), std::span(&written(triangles), count));
  if (!read) return fail(read.error(), error);
  return PLANETREE_OK;
}

uint32_t planetree_create_probe(const planetree_model* model, planetree_probe** probe,
                                planetree_error* error) noexcept {
  *probe = nullptr;
  auto created = planetree::Probe::create(model->model);
  if (!created) return fail(created.error(), error);
  *probe = new (std::nothrow) planetree_probe{*std::move(created)};
  if (!*probe) return planetree::c::fail_without_memory(error);
  return PLANETREE_OK;
}

void planetree_destroy_probe(planetree_probe* probe) noexcept { delete probe; }

void planetree_find_closest_point(planetree_probe* probe, const double point[3],
                                  const planetree_query_options* options,
                                  planetree_closest_point* answer) noexcept {
  written(answer) = probe->probe.closest_point(point_of(point), options_of(options));
}

uint32_t planetree_find_side(planetree_probe* probe, const double point[3],
                             const planetree_query_options* options) noexcept {
  return static_cast<uint32_t>(probe->probe.contains(point_of(point), options_of(options)).side);
}

void planetree_find_first_hit(planetree_probe* probe, const planetree_ray* ray,
                              const planetree_query_options* options, planetree_hit* hit) noexcept {
  written(hit) = probe->probe.first_hit(*planetree::c::read(ray), options_of(options));
}

void planetree_find_first_contact(planetree_probe* probe, const planetree_sweep* sweep,
                                  const planetree_query_options* options,
                                  planetree_first_contact* contact) noexcept {
  written(contact) = probe->probe.first_contact(*planetree::c::read(sweep), options_of(options));
}

planetree_found planetree_find_all_hits(planetree_probe* probe, const planetree_ray* ray,
                                        const planetree_query_options* options, planetree_hit* hits,
                                        size_t size) noexcept {
  return planetree::c::found(
      probe->probe.all_hits(*planetree::c::read(ray), {&written(hits), size}, options_of(options)));
}

planetree_found planetree_find_contacts(planetree_probe* probe, const double point[3],
                                        double radius, const planetree_query_options* options,
                                        planetree_closest_point* answers, size_t size) noexcept {
  return planetree::c::found(probe->probe.contacts(
      point_of(point), radius, std::span(&written(answers), size), options_of(options)));
}

planetree_found planetree_find_nearest_triangles(planetree_probe* probe, const double point[3],
                                                 const planetree_query_options* options,
                                                 planetree_closest_point* answers,
                                                 size_t size) noexcept {
  return planetree::c::found(probe->probe.nearest_triangles(
      point_of(point), std::span(&written(answers), size), options_of(options)));
}

planetree_found planetree_find_triangles_within(planetree_probe* probe, const double point[3],
                                                double radius,
                                                const planetree_query_options* options,
                                                planetree_closest_point* answers,
                                                size_t size) noexcept {
  return planetree::c::found(probe->probe.triangles_within(
      point_of(point), radius, std::span(&written(answers), size), options_of(options)));
}

void planetree_find_closest_points(planetree_probe* probe, const double* points, size_t count,
                                   const planetree_query_options* options,
                                   planetree_closest_point* answers) noexcept {
  probe->probe.closest_points(std::span(&point_of(points), count),
                              std::span(&written(answers), count), options_of(options));
}

void planetree_find_first_hits(planetree_probe* probe, const planetree_ray* rays, size_t count,
                               const planetree_query_options* options,
                               planetree_hit* hits) noexcept {
  probe->probe.first_hits(std::span(planetree::c::read(rays), count),
                          std::span(&written(hits), count), options_of(options));
}

void planetree_find_first_contacts(planetree_probe* probe, const planetree_sweep* sweeps,
                                   size_t count, const planetree_query_options* options,
                                   planetree_first_contact* contacts) noexcept {
  probe->probe.first_contacts(std::span(planetree::c::read(sweeps), count),
                              std::span(&written(contacts), count), options_of(options));
}

void planetree_note_motion(planetree_probe* probe, const double position[3],
                           const double velocity[3]) noexcept {
  probe->probe.motion(point_of(position), point_of(velocity));
}
