#include "storage/http/http_url.h"

#include <algorithm>

namespace planetree::storage {
namespace {

// Whether a text starts with `prefix`, which is in small letters, in any case.
bool starts_with_any_case(std::string_view text, std::string_view prefix) noexcept {
  return text.size() >= prefix.size() &&
         std::equal(prefix.begin(), prefix.end(), text.begin(), [](char wanted, char given) {
           return wanted ==
                  (given >= 'A' && given <= 'Z' ? static_cast<char>(given | 0x20) : given);
         });
}

}  // namespace

bool is_http_url(std::string_view path) noexcept {
  return starts_with_any_case(path, "http://") || starts_with_any_case(path, "https://");
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
