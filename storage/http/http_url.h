#pragma once

#include <string>
#include <string_view>

namespace planetree::storage {

/// Whether a path is a URL of HTTP: it starts with `http://` or `https://`, in any case.
[[nodiscard]] bool is_http_url(std::string_view path) noexcept;

/// Returns a URL for people to read: without the name and the password before the host, and without
/// what follows `?` or `#`, since these may be secret.
[[nodiscard]] std::string shown_url(std::string_view url);

}  // namespace planetree::storage
