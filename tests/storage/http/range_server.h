#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace planetree::storage {

/// An HTTP server of one object, on this machine. It serves ranges as RFC 9110 says, unless a rule
/// changes replies: it may delay, cut, repeat, or lie.
class RangeServer {
 public:
  struct Request {
    unsigned number = 0;  ///< counted from 0
    bool has_range = false;
    std::uint64_t first = 0, last = 0;
    std::string head;  ///< all lines
    bool contains(const char* text) const { return head.find(text) != std::string::npos; }
  };
  /// A reply that is as it should be until the rule changes it.
  struct Reply {
    int status = 206;
    std::vector<std::string> fields;  ///< without line ends
    std::string body;
    std::size_t sent_bytes = std::string::npos;  ///< the connection is closed after so many
    unsigned delay_ms = 0;                       ///< before the head
    bool closes_at_once = false;                 ///< no reply at all

    /// Replaces a field by its name, with ": ".
    void set(const std::string& name, const std::string& value);
    void remove(const std::string& name);
    /// Becomes a reply without an object.
    void fail(int with_status);
  };
  using Rule = std::function<void(const Request&, Reply&)>;

  explicit RangeServer(std::string object);
  ~RangeServer();
  RangeServer(const RangeServer&) = delete;
  RangeServer& operator=(const RangeServer&) = delete;

  /// http://127.0.0.1:PORT/model.ptree
  std::string url() const;
  void set_rule(Rule rule);
  /// Puts another object in place. The entity tag follows from `version`.
  void set_object(std::string object, unsigned version);

  unsigned requests() const { return requests_; }
  std::uint64_t bytes() const { return bytes_; }  ///< of bodies sent
  unsigned most_at_once() const { return most_at_once_; }

 private:
  void accept_all();
  void serve(int connection);
  bool answer(int connection, const std::string& head);
  Reply reply_to(const Request& request);

  int listener_ = -1;
  int port_ = 0;
  std::mutex mutex_;  // guards the members up to `connections_`
  std::string object_;
  unsigned version_ = 1;
  Rule rule_;
  std::vector<std::thread> connections_;
  std::vector<int> open_;
  std::atomic<bool> stopping_{false};
  std::atomic<unsigned> requests_{0};
  std::atomic<std::uint64_t> bytes_{0};
  std::atomic<unsigned> at_once_{0}, most_at_once_{0};
  std::thread acceptor_;
};

/// The bytes of a file.
std::string text_of(const std::string& path);

}  // namespace planetree::storage
