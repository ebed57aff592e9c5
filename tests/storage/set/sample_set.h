#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "storage/set/new_set.h"
#include "storage/set/open_model.h"
#include "tests/storage/file/sample_file.h"

/// Sets of a sample file.
namespace planetree::storage {

/// Writes the pages of a sample as a set.
///
/// member_bytes  of the members; the pages of the sample have some 100 bytes each
inline Result<FileHeader> write_set(const SampleFile& sample, const std::filesystem::path& path,
                                    std::uint64_t member_bytes, bool replace = false,
                                    FileCalls& calls = FileCalls::real()) {
  SetDivision division;
  division.member_bytes = member_bytes;
  division.box_of_pages = [](std::uint32_t first, std::uint32_t end) -> std::optional<MemberBox> {
    if (first == end) return {};
    return MemberBox{{static_cast<double>(first), 0, 0}, {static_cast<double>(end), 1, 1}};
  };
  auto output = NewSet::create(path, std::move(division), replace, calls);
  if (!output) return output.error();
  auto writer = PageWriter::create(*std::move(output), sample.page_count, sample.extensions);
  if (!writer) return writer.error();
  for (std::uint32_t page = 0; page < sample.page_count; ++page) {
    const Bytes bytes = sample.raw(page);
    const auto appended =
        writer->append(page / 2, static_cast<std::uint32_t>(bytes.size()), compress_page(bytes));
    if (!appended) return appended.error();
  }
  return writer->finish(sample_model(), kMinPageBytes);
}

/// All bytes of a source.
inline Bytes bytes_of(const ByteSource& source) {
  Bytes bytes(static_cast<std::size_t>(source.size_bytes()));
  const auto read = source.read_at(0, bytes);
  EXPECT_TRUE(read) << read.error().text;
  return bytes;
}

/// A set file.
inline SetDescription description_of(const std::filesystem::path& path) {
  const auto description = SetDescription::parse(read_bytes(path));
  EXPECT_TRUE(description) << description.error().text;
  return description ? *description : SetDescription();
}

}  // namespace planetree::storage
