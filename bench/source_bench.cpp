// Compares two sources of a page's bytes: a positioned read, which the library uses, and a copy
// from a map of the file. Measures the time of a page from memory and from the disk, and meanwhile
// the time that another thread takes to read memory, because fetch threads must not slow that down.

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <cstring>
#include <iostream>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include "storage/file/page_file.h"

namespace planetree::bench {
namespace {

using Clock = std::chrono::steady_clock;
using storage::PageEntry;

struct Arguments {
  std::string model;
  double seconds = 2;
};

double us_since(Clock::time_point start) {
  return std::chrono::duration<double, std::micro>(Clock::now() - start).count();
}

/// Reads the stored bytes of pages in one of several ways. kMappedAndDropped unmaps each page after
/// use, as a process that must keep within its memory has to.
class Source {
 public:
  /// kMapped lets the system read ahead around each access; kMappedAtRandom forbids it.
  enum class Way { kPositioned, kMapped, kMappedAtRandom, kMappedAndDropped };
  Source(int descriptor, const storage::PageFile& file, Way way)
      : descriptor_(descriptor), file_(file), way_(way), out_(file.header().max_stored_bytes) {
    if (way == Way::kPositioned) return;
    bytes_ = file.header().file_bytes;
    map_ = static_cast<std::byte*>(::mmap(nullptr, bytes_, PROT_READ, MAP_SHARED, descriptor, 0));
    if (way == Way::kMappedAtRandom) ::madvise(map_, bytes_, MADV_RANDOM);
  }
  ~Source() {
    if (map_) ::munmap(map_, bytes_);
  }
  Source(const Source&) = delete;
  Source& operator=(const Source&) = delete;

  void read(std::uint32_t page) {
    const PageEntry entry = *file_.entry(page);
    if (!map_) {
      if (::pread(descriptor_, out_.data(), entry.stored_bytes, static_cast<off_t>(entry.offset)) <
          0)
        std::abort();
      return;
    }
    std::memcpy(out_.data(), map_ + entry.offset, entry.stored_bytes);
    if (way_ == Way::kMappedAndDropped) drop(entry);
  }

 private:
  void drop(const PageEntry& entry) {
    const std::uint64_t first = entry.offset & ~std::uint64_t{4095};
    ::madvise(map_ + first, entry.offset + entry.stored_bytes - first, MADV_DONTNEED);
  }

  const int descriptor_;
  const storage::PageFile& file_;
  const Way way_;
  std::vector<std::byte> out_;
  std::byte* map_ = nullptr;
  std::size_t bytes_ = 0;
};

std::vector<std::uint32_t> shuffled_pages(const storage::PageFile& file) {
  std::vector<std::uint32_t> pages(file.page_count());
  for (std::uint32_t i = 0; i < pages.size(); ++i) pages[i] = i;
  std::shuffle(pages.begin(), pages.end(), std::mt19937(1));
  return pages;
}

/// Reads every page once. Returns microseconds a page.
double read_all(Source& source, const std::vector<std::uint32_t>& pages) {
  const auto start = Clock::now();
  for (const std::uint32_t page : pages) source.read(page);
  return us_since(start) / static_cast<double>(pages.size());
}

void drop_from_page_cache(int descriptor) {
  ::fdatasync(descriptor);
  ::posix_fadvise(descriptor, 0, 0, POSIX_FADV_DONTNEED);
}

/// Times ticks of 2000 dependent reads of a 64 MiB arena.
class Ticker {
 public:
  Ticker() : arena_(std::size_t{1} << 24) {
    std::mt19937 random(2);
    for (std::uint32_t& next : arena_) next = static_cast<std::uint32_t>(random() % arena_.size());
  }
  struct Ticks {
    double median, p999, max;  // us
    std::size_t count;
  };
  Ticks run(double seconds) {
    std::vector<double> ticks;
    ticks.reserve(1 << 20);
    const auto start = Clock::now();
    while (us_since(start) < seconds * 1e6 && ticks.size() < ticks.capacity()) {
      const auto tick = Clock::now();
      for (int i = 0; i < 2000; ++i)
        at_ = (arena_[at_] + static_cast<std::uint32_t>(i)) % arena_.size();
      ticks.push_back(us_since(tick));
    }
    std::sort(ticks.begin(), ticks.end());
    return {ticks[ticks.size() / 2], ticks[ticks.size() - 1 - ticks.size() / 1000], ticks.back(),
            ticks.size()};
  }

 private:
  std::vector<std::uint32_t> arena_;
  std::size_t at_ = 0;
};

struct Row {
  const char* name;
  Source::Way way;
};
constexpr Row kRows[] = {{"positioned", Source::Way::kPositioned},
                         {"mapped", Source::Way::kMapped},
                         {"mapped at random", Source::Way::kMappedAtRandom},
                         {"mapped, given back", Source::Way::kMappedAndDropped}};

void measure(int descriptor, const storage::PageFile& file, Ticker& ticker, double seconds) {
  const std::vector<std::uint32_t> pages = shuffled_pages(file);
  for (const Row& row : kRows) {
    drop_from_page_cache(descriptor);
    Source source(descriptor, file, row.way);
    const double cold = read_all(source, pages);
    double warm = read_all(source, pages);
    for (int round = 0; round < 4; ++round) warm = std::min(warm, read_all(source, pages));
    std::atomic<bool> stop{false};
    std::thread fetching([&] {
      while (!stop)
        for (const std::uint32_t page : pages) source.read(page);
    });
    const Ticker::Ticks ticks = ticker.run(seconds);
    stop = true;
    fetching.join();
    fmt::print("{:<20}{:>10.1f}{:>10.2f}{:>10.0f}{:>10.0f}{:>10.0f}\n", row.name, cold, warm,
               ticks.median, ticks.p999, ticks.max);
  }
}

int run(const Arguments& arguments) {
  const auto file = storage::PageFile::open(arguments.model);
  const int descriptor = ::open(arguments.model.c_str(), O_RDONLY | O_CLOEXEC);
  if (!file || descriptor < 0) {
    std::cerr << "source_bench: " << (file ? "cannot open the model" : file.error().text) << '\n';
    return 1;
  }
  Ticker ticker;
  fmt::print("{:<20}{:>10}{:>10}{:>10}{:>10}{:>10}\n", "us", "cold page", "warm page", "tick",
             "99.9 %", "longest");
  const Ticker::Ticks alone = ticker.run(arguments.seconds);
  fmt::print("{:<20}{:>10}{:>10}{:>10.0f}{:>10.0f}{:>10.0f}\n", "no other load", "", "",
             alone.median, alone.p999, alone.max);
  for (int round = 0; round < 3; ++round) measure(descriptor, *file, ticker, arguments.seconds);
  ::close(descriptor);
  return 0;
}

}  // namespace
}  // namespace planetree::bench

int main(int argc, char** argv) {
  planetree::bench::Arguments arguments;
  CLI::App app("Compares reading a page by a positioned read and from a map of the file");
  app.add_option("model", arguments.model, "File that planetree build wrote")->required();
  app.add_option("--seconds", arguments.seconds, "Seconds of ticks beside each source")
      ->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  return planetree::bench::run(arguments);
}
