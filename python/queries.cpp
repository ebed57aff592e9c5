#include "python/queries.h"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <vector>

#include <pybind11/numpy.h>

#include "python/answer_fields.h"
#include "python/chunks.h"
#include "python/inputs.h"
#include "python/model_handle.h"

namespace planetree::python {
namespace {

namespace py = pybind11;

// Runs the batch of a kind of query, and writes its answers to columns chunk by chunk.
//
// query  query(probe, first, end, answers) makes the queries from `first` on
template <class Answer, class Query>
void run_batch(const ModelHandle& handle, std::size_t count, const Columns<Answer>& columns,
               const py::object& progress, const Query& query) {
  const std::shared_ptr<OpenModel> model = handle.get();
  std::vector<Answer> answers(max_chunk_rows(count, sizeof(Answer)));
  in_chunks(count, sizeof(Answer), progress, [&](std::size_t first, std::size_t end) {
    const auto some = std::span(answers).first(end - first);
    LentProbe probe(*model);
    query(probe, first, end, some);
    columns.write(first, some);
  });
}

void closest_points(const ModelHandle& handle, const py::array& points, const py::dict& outputs,
                    const QueryOptions& options, const py::object& progress) {
  const std::span<const Vec3> queries = points_of("points", points);
  const Columns<ClosestPoint> columns(outputs, kClosestPointFields, queries.size());
  run_batch(
      handle, queries.size(), columns, progress,
      [&](LentProbe& probe, std::size_t first, std::size_t end, std::span<ClosestPoint> answers) {
        probe->closest_points(queries.subspan(first, end - first), answers, options);
      });
}

void contains(const ModelHandle& handle, const py::array& points, const py::dict& outputs,
              const QueryOptions& options, const py::object& progress) {
  const std::span<const Vec3> queries = points_of("points", points);
  const Columns<Containment> columns(outputs, kContainmentFields, queries.size());
  run_batch(
      handle, queries.size(), columns, progress,
      [&](LentProbe& probe, std::size_t first, std::size_t end, std::span<Containment> answers) {
        probe->contains(queries.subspan(first, end - first), answers, options);
      });
}

// The rays of a call: columns of which each may be anywhere in memory.
struct RayColumns {
  Rows origins, directions, t_min, t_max;

