#include "tools/trace_file/trace_writer.h"

#include <algorithm>
#include <cstring>
#include <utility>
#include <vector>

#include "storage/file/checksum.h"
#include "storage/file/page_codec.h"
#include "tools/trace_file/trace_layout.h"

namespace planetree::tools {
namespace {

// Raw bytes after which a chunk ends. A record and the page that it may describe take fewer than
// the rest of kMaxTraceChunkBytes.
constexpr std::size_t kChunkBytes = std::size_t{1} << 18;

std::uint64_t hash_of(std::span<const std::byte> first, std::span<const std::byte> then,
                      std::uint64_t seed) {
  std::vector<std::byte> all(first.begin(), first.end());
  all.insert(all.end(), then.begin(), then.end());
  return storage::hash64(all, seed);
}

}  // namespace

Result<TraceWriter> TraceWriter::create(const std::filesystem::path& path, bool may_replace) {
  auto file = OutputFile::create(path, may_replace);
  if (!file) return file.error();
  return TraceWriter(std::move(*file));
}

Result<void> TraceWriter::begin(const TraceHeader& header) {
  const std::string name = header.model.substr(0, TraceHeader::kMaxNameBytes);
  TraceHeaderRecord record{};
  std::memcpy(record.magic, kTraceMagic, sizeof record.magic);
  record.version = kTraceVersion;
  record.name_bytes = static_cast<std::uint32_t>(name.size());
  record.content_id[0] = header.content_id[0];
  record.content_id[1] = header.content_id[1];
  record.memory_bytes = header.memory_bytes;
  record.frames = header.frames;
  record.page_bytes = header.page_bytes;
  record.pages = header.pages;
  record.rate_hz = header.rate_hz;
  record.layers = header.layers;
  record.policy = static_cast<std::uint8_t>(header.policy);
  record.flags = header.is_deterministic ? kTraceIsDeterministic : 0;
  record.fetch_threads = header.fetch_threads;
  record.latency_ns = header.latency_ns;
  const auto name_bytes = std::as_bytes(std::span(name));
  record.hash = hash_of(bytes_of(record).first(offsetof(TraceHeaderRecord, hash)), name_bytes, 0);
  seed_ = record.hash;
  encoder_.emplace(header.rate_hz);
  if (const auto written = file_.write(bytes_of(record)); !written) return written;
  return file_.write(name_bytes);
}

Result<void> TraceWriter::add(std::span<const PageAccess> accesses) {
  for (const PageAccess& access : accesses) {
    encoder_->add(access);
    if (encoder_->bytes() < kChunkBytes) continue;
    const auto kind = static_cast<std::uint32_t>(TraceChunkKind::kRecords);
    if (const auto written = write_chunk(kind, encoder_->take()); !written) return written;
  }
  totals_.records += accesses.size();
  return {};
}

Result<void> TraceWriter::finish(std::uint64_t ticks, std::uint64_t lost) {
  if (encoder_->bytes() > 0) {
    const auto kind = static_cast<std::uint32_t>(TraceChunkKind::kRecords);
    if (const auto written = write_chunk(kind, encoder_->take()); !written) return written;
  }
  const TraceEndRecord end{totals_.records, lost, ticks};
  const auto kind = static_cast<std::uint32_t>(TraceChunkKind::kEnd);
  if (const auto written = write_chunk(kind, bytes_of(end)); !written) return written;
  return file_.commit();
}

Result<void> TraceWriter::write_chunk(std::uint32_t kind, std::span<const std::byte> raw) {
  const storage::StoredPage stored = storage::compress_page(raw);
  TraceChunkRecord chunk{};
  chunk.kind = static_cast<TraceChunkKind>(kind);
  chunk.codec = static_cast<std::uint32_t>(stored.codec);
  chunk.stored_bytes = static_cast<std::uint32_t>(stored.bytes.size());
  chunk.raw_bytes = static_cast<std::uint32_t>(raw.size());
  chunk.hash =
      hash_of(bytes_of(chunk).first(offsetof(TraceChunkRecord, hash)), stored.bytes, seed_++);
  if (const auto written = file_.write(bytes_of(chunk)); !written) return written;
  return file_.write(stored.bytes);
}

}  // namespace planetree::tools
