#pragma once

#include <cstdint>

#include "planetree/model.h"
#include "query/shell/shell_query.h"

namespace planetree::query {

/// A model that a probe asks. Both have the floating-point mode that queries need.
///
/// Asked  Probe, or another class with its functions
template <class Asked>
class ProbeSource final : public ShellSource {
 public:
  /// probe, info  must outlive this
  ProbeSource(Asked& probe, const ModelInfo& info) : probe_(probe), info_(info) {}

  ClosestPoint closest_point(const Vec3& query, const QueryOptions& options) noexcept override {
    return probe_.closest_point(query, options);
  }
  Containment contains(const Vec3& query, const QueryOptions& options) noexcept override {
    return probe_.contains(query, options);
  }
  std::uint64_t work_spent() const noexcept override { return probe_.work_spent(); }
  const ModelInfo& info() const noexcept override { return info_; }

 private:
  Asked& probe_;
  const ModelInfo& info_;
};

}  // namespace planetree::query
