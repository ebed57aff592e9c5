#pragma once

#include <chrono>
#include <functional>
#include <thread>

namespace planetree::query {

/// Waits up to a minute for a condition; returns whether it became true. A minute allows for busy
/// machines.
inline bool eventually(const std::function<bool()>& is_true) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::minutes(1);
  while (!is_true()) {
    if (std::chrono::steady_clock::now() > end) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return true;
}

}  // namespace planetree::query
