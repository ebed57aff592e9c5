#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "tools/view/view_request.h"
#include "tools/view/view_source.h"

namespace planetree::tools {

/// A file of the page, which is part of the program.
struct PageFile {
  std::string_view name;   ///< in the address; index.html is the page itself
  std::string_view type;   ///< media type
  std::string_view bytes;  ///< contents
};

/// The answer to a request.
struct ViewReply {
  int status = 404;
  std::string_view type = "text/plain; charset=utf-8";
  std::string body;
};

/// A header that every answer has.
struct ViewHeader {
  const char* name;
  const char* value;
};

/// Decides what a request gets: one of the page's own files, data of the source, or a refusal. It
/// opens no file and keeps no state, so that no request changes what a later one gets. A request is
/// refused, in this order, with
///
///     403  if its Host names another machine, or its Origin is not the page
///     405  if its method is not GET
///     414  if its target is longer than kMaxTargetBytes
///     404  if the first part of its path is not the token, or nothing has the rest of its path
///     400  if its query is not what the path takes
///
/// threads  any, several at a time
class ViewRouter {
 public:
  static constexpr std::size_t kMaxTargetBytes = 1024;
  static constexpr std::size_t kTokenBytes = 32;

  /// token      kTokenBytes hexadecimal digits
  /// addresses  numeric addresses that the server listens at, such as 127.0.0.1 or ::1
  /// files      must outlive this, as `source` must
  ViewRouter(std::string token, const std::vector<std::string>& addresses, std::uint16_t port,
             std::span<const PageFile> files, ViewSource& source);

  /// The answer to a request.
  ViewReply respond(const ViewRequest& request) const;

  /// Headers of every answer: they forbid the page to load or send anything elsewhere, and others
  /// to keep or embed it.
  static std::span<const ViewHeader> headers();

 private:
  bool is_own_host(std::string_view host) const;
  bool is_own_origin(std::string_view origin) const;
  bool is_own_token(std::string_view text) const;
  ViewReply find(std::string_view name, std::string_view query, bool has_query) const;
  ViewReply data(std::string_view name, bool& is_found) const;

  const std::string token_;
  const std::string port_suffix_;   // such as ":8080"
  std::vector<std::string> hosts_;  // values of Host that name this server
  bool is_any_address_ = false;     // the server listens at all addresses of the machine
  const std::span<const PageFile> files_;
  ViewSource& source_;
};

}  // namespace planetree::tools
