/* Every call of the C interface, on a cube. */

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "planetree/c.h"

#define CHECK(condition)                                                    \
  do {                                                                      \
    if (!(condition)) {                                                     \
      fprintf(stderr, "%s:%d: %s does not hold\n", __FILE__, __LINE__, #condition); \
      exit(1);                                                              \
    }                                                                       \
  } while (0)

static const double kVertices[8][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0},
                                       {0, 0, 1}, {1, 0, 1}, {0, 1, 1}, {1, 1, 1}};
static const uint32_t kTriangles[12][3] = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6},
                                           {0, 1, 5}, {0, 5, 4}, {2, 6, 7}, {2, 7, 3},
                                           {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};

static bool count_calls(void* context, const char* phase, uint64_t done, uint64_t total) {
  CHECK(phase != NULL && done <= total);
  ++*(int*)context;
  return true;
}

static void read_triangles(const planetree_model* model) {
  const uint64_t indices[2] = {7, 2}, none = 12;
  planetree_triangle triangles[2];
  planetree_error error;
  CHECK(planetree_read_triangles(model, indices, 2, triangles, &error) == PLANETREE_OK);
  for (int i = 0; i < 2; ++i)
    for (int k = 0; k < 3; ++k) {
      const double* const vertex = kVertices[kTriangles[indices[i]][k]];
      CHECK(memcmp(triangles[i].corners[k], vertex, sizeof triangles[i].corners[k]) == 0);
      CHECK(triangles[i].colors[k][0] == 0 && triangles[i].colors[k][3] == 255);
    }
  CHECK(planetree_read_triangles(model, &none, 1, triangles, &error) == PLANETREE_BAD_ARGUMENT);
}

static bool cancel(void* context, const char* phase, uint64_t done, uint64_t total) {
  (void)context, (void)phase, (void)done, (void)total;
  return false;
}

static bool is_near(double a, double b) { return fabs(a - b) < 1e-12; }

static void build(const char* path) {
  planetree_build_options options;
  planetree_build_report report;
  planetree_error error;
  int calls = 0;
  planetree_default_build_options(&options);
  options.replace = true;
  options.on_progress = count_calls;
  options.context = &calls;
  options.keep = PLANETREE_KEEP_TRIANGLES;
  CHECK(planetree_build_mesh(kVertices[0], 8, kTriangles[0], 12, path, &options, &report, &error) ==
        PLANETREE_OK);
  CHECK(report.triangles == 12 && report.unbalanced_edges == 0 && report.skipped == 0);
  CHECK(report.side_rule == PLANETREE_RULE_SOLID && calls > 0);
  options.on_progress = cancel;
  CHECK(planetree_build_mesh(kVertices[0], 8, kTriangles[0], 12, path, &options, NULL, NULL) ==
        PLANETREE_CANCELLED);
  CHECK(planetree_build_mesh(kVertices[0], 8, kTriangles[0], 12, path, NULL, NULL, &error) ==
        PLANETREE_ALREADY_EXISTS);
  CHECK(strlen(error.text) > 0 && error.page == PLANETREE_NOWHERE);
  CHECK(planetree_build("/no/such.ply", "/no/such.ptree", NULL, NULL, &error) ==
        PLANETREE_NOT_FOUND);
  memset(&options, 0, sizeof options);
  CHECK(planetree_build_mesh(kVertices[0], 8, kTriangles[0], 12, path, &options, NULL, &error) ==
        PLANETREE_BAD_ARGUMENT);
}

static planetree_model* open_model(const char* path) {
  planetree_open_options options;
  planetree_model* model = NULL;
  planetree_error error;
  CHECK(planetree_open("/no/such.ptree", NULL, &model, &error) == PLANETREE_NOT_FOUND && !model);
  memset(&options, 0, sizeof options);
  CHECK(planetree_open(path, &options, &model, &error) == PLANETREE_BAD_ARGUMENT && !model);
  planetree_default_open_options(&options);
  options.memory_budget_bytes = 1;
  CHECK(planetree_open(path, &options, &model, NULL) == PLANETREE_NO_MEMORY && !model);
  options.memory_budget_bytes = (uint64_t)64 << 20;
  options.max_probes = 1;
  CHECK(planetree_open(path, &options, &model, &error) == PLANETREE_OK && model);
  planetree_info info;
  planetree_model_info(model, &info);
  CHECK(info.triangles == 12 && info.vertices == 8 && info.unbalanced_edges == 0);
  CHECK(info.attributes == PLANETREE_KEEP_TRIANGLES);
  CHECK(info.layers == (PLANETREE_DISTANCE_LAYER | PLANETREE_SIDE_LAYER | PLANETREE_ATTRIBUTE_LAYER));
  CHECK(info.box_lower[0] == 0 && info.box_upper[2] == 1 && info.file_bytes > 0);
  return model;
}

