#pragma once

#include <httplib.h>

#include <chrono>
#include <cstddef>
#include <functional>

namespace planetree::tools {

/// The socket of a client, for one request and its answer. A client may send or take bytes as
/// slowly as it likes, or not at all: reading ends after a time and a number of bytes, writing when
/// nothing is taken for a while or the whole takes too long.
///
/// threads  one at a time
class Connection final : public httplib::Stream {
 public:
  struct Limits {
    std::chrono::milliseconds request{3000};  ///< until the request is complete
    std::chrono::milliseconds silent{100};    ///< until its first byte, while others wait
    std::chrono::milliseconds hurried{400};   ///< until it is complete, while others wait
    std::chrono::milliseconds stalled{3000};  ///< while nothing of the answer is taken
    std::chrono::milliseconds answer{60000};  ///< until all of it is taken
    std::size_t request_bytes = 32768;        ///< of the request
  };

  /// socket      of the client; not closed
  /// is_hurried  whether other clients wait for this thread
  /// is_ending   whether the server ends
  Connection(socket_t socket, std::function<bool()> is_hurried, std::function<bool()> is_ending,
             const Limits& limits);

  /// Whether a byte of a request comes in time.
  bool is_readable() const override;
  bool is_writable() const override;
  ssize_t read(char* bytes, std::size_t size) override;
  ssize_t write(const char* bytes, std::size_t size) override;
  void get_remote_ip_and_port(std::string& ip, int& port) const override;
  void get_local_ip_and_port(std::string& ip, int& port) const override;
  socket_t socket() const override { return socket_; }

 private:
  using Clock = std::chrono::steady_clock;
  bool wait_to_read() const;
  bool wait_to_write() const;

  const socket_t socket_;
  const std::function<bool()> is_hurried_, is_ending_;
  const Limits limits_;
  const Clock::time_point begin_ = Clock::now();
  Clock::time_point answer_begin_{};  // of the first write
  std::size_t read_bytes_ = 0;
};

}  // namespace planetree::tools
