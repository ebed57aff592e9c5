#include "tests/cache/explorer/fibers.h"

// ThreadSanitizer keeps a call stack for each thread and must be informed of switches. g++ and
// clang++ use different macros to show that it is on.
#if defined(__has_feature)
#if __has_feature(thread_sanitizer)
#define PLANETREE_TELLS_TSAN
#endif
#endif
#if defined(__SANITIZE_THREAD__) && !defined(PLANETREE_TELLS_TSAN)
#define PLANETREE_TELLS_TSAN
#endif

#ifdef PLANETREE_TELLS_TSAN
#include <sanitizer/tsan_interface.h>
#endif

namespace planetree::explorer {
namespace {

constexpr std::size_t kStackBytes = 64 * 1024;

#ifdef PLANETREE_TELLS_TSAN
void* current_fiber() { return __tsan_get_current_fiber(); }
void* make_fiber() { return __tsan_create_fiber(0); }
void destroy_fiber(void* fiber) { __tsan_destroy_fiber(fiber); }
void announce_switch(void* fiber) { __tsan_switch_to_fiber(fiber, 0); }
#else
void* current_fiber() { return nullptr; }
void* make_fiber() { return nullptr; }
void destroy_fiber(void*) {}
void announce_switch(void*) {}
#endif

}  // namespace

Fibers::Fibers(std::size_t count, void (*body)()) : strands_(count + 1), running_(count) {
  for (std::size_t i = 0; i < count; ++i) {
    stacks_.push_back(std::make_unique<std::byte[]>(kStackBytes));
    strands_[i].sanitizer_fiber = make_fiber();
    ucontext_t& context = strands_[i].context;
    getcontext(&context);
    context.uc_stack.ss_sp = stacks_[i].get();
    context.uc_stack.ss_size = kStackBytes;
    context.uc_link = nullptr;
    makecontext(&context, body, 0);
  }
  strands_[count].sanitizer_fiber = current_fiber();
}

Fibers::~Fibers() {
  for (std::size_t i = 0; i < stacks_.size(); ++i) destroy_fiber(strands_[i].sanitizer_fiber);
}

void Fibers::switch_to(std::size_t fiber) {
  if (fiber == running_) return;
  Strand& from = strands_[running_];
  Strand& to = strands_[fiber];
  running_ = fiber;
  announce_switch(to.sanitizer_fiber);
  swapcontext(&from.context, &to.context);
}

}  // namespace planetree::explorer
