#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <span>
#include <type_traits>
#include <vector>

#include "planetree/types.h"
#include "tools/answers/placed_point.h"
#include "tools/view/view_request.h"

namespace planetree::tools {

/// What is answered to a question at a point. Answers of a model have no instance.
struct PointAnswer {
  static constexpr std::size_t kMaxContacts = 16;

  PlacedPoint nearest;
  std::vector<PlacedPoint> contacts;  ///< at most kMaxContacts
  bool are_all = false;               ///< no other contact is within the distance that was asked
  std::uint32_t parts = kAllParts;    ///< as QueryOptions::parts
};

/// Asks a question from the pages that are in memory.
///
/// probe   a Probe or a SceneProbe
/// parts   as QueryOptions::parts
/// placed  makes a PlacedPoint of an answer of the probe
template <class AnyProbe, class Placed>
PointAnswer ask_at(AnyProbe& probe, const PointQuestion& question, std::uint32_t parts,
                   const Placed& placed) {
  QueryOptions options;
  options.wait = Wait::kNever;
  options.parts = parts;
  const auto nearest = probe.closest_point(question.point, options);
  PointAnswer answer{placed(nearest), {}, false, parts};
  if (!(question.within > 0)) return answer;
  std::array<std::remove_cv_t<decltype(nearest)>, PointAnswer::kMaxContacts> contacts;
  const Found found = probe.contacts(question.point, question.within, contacts, options);
  std::transform(contacts.begin(), contacts.begin() + static_cast<std::ptrdiff_t>(found.count),
                 std::back_inserter(answer.contacts), placed);
  answer.are_all = found.complete;
  return answer;
}

}  // namespace planetree::tools