  RayColumns(const py::array& origin, const py::array& direction, const py::array& least,
             const py::array& greatest)
      : origins("origins", origin, 3),
        directions("directions", direction, 3),
        t_min("t_min", least, 1),
        t_max("t_max", greatest, 1) {
    check_count("directions", directions.count(), origins.count());
    check_count("t_min", t_min.count(), origins.count());
    check_count("t_max", t_max.count(), origins.count());
  }
  Ray ray(std::size_t i) const {
    return {origins.point(i), directions.point(i), t_min.number(i), t_max.number(i)};
  }
};

void first_hits(const ModelHandle& handle, const py::array& origins, const py::array& directions,
                const py::array& t_min, const py::array& t_max, const py::dict& outputs,
                const QueryOptions& options, const py::object& progress) {
  const RayColumns columns_of_rays(origins, directions, t_min, t_max);
  const std::size_t count = columns_of_rays.origins.count();
  const Columns<RayHit> columns(outputs, kRayHitFields, count);
  std::vector<Ray> rays(max_chunk_rows(count, sizeof(RayHit)));
  run_batch(handle, count, columns, progress,
            [&](LentProbe& probe, std::size_t first, std::size_t end, std::span<RayHit> answers) {
              for (std::size_t i = first; i < end; ++i) rays[i - first] = columns_of_rays.ray(i);
              probe->first_hits(std::span(rays).first(end - first), answers, options);
            });
}

void first_contacts(const ModelHandle& handle, const py::array& from, const py::array& to,
                    const py::array& radius, const py::dict& outputs, const QueryOptions& options,
                    const py::object& progress) {
  const Rows starts("from", from, 3), ends("to", to, 3), radii("radius", radius, 1);
  const std::size_t count = starts.count();
  check_count("to", ends.count(), count);
  check_count("radius", radii.count(), count);
  const Columns<FirstContact> columns(outputs, kFirstContactFields, count);
  std::vector<Sweep> sweeps(max_chunk_rows(count, sizeof(FirstContact)));
  run_batch(
      handle, count, columns, progress,
      [&](LentProbe& probe, std::size_t first, std::size_t end, std::span<FirstContact> answers) {
        for (std::size_t i = first; i < end; ++i)
          sweeps[i - first] = {starts.point(i), ends.point(i), radii.number(i)};
        probe->first_contacts(std::span(sweeps).first(end - first), answers, options);
      });
}

ClosestPoint no_closest_point() {
  ClosestPoint none;
  none.distance = none.lower = none.upper = std::numeric_limits<double>::infinity();
  return none;
}

// Runs a kind of query that finds up to `share` answers for each row, in columns of count * share
// rows. `counts` and `complete` receive how many each found and whether these are all.
//
// find  find(probe, first, end, answers, found)
template <class Answer, class Find>
void run_sets(const ModelHandle& handle, std::size_t count, std::size_t share, const Answer& none,
              const Columns<Answer>& columns, const py::array& counts, const py::array& complete,
              const py::object& progress, const Find& find) {
  if (share == 0) throw py::value_error("'limit' must be 1 or more");
  if (share > kMaxChunkBytes / sizeof(Answer))
    throw py::value_error("'limit' is too large; the answers of one row take more than 48 MiB");
  auto* const count_rows =
      reinterpret_cast<std::uint64_t*>(checked_rows("counts", counts, 'L', 1, count));
  std::byte* const complete_rows = checked_rows("complete", complete, 'B', 1, count);
  const std::shared_ptr<OpenModel> model = handle.get();
  const std::size_t row_bytes = share * sizeof(Answer);
  const std::size_t most = max_chunk_rows(count, row_bytes);
  std::vector<Answer> answers(most * share);
  std::vector<Found> found(most);
  in_chunks(count, row_bytes, progress, [&](std::size_t first, std::size_t end) {
    const std::size_t rows = end - first;
    const auto room = std::span(answers).first(rows * share);
    LentProbe probe(*model);
    find(probe, first, end, room, std::span(found).first(rows));
    for (std::size_t i = 0; i < rows; ++i) {
      count_rows[first + i] = found[i].count;
      complete_rows[first + i] = std::byte{found[i].complete};
      // What follows the answers found is no answer.
      std::fill(room.begin() + static_cast<std::ptrdiff_t>(i * share + found[i].count),
                room.begin() + static_cast<std::ptrdiff_t>((i + 1) * share), none);
    }
    columns.write(first * share, room);
  });
}

enum class PointSet { kContacts, kNearest, kWithin };

void find_triangles(const ModelHandle& handle, PointSet kind, const py::array& points,
                    double radius, std::size_t limit, const py::dict& outputs,
                    const py::array& counts, const py::array& complete, const QueryOptions& options,
                    const py::object& progress) {
  const std::span<const Vec3> queries = points_of("points", points);
  const Columns<ClosestPoint> columns(outputs, kClosestPointFields, queries.size() * limit);
  run_sets(handle, queries.size(), limit, no_closest_point(), columns, counts, complete, progress,
           [&](LentProbe& probe, std::size_t first, std::size_t end,
               std::span<ClosestPoint> answers, std::span<Found> found) {
             const auto some = queries.subspan(first, end - first);
             if (kind == PointSet::kContacts)
               probe->contacts(some, radius, answers, found, options);
             else if (kind == PointSet::kNearest)
               probe->nearest_triangles(some, answers, found, options);
             else
               probe->triangles_within(some, radius, answers, found, options);
           });
}

void all_hits(const ModelHandle& handle, const py::array& origins, const py::array& directions,
              const py::array& t_min, const py::array& t_max, std::size_t limit,
              const py::dict& outputs, const py::array& counts, const py::array& complete,
              const QueryOptions& options, const py::object& progress) {
  const RayColumns rays(origins, directions, t_min, t_max);
  const std::size_t count = rays.origins.count();
  const Columns<RayHit> columns(outputs, kRayHitFields, count * limit);
  run_sets(handle, count, limit, RayHit{}, columns, counts, complete, progress,
           [&](LentProbe& probe, std::size_t first, std::size_t end, std::span<RayHit> answers,
               std::span<Found> found) {
             for (std::size_t i = first; i < end; ++i)
               found[i - first] = probe->all_hits(
                   rays.ray(i), answers.subspan((i - first) * limit, limit), options);
           });
}

}  // namespace

void define_queries(py::class_<ModelHandle, std::shared_ptr<ModelHandle>>& model) {
  model.def("closest_points", &closest_points);
  model.def("contains", &contains);
  model.def("first_hits", &first_hits);
  model.def("all_hits", &all_hits);
  model.def("first_contacts", &first_contacts);
  const auto define_set = [&](const char* name, PointSet kind) {
    model.def(name, [kind](const ModelHandle& handle, const py::array& points, double radius,
                           std::size_t limit, const py::dict& outputs, const py::array& counts,
                           const py::array& complete, const QueryOptions& options,
                           const py::object& progress) {
      find_triangles(handle, kind, points, radius, limit, outputs, counts, complete, options,
                     progress);
    });
  };
  define_set("contacts", PointSet::kContacts);
  define_set("nearest_triangles", PointSet::kNearest);
  define_set("triangles_within", PointSet::kWithin);
}

}  // namespace planetree::python
