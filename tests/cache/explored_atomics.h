#pragma once

#include <array>
#include <atomic>
#include <cstddef>

#include "cache/protocol.h"
#include "tests/cache/explorer/atomic.h"

namespace planetree::cache {

/// Makes the classes of the protocol explorable. The memory orders are those shipped, until a test
/// weakens one.
class ExploredAtomics {
 public:
  template <class T>
  using Atomic = explorer::Atomic<T>;

  static std::memory_order order(ProtocolStep step) noexcept { return orders()[index(step)]; }

  static void ship_orders() noexcept {
    for (std::size_t i = 0; i < kSteps; ++i) orders()[i] = order_of(static_cast<ProtocolStep>(i));
  }
  static void set_order(ProtocolStep step, std::memory_order order) noexcept {
    orders()[index(step)] = order;
  }

 private:
  static constexpr std::size_t kSteps = static_cast<std::size_t>(ProtocolStep::kPublish) + 1;

  static std::size_t index(ProtocolStep step) noexcept { return static_cast<std::size_t>(step); }
  static std::array<std::memory_order, kSteps>& orders() noexcept {
    static std::array<std::memory_order, kSteps> all;
    return all;
  }
};

}  // namespace planetree::cache
