#include "tools/trace_file/trace_coding.h"

#include <array>
#include <bit>
#include <cstring>

#include "tools/trace_file/trace_layout.h"

namespace planetree::tools {
namespace {

using Event = PageAccess::Event;

constexpr double Vec3::*kAxes[] = {&Vec3::x, &Vec3::y, &Vec3::z};

void put(std::vector<std::byte>& to, std::uint64_t value, std::size_t bytes) {
  for (std::size_t i = 0; i < bytes; ++i) to.push_back(static_cast<std::byte>(value >> 8 * i));
}

void put_varint(std::vector<std::byte>& to, std::uint64_t value) {
  for (; value >= 128; value >>= 7) put(to, value | 128, 1);
  put(to, value, 1);
}

// Small differences of either sign become small numbers.
void put_difference(std::vector<std::byte>& to, std::uint64_t value, std::uint64_t last) {
  const std::uint64_t difference = value - last;
  put_varint(to, difference << 1 ^ (0 - (difference >> 63)));
}

std::uint8_t kind_of(const PageAccess& access) {
  return static_cast<std::uint8_t>(static_cast<std::uint8_t>(access.query_kind) |
                                   (access.in_batch ? TraceKind::kInBatch : 0) |
                                   (access.waits ? TraceKind::kWaits : 0));
}

// The six words of a motion that are expected after the last one: the same position, and the
// velocity that leads from that to the new position in a tick.
std::array<std::uint64_t, 6> expected_motion(const TraceState& state, const Vec3& position,
                                             double rate_hz) {
  std::array<std::uint64_t, 6> words{};
  if (!state.has_position) return words;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double last = state.position.*kAxes[axis];
    words[axis] = std::bit_cast<std::uint64_t>(last);
    words[3 + axis] = std::bit_cast<std::uint64_t>((position.*kAxes[axis] - last) * rate_hz);
  }
  return words;
}

std::size_t significant_bytes(std::uint64_t value) {
  return (static_cast<std::size_t>(std::bit_width(value)) + 7) / 8;
}

}  // namespace

std::uint32_t TraceEncoder::index_of(const PageAccess& access) {
  const auto next = static_cast<std::uint32_t>(indices_.size());
  const auto [at, is_new] = indices_.emplace(access.page, next);
  if (is_new) {
    ++new_pages_;
    put_varint(pages_, access.page);
    put(pages_, access.octcode, 8);
    put(pages_, static_cast<std::uint64_t>(access.section), 1);
    put_varint(pages_, access.stored_bytes);
  }
  return at->second;
}

void TraceEncoder::add(const PageAccess& access) {
  const std::uint8_t kind = kind_of(access);
  const bool has_context =
      access.probe != state_.probe || access.query != state_.query || kind != state_.kind;
  const bool has_time = access.time_ns != state_.time_ns;
  put(records_,
      static_cast<std::uint64_t>(access.event) |
          (access.needed || access.is_upper ? TraceTag::kFlag : 0U) |
          (has_context ? TraceTag::kContext : 0U) | (has_time ? TraceTag::kTime : 0U),
      1);
  if (has_context) {
    put_varint(records_, access.probe);
    put(records_, kind, 1);
    put_difference(records_, access.query, state_.query);
    state_.probe = access.probe;
    state_.kind = kind;
    state_.query = access.query;
  }
  if (has_time) {
    put_difference(records_, access.time_ns, state_.time_ns);
    state_.time_ns = access.time_ns;
  }
  if (access.event == Event::kMotion) return add_motion(access);
  if (access.event == Event::kDegraded)
    return put(records_, std::bit_cast<std::uint32_t>(access.width), 4);
  const std::uint32_t index = index_of(access);
  put_difference(records_, index, state_.page);
  state_.page = index;
}

void TraceEncoder::add_motion(const PageAccess& access) {
  const auto expected = expected_motion(state_, access.position, rate_hz_);
  std::array<std::uint64_t, 6> words{};
  std::uint64_t lengths = 0;
  for (std::size_t i = 0; i < 6; ++i) {
    const Vec3& value = i < 3 ? access.position : access.velocity;
    words[i] = std::bit_cast<std::uint64_t>(value.*kAxes[i % 3]) ^ expected[i];
    lengths |= std::uint64_t{significant_bytes(words[i])} << 4 * i;
  }
  put(records_, lengths, 3);
  for (const std::uint64_t word : words) put(records_, word, significant_bytes(word));
  state_.position = access.position;
  state_.has_position = true;
}

std::vector<std::byte> TraceEncoder::take() {
  std::vector<std::byte> raw;
  raw.reserve(bytes() + 8);
  put_varint(raw, new_pages_);
  raw.insert(raw.end(), pages_.begin(), pages_.end());
  raw.insert(raw.end(), records_.begin(), records_.end());
  pages_.clear();
  records_.clear();
  new_pages_ = 0;
  state_ = {};
  return raw;
}

namespace {

Error damaged(const char* cause) {
  return make_error(ErrorCode::kDamaged, Error::kNowhere, Error::kNowhere,
                    "%s; restore the trace from a copy or record the session again", cause);
}

}  // namespace

bool TraceDecoder::take(std::size_t count, std::uint64_t& value) {
  if (raw_.size() - at_ < count) return false;
  value = 0;
  std::memcpy(&value, raw_.data() + at_, count);
  at_ += count;
  return true;
}

