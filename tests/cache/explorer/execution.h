#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "tests/cache/explorer/choices.h"
#include "tests/cache/explorer/fibers.h"
#include "tests/cache/explorer/memory.h"
#include "tests/cache/explorer/program.h"
#include "tests/cache/explorer/trace.h"

namespace planetree::explorer {

using MakeProgram = std::function<std::unique_ptr<Program>()>;

/// Executes a program, one run after the other. `choices` decides which thread runs next and which
/// store a load returns.
///
/// Threads are switched only after a visible step: a store, an exchange, an addition, a lock or an
/// unlock. A load need not be a switch point. It could equally be executed later, directly before
/// the next visible step of its thread: there it may still return the same store, because older
/// stores stay readable, or a newer one. A plain access need not be one either: a race is found
/// whichever access comes first. So no behaviour is lost, and far fewer runs are needed.
class Execution {
 public:
  /// The second argument limits how often, in each run, a thread that could continue is preempted.
  Execution(Choices& choices, std::uint32_t max_preemptions);
  ~Execution();

  /// Executes one run. False if it failed; no other run may follow then.
  bool run(const MakeProgram& make);

  /// Reason for the failure and the steps that led to it; empty if no run failed.
  std::string failure() const;

  // For Atomic, Plain, Mutex and programs only.

  /// The execution in progress; there is at most one.
  static Execution& current() noexcept;

  std::size_t add_atomic(std::uint64_t value) { return memory_.add_atomic(value); }
  std::uint64_t load(std::size_t atomic, std::memory_order order);
  void store(std::size_t atomic, std::uint64_t value, std::memory_order order);
  std::uint64_t exchange(std::size_t atomic, std::uint64_t value, std::memory_order order);
  std::uint64_t fetch_add(std::size_t atomic, std::uint64_t value, std::memory_order order);

  std::size_t add_plain() { return memory_.add_plain(); }
  void read_plain(std::size_t plain);
  void write_plain(std::size_t plain);

  /// `knowledge` is what the last holder of the mutex knew when it unlocked.
  void lock(bool& held, const Knowledge& knowledge);
  void unlock(bool& held, Knowledge& knowledge);

  /// Lets another thread run, if one can.
  void yield();

  /// Returns each of 0 ... count - 1, in different runs. For decisions that a program leaves open.
  std::uint32_t choose(std::uint32_t count) { return choices_.choose(count); }

  /// Ends the run as failed. Returns only if no thread is running.
  void fail(const char* why);

  /// Adds a line to the trace; `what` is a string literal.
  void note(const char* what, std::uint64_t number);

 private:
  void note_change(const char* what, std::size_t atomic, std::uint64_t value,
                   std::memory_order order);

  static constexpr std::uint32_t kNoPage = kMaxThreads;

  static void fiber_body();
  void run_thread();
  void start_threads();
  void join_threads();

  bool may_go_on(std::uint32_t thread) const noexcept;
  void before_step();
  bool choose_thread(bool may_stay);

  struct Thread {
    bool ended = true;
    bool did_visible_step = false;        ///< visible step since other threads could last run
    const bool* awaited_mutex = nullptr;  ///< whether that mutex is held; nullptr: waits for none
  };

  Choices& choices_;
  const std::uint32_t max_preemptions_;
  Memory memory_;
  Trace trace_;
  Fibers fibers_;

  Program* program_ = nullptr;
  std::array<Thread, kMaxThreads> threads_;
  std::uint32_t thread_count_ = 0;
  std::uint32_t running_ = 0;
  bool threads_run_ = false;  ///< false while the program is set up or finishes
  std::uint32_t preemptions_left_ = 0;
  const char* why_failed_ = nullptr;
};

}  // namespace planetree::explorer
