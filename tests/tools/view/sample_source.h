#pragma once

#include <string>

#include "tools/view/view_router.h"
#include "tools/view/view_source.h"

namespace planetree::tools {

/// A source that says what it was asked.
class SampleSource final : public ViewSource {
 public:
  std::string info() override { return "info"; }
  Result<std::string> shape(const ShapeView& view) override {
    if (view.discs == 13)
      return make_error(ErrorCode::kDamaged, 7, Error::kNowhere, "it cannot be read");
    return "shape of " + std::to_string(view.discs) + (view.has_eye ? " from an eye" : "");
  }
  std::string answer(const PointQuestion& question) override {
    return "answer at " + std::to_string(question.point.y);
  }
  std::string stats() override { return "stats"; }
  std::string pages() override { return std::string(3, '\0'); }
  std::string timeline() override { return "null"; }
};

inline constexpr PageFile kSampleFiles[] = {{"index.html", "text/html", "<!doctype html>"},
                                            {"view.js", "text/javascript", "main()"}};
inline constexpr const char* kSampleToken = "0123456789abcdef0123456789abcdef";

}  // namespace planetree::tools
