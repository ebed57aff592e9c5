#include "python/model.h"

#include <filesystem>
#include <memory>

#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include "planetree/model.h"
#include "planetree/stats.h"
#include "python/errors.h"
#include "python/model_handle.h"
#include "python/options.h"
#include "python/queries.h"
#include "python/triangles.h"

namespace planetree::python {
namespace {

namespace py = pybind11;

std::shared_ptr<ModelHandle> open(const std::filesystem::path& path, const py::dict& given) {
  OpenOptions options;
  const Options from(given);
  from.take("memory_budget_bytes", options.memory_budget_bytes);
  from.take("fetch_threads", options.fetch_threads);
  from.take("batch_threads", options.batch_threads);
  from.take("max_probes", options.max_probes);
  from.take("layers", options.layers);
  from.take("read_ahead", options.read_ahead);
  from.take("wait_limit_ms", options.wait_limit_ms);
  from.take("use_io_uring", options.use_io_uring);
  from.take("locking", options.locking);
  from.take("policy", options.policy);
  from.take("http_cache", options.http_cache);
  from.take("http_cache_bytes", options.http_cache_bytes);
  from.take("allow_missing_members", options.allow_missing_members);
  return std::make_shared<ModelHandle>(path, options);
}

py::tuple corner(const Vec3& at) { return py::make_tuple(at.x, at.y, at.z); }

py::dict info_of(const ModelHandle& handle) {
  const ModelInfo info = handle.get()->model().info();
  py::dict told;
  told["triangles"] = info.triangles;
  told["input_triangles"] = info.input_triangles;
  told["skipped"] = info.skipped;
  told["vertices"] = info.vertices;
  told["box"] = py::make_tuple(corner(info.box_lower), corner(info.box_upper));
  told["core"] = py::make_tuple(corner(info.core_lower), corner(info.core_upper));
  told["strays"] = info.strays;
  told["region"] =
      info.has_region
          ? py::object(py::make_tuple(corner(info.region_lower), corner(info.region_upper)))
          : py::object(py::none());
  told["watertight"] = info.watertight();
  told["unbalanced_edges"] = info.unbalanced_edges;
  told["caps"] = info.caps;
  told["cap_area"] = info.cap_area;
  told["side_rule"] = static_cast<unsigned>(info.side_rule);
  told["openness"] = info.openness;
  told["float64"] = info.float64;
  told["levels"] = info.levels;
  told["layers"] = info.layers;
  told["attributes"] = info.attributes;
  told["value_kind"] = static_cast<unsigned>(info.value_kind);
  told["pages"] = info.pages;
  told["page_bytes"] = info.page_bytes;
  told["file_bytes"] = info.file_bytes;
  return told;
}

Metadata metadata_of(const ModelHandle& handle) {
  const auto pinned = handle.get();
  const py::gil_scoped_release unlocked;
  return value_of(pinned->model().metadata());
}

py::dict stats_of(const ModelHandle& handle) {
  const Stats stats = handle.get()->model().stats();
  py::dict told;
  told["page_hits"] = stats.page_hits;
  told["page_misses"] = stats.page_misses;
  told["pages_read"] = stats.pages_read;
  told["pages_evicted"] = stats.pages_evicted;
  told["pages_prefetched"] = stats.pages_prefetched;
  told["pages_read_ahead"] = stats.pages_read_ahead;
  told["quarantined_pages"] = stats.quarantined_pages;
  told["waits_given_up"] = stats.waits_given_up;
  told["degraded_answers"] = stats.degraded_answers;
  told["fetch_requests"] = stats.fetch_requests;
  told["fetch_requests_served"] = stats.fetch_requests_served;
  told["http_requests"] = stats.http_requests;
  told["http_bytes"] = stats.http_bytes;
  told["http_cached_bytes"] = stats.http_cached_bytes;
  told["layers"] = stats.layers;
  told["frames"] = stats.frames;
  told["arena_bytes"] = stats.arena_bytes;
  told["table_bytes"] = stats.table_bytes;
  told["budget_bytes"] = stats.budget_bytes;
  told["locked_bytes"] = stats.locked_bytes;
  return told;
}

}  // namespace

void define_model(py::module_& module) {
  py::class_<ModelHandle, std::shared_ptr<ModelHandle>> model(module, "Model");
  model.def(py::init(&open))
      .def("close", &ModelHandle::close)
      .def_property_readonly("is_closed", &ModelHandle::is_closed)
      .def("info", &info_of)
      .def("metadata", &metadata_of)
      .def("stats", &stats_of);
  define_queries(model);
  define_triangles(model);
}

}  // namespace planetree::python
