#include "tests/cache/explorer/execution.h"

#include <cassert>
#include <utility>

namespace planetree::explorer {
namespace {

Execution* the_current = nullptr;

// Step numbers have 16 bits. No program here comes near this limit unless a thread never ends.
constexpr std::uint16_t kMaxSteps = 10'000;

const char* name_of(std::memory_order order) noexcept {
  switch (order) {
    case std::memory_order_relaxed:
      return "relaxed";
    case std::memory_order_acquire:
      return "acquire";
    case std::memory_order_release:
      return "release";
    case std::memory_order_seq_cst:
      return "seq_cst";
    default:
      return "acq_rel";
  }
}

}  // namespace

Execution::Execution(Choices& choices, std::uint32_t max_preemptions)
    : choices_(choices), max_preemptions_(max_preemptions), fibers_(kMaxThreads, &fiber_body) {
  assert(the_current == nullptr);
  the_current = this;
}

Execution::~Execution() { the_current = nullptr; }

Execution& Execution::current() noexcept { return *the_current; }

bool Execution::run(const MakeProgram& make) {
  memory_.clear();
  trace_.clear();
  running_ = 0;
  preemptions_left_ = max_preemptions_;
  const std::unique_ptr<Program> program = make();
  program_ = program.get();
  start_threads();
  running_ = kNoPage;
  choose_thread(false);
  threads_run_ = true;
  fibers_.switch_to(running_);
  threads_run_ = false;
  if (why_failed_ == nullptr) {
    join_threads();
    program->finish();
  }
  program_ = nullptr;
  return why_failed_ == nullptr;
}

// Setting up and finishing the program count as steps of thread 0, as if it started and joined the
// others.
void Execution::start_threads() {
  thread_count_ = program_->thread_count();
  assert(thread_count_ <= kMaxThreads);
  const Knowledge knowledge = memory_.publish_knowledge(0);
  for (std::uint32_t i = 0; i < thread_count_; ++i) {
    threads_[i] = {false, false, nullptr};
    memory_.learn(i, knowledge);
  }
}

void Execution::join_threads() {
  running_ = 0;
  for (std::uint32_t i = 1; i < thread_count_; ++i) memory_.learn(0, memory_.publish_knowledge(i));
}

// A fiber lives as long as its stack and runs one thread in each run.
void Execution::fiber_body() {
  for (;;) current().run_thread();
}

void Execution::run_thread() {
  program_->run(running_);
  threads_[running_].ended = true;
  if (choose_thread(false)) {
    fibers_.switch_to(running_);
  } else {
    fibers_.switch_to_maker();
  }
}

bool Execution::may_go_on(std::uint32_t thread) const noexcept {
  const Thread& one = threads_[thread];
  return !one.ended && (one.awaited_mutex == nullptr || !*one.awaited_mutex);
}

/// Chooses the thread that runs next; false if no thread can run. The running thread is a candidate
/// only if it may stay; switching away from it then counts as a preemption.
bool Execution::choose_thread(bool may_stay) {
  if (may_stay && preemptions_left_ == 0) return true;
  std::array<std::uint32_t, kMaxThreads> able;
  std::uint32_t count = 0;
  if (may_stay) able[count++] = running_;
  for (std::uint32_t i = 0; i < thread_count_; ++i) {
    if (i != running_ && may_go_on(i)) able[count++] = i;
  }
  if (count == 0) return false;
  const std::uint32_t next = able[choices_.choose(count)];
  if (may_stay && next != running_) --preemptions_left_;
  running_ = next;
  return true;
}

void Execution::before_step() {
  if (!threads_run_) return;
  if (memory_.time_of(running_) > kMaxSteps) fail("a thread does not end");
  if (!std::exchange(threads_[running_].did_visible_step, false)) return;
  choose_thread(true);
  fibers_.switch_to(running_);
}

void Execution::yield() {
  threads_[running_].did_visible_step = false;
  choose_thread(false);
  fibers_.switch_to(running_);
}

std::uint64_t Execution::load(std::size_t atomic, std::memory_order order) {
  before_step();
  const Memory::Loaded loaded = memory_.load(running_, atomic, order, choices_);
  trace_.add({running_, "loads atomic", atomic, loaded.value, name_of(order), loaded.newer_stores});
  return loaded.value;
}

void Execution::note_change(const char* what, std::size_t atomic, std::uint64_t value,
                            std::memory_order order) {
  threads_[running_].did_visible_step = true;
  trace_.add({running_, what, atomic, value, name_of(order), 0});
}

void Execution::store(std::size_t atomic, std::uint64_t value, std::memory_order order) {
  before_step();
  memory_.store(running_, atomic, value, order);
  note_change("stores atomic", atomic, value, order);
}

std::uint64_t Execution::exchange(std::size_t atomic, std::uint64_t value,
                                  std::memory_order order) {
  before_step();
  const std::uint64_t replaced = memory_.exchange(running_, atomic, value, order);
  note_change("exchanges atomic", atomic, value, order);
  return replaced;
}

std::uint64_t Execution::fetch_add(std::size_t atomic, std::uint64_t value,
                                   std::memory_order order) {
  before_step();
  const std::uint64_t replaced = memory_.fetch_add(running_, atomic, value, order);
  note_change("adds to atomic", atomic, value, order);
  return replaced;
}

void Execution::read_plain(std::size_t plain) {
  note("reads plain", plain);
  if (!memory_.read_plain(running_, plain)) fail("a data race: a read after a write");
}

void Execution::write_plain(std::size_t plain) {
  note("writes plain", plain);
  if (!memory_.write_plain(running_, plain)) fail("a data race: a write after another access");
}

void Execution::lock(bool& held, const Knowledge& knowledge) {
  before_step();
  if (held) {
    threads_[running_].awaited_mutex = &held;
    if (!choose_thread(false)) fail("every thread waits for another");
    fibers_.switch_to(running_);
    threads_[running_].awaited_mutex = nullptr;
  }
  held = true;
  memory_.learn(running_, knowledge);
  threads_[running_].did_visible_step = true;
  note("locks", 0);
}

void Execution::unlock(bool& held, Knowledge& knowledge) {
  before_step();
  knowledge = memory_.publish_knowledge(running_);
  held = false;
  threads_[running_].did_visible_step = true;
  note("unlocks", 0);
}

void Execution::fail(const char* why) {
  if (why_failed_ == nullptr) why_failed_ = why;
  // The other fibers stay suspended for good.
  if (threads_run_) fibers_.switch_to_maker();
}

void Execution::note(const char* what, std::uint64_t number) {
  trace_.add({running_, what, number, 0, nullptr, 0});
}

std::string Execution::failure() const {
  return why_failed_ == nullptr ? std::string() : why_failed_ + ("\n" + trace_.text());
}

}  // namespace planetree::explorer
