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

/// Executes a program, one run after the other, as `choices` say: which thread
/// goes on, and which store a load returns.
///
/// Another thread can go on only after a deed, which is what others may notice:
/// a store, an exchange, a lock or an unlock. A load is none, and might as well
/// have come later, directly before the next deed of its thread: it could still
/// return the same store, because stores stay visible however many follow, and
/// perhaps a newer one. Nor is a plain access: if it races, then whichever of
/// the two comes first. So nothing is lost, and runs are fewer by far.
class Execution {
 public:
  /// In each run, at most `stops` times is a thread stopped that could have
  /// gone on.
  Execution(Choices& choices, std::uint32_t stops);
  ~Execution();

  /// False if the run failed, after which no other may follow.
  bool run(const MakeProgram& make);

  /// Why, and the steps that led there.
  std::string failure() const;

  // The rest is for Atomic, Plain, Mutex and programs.

  /// The one there is.
  static Execution& current() noexcept;

  std::size_t add_atomic(std::uint64_t value) { return memory_.add_atomic(value); }
  std::uint64_t load(std::size_t atomic, std::memory_order order);
  void store(std::size_t atomic, std::uint64_t value, std::memory_order order);
  std::uint64_t exchange(std::size_t atomic, std::uint64_t value, std::memory_order order);

  std::size_t add_plain() { return memory_.add_plain(); }
  void read_plain(std::size_t plain);
  void write_plain(std::size_t plain);

  /// `told` is what the mutex's last holder knew.
  void lock(bool& held, const Knowledge& knowledge);
  void unlock(bool& held, Knowledge& knowledge);

  /// Lets another thread go on, if there is one.
  void yield();

  /// Each of 0 ... count - 1, in different runs: for what a program may decide
  /// in any way.
  std::uint32_t choose(std::uint32_t count) { return choices_.choose(count); }

  /// Ends the run as failed; returns only when no thread runs.
  void fail(const char* why);

  /// A line for the trace; `what` is a literal.
  void note(const char* what, std::uint64_t number);

 private:
  static constexpr std::uint32_t kNobody = kMaxThreads;

  static void fiber_body();
  void run_thread();
  void start_threads();
  void join_threads();

  bool may_go_on(std::uint32_t thread) const noexcept;
  void before_step();
  bool choose_thread(bool may_stay);

  struct Thread {
    bool ended = true;
    bool did_a_deed = false;              ///< since others could last run
    const bool* awaited_mutex = nullptr;  ///< whether it is held
  };

  Choices& choices_;
  const std::uint32_t stops_;
  Memory memory_;
  Trace trace_;
  Fibers fibers_;

  Program* program_ = nullptr;
  std::array<Thread, kMaxThreads> threads_;
  std::uint32_t thread_count_ = 0;
  std::uint32_t running_ = 0;
  bool threads_run_ = false;  ///< else the program is being set up, or finishes
  std::uint32_t stops_left_ = 0;
  const char* why_failed_ = nullptr;
};

}  // namespace planetree::explorer
