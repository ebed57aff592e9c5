#include "tools/view/view_router.h"

#include <openssl/crypto.h>

#include <algorithm>
#include <utility>

#include "tools/view/numeric_address.h"

namespace planetree::tools {
namespace {

constexpr std::string_view kJson = "application/json", kBytes = "application/octet-stream";

ViewReply refusal(int status, std::string_view cause) {
  return {status, {"text/plain; charset=utf-8"}, std::string(cause) + "\n"};
}

std::string lower(std::string_view text) {
  std::string copy(text);
  for (char& byte : copy)
    if (byte >= 'A' && byte <= 'Z') byte = static_cast<char>(byte - 'A' + 'a');
  return copy;
}

constexpr ViewHeader kHeaders[] = {
    {"Content-Security-Policy",
     "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self'; connect-src 'self'; "
     "base-uri 'none'; form-action 'none'; frame-ancestors 'none'"},
    {"X-Content-Type-Options", "nosniff"},
    {"X-Frame-Options", "DENY"},
    {"Cross-Origin-Resource-Policy", "same-origin"},
    {"Cross-Origin-Opener-Policy", "same-origin"},
    {"Referrer-Policy", "no-referrer"},
    {"Cache-Control", "no-store"},
};

}  // namespace

ViewRouter::ViewRouter(std::string token, const std::vector<std::string>& addresses,
                       std::uint16_t port, std::span<const PageFile> files, ViewSource& source)
    : token_(std::move(token)),
      port_suffix_(":" + std::to_string(port)),
      files_(files),
      source_(source) {
  for (const std::string& address : addresses) {
    hosts_.push_back(lower(host_of_address(address)) + port_suffix_);
    is_any_address_ = is_any_address_ || is_unspecified_address(address);
    if (is_loopback_address(address)) hosts_.push_back("localhost" + port_suffix_);
  }
}

std::span<const ViewHeader> ViewRouter::headers() { return kHeaders; }

bool ViewRouter::is_own_host(std::string_view host) const {
  const std::string name = lower(host);
  if (std::find(hosts_.begin(), hosts_.end(), name) != hosts_.end()) return true;
  // A page of another site reaches this server under its own name only, never under a number.
  return is_any_address_ && name.ends_with(port_suffix_) &&
         is_numeric_host(std::string_view(name).substr(0, name.size() - port_suffix_.size()));
}

bool ViewRouter::is_own_origin(std::string_view origin) const {
  constexpr std::string_view kScheme = "http://";
  return origin.starts_with(kScheme) && is_own_host(origin.substr(kScheme.size()));
}

bool ViewRouter::is_own_token(std::string_view text) const {
  return text.size() == token_.size() &&
         CRYPTO_memcmp(text.data(), token_.data(), token_.size()) == 0;
}

ViewReply ViewRouter::respond(const ViewRequest& request) const {
  if (request.hosts.size() != 1 || !is_own_host(request.hosts[0]))
    return refusal(403, "this address is not served");
  for (const std::string_view origin : request.origins)
    if (!is_own_origin(origin)) return refusal(403, "other pages are not served");
  if (request.method != "GET") return refusal(405, "only GET is served");
  if (request.target.size() > kMaxTargetBytes) return refusal(414, "the address is too long");
  const std::string_view target = request.target;
  const std::size_t mark = target.find('?');
  const std::string_view path = target.substr(0, mark);
  const std::size_t slash = path.find('/', 1);
  if (!path.starts_with('/') || slash == std::string_view::npos ||
      !is_own_token(path.substr(1, slash - 1)))
    return refusal(404, "nothing is here");
  const bool has_query = mark != std::string_view::npos;
  return find(path.substr(slash + 1), has_query ? target.substr(mark + 1) : std::string_view(),
              has_query);
}

ViewReply ViewRouter::find(std::string_view name, std::string_view query, bool has_query) const {
  constexpr std::string_view kBadQuery = "the address has a bad query";
  if (name == "shape") {
    const auto view = parse_shape_view(query);
    if (!view) return refusal(400, kBadQuery);
    auto shape = source_.shape(*view);
    if (!shape) return refusal(500, shape.error().text);
    return {200, kBytes, *std::move(shape)};
  }
  if (name == "query") {
    const auto question = parse_point_question(query);
    if (!question) return refusal(400, kBadQuery);
    return {200, kJson, source_.answer(*question)};
  }
  const std::string_view wanted = name.empty() ? "index.html" : name;
  const auto file = std::find_if(files_.begin(), files_.end(),
                                 [wanted](const PageFile& one) { return one.name == wanted; });
  bool is_found = file != files_.end();
  if (is_found && !has_query) return {200, file->type, std::string(file->bytes)};
  if (has_query) return refusal(is_found ? 400 : 404, is_found ? kBadQuery : "nothing is here");
  ViewReply reply = data(name, is_found);
  return is_found ? reply : refusal(404, "nothing is here");
}

ViewReply ViewRouter::data(std::string_view name, bool& is_found) const {
  is_found = true;
  if (name == "info") return {200, kJson, source_.info()};
  if (name == "stats") return {200, kJson, source_.stats()};
  if (name == "pages") return {200, kBytes, source_.pages()};
  if (name == "timeline") return {200, kJson, source_.timeline()};
  is_found = false;
  return {};
}

}  // namespace planetree::tools
