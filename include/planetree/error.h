#pragma once

#include <cassert>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <variant>

/// Failures are values. Nothing in planetree throws across its API, prints or
/// exits; a call that can fail returns Result<T>.
namespace planetree {

/// What kind of failure this is; who has to act follows from it.
enum class ErrorCode : std::uint16_t {
  kBadArgument = 1,  ///< the caller's request makes no sense
  kNotFound,         ///< no such file
  kAlreadyExists,    ///< the destination exists and may not be replaced
  kPermission,       ///< the system refused access
  kNoSpace,          ///< no room on the device
  kNoMemory,         ///< no memory, or the memory budget is too small
  kReadFailed,       ///< the device or the system failed to read
  kWriteFailed,      ///< the device or the system failed to write
  kBadInput,         ///< a mesh or point file is structurally damaged
  kNotPlanetree,     ///< the file is not a .ptree file
  kUnsupported,      ///< a newer version or an unknown feature
  kTruncated,        ///< the file is shorter or longer than it says
  kDamaged,          ///< a checksum, a count or a structure is wrong
};

/// A failure: its kind, the place, the cause and the remedy. Plain data: no
/// allocation, copied freely.
struct Error {
  static constexpr std::uint64_t kNowhere = ~std::uint64_t{0};

  ErrorCode code = ErrorCode::kBadArgument;
  std::uint64_t page = kNowhere;    ///< page number, or kNowhere
  std::uint64_t offset = kNowhere;  ///< byte offset in the file, or kNowhere
  char text[192] = {};              ///< cause and remedy, one line, ended by 0
};

/// Makes an Error whose text is printed from `format` as std::printf would,
/// cut to fit.
[[nodiscard]] [[gnu::format(printf, 4, 5)]] Error make_error(ErrorCode code, std::uint64_t page,
                                                             std::uint64_t offset,
                                                             const char* format, ...) noexcept;

/// A T or an Error. Test it with `if (result)`, then read `*result`, or
/// `result.error()`. Reading the side that is not there is a mistake of the
/// program and asserts.
template <class T>
class [[nodiscard]] Result {
 public:
  Result(T value) : state_(std::in_place_index<0>, std::move(value)) {}
  Result(const Error& error) : state_(std::in_place_index<1>, error) {}

  explicit operator bool() const noexcept { return state_.index() == 0; }
  T& operator*() & noexcept { return *checked(); }
  const T& operator*() const& noexcept { return *checked(); }
  T&& operator*() && noexcept { return std::move(*checked()); }
  T* operator->() noexcept { return checked(); }
  const T* operator->() const noexcept { return checked(); }
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

/// Success without a value, or an Error.
template <>
class [[nodiscard]] Result<void> {
 public:
  Result() = default;
  Result(const Error& error) : error_(error) {}

  explicit operator bool() const noexcept { return !error_.has_value(); }
  const Error& error() const noexcept {
    assert(error_.has_value());
    return *error_;
  }

 private:
  std::optional<Error> error_;
};

}  // namespace planetree
