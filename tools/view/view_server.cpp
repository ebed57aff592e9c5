#include "tools/view/view_server.h"

#include <httplib.h>
#include <openssl/rand.h>
#include <sys/socket.h>
#include <unistd.h>

#include <atomic>
#include <cstddef>
#include <exception>
#include <optional>
#include <thread>
#include <utility>

#include "tools/view/connection.h"
#include "tools/view/numeric_address.h"
#include "tools/view/serving_threads.h"

namespace planetree::tools {
namespace {

/// Random hexadecimal digits. Empty if the system has no random numbers.
std::string new_token() {
  unsigned char bytes[ViewRouter::kTokenBytes / 2];
  if (RAND_bytes(bytes, sizeof bytes) != 1) return {};
  std::string token;
  for (const unsigned char byte : bytes)
    for (const unsigned digit : {byte / 16U, byte % 16U}) token += "0123456789abcdef"[digit];
  return token;
}

std::vector<std::string_view> values_of(const httplib::Request& request, const char* name) {
  std::vector<std::string_view> values;
  const auto [first, last] = request.headers.equal_range(name);
  for (auto header = first; header != last; ++header) values.push_back(header->second);
  return values;
}

void answer(const ViewRouter& router, const httplib::Request& request,
            httplib::Response& response) {
  const ViewReply reply = router.respond(
      {request.method, request.target, values_of(request, "Host"), values_of(request, "Origin")});
  response.status = reply.status;
  response.body = reply.body;
  response.set_header("Content-Type", std::string(reply.type));
  if (reply.status == 405) response.set_header("Allow", "GET");
}

/// Closes the socket of a client. What it sent beyond the request is read first, a little of it, as
/// the system would take the answer back otherwise.
void close_after_answer(socket_t socket) {
  ::shutdown(socket, SHUT_WR);
  char bytes[4096];
  for (int i = 0; i < 16 && ::recv(socket, bytes, sizeof bytes, MSG_DONTWAIT) > 0;) ++i;
  ::close(socket);
}

}  // namespace

/// A listening socket, and the threads that serve its clients.
class ViewServer::Listener final : public httplib::Server {
 public:
  Listener() {
    new_task_queue = [this] { return new ServingThreads(waiting_); };
    // Two sessions must not share a port.
    set_socket_options([](socket_t socket) {
      const int yes = 1;
      ::setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
    });
    httplib::Headers headers;
    for (const ViewHeader& header : ViewRouter::headers())
      headers.emplace(header.name, header.value);
    set_default_headers(std::move(headers));
    set_pre_routing_handler([this](const httplib::Request& request, httplib::Response& response) {
      answer(*router_, request, response);
      return HandlerResponse::Handled;
    });
  }
  ~Listener() override {
    is_ending_ = true;
    if (thread_.joinable()) {
      stop();
      thread_.join();
    } else if (svr_sock_ != INVALID_SOCKET) {
      ::close(svr_sock_);
    }
  }
  /// Returns the port, or nothing if it cannot be had.
  std::optional<std::uint16_t> bind(const std::string& address, std::uint16_t port) {
    const int bound = port == 0                     ? bind_to_any_port(address)
                      : bind_to_port(address, port) ? int{port}
                                                    : -1;
    if (bound <= 0) return std::nullopt;
    return static_cast<std::uint16_t>(bound);
  }
  /// Serves from now on. The router must outlive this.
  void serve(const ViewRouter& router) {
    router_ = &router;
    thread_ = std::thread([this] { listen_after_bind(); });
    while (!is_running()) std::this_thread::yield();  // stop() has no effect before
  }

 private:
  bool process_and_close_socket(socket_t socket) override {
    Connection connection(
        socket, [this] { return waiting_ > 0; }, [this] { return is_ending_.load(); }, {});
    bool is_closed = false;
    bool is_done = false;
    try {
      is_done = connection.is_readable() &&
                process_request(connection, true, is_closed, [](httplib::Request& request) {
                  // Ranges that overlap could make an answer much larger than what it is of, and
                  // packing takes longer than the way to a browser on this machine.
                  request.ranges.clear();
                  request.headers.erase("Accept-Encoding");
                  request.headers.erase("Expect");
                });
    } catch (const std::exception&) {
      is_done = false;  // no memory for this request
    }
    close_after_answer(socket);
    return is_done;
  }

  const ViewRouter* router_ = nullptr;
  std::atomic<std::size_t> waiting_ = 0;
  std::atomic<bool> is_ending_ = false;
  std::thread thread_;
};

ViewServer::~ViewServer() = default;

Result<void> ViewServer::listen(const ViewPlace& place) {
  port_ = place.port;
  for (const std::string& address : place.addresses) {
    auto listener = std::make_unique<Listener>();
    const auto port = listener->bind(address, port_);
    if (!port)
      return make_error(ErrorCode::kPermission, Error::kNowhere, Error::kNowhere,
                        "cannot listen at %s, port %u: it is in use, refused, or not of this "
                        "machine; give another --port or --listen",
                        address.c_str(), port_);
    port_ = *port;
    addresses_.push_back(address);
    listeners_.push_back(std::move(listener));
  }
  return {};
}

Result<std::unique_ptr<ViewServer>> ViewServer::start(const ViewPlace& place,
                                                      std::span<const PageFile> files,
                                                      ViewSource& source) {
  std::unique_ptr<ViewServer> server(new ViewServer);
  server->token_ = new_token();
  if (server->token_.empty())
    return make_error(ErrorCode::kPermission, Error::kNowhere, Error::kNowhere,
                      "the system gives no random numbers; see getrandom(2)");
  if (const auto listens = server->listen(place); !listens) return listens.error();
  server->router_ = std::make_unique<ViewRouter>(server->token_, server->addresses_, server->port_,
                                                 files, source);
  for (const auto& listener : server->listeners_) listener->serve(*server->router_);
  return server;
}

std::vector<std::string> ViewServer::pages() const {
  std::vector<std::string> pages;
  for (const std::string& address : addresses_)
    pages.push_back("http://" + host_of_address(address) + ":" + std::to_string(port_) + "/" +
                    token_ + "/");
  return pages;
}

}  // namespace planetree::tools
