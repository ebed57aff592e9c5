#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "planetree/error.h"
#include "tools/view/view_router.h"
#include "tools/view/view_source.h"

namespace planetree::tools {

/// Where a ViewServer listens.
struct ViewPlace {
  std::vector<std::string> addresses{"127.0.0.1"};  ///< numeric; at most kMaxAddresses
  std::uint16_t port = 0;                           ///< 0: a free one

  static constexpr std::size_t kMaxAddresses = 8;
};

/// A server of HTTP for one page. Each connection is for one request. The number of threads and of
/// connections is bounded, and no client holds a thread for longer than Connection::Limits.
class ViewServer {
 public:
  /// Listens, with a new random token, and serves from now on in threads of its own.
  ///
  /// files, source  must outlive this
  /// errors         kPermission, kBadArgument: the address or port cannot be had
  static Result<std::unique_ptr<ViewServer>> start(const ViewPlace& place,
                                                   std::span<const PageFile> files,
                                                   ViewSource& source);
  /// Ends all connections and stops listening.
  ~ViewServer();
  ViewServer(const ViewServer&) = delete;
  ViewServer& operator=(const ViewServer&) = delete;

  std::uint16_t port() const { return port_; }
  /// The addresses of the page, one for each address of the place.
  std::vector<std::string> pages() const;

 private:
  class Listener;
  ViewServer() = default;
  Result<void> listen(const ViewPlace& place);

  std::vector<std::string> addresses_;
  std::uint16_t port_ = 0;
  std::string token_;
  std::unique_ptr<ViewRouter> router_;
  std::vector<std::unique_ptr<Listener>> listeners_;
};

}  // namespace planetree::tools
