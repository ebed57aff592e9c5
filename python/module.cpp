// The extension module planetree._planetree: the library with arrays in place of spans. The package
// in planetree/ makes the arrays and documents the interface.

#include <pybind11/pybind11.h>

#include "planetree/error.h"
#include "planetree/eviction_policy.h"
#include "planetree/layers.h"
#include "planetree/model.h"
#include "planetree/types.h"
#include "python/build.h"
#include "python/errors.h"
#include "python/model.h"
#include "python/probe.h"

namespace planetree::python {
namespace {

namespace py = pybind11;

template <class Enum>
py::dict values(std::initializer_list<std::pair<const char*, Enum>> named) {
  py::dict all;
  for (const auto& [name, value] : named) all[name] = static_cast<unsigned>(value);
  return all;
}

// The values of enumerations, for planetree/_enums.py.
py::dict enum_values() {
  py::dict all;
  all["Side"] = values<Side>({{"INSIDE", Side::kInside},
                              {"OUTSIDE", Side::kOutside},
                              {"ON_SURFACE", Side::kOnSurface},
                              {"UNKNOWN", Side::kUnknown}});
  all["Feature"] = values<Feature>(
      {{"FACE", Feature::kFace}, {"EDGE", Feature::kEdge}, {"VERTEX", Feature::kVertex}});
  all["Status"] = values<Status>({{"EXACT", Status::kExact},
                                  {"WITHIN_ERROR", Status::kWithinError},
                                  {"DEGRADED", Status::kDegraded},
                                  {"BEYOND_MAX_DISTANCE", Status::kBeyondMaxDistance},
                                  {"BAD_QUERY", Status::kBadQuery}});
  all["SideRule"] = values<SideRule>({{"OF_FILE", SideRule::kOfFile},
                                      {"SOLID", SideRule::kSolid},
                                      {"SURFACE", SideRule::kSurface}});
  all["NormalRule"] = values<NormalRule>(
      {{"OUTWARD", NormalRule::kOutward}, {"TOWARD_QUERY", NormalRule::kTowardQuery}});
  all["Layers"] = values<std::uint32_t>({{"DISTANCE", kDistanceLayer},
                                         {"SIDE", kSideLayer},
                                         {"FIELD", kFieldLayer},
                                         {"ATTRIBUTES", kAttributeLayer}});
  all["Attributes"] = values<std::uint32_t>({{"TRIANGLES", kKeepTriangles},
                                             {"COLOR", kKeepColor},
                                             {"UV", kKeepUv},
                                             {"VALUE", kKeepValue}});
  all["ValueKind"] = values<ValueKind>({{"UNSIGNED", ValueKind::kUnsigned},
                                        {"SIGNED", ValueKind::kSigned},
                                        {"REAL", ValueKind::kReal}});
  all["Parts"] =
      values<std::uint32_t>({{"DISTANCE", kDistance}, {"SIDE", kSide}, {"NORMAL", kNormal}});
  all["Locking"] = values<Locking>(
      {{"TRY", Locking::kTry}, {"REQUIRE", Locking::kRequire}, {"NEVER", Locking::kNever}});
  all["EvictionPolicy"] = values<EvictionPolicy>({{"CLOCK", EvictionPolicy::kClock},
                                                  {"LRU", EvictionPolicy::kLru},
                                                  {"SIEVE", EvictionPolicy::kSieve},
                                                  {"S3_FIFO", EvictionPolicy::kS3Fifo},
                                                  {"TWO_Q", EvictionPolicy::kTwoQ}});
  all["ErrorCode"] = values<ErrorCode>({{"BAD_ARGUMENT", ErrorCode::kBadArgument},
                                        {"NOT_FOUND", ErrorCode::kNotFound},
                                        {"ALREADY_EXISTS", ErrorCode::kAlreadyExists},
                                        {"PERMISSION", ErrorCode::kPermission},
                                        {"NO_SPACE", ErrorCode::kNoSpace},
                                        {"NO_MEMORY", ErrorCode::kNoMemory},
                                        {"READ_FAILED", ErrorCode::kReadFailed},
                                        {"WRITE_FAILED", ErrorCode::kWriteFailed},
                                        {"BAD_INPUT", ErrorCode::kBadInput},
                                        {"NOT_PLANETREE", ErrorCode::kNotPlanetree},
                                        {"UNSUPPORTED", ErrorCode::kUnsupported},
                                        {"TRUNCATED", ErrorCode::kTruncated},
                                        {"DAMAGED", ErrorCode::kDamaged},
                                        {"CANCELLED", ErrorCode::kCancelled}});
  return all;
}

}  // namespace
}  // namespace planetree::python

PYBIND11_MODULE(_planetree, module) {
  module.doc() = "Extension module of planetree; use the package planetree.";
  module.attr("version") = PLANETREE_VERSION;
  module.attr("no_triangle") = planetree::kNoTriangle;
  module.attr("enum_values") = planetree::python::enum_values();
  planetree::python::define_error(module);
  planetree::python::define_probe(module);
  planetree::python::define_model(module);
  planetree::python::define_build(module);
}
