#include "octree/builder/job/build_memory.h"

#include <unistd.h>

#include <algorithm>

#include "storage/system/processors.h"

namespace planetree::octree {
namespace {

constexpr std::uint64_t kMiB = std::uint64_t{1} << 20;

std::uint64_t machine_bytes() {
  const long pages = ::sysconf(_SC_PHYS_PAGES), page_bytes = ::sysconf(_SC_PAGESIZE);
  return static_cast<std::uint64_t>(pages) * static_cast<std::uint64_t>(page_bytes);
}

}  // namespace

Result<BuildMemory> BuildMemory::share(std::uint64_t bytes, unsigned threads) {
  if (bytes == 0) bytes = std::max(machine_bytes() / 4, kMinBytes);
  if (bytes < kMinBytes)
    return make_error(ErrorCode::kNoMemory, Error::kNowhere, Error::kNowhere,
                      "%llu MiB of memory are too little for a build; give it %llu MiB or more",
                      static_cast<unsigned long long>(bytes / kMiB),
                      static_cast<unsigned long long>(kMinBytes / kMiB));
  if (threads == 0) threads = storage::usable_processors();
  const std::uint64_t max_threads = (bytes - kFixedBytes) / kThreadBytes;
  BuildMemory memory;
  memory.threads = static_cast<int>(std::min<std::uint64_t>(threads, max_threads));
  const std::uint64_t used = kFixedBytes + kThreadBytes * static_cast<unsigned>(memory.threads);
  const std::uint64_t left = bytes - used;
  memory.batch_triangles = 1 << 19;
  memory.reading_bytes = 16 * kMiB + left / 8;
  memory.spool_bytes = left / 4;
  memory.runs_bytes = left / 2;
  memory.pages_bytes = left / 8;
  memory.edge_bytes = left / 16;
  memory.visitor_bytes = left / 16;
  memory.cap_bytes = left / 32;
  memory.part_bytes = memory.spool_bytes - 2 * memory.cap_bytes;  // the spool is empty by then
  return memory;
}

BuildMemory BuildMemory::with_checkpoint() const {
  BuildMemory memory = *this;
  memory.spool_bytes += memory.runs_bytes;
  memory.runs_bytes = 0;
  memory.pages_bytes = 0;
  memory.visitor_bytes = 0;
  memory.part_bytes = 0;
  memory.cap_bytes = 0;
  return memory;
}

}  // namespace planetree::octree
