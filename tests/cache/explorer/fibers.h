#pragma once

#include <ucontext.h>

#include <cstddef>
#include <memory>
#include <vector>

namespace planetree::explorer {

/// Threads of a program that take turns on one thread of the system, and only
/// where they say so. Each has its own stack, so that what it runs need not
/// know of this.
class Fibers {
 public:
  /// Each runs `body`, which must not return, from its first turn on.
  Fibers(std::size_t count, void (*body)());
  ~Fibers();
  Fibers(const Fibers&) = delete;
  Fibers& operator=(const Fibers&) = delete;

  /// Goes on with a fiber where it stopped, until another switch comes back to
  /// the caller.
  void switch_to(std::size_t fiber);

  /// Goes on with whoever made the fibers.
  void switch_to_maker() { switch_to(stacks_.size()); }

 private:
  /// What runs: a fiber, or their maker.
  struct Strand {
    ucontext_t context;
    void* sanitizer_fiber;
  };

  std::vector<std::unique_ptr<std::byte[]>> stacks_;
  std::vector<Strand> strands_;  // The maker's last.
  std::size_t running_;
};

}  // namespace planetree::explorer
