#include "python/build.h"

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <filesystem>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <thread>
#include <vector>

#include <pybind11/numpy.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include "planetree/build.h"
#include "python/errors.h"
#include "python/inputs.h"
#include "python/options.h"

namespace planetree::python {
namespace {

namespace py = pybind11;

// A build on a thread of its own. The caller's thread meanwhile handles signals and tells progress:
// Python does neither on other threads.
class RunningBuild {
 public:
  RunningBuild(const BuildInput& input, const std::filesystem::path& output, BuildOptions options)
      : thread_([this, &input, &output, options = std::move(options)]() mutable {
          options.cancel = &cancel_;
          options.on_progress = [this](BuildPhase phase, std::uint64_t done, std::uint64_t total) {
            const std::lock_guard lock(mutex_);
            last_ = {phase, done, total};
            return true;
          };
          options.on_failure = [this](const std::filesystem::path& path) { failed_ = path; };
          Result<BuildReport> report = build(input, output, options);
          const std::lock_guard lock(mutex_);
          report_.emplace(std::move(report));
          ended_.notify_one();
        }) {}
  ~RunningBuild() {
    cancel_.store(true, std::memory_order_relaxed);
    const py::gil_scoped_release unlocked;
    thread_.join();
  }
  RunningBuild(const RunningBuild&) = delete;
  RunningBuild& operator=(const RunningBuild&) = delete;

  // Returns the report. Throws what a signal or the progress function raises.
  BuildReport wait(const py::object& progress) {
    while (!has_ended_soon()) {
      if (PyErr_CheckSignals() != 0) throw py::error_already_set();
      tell(progress);
    }
    if (*report_) return **report_;
    throw Failure{report_->error(), failed_};
  }

 private:
  struct Progress {
    BuildPhase phase = BuildPhase::kReading;
    std::uint64_t done = 0, total = 0;
  };

  bool has_ended_soon() {
    const py::gil_scoped_release unlocked;
    std::unique_lock lock(mutex_);
    return ended_.wait_for(lock, std::chrono::milliseconds(50),
                           [this] { return report_.has_value(); });
  }
  void tell(const py::object& progress) {
    if (progress.is_none()) return;
    Progress last;
    {
      const std::lock_guard lock(mutex_);
      last = last_;
    }
    progress(name_of(last.phase), last.done, last.total);
  }

  std::mutex mutex_;
  std::condition_variable ended_;
  std::optional<Result<BuildReport>> report_;
  Progress last_;
  std::filesystem::path failed_;
  std::atomic<bool> cancel_{false};
  std::thread thread_;  // last: it uses the others
};

// The package gives a SideRule, whose values are those of the choice.
static_assert(static_cast<int>(SideChoice::kAuto) == static_cast<int>(SideRule::kOfFile) &&
              static_cast<int>(SideChoice::kSolid) == static_cast<int>(SideRule::kSolid) &&
              static_cast<int>(SideChoice::kSurface) == static_cast<int>(SideRule::kSurface));

BuildOptions options_of(const py::dict& given) {
  BuildOptions options;
  const Options from(given);
  from.take("memory_bytes", options.memory_bytes);
  from.take("threads", options.threads);
  from.take("temp_directory", options.temp_directory);
  from.take("page_bytes", options.page_bytes);
  from.take("member_bytes", options.member_bytes);
  from.take("layers", options.layers);
  from.take("keep", options.keep);
  from.take("value_property", options.value_property);
  from.take("resume", options.resume);
  from.take("float64", options.float64);
  from.take("strict", options.strict);
  from.take("replace", options.replace);
  from.take("side", options.side);
  from.take("metadata", options.metadata);
  if (given.contains("box")) {
    const auto box = py::cast<std::array<std::array<double, 3>, 2>>(given["box"]);
    options.box = Box{{box[0][0], box[0][1], box[0][2]}, {box[1][0], box[1][1], box[1][2]}};
  }
  return options;
}

BuildReport build_files(const std::vector<std::filesystem::path>& meshes,
                        const std::filesystem::path& output, const py::dict& options,
                        const py::object& progress) {
  const BuildInput input(meshes);
  return RunningBuild(input, output, options_of(options)).wait(progress);
}

// The rows of an array that planetree/_attributes.py made; empty if there is none.
template <class Row>
std::span<const Row> rows_of(const py::dict& attributes, const char* name) {
  if (!attributes.contains(name)) return {};
  const auto array = py::cast<py::array>(attributes[name]);
  const auto bytes = static_cast<std::size_t>(array.nbytes());
  if ((array.flags() & py::array::c_style) == 0 || bytes % sizeof(Row) != 0)
    throw py::value_error(std::string("'") + name + "' is no array of its rows");
  return {static_cast<const Row*>(array.data()), bytes / sizeof(Row)};
}

template <class Vertex>
BuildInput input_of(std::span<const Vertex> vertices, std::span<const TriangleVertices> triangles,
                    const py::dict& attributes) {
  BuildInput::Mesh<Vertex> mesh;
  mesh.vertices = vertices;
  mesh.triangles = triangles;
  mesh.colors = rows_of<Color>(attributes, "colors");
  mesh.uvs = rows_of<TextureCoordinate>(attributes, "uvs");
  mesh.values = rows_of<std::uint64_t>(attributes, "values");
  if (attributes.contains("value_kind"))
    mesh.value_kind = static_cast<ValueKind>(py::cast<std::uint8_t>(attributes["value_kind"]));
  return mesh;
}

BuildReport build_arrays(const py::array& vertices, const py::array& faces,
                         const py::dict& attributes, const std::filesystem::path& output,
                         const py::dict& options, const py::object& progress) {
  const auto triangles = triples_of<TriangleVertices>("faces", faces, 'I');
  const BuildInput input =
      vertices.dtype().char_() == 'f'
          ? input_of(triples_of<FloatVertex>("vertices", vertices, 'f'), triangles, attributes)
          : input_of(triples_of<Vec3>("vertices", vertices, 'd'), triangles, attributes);
  return RunningBuild(input, output, options_of(options)).wait(progress);
}

}  // namespace

void define_build(py::module_& module) {
  py::class_<BuildReport>(module, "BuildReport", "What a build made.")
      .def_readonly("triangles", &BuildReport::triangles)
      .def_readonly("input_triangles", &BuildReport::input_triangles)
      .def_readonly("skipped", &BuildReport::skipped)
      .def_readonly("first_skipped", &BuildReport::first_skipped)
      .def_readonly("first_skipped_text", &BuildReport::first_skipped_text)
      .def_readonly("notes", &BuildReport::notes)
      .def_readonly("vertices", &BuildReport::vertices)
      .def_readonly("strays", &BuildReport::strays)
      .def_readonly("unbalanced_edges", &BuildReport::unbalanced_edges)
      .def_property_readonly("watertight", &BuildReport::watertight)
      .def_property_readonly("side_rule",
                             [](const BuildReport& r) { return unsigned(r.side_rule); })
      .def_readonly("openness", &BuildReport::openness)
      .def_readonly("levels", &BuildReport::levels)
      .def_readonly("layers", &BuildReport::layers)
      .def_readonly("attributes", &BuildReport::attributes)
      .def_readonly("pages", &BuildReport::pages)
      .def_readonly("file_bytes", &BuildReport::file_bytes)
      .def_readonly("temporary_bytes", &BuildReport::temporary_bytes)
      .def_readonly("peak_resident_bytes", &BuildReport::peak_resident_bytes);
  module.def("build_files", &build_files);
  module.def("build_arrays", &build_arrays);
}

}  // namespace planetree::python
