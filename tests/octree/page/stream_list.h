#pragma once

#include <cstddef>
#include <vector>

#include "octree/page/page_streams.h"

namespace planetree::octree {

/// Copies all elements of a stream, so that a test can change them.
template <class T>
std::vector<T> list(const ByteSplit<T>& stream) {
  std::vector<T> values;
  for (std::size_t i = 0; i < stream.size(); ++i) values.push_back(stream[i]);
  return values;
}

}  // namespace planetree::octree
