#include "c/c_values.h"

#include <cstring>
#include <limits>

#include "planetree/layers.h"

namespace planetree::c {

static_assert(PLANETREE_CANCELLED == static_cast<int>(ErrorCode::kCancelled));
static_assert(PLANETREE_SIDE_UNKNOWN == static_cast<int>(Side::kUnknown));
static_assert(PLANETREE_INSIDE == static_cast<int>(Side::kInside));
static_assert(PLANETREE_VERTEX == static_cast<int>(Feature::kVertex));
static_assert(PLANETREE_BAD_QUERY == static_cast<int>(Status::kBadQuery));
static_assert(PLANETREE_RULE_SURFACE == static_cast<int>(SideRule::kSurface));
static_assert(PLANETREE_TOWARD_QUERY == static_cast<int>(NormalRule::kTowardQuery));
static_assert(PLANETREE_NO_TRIANGLE == kNoTriangle && PLANETREE_NOWHERE == Error::kNowhere);
static_assert(PLANETREE_NO_LIMIT == QueryOptions::kNoLimit);
static_assert((PLANETREE_KEEP_TRIANGLES | PLANETREE_KEEP_COLOR | PLANETREE_KEEP_UV |
               PLANETREE_KEEP_VALUE) == kAllAttributes);
static_assert(PLANETREE_VALUE_REAL == static_cast<int>(ValueKind::kReal));
static_assert((PLANETREE_DISTANCE_LAYER | PLANETREE_SIDE_LAYER | PLANETREE_FIELD_LAYER |
               PLANETREE_ATTRIBUTE_LAYER) == kAllLayers);
static_assert((PLANETREE_DISTANCE | PLANETREE_SIDE | PLANETREE_NORMAL) == kAllParts);

QueryOptions options_of(const planetree_query_options* given) {
  QueryOptions options;
  if (!given) return options;
  options.parts = are_set(given) ? given->parts : ~kAllParts;
  options.wait = given->never_waits ? Wait::kNever : Wait::kForPages;
  options.side_rule = static_cast<SideRule>(given->side_rule);
  options.normal_rule = static_cast<NormalRule>(given->normal_rule);
  options.max_work = given->max_work;
  options.max_error = given->max_error;
  options.max_distance = given->max_distance;
  return options;
}

std::uint32_t fail(const Error& error, planetree_error* to) {
  const auto code = static_cast<std::uint32_t>(error.code);
  if (!to) return code;
  *to = {code, error.page, error.offset, {}};
  static_assert(sizeof to->text == sizeof error.text);
  std::memcpy(to->text, error.text, sizeof to->text);
  return code;
}

std::uint32_t fail_without_memory(planetree_error* to) {
  return fail(make_error(ErrorCode::kNoMemory, Error::kNowhere, Error::kNowhere,
                         "no memory for a handle; free some and try again"),
              to);
}

std::uint32_t fail_for_unset_options(planetree_error* to) {
  return fail(make_error(ErrorCode::kBadArgument, Error::kNowhere, Error::kNowhere,
                         "the options are not set; call the planetree_default_..._options() of "
                         "this version first"),
              to);
}

}  // namespace planetree::c
