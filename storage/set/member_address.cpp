#include "storage/set/member_address.h"

#include "storage/http/http_url.h"
#include "storage/http/letter_case.h"
#include "storage/set/set_description.h"

namespace planetree::storage {
namespace {

std::string_view without_query(std::string_view url) {
  return url.substr(0, url.find_first_of("?#"));
}

// Whether an address leads to the folder of the set, or to one below.
bool stays_below(const std::filesystem::path& address) {
  if (address.has_root_path()) return false;
  for (const std::filesystem::path& part : address)
    if (part == "..") return false;
  return true;
}

// The address as a part of a URL: what has a meaning there is written as %XX.
std::string escaped(std::string_view address) {
  static constexpr char kDigits[] = "0123456789ABCDEF";
  std::string text;
  for (const char c : address) {
    const auto byte = static_cast<unsigned char>(c);
    const bool is_plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') ||
                          (c >= '0' && c <= '9') ||
                          std::string_view("-._~/").find(c) != std::string_view::npos;
    if (is_plain)
      text += c;
    else
      text.append({'%', kDigits[byte >> 4], kDigits[byte & 15]});
  }
  return text;
}

}  // namespace

bool is_set_name(std::string_view path) {
  if (is_http_url(path)) path = without_query(path);
  constexpr std::string_view kExtension = SetDescription::kExtension;
  return path.size() > kExtension.size() &&
         equals_in_any_case(path.substr(path.size() - kExtension.size()), kExtension);
}

Result<std::filesystem::path> member_path(const std::filesystem::path& set,
                                          const std::string& address) {
  if (is_http_url(address)) return std::filesystem::path(address);
  if (!is_http_url(set.native())) return set.parent_path() / address;
  if (!stays_below(address))
    return make_error(ErrorCode::kUnsupported, Error::kNowhere, Error::kNowhere,
                      "the set names a member outside of its folder on the server; name members "
                      "by URLs, or by paths from the set on");
  const std::string_view url = without_query(set.native());
  return std::filesystem::path(std::string(url.substr(0, url.rfind('/') + 1)) + escaped(address));
}

}  // namespace planetree::storage
