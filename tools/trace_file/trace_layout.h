#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>

/// Numbers of the trace file. See format-spec/trace-v1/spec.md.
namespace planetree::tools {

inline constexpr char kTraceMagic[8] = {'p', 't', 't', 'r', 'a', 'c', 'e', '\n'};
inline constexpr std::uint32_t kTraceVersion = 1;

/// The fixed part of the header. The name of the model follows it. Little-endian.
struct TraceHeaderRecord {
  char magic[8];
  std::uint32_t version;
  std::uint32_t name_bytes;
  std::uint64_t content_id[2];
  std::uint64_t memory_bytes;
  std::uint64_t frames;
  std::uint32_t page_bytes;
  std::uint32_t pages;
  std::uint32_t rate_hz;
  std::uint32_t layers;
  std::uint8_t policy;
  std::uint8_t flags;  ///< kTraceIsDeterministic
  std::uint16_t fetch_threads;
  std::uint32_t reserved;  ///< 0
  std::uint64_t latency_ns;
  std::uint64_t hash;  ///< XXH3-64 of all bytes before it and of the name
};
static_assert(sizeof(TraceHeaderRecord) == 88 && std::endian::native == std::endian::little);

inline constexpr std::uint8_t kTraceIsDeterministic = 1;

enum class TraceChunkKind : std::uint32_t { kRecords = 1, kEnd = 2 };

/// Precedes the stored bytes of a chunk.
struct TraceChunkRecord {
  TraceChunkKind kind;
  std::uint32_t codec;  ///< storage::Codec
  std::uint32_t stored_bytes;
  std::uint32_t raw_bytes;
  /// XXH3-64 of the bytes before it and of the stored bytes. Its seed is the hash of the header
  /// plus the number of the chunk.
  std::uint64_t hash;
};
static_assert(sizeof(TraceChunkRecord) == 24);

/// A reader may refuse longer chunks.
inline constexpr std::uint32_t kMaxTraceChunkBytes = std::uint32_t{1} << 20;

/// Raw bytes of the last chunk.
struct TraceEndRecord {
  std::uint64_t records, lost, ticks;
};
static_assert(sizeof(TraceEndRecord) == 24);

/// The first byte of a record: PageAccess::Event and flags.
struct TraceTag {
  static constexpr std::uint8_t kEventMask = 15;
  static constexpr std::uint8_t kFlag = 16;     ///< PageAccess::needed; of kInstalled, is_upper
  static constexpr std::uint8_t kContext = 32;  ///< another query: probe, kind and number follow
  static constexpr std::uint8_t kTime = 64;     ///< another time follows
};

/// The byte of a query's kind: PageAccess::Query and flags.
struct TraceKind {
  static constexpr std::uint8_t kQueryMask = 7;
  static constexpr std::uint8_t kInBatch = 8;
  static constexpr std::uint8_t kWaits = 16;
};

template <class Record>
std::span<const std::byte> bytes_of(const Record& record) {
  return std::as_bytes(std::span(&record, 1));
}

}  // namespace planetree::tools
