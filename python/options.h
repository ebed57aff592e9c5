#pragma once

#include <type_traits>

#include <pybind11/pybind11.h>

namespace planetree::python {

/// Options that a dictionary may have. Those that it lacks keep their values.
class Options {
 public:
  explicit Options(const pybind11::dict& given) : given_(given) {}

  /// Sets an option if the dictionary has it. Throws TypeError or RuntimeError for a value of
  /// another type.
  template <class Value>
  void take(const char* name, Value& to) const {
    if (!given_.contains(name)) return;
    if constexpr (std::is_enum_v<Value>)
      to = static_cast<Value>(pybind11::cast<std::underlying_type_t<Value>>(given_[name]));
    else
      to = pybind11::cast<Value>(given_[name]);
  }

 private:
  const pybind11::dict& given_;
};

}  // namespace planetree::python
