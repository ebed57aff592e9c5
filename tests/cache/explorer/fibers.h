#pragma once

#include <ucontext.h>

#include <cstddef>
#include <memory>
#include <vector>

namespace planetree::explorer {

/// Cooperative threads of a program: they share one system thread and switch only by a call. Each
/// has its own stack, so the code that runs on it needs no changes.
class Fibers {
 public:
  /// Each fiber runs `body` from its first switch on; `body` must not return.
  Fibers(std::size_t count, void (*body)());
  ~Fibers();
  Fibers(const Fibers&) = delete;
  Fibers& operator=(const Fibers&) = delete;

  /// Continues a fiber where it stopped. Returns when another switch comes back to the caller.
  void switch_to(std::size_t fiber);

  /// Continues the code that created the fibers.
  void switch_to_maker() { switch_to(stacks_.size()); }

 private:
  /// A fiber, or the code that created the fibers.
  struct Strand {
    ucontext_t context;
    void* sanitizer_fiber;
  };

  std::vector<std::unique_ptr<std::byte[]>> stacks_;
  std::vector<Strand> strands_;  // the creator is the last
  std::size_t running_;
};

}  // namespace planetree::explorer
