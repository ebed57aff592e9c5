#include "python/probe.h"

#include <array>
#include <memory>
#include <stdexcept>

#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include "planetree/contact.h"
#include "planetree/probe.h"
#include "planetree/types.h"
#include "python/errors.h"
#include "python/model_handle.h"

namespace planetree::python {
namespace {

namespace py = pybind11;

using Coordinates = std::array<double, 3>;

Vec3 vector_of(const Coordinates& at) { return {at[0], at[1], at[2]}; }

py::array_t<double> array_of(const Vec3& at) {
  py::array_t<double> array(3);
  double* const numbers = array.mutable_data();
  numbers[0] = at.x;
  numbers[1] = at.y;
  numbers[2] = at.z;
  return array;
}

// A probe of one thread, and the model that must outlive it.
class OwnProbe {
 public:
  explicit OwnProbe(const ModelHandle& handle)
      : model_(handle.get()), probe_(value_of(Probe::create(model_->model()))) {}

  // Runs a query. Blocking queries let other Python threads run meanwhile; others are over sooner
  // than that would take.
  template <class Query>
  auto run(const QueryOptions& options, const Query& query) {
    if (is_busy_) throw std::runtime_error("the probe is in use by another thread");
    if (options.wait == Wait::kNever) return query(probe_);
    const Use use(is_busy_);
    const py::gil_scoped_release unlocked;
    return query(probe_);
  }
  void motion(const Coordinates& position, const Coordinates& velocity) {
    probe_.motion(vector_of(position), vector_of(velocity));
  }
  std::uint64_t work_spent() const { return probe_.work_spent(); }

 private:
  // Sets and clears the mark with Python's global lock held.
  class Use {
   public:
    explicit Use(bool& mark) : mark_(mark) { mark_ = true; }
    ~Use() { mark_ = false; }
    Use(const Use&) = delete;
    Use& operator=(const Use&) = delete;

   private:
    bool& mark_;
  };

  std::shared_ptr<OpenModel> model_;
  Probe probe_;
  bool is_busy_ = false;
};

void define_options(py::module_& module) {
  py::class_<QueryOptions>(module, "QueryOptions")
      .def(py::init([](std::uint32_t parts, std::uint8_t wait, std::uint8_t side_rule,
                       std::uint8_t normal_rule, double max_error, double max_distance,
                       std::uint32_t max_work) {
        QueryOptions options;
        options.parts = parts;
        options.wait = static_cast<Wait>(wait);
        options.side_rule = static_cast<SideRule>(side_rule);
        options.normal_rule = static_cast<NormalRule>(normal_rule);
        options.max_error = max_error;
        options.max_distance = max_distance;
        options.max_work = max_work;
        return options;
      }));
}

void define_answers(py::module_& module) {
  py::class_<ClosestPoint>(module, "ClosestPoint")
      .def_readonly("distance", &ClosestPoint::distance)
      .def_readonly("lower", &ClosestPoint::lower)
      .def_readonly("upper", &ClosestPoint::upper)
      .def_property_readonly("signed_distance", &ClosestPoint::signed_distance)
      .def_property_readonly("side", [](const ClosestPoint& a) { return unsigned(a.side); })
      .def_property_readonly("point", [](const ClosestPoint& a) { return array_of(a.point); })
      .def_property_readonly("normal", [](const ClosestPoint& a) { return array_of(a.normal); })
      .def_readonly("triangle", &ClosestPoint::triangle)
      .def_property_readonly("barycentric",
                             [](const ClosestPoint& a) { return array_of(a.barycentric); })
      .def_property_readonly("feature", [](const ClosestPoint& a) { return unsigned(a.feature); })
      .def_property_readonly("status", [](const ClosestPoint& a) { return unsigned(a.status); });
  py::class_<FirstContact>(module, "FirstContact")
      .def_readonly("t", &FirstContact::t)
      .def_readonly("t_lower", &FirstContact::t_lower)
      .def_readonly("t_upper", &FirstContact::t_upper)
      .def_readonly("at", &FirstContact::at)
      .def_readonly("free", &FirstContact::free)
      .def_property_readonly("status", [](const FirstContact& a) { return unsigned(a.status); });
  py::class_<RayHit>(module, "RayHit")
      .def_readonly("t", &RayHit::t)
      .def_readonly("t_lower", &RayHit::t_lower)
      .def_readonly("t_upper", &RayHit::t_upper)
      .def_property_readonly("point", [](const RayHit& a) { return array_of(a.point); })
      .def_property_readonly("normal", [](const RayHit& a) { return array_of(a.normal); })
      .def_readonly("triangle", &RayHit::triangle)
      .def_property_readonly("barycentric", [](const RayHit& a) { return array_of(a.barycentric); })
      .def_readonly("entering", &RayHit::entering)
      .def_property_readonly("status", [](const RayHit& a) { return unsigned(a.status); });
}

}  // namespace

void define_probe(py::module_& module) {
  define_options(module);
  define_answers(module);
  py::class_<OwnProbe>(module, "Probe")
      .def(py::init<const ModelHandle&>())
      .def("closest_point",
           [](OwnProbe& self, const Coordinates& point, const QueryOptions& options) {
             return self.run(options, [&](Probe& probe) {
               return probe.closest_point(vector_of(point), options);
             });
           })
      .def("contains",
           [](OwnProbe& self, const Coordinates& point, const QueryOptions& options) {
             const Containment found = self.run(
                 options, [&](Probe& probe) { return probe.contains(vector_of(point), options); });
             return py::make_tuple(unsigned(found.side), unsigned(found.status));
           })
      .def("first_hit",
           [](OwnProbe& self, const Coordinates& origin, const Coordinates& direction, double t_min,
              double t_max, const QueryOptions& options) {
             const Ray ray{vector_of(origin), vector_of(direction), t_min, t_max};
             return self.run(options, [&](Probe& probe) { return probe.first_hit(ray, options); });
           })
      .def("first_contact",
           [](OwnProbe& self, const Coordinates& from, const Coordinates& to, double radius,
              const QueryOptions& options) {
             const Sweep sweep{vector_of(from), vector_of(to), radius};
             return self.run(options,
                             [&](Probe& probe) { return probe.first_contact(sweep, options); });
           })
      .def("contacts",
           [](OwnProbe& self, const Coordinates& point, double radius, std::size_t limit,
              const QueryOptions& options) {
             std::vector<ClosestPoint> found(limit);
             const Found set = self.run(options, [&](Probe& probe) {
               return probe.contacts(vector_of(point), radius, found, options);
             });
             found.resize(set.count);
             return py::make_tuple(found, set.complete);
           })
      .def("motion", &OwnProbe::motion)
      .def("work_spent", &OwnProbe::work_spent);
}

}  // namespace planetree::python
