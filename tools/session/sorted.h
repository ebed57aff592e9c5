#pragma once

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

namespace planetree::tools {

/// Measured values in ascending order.
template <class Value>
class Sorted {
 public:
  explicit Sorted(std::vector<Value> values) : values_(std::move(values)) {
    std::sort(values_.begin(), values_.end());
  }
  /// The quantile for a share in [0, 1]; 0 if there are no values.
  Value at(double share) const {
    if (values_.empty()) return {};
    const auto rank = static_cast<std::size_t>(share * static_cast<double>(values_.size()));
    return values_[std::min(rank, values_.size() - 1)];
  }

 private:
  std::vector<Value> values_;
};

}  // namespace planetree::tools
