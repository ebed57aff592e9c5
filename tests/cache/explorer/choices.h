#pragma once

#include <cstdint>
#include <vector>

namespace planetree::explorer {

/// Decides how a run continues wherever it can continue in several ways.
class Choices {
 public:
  virtual ~Choices() = default;

  /// Returns one of 0 ... count - 1.
  std::uint32_t choose(std::uint32_t count) { return count == 1 ? 0 : decide(count); }

  /// Prepares for the next run; false if there is none left.
  virtual bool next_run() = 0;

 private:
  virtual std::uint32_t decide(std::uint32_t count) = 0;
};

/// Enumerates every run once, depth first. Each run repeats the previous one up to the last choice
/// that has an alternative left.
class EveryChoice final : public Choices {
 public:
  bool next_run() override;

 private:
  std::uint32_t decide(std::uint32_t count) override;

  struct Fork {
    std::uint32_t chosen;
    std::uint32_t count;
  };
  std::vector<Fork> path_;
  std::size_t depth_ = 0;
};

/// Makes a fixed number of runs with every alternative equally likely; the same on every machine.
class RandomChoice final : public Choices {
 public:
  RandomChoice(std::uint64_t runs, std::uint64_t seed) noexcept : runs_left_(runs), state_(seed) {}

  bool next_run() override;

 private:
  std::uint32_t decide(std::uint32_t count) override;

  std::uint64_t runs_left_;
  std::uint64_t state_;
};

}  // namespace planetree::explorer
