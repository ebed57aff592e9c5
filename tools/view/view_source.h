#pragma once

#include <string>

#include "planetree/error.h"
#include "tools/view/view_request.h"

namespace planetree::tools {

/// What a page shows: a model, or another thing that has a shape and answers questions at points.
/// The texts are JSON, the bytes little-endian arrays; tools/view/README.md describes both.
///
/// threads  any, several at a time
class ViewSource {
 public:
  ViewSource() = default;
  ViewSource(const ViewSource&) = delete;
  ViewSource& operator=(const ViewSource&) = delete;
  virtual ~ViewSource() = default;

  /// Facts that do not change while the page is served.
  virtual std::string info() = 0;
  /// The shape as discs and triangles.
  ///
  /// errors  the data cannot be read
  virtual Result<std::string> shape(const ShapeView& view) = 0;
  /// The answer at a point, from the pages that are in memory.
  virtual std::string answer(const PointQuestion& question) = 0;
  /// Counts of pages.
  virtual std::string stats() = 0;
  /// The state of each page, in a byte.
  virtual std::string pages() = 0;
  /// What happened in a recorded session; `null` without one.
  virtual std::string timeline() = 0;
};

}  // namespace planetree::tools