bool TraceDecoder::take_varint(std::uint64_t& value) {
  value = 0;
  for (unsigned shift = 0; shift < 64; shift += 7) {
    if (at_ == raw_.size()) return false;
    const auto byte = static_cast<std::uint64_t>(raw_[at_++]);
    if (shift == 63 && byte > 1) return false;
    value |= (byte & 127) << shift;
    if (byte < 128) return true;
  }
  return false;
}

// Adds a difference to the last value.
bool TraceDecoder::take_difference(std::uint64_t& value) {
  std::uint64_t coded = 0;
  if (!take_varint(coded)) return false;
  value += coded >> 1 ^ (0 - (coded & 1));
  return true;
}

Result<void> TraceDecoder::begin(std::span<const std::byte> raw) {
  raw_ = raw;
  at_ = 0;
  state_ = {};
  std::uint64_t count = 0;
  if (!take_varint(count)) return damaged("a chunk has no count of pages");
  for (; count > 0; --count)
    if (!take_page()) return damaged("a chunk describes a page that cannot be");
  return {};
}

bool TraceDecoder::take_page() {
  std::uint64_t page = 0, octcode = 0, section = 0, stored = 0;
  if (!take_varint(page) || !take(8, octcode) || !take(1, section) || !take_varint(stored))
    return false;
  if (page >= page_count_ ||
      section > static_cast<std::uint64_t>(PageAccess::Section::kAttributes) || stored > UINT32_MAX)
    return false;
  pages_.push_back({static_cast<std::uint32_t>(page), static_cast<std::uint32_t>(stored), octcode,
                    static_cast<PageAccess::Section>(section)});
  return true;
}

bool TraceDecoder::take_context() {
  std::uint64_t probe = 0, kind = 0;
  if (!take_varint(probe) || probe > UINT32_MAX || !take(1, kind)) return false;
  constexpr auto kAllBits = TraceKind::kQueryMask | TraceKind::kInBatch | TraceKind::kWaits;
  if ((kind & ~std::uint64_t{kAllBits}) != 0 ||
      (kind & TraceKind::kQueryMask) > static_cast<std::uint64_t>(PageAccess::Query::kOpen))
    return false;
  state_.probe = static_cast<std::uint32_t>(probe);
  state_.kind = static_cast<std::uint8_t>(kind);
  return take_difference(state_.query);
}

Result<PageAccess> TraceDecoder::next() {
  std::uint64_t tag = 0;
  PageAccess access;
  if (!take(1, tag) || (tag & 128) != 0 ||
      (tag & TraceTag::kEventMask) > static_cast<std::uint64_t>(Event::kMotion))
    return damaged("a record has an unknown event");
  access.event = static_cast<Event>(tag & TraceTag::kEventMask);
  if ((tag & TraceTag::kContext) != 0 && !take_context())
    return damaged("a record has a query that cannot be");
  if ((tag & TraceTag::kTime) != 0 && !take_difference(state_.time_ns))
    return damaged("a record has no time");
  access.time_ns = state_.time_ns;
  access.query = state_.query;
  access.probe = state_.probe;
  access.query_kind = static_cast<PageAccess::Query>(state_.kind & TraceKind::kQueryMask);
  access.in_batch = (state_.kind & TraceKind::kInBatch) != 0;
  access.waits = (state_.kind & TraceKind::kWaits) != 0;
  const bool flag = (tag & TraceTag::kFlag) != 0;
  access.is_upper = flag && access.event == Event::kInstalled;
  access.needed = flag && access.event != Event::kInstalled;
  if (!take_details(access))
    return damaged("a record ends early, or has a page that is not described");
  return access;
}

bool TraceDecoder::take_details(PageAccess& access) {
  if (access.event == Event::kMotion) return take_motion(access);
  if (access.event == Event::kDegraded) {
    std::uint64_t width = 0;
    if (!take(4, width)) return false;
    access.width = std::bit_cast<float>(static_cast<std::uint32_t>(width));
    return true;
  }
  std::uint64_t index = state_.page;
  if (!take_difference(index) || index >= pages_.size()) return false;
  state_.page = static_cast<std::uint32_t>(index);
  const TracePage& page = pages_[index];
  access.page = page.page;
  access.octcode = page.octcode;
  access.level = static_cast<std::uint8_t>(page.octcode >> 59);
  access.section = page.section;
  access.stored_bytes = page.stored_bytes;
  return true;
}

bool TraceDecoder::take_motion(PageAccess& access) {
  std::uint64_t lengths = 0;
  if (!take(3, lengths)) return false;
  std::array<std::uint64_t, 6> expected = expected_motion(state_, {}, rate_hz_);
  for (std::size_t i = 0; i < 6; ++i) {
    const auto length = static_cast<std::size_t>(lengths >> 4 * i & 15);
    std::uint64_t word = 0;
    if (length > 8 || !take(length, word)) return false;
    // The position is known now.
    if (i == 3) expected = expected_motion(state_, access.position, rate_hz_);
    Vec3& value = i < 3 ? access.position : access.velocity;
    value.*kAxes[i % 3] = std::bit_cast<double>(word ^ expected[i]);
  }
  state_.position = access.position;
  state_.has_position = true;
  return true;
}

}  // namespace planetree::tools
