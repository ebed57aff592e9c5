#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <iterator>
#include <limits>
#include <span>

namespace planetree {

/// Random choices of a mutator. They depend on the seed that libFuzzer gives.
class Choices {
 public:
  explicit Choices(unsigned seed) : state_(seed) {}

  std::uint64_t next() {
    std::uint64_t z = state_ += 0x9e3779b97f4a7c15;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9;
    z = (z ^ (z >> 27)) * 0x94d049bb133111eb;
    return z ^ (z >> 31);
  }
  /// Below `count`, which must not be 0.
  std::size_t below(std::size_t count) { return next() % count; }
  bool one_in(std::size_t count) { return below(count) == 0; }
  template <class Array>
  auto& of(Array& array) {
    return array[below(std::size(array))];
  }

 private:
  std::uint64_t state_;
};

/// Replaces a little-endian integer, a float or a double: a bit or the last digit changes, or the
/// value becomes a special one. There must be 1 to 8 bytes.
inline void change_value(std::span<std::byte> bytes, Choices& choices) {
  constexpr double kDoubles[] = {0.0,
                                 -0.0,
                                 1.0,
                                 -1.0,
                                 0.5,
                                 1e-30,
                                 1e30,
                                 1e300,
                                 -1e300,
                                 5e-324,
                                 1.5e-45,
                                 3.5e38,
                                 std::numeric_limits<double>::infinity(),
                                 -std::numeric_limits<double>::infinity(),
                                 std::numeric_limits<double>::quiet_NaN()};
  const auto put = [&](const auto& value) { std::memcpy(bytes.data(), &value, bytes.size()); };
  std::uint64_t value = 0;
  std::memcpy(&value, bytes.data(), bytes.size());
  const unsigned bits = static_cast<unsigned>(8 * bytes.size());
  switch (choices.below(6)) {
    case 0:
      return put(value ^ std::uint64_t{1} << choices.below(bits));
    case 1:
      return put(value + 1 + choices.below(4));
    case 2:
      return put(value - 1 - choices.below(4));
    case 3: {
      constexpr std::uint64_t kWhole[] = {0, 1, 2, 3, 8, 16, 64, 127, 128, 255, 256, 32767, 65535};
      return put(choices.one_in(3) ? ~std::uint64_t{0} >> choices.below(64) : choices.of(kWhole));
    }
    case 4:
      return put(choices.next());
    default:
      if (bytes.size() == 8) return put(choices.of(kDoubles));
      if (bytes.size() == 4) return put(static_cast<float>(choices.of(kDoubles)));
      return put(~value);
  }
}

}  // namespace planetree
