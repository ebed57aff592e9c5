#include "tests/cache/policy/policy_oracle.h"

#include <algorithm>
#include <deque>
#include <list>
#include <map>
#include <utility>

namespace planetree::cache {
namespace {

/// A resident page. What `uses` means depends on the policy.
struct Resident {
  std::uint32_t page;
  int uses = 0;
  bool is_upper = false;
};
using Queue = std::list<Resident>;  // oldest first

Queue::iterator find(Queue& queue, std::uint32_t page) {
  return std::find_if(queue.begin(), queue.end(),
                      [page](const Resident& resident) { return resident.page == page; });
}

std::uint32_t take_oldest(Queue& queue) {
  const std::uint32_t page = queue.front().page;
  queue.pop_front();
  return page;
}

/// Pages evicted last. A page that is taken leaves a gap.
class Ghosts {
 public:
  explicit Ghosts(std::size_t capacity) : capacity_(capacity) {}
  void add(std::uint32_t page) {
    pages_.push_back(page);
    if (pages_.size() > capacity_) pages_.pop_front();
  }
  bool take(std::uint32_t page) {
    const auto found = std::find(pages_.begin(), pages_.end(), std::int64_t{page});
    if (found == pages_.end()) return false;
    *found = -1;
    return true;
  }

 private:
  std::size_t capacity_;
  std::deque<std::int64_t> pages_;
};

/// Which frame each page is in. A page gets the frame of the page evicted last.
class FrameNumbers {
 public:
  std::uint32_t of(std::uint32_t page) const { return frames_.at(page); }
  void assign(std::uint32_t page) { frames_[page] = has_freed_ ? freed_ : next_++; }
  void free(std::uint32_t page) {
    freed_ = frames_.at(page);
    has_freed_ = true;
    frames_.erase(page);
  }

 private:
  std::map<std::uint32_t, std::uint32_t> frames_;
  bool has_freed_ = false;
  std::uint32_t freed_ = 0, next_ = 0;
};

/// Evicts the least recently used page: that of the least `uses`. Uses between two installs are
/// equally old; of these the lowest frame is evicted first.
std::uint32_t evict_least_recent(Queue& queue, const FrameNumbers& frames) {
  const auto oldest = std::min_element(queue.begin(), queue.end(),
                                       [&frames](const Resident& one, const Resident& other) {
                                         return std::pair(one.uses, frames.of(one.page)) <
                                                std::pair(other.uses, frames.of(other.page));
                                       });
  const std::uint32_t page = oldest->page;
  queue.erase(oldest);
  return page;
}

// The clock as a list: the hand is at the front, and a frame that it passes goes to the back.
class ClockOracle final : public PolicyOracle {
 public:
  explicit ClockOracle(std::size_t frames) : frames_(frames) {}
  void use(std::uint32_t page) override {
    int& uses = find(clock_, page)->uses;
    if (uses <= 8) uses += 4;
  }
  std::uint32_t evict() override {
    const auto upper = std::count_if(clock_.begin(), clock_.end(),
                                     [](const Resident& resident) { return resident.is_upper; });
    const bool favours_upper = static_cast<std::size_t>(upper) <= frames_ / 2;
    for (; clock_.front().uses > 0; clock_.splice(clock_.end(), clock_, clock_.begin())) {
      Resident& at_hand = clock_.front();
      at_hand.uses = std::max(0, at_hand.uses - (at_hand.is_upper && favours_upper ? 1 : 4));
    }
    return take_oldest(clock_);
  }
  void install(std::uint32_t page, PageTier tier) override {
    clock_.push_back({page, 8, tier == PageTier::kUpper});
  }

 private:
  std::size_t frames_;
  Queue clock_;
};

class LruOracle final : public PolicyOracle {
 public:
  void use(std::uint32_t page) override { find(pages_, page)->uses = time_; }
  std::uint32_t evict() override {
    const std::uint32_t page = evict_least_recent(pages_, frames_);
    frames_.free(page);
    return page;
  }
  void install(std::uint32_t page, PageTier) override {
    frames_.assign(page);
    pages_.push_back({page, ++time_});
  }

