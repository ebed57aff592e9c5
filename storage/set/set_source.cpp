#include "storage/set/set_source.h"

#include <algorithm>
#include <cinttypes>
#include <new>
#include <utility>

namespace planetree::storage {

SetSource::SetSource(SetDescription description, std::uint64_t member_memory, std::string name,
                     Open open)
    : description_(std::move(description)),
      member_memory_(member_memory),
      name_(std::move(name)),
      open_(std::move(open)),
      sources_(description_.members.size()),
      owned_(description_.members.size()) {
  std::uint64_t end = 0;
  for (const SetMember& member : description_.members) ends_.push_back(end += member.bytes);
}

Result<void> SetSource::open_all() const {
  for (std::size_t i = 0; i < description_.members.size(); ++i)
    if (const auto source = open_member(i); !source) return source.error();
  return {};
}

Result<const ByteSource*> SetSource::open_member(std::size_t member) const {
  if (const ByteSource* const source = opened(member)) return source;
  const std::lock_guard one(opening_);
  if (const ByteSource* const source = opened(member)) return source;
  const SetMember& expected = description_.members[member];
  auto source = open_(expected.address);
  if (!source) return named(member, source.error());
  if ((*source)->size_bytes() != expected.bytes)
    return named(member, make_error(ErrorCode::kTruncated, Error::kNowhere, Error::kNowhere,
                                    "it has %" PRIu64 " bytes instead of %" PRIu64
                                    "; copy it again, or build the set again",
                                    (*source)->size_bytes(), expected.bytes));
  owned_[member] = *std::move(source);
  sources_[member].store(owned_[member].get(), std::memory_order_release);
  return owned_[member].get();
}

const ByteSource* SetSource::opened(std::size_t member) const noexcept {
  return sources_[member].load(std::memory_order_acquire);
}

Error SetSource::named(std::size_t member, const Error& error) const noexcept {
  return make_error(error.code, error.page, error.offset, "member %s: %s",
                    description_.members[member].address.c_str(), error.text);
}

SetSource::Piece SetSource::piece_at(const ByteRange& range) const noexcept {
  const auto end = std::upper_bound(ends_.begin(), ends_.end(), range.offset);
  const auto member = static_cast<std::size_t>(end - ends_.begin());
  const std::uint64_t start = member > 0 ? ends_[member - 1] : 0;
  return {member, range.offset - start, std::min(range.bytes, *end - range.offset)};
}

/// Calls visit(piece, bytes before it) until it returns false. Returns whether it never did. A
/// range beyond the end has no pieces, and the call returns false.
template <class Visit>
bool SetSource::for_each_piece(ByteRange range, const Visit& visit) const noexcept {
  if (range.offset > size_bytes() || range.bytes > size_bytes() - range.offset) return false;
  for (std::uint64_t done = 0; range.bytes > 0;) {
    const Piece piece = piece_at(range);
    if (!visit(piece, done)) return false;
    done += piece.bytes;
    range = {range.offset + piece.bytes, range.bytes - piece.bytes};
  }
  return true;
}

/// Calls read(member's source, offset in it, bytes) for each piece.
template <class Read>
Result<void> SetSource::read_pieces(std::uint64_t offset, std::span<std::byte> out,
                                    const Read& read) const noexcept {
  if (offset > size_bytes() || out.size() > size_bytes() - offset)
    return make_error(ErrorCode::kTruncated, Error::kNowhere, offset,
                      "the set ends too early; restore it from a copy or build it again");
  Result<void> result;
  for_each_piece({offset, out.size()}, [&](const Piece& piece, std::uint64_t done) {
    const auto source = open_member(piece.member);
    if (source) {
      const auto bytes =
          out.subspan(static_cast<std::size_t>(done), static_cast<std::size_t>(piece.bytes));
      const Result<void> got = read(**source, piece.offset, bytes);
      if (!got) result = named(piece.member, got.error());
    } else {
      result = source.error();
    }
    return static_cast<bool>(result);
  });
  return result;
}

Result<void> SetSource::read_at(std::uint64_t offset, std::span<std::byte> out,
                                const char* what) const noexcept {
  return read_pieces(offset, out, [what](const ByteSource& source, auto at, auto bytes) {
    return source.read_at(at, bytes, what);
  });
}

Result<void> SetSource::read_early(std::uint64_t offset, std::span<std::byte> out) const noexcept {
  return read_pieces(offset, out, [](const ByteSource& source, auto at, auto bytes) {
    return source.read_early(at, bytes);
  });
}

bool SetSource::try_read(std::uint64_t offset, std::span<std::byte> out,
                         const ReadLimits& terms) const noexcept {
  return for_each_piece({offset, out.size()}, [&](const Piece& piece, std::uint64_t done) {
    const ByteSource* const source = opened(piece.member);
    return source && source->try_read(piece.offset,
                                      out.subspan(static_cast<std::size_t>(done),
                                                  static_cast<std::size_t>(piece.bytes)),
                                      terms);
  });
}

/// The parts of ranges, by member. Ranges beyond the end are left out.
std::vector<std::vector<ByteRange>> SetSource::divide(std::span<const ByteRange> ranges) const {
  std::vector<std::vector<ByteRange>> of_member(ends_.size());
  for (const ByteRange& range : ranges) {
    for_each_piece(range, [&](const Piece& piece, std::uint64_t) {
      of_member[piece.member].push_back({piece.offset, piece.bytes});
      return true;
    });
  }
  return of_member;
}

void SetSource::prefetch(std::span<const ByteRange> ranges) const noexcept {
  for (const ByteRange& range : ranges)
    for_each_piece(range, [this](const Piece& piece, std::uint64_t) {
      static_cast<void>(open_member(piece.member));
      return true;
    });
  prefetch_within(ranges, std::chrono::hours(1));
}

void SetSource::prefetch_within(std::span<const ByteRange> ranges,
                                std::chrono::milliseconds max_time) const noexcept {
  using Clock = std::chrono::steady_clock;
  const Clock::time_point end = Clock::now() + max_time;
  try {
    const auto of_member = divide(ranges);
    for (std::size_t i = 0; i < of_member.size(); ++i) {
      const ByteSource* const source = opened(i);
      const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(end - Clock::now());
      if (of_member[i].empty() || !source || left.count() <= 0) continue;
      source->prefetch_within(of_member[i], left);
    }
  } catch (const std::bad_alloc&) {
    return;  // read_at() reads them all the same
  }
}

bool SetSource::is_here(const ByteRange& range) const noexcept {
  return for_each_piece(range, [&](const Piece& piece, std::uint64_t) {
    const ByteSource* const source = opened(piece.member);
    return source && source->is_here({piece.offset, piece.bytes});
  });
}

bool SetSource::forget(const ByteRange& range) const noexcept {
  bool may_differ = false;
  for_each_piece(range, [&](const Piece& piece, std::uint64_t) {
    const ByteSource* const source = opened(piece.member);
    if (source && source->forget({piece.offset, piece.bytes})) may_differ = true;
    return true;
  });
  return may_differ;
}

SourceStats SetSource::stats() const noexcept {
  SourceStats sum;
  for (std::size_t i = 0; i < sources_.size(); ++i) {
    const ByteSource* const source = opened(i);
    if (!source) continue;
    const SourceStats some = source->stats();
    sum.requests += some.requests;
    sum.bytes += some.bytes;
    sum.cached_bytes += some.cached_bytes;
    sum.rounds += some.rounds;
  }
  return sum;
}

}  // namespace planetree::storage
