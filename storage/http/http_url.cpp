#include "storage/http/http_url.h"

#include <algorithm>

#include "storage/http/letter_case.h"

namespace planetree::storage {

bool is_http_url(std::string_view path) noexcept {
  const std::string_view scheme = path.substr(0, path.find("//"));
  return scheme.size() < path.size() &&
         (equals_in_any_case(scheme, "http:") || equals_in_any_case(scheme, "https:"));
}

std::string shown_url(std::string_view url) {
  url = url.substr(0, url.find_first_of("?#"));
  const std::size_t scheme = url.find("://");
  if (scheme == std::string_view::npos) return std::string(url);
  const std::size_t host = scheme + 3;
  const std::size_t path = std::min(url.find('/', host), url.size());
  const std::size_t at = url.substr(0, path).rfind('@');
  if (at == std::string_view::npos || at < host) return std::string(url);
  return std::string(url.substr(0, host)).append(url.substr(at + 1));
}

}  // namespace planetree::storage