 private:
  Queue pages_;
  FrameNumbers frames_;
  int time_ = 0;
};

class SieveOracle final : public PolicyOracle {
 public:
  void use(std::uint32_t page) override { find(queue_, page)->uses = 1; }
  std::uint32_t evict() override {
    auto at = hand_ == queue_.end() ? queue_.begin() : hand_;
    while (at->uses > 0) {
      at->uses = 0;
      if (++at == queue_.end()) at = queue_.begin();
    }
    const std::uint32_t page = at->page;
    hand_ = queue_.erase(at);
    hand_is_past_ = hand_ == queue_.end();
    return page;
  }
  void install(std::uint32_t page, PageTier) override {
    queue_.push_back({page});
    if (hand_is_past_) hand_ = queue_.end();
  }

 private:
  Queue queue_;
  Queue::iterator hand_ = queue_.end();
  bool hand_is_past_ = true;
};

class S3FifoOracle final : public PolicyOracle {
 public:
  explicit S3FifoOracle(std::size_t frames)
      : small_capacity_(std::max<std::size_t>(frames / 10, 1)),
        main_capacity_(frames - small_capacity_),
        ghosts_(main_capacity_) {}
  void use(std::uint32_t page) override {
    auto at = find(small_, page);
    if (at == small_.end()) at = find(main_, page);
    at->uses = std::min(3, at->uses + 1);
  }
  std::uint32_t evict() override {
    if (small_.size() < small_capacity_ && !main_.empty()) return evict_main();
    while (!small_.empty()) {
      if (small_.front().uses <= 1) {
        ghosts_.add(small_.front().page);
        return take_oldest(small_);
      }
      small_.front().uses = 0;
      main_.splice(main_.end(), small_, small_.begin());
      if (main_.size() > main_capacity_) break;
    }
    return evict_main();
  }
  void install(std::uint32_t page, PageTier) override {
    (ghosts_.take(page) ? main_ : small_).push_back({page});
  }

 private:
  std::uint32_t evict_main() {
    for (; main_.front().uses > 0; main_.splice(main_.end(), main_, main_.begin()))
      --main_.front().uses;
    return take_oldest(main_);
  }

  std::size_t small_capacity_, main_capacity_;
  Ghosts ghosts_;
  Queue small_, main_;
};

class TwoQOracle final : public PolicyOracle {
 public:
  explicit TwoQOracle(std::size_t frames)
      : in_capacity_(std::max<std::size_t>(frames / 4, 1)),
        out_(std::max<std::size_t>(frames / 2, 1)) {}
  void use(std::uint32_t page) override {
    if (find(in_, page) == in_.end()) find(main_, page)->uses = time_;
  }
  std::uint32_t evict() override {
    const bool from_in = in_.size() > in_capacity_ || main_.empty();
    const std::uint32_t page = from_in ? take_oldest(in_) : evict_least_recent(main_, frames_);
    if (from_in) out_.add(page);
    frames_.free(page);
    return page;
  }
  void install(std::uint32_t page, PageTier) override {
    frames_.assign(page);
    (out_.take(page) ? main_ : in_).push_back({page, ++time_});
  }

 private:
  std::size_t in_capacity_;
  Ghosts out_;
  Queue in_, main_;
  FrameNumbers frames_;
  int time_ = 0;
};

}  // namespace

std::unique_ptr<PolicyOracle> make_policy_oracle(EvictionPolicy policy, std::uint32_t frame_count) {
  switch (policy) {
    case EvictionPolicy::kClock:
      return std::make_unique<ClockOracle>(frame_count);
    case EvictionPolicy::kLru:
      return std::make_unique<LruOracle>();
    case EvictionPolicy::kSieve:
      return std::make_unique<SieveOracle>();
    case EvictionPolicy::kS3Fifo:
      return std::make_unique<S3FifoOracle>(frame_count);
    case EvictionPolicy::kTwoQ:
      return std::make_unique<TwoQOracle>(frame_count);
  }
  return nullptr;
}

}  // namespace planetree::cache
