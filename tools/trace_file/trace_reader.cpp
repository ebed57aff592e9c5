#include "tools/trace_file/trace_reader.h"

#include <algorithm>
#include <cinttypes>
#include <cstring>
#include <utility>

#include "storage/file/checksum.h"
#include "storage/file/page_codec.h"

namespace planetree::tools {
namespace {

constexpr const char* kRemedy = "restore the trace from a copy or record the session again";

Error refuse(ErrorCode code, std::uint64_t offset, const char* cause) {
  return make_error(code, Error::kNowhere, offset, "%s; %s", cause, kRemedy);
}

/// Fills `to` from the file.
///
/// what  part of the file, for the error
Result<void> fill(InputFile& file, std::uint64_t offset, std::span<std::byte> to,
                  const char* what) {
  const auto count = file.read(to);
  if (!count) return count.error();
  if (*count == to.size()) return {};
  return make_error(ErrorCode::kTruncated, Error::kNowhere, offset + *count,
                    "the trace was cut in %s; %s", what, kRemedy);
}

Result<void> check_fields(const TraceHeaderRecord& record) {
  const bool is_sound = record.policy <= static_cast<std::uint8_t>(EvictionPolicy::kTwoQ) &&
                        (record.flags & ~kTraceIsDeterministic) == 0 && record.reserved == 0 &&
                        record.page_bytes > 0 && record.pages > 0 && record.frames <= record.pages;
  if (is_sound) return {};
  return refuse(ErrorCode::kDamaged, 0, "the header of the trace has a value that cannot be");
}

TraceHeader header_of(const TraceHeaderRecord& record, std::string name) {
  TraceHeader header;
  header.model = std::move(name);
  header.content_id[0] = record.content_id[0];
  header.content_id[1] = record.content_id[1];
  header.memory_bytes = record.memory_bytes;
  header.frames = record.frames;
  header.page_bytes = record.page_bytes;
  header.pages = record.pages;
  header.rate_hz = record.rate_hz;
  header.layers = record.layers;
  header.policy = static_cast<EvictionPolicy>(record.policy);
  header.is_deterministic = (record.flags & kTraceIsDeterministic) != 0;
  header.fetch_threads = record.fetch_threads;
  header.latency_ns = record.latency_ns;
  return header;
}

}  // namespace

Result<TraceReader> TraceReader::open(const std::string& path) {
  auto file = InputFile::open(path);
  if (!file) return file.error();
  std::vector<std::byte> bytes(sizeof(TraceHeaderRecord));
  const auto count = file->read(bytes);
  if (!count) return count.error();
  TraceHeaderRecord record{};
  std::memcpy(&record, bytes.data(), *count);
  if (*count < sizeof kTraceMagic ||
      std::memcmp(record.magic, kTraceMagic, sizeof kTraceMagic) != 0)
    return make_error(ErrorCode::kNotPlanetree, Error::kNowhere, 0,
                      "this is not a page trace; give a file that --trace of touch or query wrote");
  if (*count < sizeof record)
    return refuse(ErrorCode::kTruncated, *count, "the trace was cut in its header");
  if (record.version != kTraceVersion)
    return make_error(ErrorCode::kUnsupported, Error::kNowhere, 8,
                      "the trace has version %" PRIu32 " and this program reads version %" PRIu32
                      "; use a planetree of that version or record the session again",
                      record.version, kTraceVersion);
  if (record.name_bytes > TraceHeader::kMaxNameBytes)
    return refuse(ErrorCode::kDamaged, 12, "the header of the trace is damaged");
  std::string name(record.name_bytes, '\0');
  if (const auto filled =
          fill(*file, sizeof record, std::as_writable_bytes(std::span(name)), "its header");
      !filled)
    return filled.error();
  bytes.resize(offsetof(TraceHeaderRecord, hash));
  const auto name_bytes = std::as_bytes(std::span(name));
  bytes.insert(bytes.end(), name_bytes.begin(), name_bytes.end());
  if (storage::hash64(bytes) != record.hash)
    return refuse(ErrorCode::kDamaged, 0, "the header of the trace is damaged");
  if (const auto checked = check_fields(record); !checked) return checked.error();
  const std::uint64_t offset = sizeof record + name.size();
  return TraceReader(std::move(*file), header_of(record, std::move(name)), record.hash, offset);
}

Result<std::size_t> TraceReader::read(std::span<PageAccess> accesses) {
  std::size_t count = 0;
  while (count < accesses.size() && !is_at_end_) {
    if (decoder_.at_end()) {
      if (const auto read = read_chunk(); !read) return read.error();
      continue;
    }
    const auto access = decoder_.next();
    if (!access) return access.error();
    accesses[count++] = *access;
    ++records_;
  }
  return count;
}

Result<void> TraceReader::read_chunk() {
  TraceChunkRecord chunk{};
  std::vector<std::byte> bytes(sizeof chunk);
  if (const auto filled = fill(file_, offset_, bytes, "a chunk's header, before its end"); !filled)
    return filled;
  std::memcpy(&chunk, bytes.data(), sizeof chunk);
  const auto codec = static_cast<storage::Codec>(chunk.codec);
  if (chunk.raw_bytes > kMaxTraceChunkBytes ||
      !storage::lengths_are_plausible(codec, chunk.stored_bytes, chunk.raw_bytes))
    return refuse(ErrorCode::kDamaged, offset_, "the header of a chunk is damaged");
  bytes.resize(offsetof(TraceChunkRecord, hash) + chunk.stored_bytes);
  const auto stored = std::span(bytes).subspan(offsetof(TraceChunkRecord, hash));
  if (const auto filled = fill(file_, offset_ + sizeof chunk, stored, "a chunk"); !filled)
    return filled;
  if (storage::hash64(bytes, seed_++) != chunk.hash)
    return refuse(ErrorCode::kDamaged, offset_, "a chunk of the trace is damaged");
  raw_.resize(chunk.raw_bytes);
  if (!storage::decompress_page(codec, stored, raw_))
    return refuse(ErrorCode::kDamaged, offset_, "a chunk of the trace cannot be unpacked");
  offset_ += sizeof chunk + chunk.stored_bytes;
  if (chunk.kind == TraceChunkKind::kEnd) return finish();
  if (chunk.kind != TraceChunkKind::kRecords)
    return refuse(ErrorCode::kDamaged, offset_, "a chunk of the trace is of an unknown kind");
  return decoder_.begin(raw_);
}

Result<void> TraceReader::finish() {
  TraceEndRecord end{};
  if (raw_.size() != sizeof end)
    return refuse(ErrorCode::kDamaged, offset_, "the end of the trace has a wrong length");
  std::memcpy(&end, raw_.data(), sizeof end);
  if (end.records != records_)
    return refuse(ErrorCode::kDamaged, offset_,
                  "the trace has another number of records than it says");
  std::byte more{};
  const auto count = file_.read(std::span(&more, 1));
  if (!count) return count.error();
  if (*count > 0)
    return refuse(ErrorCode::kTruncated, offset_, "bytes follow the end of the trace");
  totals_ = {end.records, end.lost, end.ticks};
  is_at_end_ = true;
  return {};
}

}  // namespace planetree::tools
