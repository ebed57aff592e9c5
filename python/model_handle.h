#pragma once

#include <condition_variable>
#include <filesystem>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

#include <unistd.h>

#include "planetree/model.h"
#include "planetree/probe.h"

namespace planetree::python {

/// An open model and its probes that no call uses at the moment. Any number of threads may call it,
/// none of which needs to hold Python's global lock.
class OpenModel {
 public:
  explicit OpenModel(Model model) : model_(std::move(model)) {}

  const Model& model() const noexcept { return model_; }

  /// Takes a probe, for one thread. Waits for another call to end if all probes are in use.
  ///
  /// throws  Failure if there is no memory
  std::unique_ptr<Probe> take_probe();
  void give_back(std::unique_ptr<Probe> probe) noexcept;

 private:
  Model model_;
  std::mutex mutex_;
  std::condition_variable returned_;
  std::vector<std::unique_ptr<Probe>> idle_;
  unsigned lent_ = 0;  // probes that will be given back
};

/// A probe for the time of one call.
class LentProbe {
 public:
  explicit LentProbe(OpenModel& model) : model_(model), probe_(model.take_probe()) {}
  ~LentProbe() { model_.give_back(std::move(probe_)); }
  LentProbe(const LentProbe&) = delete;
  LentProbe& operator=(const LentProbe&) = delete;

  Probe* operator->() noexcept { return probe_.get(); }

 private:
  OpenModel& model_;
  std::unique_ptr<Probe> probe_;
};

/// What a Python object has of a model: the model, until it is closed.
class ModelHandle {
 public:
  /// throws  Failure
  ModelHandle(const std::filesystem::path& path, const OpenOptions& options);
  ~ModelHandle() { close(); }
  ModelHandle(const ModelHandle&) = delete;
  ModelHandle& operator=(const ModelHandle&) = delete;

  /// Returns the model. It stays open at least as long as the pointer.
  ///
  /// throws  ValueError if the model is closed, RuntimeError in a process made by fork()
  std::shared_ptr<OpenModel> get() const;
  bool is_closed() const noexcept { return !model_; }
  /// Closes the model as soon as no call uses it.
  void close();

 private:
  std::shared_ptr<OpenModel> model_;
  pid_t process_ = ::getpid();
};

}  // namespace planetree::python
