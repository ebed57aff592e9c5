// Measures the cost of loading a page: reading and verifying it, and decoding it to its frame.
// usage: page_bench MODEL.ptree [Google Benchmark's flags]

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <span>
#include <vector>

#include <benchmark/benchmark.h>

#include "query/file/page_decoding.h"
#include "storage/file/page_file.h"

namespace planetree::bench {
namespace {

constexpr std::uint32_t kMinPages = 10'000;

struct alignas(octree::kSlotBytes) FrameSlot {
  std::byte bytes[octree::kSlotBytes];
};

// A range of page numbers: the distance pages or the mask pages.
struct Pages {
  std::uint32_t first, count;
};

// Loads the pages of a file one after the other into frames in turn. There are more frames than fit
// the processor's caches, as in a model.
class PageWalk {
 public:
  PageWalk(const storage::PageFile& file, const Pages& pages)
      : file_(file),
        pages_(pages),
        stored_(file.header().max_stored_bytes),
        raw_(file.header().max_raw_bytes),
        slots_(file.header().page_bytes / sizeof(FrameSlot) * kFrames) {}

  void advance() { at_ = (at_ + 1) % (std::size_t{pages_.count} * kFrames); }

  bool read() { return bool(file_.read_page(page(), stored_, {raw_.data(), entry().raw_bytes})); }

  bool decode() {
    const std::size_t bytes = file_.header().page_bytes;
    return bool(query::decode_frame(
        file_.header(), query::page_info(file_.header(), entry(), page()),
        {raw_.data(), entry().raw_bytes},
        std::as_writable_bytes(std::span(slots_)).subspan(at_ % kFrames * bytes, bytes)));
  }

 private:
  static constexpr std::size_t kFrames = 512;

  std::uint32_t page() const {
    return pages_.first + static_cast<std::uint32_t>(at_ % pages_.count);
  }
  storage::PageEntry entry() const { return *file_.entry(page()); }

  const storage::PageFile& file_;
  const Pages pages_;
  std::vector<std::byte> stored_, raw_;
  std::vector<FrameSlot> slots_;
  std::size_t at_ = 0;
};

void read_pages(benchmark::State& state, const storage::PageFile& file, const Pages& pages) {
  PageWalk walk(file, pages);
  for (auto _ : state) {
    if (!walk.read()) return state.SkipWithError("a page cannot be read");
    walk.advance();
  }
}

void load_pages(benchmark::State& state, const storage::PageFile& file, const Pages& pages) {
  PageWalk walk(file, pages);
  for (auto _ : state) {
    if (!walk.read() || !walk.decode()) return state.SkipWithError("a page is damaged");
    walk.advance();
  }
}

int run(int argc, char** argv) {
  const auto file = storage::PageFile::open(argv[1]);
  if (!file) {
    std::fprintf(stderr, "page_bench: %s\n", file.error().text);
    return 1;
  }
  // Reads all pages once, so that the system has them in memory.
  PageWalk all(*file, {0, file->page_count()});
  for (std::uint32_t i = 0; i < file->page_count(); ++i, all.advance()) (void)all.read();
  // Loads all pages equally often, because they differ in size.
  const auto add = [&](const char* name, const Pages& pages, auto measure) {
    if (pages.count == 0) return;
    benchmark::RegisterBenchmark(name, [&file, pages, measure](auto& state) {
      measure(state, *file, pages);
    })->Iterations(pages.count * (1 + kMinPages / pages.count));
  };
  const Pages tree{0, file->header().first_mask_page()};
  const Pages mask{tree.count, file->page_count() - tree.count};
  add("tree: read and verify", tree, read_pages);
  add("tree: read, verify and unpack", tree, load_pages);
  add("mask: read and verify", mask, read_pages);
  add("mask: read, verify and unpack", mask, load_pages);
  int flags = argc - 1;
  benchmark::Initialize(&flags, argv + 1);
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  return 0;
}

}  // namespace
}  // namespace planetree::bench

int main(int argc, char** argv) {
  if (argc < 2) {
    std::fputs("usage: page_bench MODEL.ptree [Google Benchmark's flags]\n", stderr);
    return 2;
  }
  return planetree::bench::run(argc, argv);
}
