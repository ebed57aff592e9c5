#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>

#include "planetree/error.h"
#include "planetree/stats.h"

namespace planetree {

namespace query {
class ModelState;
}

/// Whether to keep the system from paging the arena out.
enum class Locking : std::uint8_t {
  kTry,      ///< if the system allows; Stats says whether it did
  kRequire,  ///< or the model does not open
  kNever,
};

struct OpenOptions {
  /// Hard ceiling for all that the model holds in memory, its probes included.
  /// Claimed at open: the pages of the whole model if they fit, else as many as
  /// do. Nothing grows afterwards.
  std::uint64_t memory_budget_bytes = std::uint64_t{256} << 20;
  /// Threads that get what asks of Wait::kNever miss, and what probes are moving to; 1 to
  /// kMostFetchThreads. Started at open, as ordinary threads whatever the caller's is. Each
  /// serves some of the probes; pages are read one at a time.
  unsigned fetch_threads = 1;
  /// Threads that answer a batch together (Probe::closest_points over spans), the caller's
  /// among them; 1 to kMostBatchThreads. Probes for them are claimed at open. One batch at a
  /// time has them: others meanwhile go on in their callers' threads.
  unsigned batch_threads = 1;

  /// Most probes at one time; 1 to kMostProbes.
  unsigned max_probes = 16;
  Locking locking = Locking::kTry;

  static constexpr unsigned kMostProbes = 1024;
  static constexpr unsigned kMostFetchThreads = 64;
  static constexpr unsigned kMostBatchThreads = 256;
};

/// An opened .ptree file: immutable, shared by any number of threads, each
/// with a Probe of its own. Must outlive its probes.
class Model {
 public:
  /// Opens and checks a file, claims the memory, loads the root and looks at the mask's
  /// first page, if there is one.
  ///
  /// errors  kNotFound, kPermission, kReadFailed; kNotPlanetree, kUnsupported,
  ///         kTruncated, kDamaged; kNoMemory, naming the least budget that will
  ///         do, or because memory cannot be locked; kBadArgument for options that make
  ///         no sense.
  [[nodiscard]] static Result<Model> open(const std::filesystem::path& path,
                                          const OpenOptions& options = {});

  Model(Model&&) noexcept;
  Model& operator=(Model&&) noexcept;
  ~Model();

  const ModelInfo& info() const noexcept;
  /// Any thread, at any time; waits for nobody.
  Stats stats() const noexcept;

 private:
  friend class Probe;
  friend class query::ModelState;
  explicit Model(std::unique_ptr<query::ModelState> state) noexcept;
  std::unique_ptr<query::ModelState> state_;
};

}  // namespace planetree
