#include "python/model_handle.h"

#include <stdexcept>
#include <utility>

#include <pybind11/pybind11.h>

#include "python/errors.h"

namespace planetree::python {

namespace py = pybind11;

std::unique_ptr<Probe> OpenModel::take_probe() {
  std::unique_lock lock(mutex_);
  for (;;) {
    if (!idle_.empty()) {
      std::unique_ptr<Probe> probe = std::move(idle_.back());
      idle_.pop_back();
      ++lent_;
      return probe;
    }
    auto made = Probe::create(model_);
    if (made) {
      auto probe = std::make_unique<Probe>(*std::move(made));
      idle_.reserve(lent_ + 1);  // so that give_back() does not allocate
      ++lent_;
      return probe;
    }
    if (lent_ == 0) throw Failure{made.error(), {}};
    returned_.wait(lock);
  }
}

void OpenModel::give_back(std::unique_ptr<Probe> probe) noexcept {
  {
    const std::lock_guard lock(mutex_);
    idle_.push_back(std::move(probe));
    --lent_;
  }
  returned_.notify_one();
}

ModelHandle::ModelHandle(const std::filesystem::path& path, const OpenOptions& options) {
  const py::gil_scoped_release unlocked;
  model_ = std::make_shared<OpenModel>(value_of(Model::open(path, options), path));
}

std::shared_ptr<OpenModel> ModelHandle::get() const {
  if (!model_) throw py::value_error("the model is closed; open it again");
  if (process_ != ::getpid())
    throw std::runtime_error(
        "the model was opened before fork(), and its threads do not run in this process; open it "
        "here, or start processes by the method 'spawn'");
  return model_;
}

void ModelHandle::close() {
  std::shared_ptr<OpenModel> closing = std::move(model_);
  if (!closing) return;
  // After fork() the threads that closing waits for do not exist.
  if (process_ != ::getpid()) {
    static_cast<void>(new std::shared_ptr<OpenModel>(std::move(closing)));
    return;
  }
  const py::gil_scoped_release unlocked;
  closing.reset();
}

}  // namespace planetree::python
