#include "tools/view/numeric_address.h"

#include <arpa/inet.h>
#include <netinet/in.h>

#include <cstdint>
#include <optional>

namespace planetree::tools {
namespace {

std::optional<in_addr> ipv4_of(std::string_view text) {
  in_addr address{};
  if (::inet_pton(AF_INET, std::string(text).c_str(), &address) != 1) return std::nullopt;
  return address;
}

std::optional<in6_addr> ipv6_of(std::string_view text) {
  in6_addr address{};
  if (::inet_pton(AF_INET6, std::string(text).c_str(), &address) != 1) return std::nullopt;
  return address;
}

/// Texts with a byte 0 would be cut.
bool is_text(std::string_view text) { return text.find('\0') == std::string_view::npos; }

}  // namespace

bool is_numeric_address(std::string_view text) {
  return is_text(text) && (ipv4_of(text) || ipv6_of(text));
}

bool is_numeric_host(std::string_view text) {
  if (!is_text(text)) return false;
  if (text.starts_with('[') && text.ends_with(']'))
    return ipv6_of(text.substr(1, text.size() - 2)).has_value();
  return ipv4_of(text).has_value();
}

bool is_loopback_address(std::string_view text) {
  if (const auto address = ipv4_of(text)) return ntohl(address->s_addr) >> 24 == 127;
  const auto address = ipv6_of(text);
  return address && IN6_IS_ADDR_LOOPBACK(&*address);
}

bool is_unspecified_address(std::string_view text) {
  if (const auto address = ipv4_of(text)) return address->s_addr == 0;
  const auto address = ipv6_of(text);
  return address && IN6_IS_ADDR_UNSPECIFIED(&*address);
}

std::string host_of_address(std::string_view text) {
  const bool is_ipv6 = text.find(':') != std::string_view::npos;
  return is_ipv6 ? "[" + std::string(text) + "]" : std::string(text);
}

}  // namespace planetree::tools
