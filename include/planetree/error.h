#pragma once

#include <cassert>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <variant>

#include "planetree/export.h"

/// @file
/// Failures as values. The library does not throw through its interface, print, or exit. A call
/// that can fail returns a Result. The functions of planetree/eigen.h are the exception: they
/// allocate vectors and may throw std::bad_alloc.

namespace planetree {

/// Kind of a failure.
enum class ErrorCode : std::uint16_t {
  kBadArgument = 1,  ///< an argument or option of the call is out of range
  kNotFound,         ///< a file or directory does not exist
  kAlreadyExists,    ///< the destination exists, and the caller did not allow replacing it
  kPermission,       ///< the system refused access
  kNoSpace,          ///< no space left on the device
  kNoMemory,         ///< no memory, or the memory budget is too small
  kReadFailed,       ///< the device or the system failed to read
  kWriteFailed,      ///< the device or the system failed to write
  kBadInput,         ///< a mesh or a point file is malformed, or a callback failed
  kNotPlanetree,     ///< the file is not a .ptree file
  kUnsupported,      ///< another format version, an unknown feature, or non-IEEE arithmetic
  kTruncated,        ///< the file is shorter, or longer, than its header states
  kDamaged,          ///< a checksum, a count or a structure of a .ptree file is wrong
  kCancelled,        ///< the caller cancelled the call
};

/// A failure: its kind, its place in the file, its cause and its remedy. Plain data without
/// allocation, cheap to copy.
struct Error {
  /// Value of `page` or `offset` if it does not apply.
  static constexpr std::uint64_t kNowhere = ~std::uint64_t{0};

  ErrorCode code = ErrorCode::kBadArgument;  ///< kind of the failure
  std::uint64_t page = kNowhere;             ///< page number, or kNowhere
  std::uint64_t offset = kNowhere;           ///< byte offset in the file, or kNowhere
  char text[192] = {};                       ///< cause and remedy, one line, ended by 0
};

/// Returns an Error whose text is formatted as by std::printf and truncated to fit. A callback such
/// as a TriangleSource may use it to return an error.
///
/// page, offset  Error::kNowhere if they do not apply.
/// threads       any.
[[nodiscard]] [[gnu::format(printf, 4, 5)]] PLANETREE_API Error make_error(
    ErrorCode code, std::uint64_t page, std::uint64_t offset, const char* format, ...) noexcept;

/// A T or an Error. Test it with `if (result)`, then read `*result` or `result.error()`.
///
/// operator* and operator-> require a value, and error() requires an error. Debug builds assert
/// this. With NDEBUG a wrong call is undefined behaviour. References and pointers that a Result
/// returns are valid as long as the Result.
template <class T>
class [[nodiscard]] Result {
 public:
  /// Success with a value.
  Result(T value) : state_(std::in_place_index<0>, std::move(value)) {}
  /// Failure.
  Result(const Error& error) : state_(std::in_place_index<1>, error) {}

  /// Whether there is a value.
  explicit operator bool() const noexcept { return state_.index() == 0; }
  /// The value.
  T& operator*() & noexcept { return *checked(); }
  /// The value.
  const T& operator*() const& noexcept { return *checked(); }
  /// The value, to be moved from.
  T&& operator*() && noexcept { return std::move(*checked()); }
  /// The value's members.
  T* operator->() noexcept { return checked(); }
  /// The value's members.
  const T* operator->() const noexcept { return checked(); }
  /// The error.
  const Error& error() const noexcept {
    assert(state_.index() == 1);
    return *std::get_if<1>(&state_);
  }

 private:
  T* checked() noexcept {
    assert(state_.index() == 0);
    return std::get_if<0>(&state_);
  }
  const T* checked() const noexcept {
    assert(state_.index() == 0);
    return std::get_if<0>(&state_);
  }

  std::variant<T, Error> state_;
};

/// Success without a value, or an Error. See Result.
template <>
class [[nodiscard]] Result<void> {
 public:
  /// Success.
  Result() = default;
  /// Failure.
  Result(const Error& error) : error_(error) {}

  /// Whether the call succeeded.
  explicit operator bool() const noexcept { return !error_.has_value(); }
  /// The error.
  const Error& error() const noexcept {
    assert(error_.has_value());
    return *error_;
  }

 private:
  std::optional<Error> error_;
};

}  // namespace planetree
