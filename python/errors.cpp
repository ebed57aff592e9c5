#include "python/errors.h"

#include <cstdint>
#include <exception>
#include <string>
#include <utility>

namespace planetree::python {
namespace {

namespace py = pybind11;

PyObject* error_class = nullptr;  // lives as long as the process

py::object place(std::uint64_t at) { return at == Error::kNowhere ? py::none() : py::cast(at); }

void raise(const Failure& failure) {
  const Error& error = failure.error;
  const std::string file = failure.file.empty() ? "" : failure.file.string() + ": ";
  py::object raised = py::reinterpret_borrow<py::object>(error_class)(file + error.text);
  raised.attr("code") = static_cast<unsigned>(error.code);
  raised.attr("page") = place(error.page);
  raised.attr("offset") = place(error.offset);
  PyErr_SetObject(error_class, raised.ptr());
}

}  // namespace

void define_error(py::module_& module) {
  error_class =
      PyErr_NewExceptionWithDoc("planetree.Error",
                                "A failure: its cause and its remedy in one line.\n\n"
                                "code    int, a value of ErrorCode\n"
                                "page    page of the file that the failure concerns, or None\n"
                                "offset  byte of the file, or None",
                                PyExc_RuntimeError, nullptr);
  if (!error_class) throw py::error_already_set();
  module.attr("Error") = py::reinterpret_borrow<py::object>(error_class);
  py::register_exception_translator([](std::exception_ptr thrown) {
    try {
      if (thrown) std::rethrow_exception(std::move(thrown));
    } catch (const Failure& failure) {
      raise(failure);
    }
  });
}

}  // namespace planetree::python
