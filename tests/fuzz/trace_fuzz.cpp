#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "storage/file/checksum.h"
#include "tests/fuzz/memory_file.h"
#include "tests/tools/trace_file/sample_trace.h"
#include "tools/trace_file/trace_layout.h"

namespace planetree::tools {
namespace {

void expect(bool truth) {
  if (!truth) std::abort();
}

TraceContents read_bytes(const std::string& bytes) {
  const MemoryFile file(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size());
  TraceContents contents = read_trace(file.path().string());
  expect(contents.error.find('\n') == std::string::npos);
  expect(contents.error.empty() || contents.code == ErrorCode::kNotPlanetree ||
         contents.code == ErrorCode::kUnsupported || contents.code == ErrorCode::kTruncated ||
         contents.code == ErrorCode::kDamaged);
  return contents;
}

void append_chunk(std::string& file, TraceChunkKind kind, std::string_view raw,
                  std::uint64_t seed) {
  const auto size = static_cast<std::uint32_t>(raw.size());
  TraceChunkRecord chunk{kind, 0, size, size, 0};
  std::string hashed(reinterpret_cast<const char*>(&chunk), offsetof(TraceChunkRecord, hash));
  hashed += raw;
  chunk.hash = storage::hash64(std::as_bytes(std::span(hashed)), seed);
  file.append(reinterpret_cast<const char*>(&chunk), sizeof chunk);
  file += raw;
}

/// A file of one chunk under right hashes. The end states `records`.
std::string forged(std::string_view raw, std::uint64_t records) {
  TraceHeaderRecord header{};
  std::memcpy(header.magic, kTraceMagic, sizeof header.magic);
  header.version = kTraceVersion;
  header.page_bytes = 4096;
  header.pages = 300;
  header.rate_hz = 1000;
  header.hash = storage::hash64(bytes_of(header).first(offsetof(TraceHeaderRecord, hash)));
  std::string file(reinterpret_cast<const char*>(&header), sizeof header);
  append_chunk(file, TraceChunkKind::kRecords, raw, header.hash);
  const TraceEndRecord end{records, 0, 0};
  append_chunk(file, TraceChunkKind::kEnd, {reinterpret_cast<const char*>(&end), sizeof end},
               header.hash + 1);
  return file;
}

/// The number of records of a chunk, as far as they can be decoded.
std::uint64_t count_records(std::string_view raw) {
  TraceDecoder decoder(1000, 300);
  if (!decoder.begin(std::as_bytes(std::span(raw)))) return 0;
  std::uint64_t count = 0;
  while (!decoder.at_end() && decoder.next()) ++count;
  return count;
}

/// Encodes records again and expects the same.
void expect_round_trip(const TraceContents& contents) {
  TraceEncoder encoder(contents.header.rate_hz);
  for (const PageAccess& access : contents.records) encoder.add(access);
  const std::vector<std::byte> raw = encoder.take();
  TraceDecoder decoder(contents.header.rate_hz, contents.header.pages);
  expect(static_cast<bool>(decoder.begin(raw)));
  for (const PageAccess& access : contents.records) {
    const auto again = decoder.next();
    expect(static_cast<bool>(again));
    // NaNs are equal to nothing: their bits are compared by the position and width alone.
    expect(again->event == access.event && again->time_ns == access.time_ns &&
           again->query == access.query && again->probe == access.probe &&
           again->needed == access.needed && again->is_upper == access.is_upper &&
           std::memcmp(&again->position, &access.position, sizeof access.position) == 0 &&
           std::memcmp(&again->velocity, &access.velocity, sizeof access.velocity) == 0 &&
           std::memcmp(&again->width, &access.width, sizeof access.width) == 0);
  }
  expect(decoder.at_end());
}

}  // namespace
}  // namespace planetree::tools

/// Reads arbitrary bytes as a trace file, and as the raw bytes of a chunk in a file with right
/// hashes. What can be read is encoded again.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  using namespace planetree::tools;
  const std::string text(reinterpret_cast<const char*>(bytes), size);
  const TraceContents whole = read_bytes(text);
  if (whole.error.empty()) expect(whole.totals.records == whole.records.size());
  if (size == 0 || size > kMaxTraceChunkBytes) return 0;
  const TraceContents chunk = read_bytes(forged(text, count_records(text)));
  if (chunk.error.empty()) expect_round_trip(chunk);
  return 0;
}
