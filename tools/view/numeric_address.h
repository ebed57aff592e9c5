#pragma once

#include <string>
#include <string_view>

namespace planetree::tools {

/// Whether a text is an IPv4 or IPv6 address in numbers, without port or brackets.
bool is_numeric_address(std::string_view text);
/// Whether a text is such an address as addresses of pages have it: IPv6 in brackets.
bool is_numeric_host(std::string_view text);
/// Whether a numeric address reaches this machine alone.
bool is_loopback_address(std::string_view text);
/// Whether a numeric address stands for all addresses of the machine: 0.0.0.0 or ::.
bool is_unspecified_address(std::string_view text);
/// The form that a numeric address has in the address of a page: IPv6 in brackets.
std::string host_of_address(std::string_view text);

}  // namespace planetree::tools
