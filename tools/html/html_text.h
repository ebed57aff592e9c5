#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

/// Text in an HTML file, so that no text from outside ends an element, an attribute or a script.
namespace planetree::tools {

/// The text as contents of an element or of an attribute in double quotes. Control characters and
/// bytes that are not UTF-8, as in names of files, become U+FFFD.
[[nodiscard]] std::string html_text(std::string_view text);

/// The value as contents of a script element, in ASCII. Bytes that are not UTF-8 become U+FFFD.
[[nodiscard]] std::string script_json(const nlohmann::ordered_json& value);

/// A number of three digits, independent of locale: 0, 0.0123, 45.6, 7890, 1.23e-5. Exponents have
/// no leading zeros, as people write them.
[[nodiscard]] std::string number_text(double value);
/// A number of two digits with a power of ten, for columns of small numbers: 0, 1.0e-5.
[[nodiscard]] std::string power_text(double value);
/// A number of up to two digits, as short as it can be, for ticks: 0, 1e-3, 0.05, 1.5, 20.
[[nodiscard]] std::string short_text(double value);
/// The same for errors, where all numbers below 1 have powers of ten: 1e-3, 5e-2, 1.5, 20.
[[nodiscard]] std::string short_power_text(double value);

}  // namespace planetree::tools
