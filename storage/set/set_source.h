#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <vector>

#include "planetree/error.h"
#include "storage/set/set_description.h"
#include "storage/system/byte_source.h"

namespace planetree::storage {

/// The bytes of a set: those of its members, joined.
///
/// A member is opened when it is first read, or by open_all(). One that cannot be opened fails each
/// read, and is tried again by the next.
///
/// threads  any number at once
class SetSource final : public ByteSource {
 public:
  /// Opens the source of a member.
  using Open = std::function<Result<std::unique_ptr<ByteSource>>(const std::string& address)>;

  /// member_memory  memory that an open member takes, in bytes; 0: no member is on another machine
  /// name           see ByteSource::name()
  SetSource(SetDescription description, std::uint64_t member_memory, std::string name, Open open);

  const SetDescription& description() const noexcept { return description_; }
  /// Opens all members. Returns the first error, whose text names the member.
  ///
  /// errors  those of Open; kTruncated: a member does not have its length
  Result<void> open_all() const;
  /// Opens one member, if that was not done yet.
  Result<const ByteSource*> open_member(std::size_t member) const;

  std::string_view name() const noexcept override { return name_; }
  bool is_remote() const noexcept override { return member_memory_ > 0; }
  std::uint64_t size_bytes() const noexcept override { return ends_.back(); }
  std::uint64_t memory_bytes() const noexcept override {
    return sizeof *this + member_memory_ * ends_.size();
  }
  SourceStats stats() const noexcept override;
  Result<void> read_at(std::uint64_t offset, std::span<std::byte> out,
                       const char* what) const noexcept override;
  bool try_read(std::uint64_t offset, std::span<std::byte> out,
                const ReadLimits& terms) const noexcept override;
  Result<void> read_early(std::uint64_t offset, std::span<std::byte> out) const noexcept override;
  void prefetch(std::span<const ByteRange> ranges) const noexcept override;
  /// Members that are not open are left to read_at().
  void prefetch_within(std::span<const ByteRange> ranges,
                       std::chrono::milliseconds max_time) const noexcept override;
  bool is_here(const ByteRange& range) const noexcept override;
  bool forget(const ByteRange& range) const noexcept override;

 private:
  /// A part of a range that is in one member.
  struct Piece {
    std::size_t member;
    std::uint64_t offset;  ///< in the member
    std::uint64_t bytes;
  };
  Piece piece_at(const ByteRange& range) const noexcept;
  template <class Visit>
  bool for_each_piece(ByteRange range, const Visit& visit) const noexcept;
  std::vector<std::vector<ByteRange>> divide(std::span<const ByteRange> ranges) const;
  template <class Read>
  Result<void> read_pieces(std::uint64_t offset, std::span<std::byte> out,
                           const Read& read) const noexcept;
  const ByteSource* opened(std::size_t member) const noexcept;
  Error named(std::size_t member, const Error& error) const noexcept;

  const SetDescription description_;
  const std::uint64_t member_memory_;
  const std::string name_;
  const Open open_;
  std::vector<std::uint64_t> ends_;  // of the members, from the start of the set
  mutable std::mutex opening_;
  // Owned; null until opened, then unchanged.
  mutable std::vector<std::atomic<const ByteSource*>> sources_;
  mutable std::vector<std::unique_ptr<ByteSource>> owned_;  // guarded by opening_
};

}  // namespace planetree::storage
