// What it costs to bring a page in: read and verified, and unpacked to its frame.
// usage: page_bench MODEL.ptree [Google Benchmark's flags]

#include <cstddef>
#include <cstdio>
#include <vector>

#include <benchmark/benchmark.h>

#include "query/page_decoding.h"
#include "storage/page_file.h"

namespace planetree::bench {
namespace {

struct alignas(octree::kSlotBytes) FrameSlot {
  std::byte bytes[octree::kSlotBytes];
};

// The pages of a file one after the other, and room for one.
class PageWalk {
 public:
  explicit PageWalk(const storage::PageFile& file)
      : file_(file),
        stored_(file.header().max_stored_bytes),
        raw_(file.header().max_raw_bytes),
        frame_(file.header().page_bytes / sizeof(FrameSlot)) {}

  void advance() { page_ = (page_ + 1) % file_.page_count(); }

  bool read() { return bool(file_.read_page(page_, stored_, {raw_.data(), entry().raw_bytes})); }

  bool decode() {
    return bool(query::decode_frame(file_.header(), entry(), page_,
                                    {raw_.data(), entry().raw_bytes},
                                    std::as_writable_bytes(std::span(frame_))));
  }

 private:
  const storage::PageEntry& entry() const { return file_.entries()[page_]; }

  const storage::PageFile& file_;
  std::vector<std::byte> stored_, raw_;
  std::vector<FrameSlot> frame_;
  std::uint32_t page_ = 0;
};

void read_pages(benchmark::State& state, const storage::PageFile& file) {
  PageWalk walk(file);
  for (auto _ : state) {
    if (!walk.read()) return state.SkipWithError("a page cannot be read");
    walk.advance();
  }
}

void bring_pages(benchmark::State& state, const storage::PageFile& file) {
  PageWalk walk(file);
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
  const auto add = [&](const char* name, auto measure) {
    benchmark::RegisterBenchmark(name, [&file, measure](auto& state) { measure(state, *file); });
  };
  add("read and verify", read_pages);
  add("read, verify and unpack", bring_pages);
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
