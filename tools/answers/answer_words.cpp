#include "tools/answers/answer_words.h"

namespace planetree::tools {

std::string_view feature_word(Feature feature) {
  switch (feature) {
    case Feature::kFace:
      return "face";
    case Feature::kEdge:
      return "edge";
    case Feature::kVertex:
      break;
  }
  return "vertex";
}

std::string_view side_word(Side side) {
  switch (side) {
    case Side::kInside:
      return "inside";
    case Side::kOutside:
      return "outside";
    case Side::kOnSurface:
      return "on_surface";
    case Side::kUnknown:
      break;
  }
  return "unknown";
}

std::string_view status_word(Status status) {
  switch (status) {
    case Status::kExact:
      return "exact";
    case Status::kWithinError:
      return "within_error";
    case Status::kDegraded:
      return "degraded";
    case Status::kBeyondMaxDistance:
      return "beyond_max_distance";
    case Status::kBadQuery:
      break;
  }
  return "bad_query";
}

}  // namespace planetree::tools
