#include "storage/spill/result_file.h"

#include <fcntl.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cerrno>
#include <cstring>
#include <utility>

#include "storage/system/file_error.h"

namespace planetree::storage {
namespace {

constexpr std::array<char, 16> kResultMagic = {'p', 'l', 'a', 'n', 'e', 't', 'r', 'e',
                                               'e', ' ', 'r', 'e', 's', 'u', 'l', 't'};

std::uint64_t block_count(std::uint64_t data_bytes) {
  return data_bytes / ResultFile::kBlockBytes + (data_bytes % ResultFile::kBlockBytes > 0);
}

}  // namespace

Error ResultFile::damaged(std::uint64_t offset) const {
  return make_error(ErrorCode::kDamaged, Error::kNowhere, offset,
                    "%s does not have the bytes that were written; remove it and repeat its step",
                    name_.c_str());
}

struct ResultFile::Footer {
  std::array<char, 16> magic = kResultMagic;
  std::uint64_t data_bytes = 0;
  std::uint64_t record_bytes = 0;
  std::uint64_t kind = 0;
  std::uint64_t id_low = 0, id_high = 0;
};

Hash128 ResultFile::id_of(std::uint64_t kind, std::uint64_t data_bytes,
                          std::span<const std::uint64_t> hashes,
                          std::span<const std::byte> record) {
  Hasher hasher;
  const std::array<std::uint64_t, 2> first = {kind, data_bytes};
  hasher.add(std::as_bytes(std::span(first)));
  hasher.add(std::as_bytes(hashes));
  hasher.add(record);
  return hasher.value();
}

Result<ResultFile> ResultFile::open(const std::filesystem::path& path, std::uint64_t kind,
                                    FileCalls& calls) {
  ResultFile result;
  result.name_ = path.filename().string();
  result.file_ = FileHandle::open(calls, AT_FDCWD, path.c_str(), O_RDONLY | O_NONBLOCK);
  if (!result.file_.is_open()) return file_error(errno, FileAction::kRead, "open the file");
  const auto file_bytes = result.file_.size_bytes();
  if (!file_bytes) return file_bytes.error();
  const auto none = [] {
    return make_error(ErrorCode::kBadInput, Error::kNowhere, Error::kNowhere,
                      "not a result of this step and this release; remove the file and repeat the "
                      "step");
  };
  Footer footer;
  if (*file_bytes < sizeof footer) return none();
  std::uint64_t left = *file_bytes - sizeof footer;
  if (const auto read = result.file_.read_at(left, std::as_writable_bytes(std::span(&footer, 1)));
      !read)
    return read.error();
  if (footer.magic != kResultMagic || footer.kind != kind) return none();
  const std::uint64_t blocks = block_count(footer.data_bytes);
  if (footer.data_bytes > left || blocks > (left - footer.data_bytes) / sizeof(std::uint64_t) ||
      footer.record_bytes != left - footer.data_bytes - blocks * sizeof(std::uint64_t))
    return result.damaged(left);
  result.data_bytes_ = footer.data_bytes;
  result.hashes_.resize(blocks);
  result.record_.resize(footer.record_bytes);
  if (const auto read = result.file_.read_at(footer.data_bytes,
                                             std::as_writable_bytes(std::span(result.hashes_)));
      !read)
    return read.error();
  left -= footer.record_bytes;
  if (const auto read = result.file_.read_at(left, result.record_); !read) return read.error();
  result.id_ = id_of(kind, footer.data_bytes, result.hashes_, result.record_);
  if (result.id_ != Hash128{footer.id_low, footer.id_high})
    return result.damaged(footer.data_bytes);
  return result;
}

std::size_t ResultFile::bytes_of_block(std::uint64_t block) const {
  return static_cast<std::size_t>(
      std::min<std::uint64_t>(kBlockBytes, data_bytes_ - block * kBlockBytes));
}

Result<void> ResultFile::check_block(std::uint64_t block, std::span<const std::byte> bytes) const {
  if (hash64(bytes) == hashes_[static_cast<std::size_t>(block)]) return {};
  return damaged(block * kBlockBytes);
}

Result<void> ResultFile::read_block(std::uint64_t block, std::span<std::byte> out) const {
  if (const auto read = file_.read_at(block * kBlockBytes, out); !read) return read;
  return check_block(block, out);
}

// Whole blocks are read in one call, straight to where they belong.
Result<void> ResultFile::read(std::uint64_t offset, std::span<std::byte> out) const {
  assert(offset <= data_bytes_ && out.size() <= data_bytes_ - offset);
  std::vector<std::byte> edge;
  while (!out.empty()) {
    const std::uint64_t block = offset / kBlockBytes;
    const auto within = static_cast<std::size_t>(offset % kBlockBytes);
    const std::size_t size = bytes_of_block(block);
    std::size_t taken = 0;
    if (within > 0 || out.size() < size) {
      edge.resize(size);
      if (const auto read = read_block(block, edge); !read) return read;
      taken = std::min(size - within, out.size());
      std::memcpy(out.data(), edge.data() + within, taken);
    } else {
      const bool to_end = out.size() == data_bytes_ - offset;
      taken = to_end ? out.size() : out.size() / kBlockBytes * kBlockBytes;
      if (const auto read = file_.read_at(offset, out.first(taken)); !read) return read;
      for (std::size_t at = 0; at < taken; at += kBlockBytes) {
        const auto bytes = out.subspan(at, std::min(kBlockBytes, taken - at));
        if (const auto checked = check_block((offset + at) / kBlockBytes, bytes); !checked)
          return checked;
      }
    }
    offset += taken;
    out = out.subspan(taken);
  }
  return {};
}

Result<NewResultFile> NewResultFile::create(const std::filesystem::path& path, bool replace,
                                            FileCalls& calls) {
  auto file = NewFile::create(path, replace, calls);
  if (!file) return file.error();
  return NewResultFile(*std::move(file));
}

Result<std::vector<std::uint64_t>> NewResultFile::hash_data(std::uint64_t data_bytes) const {
  constexpr std::size_t kAtOnce = 64 * ResultFile::kBlockBytes;
  std::vector<std::uint64_t> hashes;
  std::vector<std::byte> part(
      static_cast<std::size_t>(std::min<std::uint64_t>(kAtOnce, data_bytes)));
  for (std::uint64_t offset = 0; offset < data_bytes; offset += kAtOnce) {
    const auto bytes = std::span(part).first(
        static_cast<std::size_t>(std::min<std::uint64_t>(kAtOnce, data_bytes - offset)));
    if (const auto read = file().read_at(offset, bytes); !read) return read.error();
    for (std::size_t at = 0; at < bytes.size(); at += ResultFile::kBlockBytes)
      hashes.push_back(
          hash64(bytes.subspan(at, std::min(ResultFile::kBlockBytes, bytes.size() - at))));
  }
  return hashes;
}

Result<Hash128> NewResultFile::finish(std::uint64_t kind, std::uint64_t data_bytes,
                                      std::span<const std::byte> record) {
  const auto hashes = hash_data(data_bytes);
  if (!hashes) return hashes.error();
  const Hash128 id = ResultFile::id_of(kind, data_bytes, *hashes, record);
  const ResultFile::Footer footer{.data_bytes = data_bytes,
                                  .record_bytes = record.size(),
                                  .kind = kind,
                                  .id_low = id.low,
                                  .id_high = id.high};
  std::uint64_t offset = data_bytes;
  for (const auto bytes :
       {std::as_bytes(std::span(*hashes)), record, std::as_bytes(std::span(&footer, 1))}) {
    if (const auto written = file_.write_at(offset, bytes); !written) return written.error();
    offset += bytes.size();
  }
  if (const auto committed = file_.commit(); !committed) return committed.error();
  return id;
}

}  // namespace planetree::storage