static void find_points(planetree_probe* probe) {
  const double points[2][3] = {{0.5, 0.25, 3}, {0.5, 0.25, 0.75}};
  planetree_closest_point one, many[2];
  planetree_find_closest_point(probe, points[0], NULL, &one);
  CHECK(one.status == PLANETREE_EXACT && one.side == PLANETREE_OUTSIDE);
  CHECK(is_near(one.distance, 2) && one.lower <= 2 && 2 <= one.upper);
  CHECK(is_near(one.point[2], 1) && is_near(one.normal[2], 1) && one.feature == PLANETREE_FACE);
  CHECK(one.triangle == 2 || one.triangle == 3);
  planetree_find_closest_points(probe, points[0], 2, NULL, many);
  CHECK(memcmp(&many[0].distance, &one.distance, sizeof one.distance) == 0);
  CHECK(is_near(many[1].distance, 0.25) && many[1].side == PLANETREE_INSIDE);
  CHECK(planetree_find_side(probe, points[1], NULL) == PLANETREE_INSIDE);
  planetree_query_options options;
  planetree_default_query_options(&options);
  options.parts = PLANETREE_DISTANCE;
  options.max_distance = 1;
  planetree_find_closest_point(probe, points[0], &options, &one);
  CHECK(one.status == PLANETREE_BEYOND_MAX_DISTANCE && isinf(one.distance));
  options.max_distance = INFINITY;
  options.never_waits = true;
  planetree_find_closest_point(probe, points[0], &options, &one);
  CHECK(one.lower <= 2 && 2 <= one.upper);
  memset(&options, 0, sizeof options);
  planetree_find_closest_point(probe, points[0], &options, &one);
  CHECK(one.status == PLANETREE_BAD_QUERY);
}

static void find_sets(planetree_probe* probe) {
  const double point[3] = {0.5, 0.25, 0.75};
  planetree_closest_point found[12];
  planetree_found set = planetree_find_nearest_triangles(probe, point, NULL, found, 3);
  CHECK(set.count == 3 && found[0].distance <= found[1].distance);
  set = planetree_find_triangles_within(probe, point, 10, NULL, found, 12);
  CHECK(set.count == 12 && set.complete);
  set = planetree_find_contacts(probe, point, 0.3, NULL, found, 12);
  CHECK(set.count == 2 && set.complete);
  CHECK(is_near(found[0].distance, 0.25) && is_near(found[1].distance, 0.25));
}

static void find_ways(planetree_probe* probe) {
  const planetree_ray ray = {{0.5, 0.25, 3}, {0, 0, -1}, 0, INFINITY};
  planetree_hit hit, hits[4];
  planetree_find_first_hit(probe, &ray, NULL, &hit);
  CHECK(is_near(hit.t, 2) && hit.entering && hit.status == PLANETREE_EXACT);
  CHECK(planetree_find_all_hits(probe, &ray, NULL, hits, 4).count == 2);
  CHECK(is_near(hits[1].t, 3) && !hits[1].entering);
  planetree_find_first_hits(probe, &ray, 1, NULL, hits);
  CHECK(hits[0].triangle == hit.triangle);
  const planetree_sweep sweep = {{0.5, 0.25, 3}, {0.5, 0.25, 1}, 0.5};
  planetree_first_contact contact, contacts[1];
  planetree_find_first_contact(probe, &sweep, NULL, &contact);
  CHECK(fabs(contact.t - 0.75) < 1e-9 && !contact.free);
  CHECK(contact.t_lower <= 0.75 && fabs(contact.at.distance - 0.5) < 1e-9);
  planetree_find_first_contacts(probe, &sweep, 1, NULL, contacts);
  CHECK(contacts[0].t == contact.t);
}

int main(int argc, char** argv) {
  CHECK(argc == 2 && strlen(planetree_version()) >= 5);
  build(argv[1]);
  planetree_model* model = open_model(argv[1]);
  planetree_probe *probe = NULL, *second = NULL;
  planetree_error error;
  CHECK(planetree_create_probe(model, &probe, &error) == PLANETREE_OK && probe);
  CHECK(planetree_create_probe(model, &second, &error) == PLANETREE_BAD_ARGUMENT && !second);
  find_points(probe);
  find_sets(probe);
  find_ways(probe);
  read_triangles(model);
  const double position[3] = {0.5, 0.25, 3}, velocity[3] = {0, 0, -1};
  planetree_note_motion(probe, position, velocity);
  planetree_stats stats;
  planetree_model_stats(model, &stats);
  CHECK(stats.pages_read > 0 && stats.budget_bytes == (uint64_t)64 << 20);
  planetree_destroy_probe(probe);
  planetree_destroy_probe(NULL);
  planetree_close(model);
  planetree_close(NULL);
  return 0;
}
