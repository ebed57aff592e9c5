#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "planetree/error.h"

/// Text forms of counts and sizes, independent of locale.
namespace planetree::tools {

/// What help and man pages say about the suffixes of parse_count() and parse_bytes().
inline constexpr const char* kSuffixHelp =
    "SIZE takes the suffixes K, M, G and T as powers of 1024, also as KiB to TiB, and KB to TB as "
    "powers of 1000. N takes K, M, G and T as powers of 1000. Both take exponents: 1e6.";

/// Reads a count such as 5000, 20K, 1.5M or 1e6. Suffixes K, M, G and T, in either case, are powers
/// of 1000. The result must be a whole number.
///
/// errors  kBadArgument: not such a number, negative, or above 2^64 - 1
Result<std::uint64_t> parse_count(std::string_view text);

/// Reads a number of bytes such as 4096, 64K, 1.5G or 1e6. Suffixes K, M, G and T are powers of
/// 1024, as are KiB, MiB, GiB and TiB; KB, MB, GB and TB are powers of 1000, all in either case.
/// The result must be a whole number.
///
/// errors  kBadArgument: not such a number, negative, or above 2^64 - 1
Result<std::uint64_t> parse_bytes(std::string_view text);

/// All digits in groups of three: 1,234,567.
std::string grouped_count(std::uint64_t count);

/// Three digits and a decimal prefix, for rates: 950, 3.21 M, 45.6 G.
/// `count` is finite and >= 0.
std::string short_count(double count);

/// Three digits and a binary unit: 512 B, 1.50 GiB.
std::string short_bytes(std::uint64_t bytes);

}  // namespace planetree::tools
