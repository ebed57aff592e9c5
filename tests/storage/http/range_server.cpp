#include "tests/storage/http/range_server.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <utility>

namespace planetree::storage {
namespace {

// Returns the value of a field of a head, in small letters.
std::string field_of(const std::string& head, const std::string& name) {
  std::string lower = head;
  std::transform(lower.begin(), lower.end(), lower.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  const std::size_t at = lower.find("\r\n" + name + ": ");
  if (at == std::string::npos) return {};
  const std::size_t first = at + name.size() + 4;
  return head.substr(first, head.find("\r\n", first) - first);
}

bool send_all(int connection, const std::string& bytes) {
  for (std::size_t sent = 0; sent < bytes.size();) {
    const ssize_t count =
        ::send(connection, bytes.data() + sent, bytes.size() - sent, MSG_NOSIGNAL);
    if (count <= 0) return false;
    sent += static_cast<std::size_t>(count);
  }
  return true;
}

}  // namespace

void RangeServer::Reply::remove(const std::string& name) {
  std::erase_if(fields, [&](const std::string& field) { return field.starts_with(name + ": "); });
}

void RangeServer::Reply::set(const std::string& name, const std::string& value) {
  remove(name);
  fields.push_back(name + ": " + value);
}

void RangeServer::Reply::fail(int with_status) {
  status = with_status;
  remove("Content-Range");
  body = "no\n";
}

RangeServer::RangeServer(std::string object) : object_(std::move(object)) {
  listener_ = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t length = sizeof address;
  auto* const name = reinterpret_cast<sockaddr*>(&address);
  constexpr int kWaiting = 64;
  if (listener_ < 0 || ::bind(listener_, name, length) != 0 || ::listen(listener_, kWaiting) != 0 ||
      ::getsockname(listener_, name, &length) != 0)
    std::abort();
  port_ = ntohs(address.sin_port);
  acceptor_ = std::thread([this] { accept_all(); });
}

RangeServer::~RangeServer() {
  stopping_ = true;
  ::shutdown(listener_, SHUT_RDWR);
  acceptor_.join();
  ::close(listener_);
  {
    const std::lock_guard lock(mutex_);
    for (const int connection : open_) ::shutdown(connection, SHUT_RDWR);
  }
  for (std::thread& thread : connections_) thread.join();
}

std::string RangeServer::url() const {
  return "http://127.0.0.1:" + std::to_string(port_) + "/model.ptree";
}

void RangeServer::set_rule(Rule rule) {
  const std::lock_guard lock(mutex_);
  rule_ = std::move(rule);
}

void RangeServer::set_object(std::string object, unsigned version) {
  const std::lock_guard lock(mutex_);
  object_ = std::move(object);
  version_ = version;
}

void RangeServer::accept_all() {
  while (!stopping_) {
    const int connection = ::accept4(listener_, nullptr, nullptr, SOCK_CLOEXEC);
    if (connection < 0) return;
    const int on = 1;
    ::setsockopt(connection, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
    const std::lock_guard lock(mutex_);
    open_.push_back(connection);
    connections_.emplace_back([this, connection] { serve(connection); });
  }
}

void RangeServer::serve(int connection) {
  std::string pending;
  char bytes[4096];
  bool goes_on = true;
  while (goes_on && !stopping_) {
    const std::size_t end = pending.find("\r\n\r\n");
    if (end != std::string::npos) {
      goes_on = answer(connection, pending.substr(0, end + 2));
      pending.erase(0, end + 4);
      continue;
    }
    const ssize_t count = ::recv(connection, bytes, sizeof bytes, 0);
    if (count <= 0) break;
    pending.append(bytes, static_cast<std::size_t>(count));
  }
  const std::lock_guard lock(mutex_);
  std::erase(open_, connection);
  ::close(connection);
}

// Returns whether the connection can be used again.
bool RangeServer::answer(int connection, const std::string& head) {
  Request request;
  request.head = head;
  request.number = requests_++;
  const std::string range = field_of(head, "range");
  request.has_range = range.starts_with("bytes=");
  if (request.has_range) {
    request.first = std::strtoull(range.c_str() + 6, nullptr, 10);
    request.last = std::strtoull(range.c_str() + range.find('-') + 1, nullptr, 10);
  }
  const unsigned at_once = ++at_once_;
  unsigned most = most_at_once_;
  while (most < at_once && !most_at_once_.compare_exchange_weak(most, at_once)) {
  }
  const Reply reply = reply_to(request);
  std::this_thread::sleep_for(std::chrono::milliseconds(reply.delay_ms));
  --at_once_;
  if (reply.closes_at_once) return false;
  std::string text = "HTTP/1.1 " + std::to_string(reply.status) + " Status\r\n";
  for (const std::string& field : reply.fields) text += field + "\r\n";
  text += "Content-Length: " + std::to_string(reply.body.size()) + "\r\n\r\n";
  const std::string body = reply.body.substr(0, reply.sent_bytes);
  bytes_ += body.size();
  return send_all(connection, text + body) && body.size() == reply.body.size();
}

RangeServer::Reply RangeServer::reply_to(const Request& request) {
  Rule rule;
  Reply reply;
  {
    const std::lock_guard lock(mutex_);
    rule = rule_;
    const std::string etag = "\"v" + std::to_string(version_) + "\"";
    const std::string size = std::to_string(object_.size());
    reply.set("ETag", etag);
    const std::string match = field_of(request.head, "if-match");
    if (!match.empty() && match != etag) {
      reply.fail(412);
    } else if (!request.has_range) {
      reply.status = 200;
      reply.body = object_;
    } else if (request.first >= object_.size()) {
      reply.fail(416);
      reply.set("Content-Range", "bytes */" + size);
    } else {
      const std::uint64_t last = std::min<std::uint64_t>(request.last, object_.size() - 1);
      reply.body = object_.substr(request.first, last - request.first + 1);
      reply.set("Content-Range",
                "bytes " + std::to_string(request.first) + "-" + std::to_string(last) + "/" + size);
    }
  }
  if (rule) rule(request, reply);
  return reply;
}

std::string text_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

}  // namespace planetree::storage
