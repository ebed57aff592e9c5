#include "tools/view/connection.h"

#include <poll.h>
#include <sys/socket.h>

#include <algorithm>
#include <cerrno>
#include <utility>

namespace planetree::tools {
namespace {

/// How long one wait lasts. Between waits the limits are looked at.
constexpr int kSliceMs = 20;

/// Waits for an event of a socket. Returns whether it came.
bool wait_for(socket_t socket, short event) {
  pollfd waited{socket, event, 0};
  return ::poll(&waited, 1, kSliceMs) > 0;
}

bool would_block(int error) { return error == EAGAIN || error == EWOULDBLOCK || error == EINTR; }

}  // namespace

Connection::Connection(socket_t socket, std::function<bool()> is_hurried,
                       std::function<bool()> is_ending, const Limits& limits)
    : socket_(socket),
      is_hurried_(std::move(is_hurried)),
      is_ending_(std::move(is_ending)),
      limits_(limits) {}

bool Connection::wait_to_read() const {
  while (!wait_for(socket_, POLLIN)) {
    const auto waited = Clock::now() - begin_;
    if (is_ending_() || waited > limits_.request) return false;
    const auto most = read_bytes_ == 0 ? limits_.silent : limits_.hurried;
    if (waited > most && is_hurried_()) return false;
  }
  return Clock::now() - begin_ <= limits_.request;
}

bool Connection::wait_to_write() const {
  const Clock::time_point begin = Clock::now();
  while (!wait_for(socket_, POLLOUT)) {
    const Clock::time_point now = Clock::now();
    if (is_ending_() || now - begin > limits_.stalled || now - answer_begin_ > limits_.answer)
      return false;
  }
  return Clock::now() - answer_begin_ <= limits_.answer;
}

bool Connection::is_readable() const { return wait_to_read(); }

bool Connection::is_writable() const { return !is_ending_(); }

ssize_t Connection::read(char* bytes, std::size_t size) {
  const std::size_t most = std::min(size, limits_.request_bytes - read_bytes_);
  if (most == 0) return -1;
  ssize_t count = 0;
  do {
    if (!wait_to_read()) return -1;
    count = ::recv(socket_, bytes, most, MSG_DONTWAIT);
  } while (count < 0 && would_block(errno));
  if (count > 0) read_bytes_ += static_cast<std::size_t>(count);
  return count;
}

ssize_t Connection::write(const char* bytes, std::size_t size) {
  if (answer_begin_ == Clock::time_point()) answer_begin_ = Clock::now();
  ssize_t count = 0;
  do {
    if (!wait_to_write()) return -1;
    count = ::send(socket_, bytes, size, MSG_DONTWAIT | MSG_NOSIGNAL);
  } while (count < 0 && would_block(errno));
  return count;
}

// Nothing depends on who asks or where.
void Connection::get_remote_ip_and_port(std::string& ip, int& port) const {
  ip.clear();
  port = 0;
}
void Connection::get_local_ip_and_port(std::string& ip, int& port) const {
  ip.clear();
  port = 0;
}

}  // namespace planetree::tools
