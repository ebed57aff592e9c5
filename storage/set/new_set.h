#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "planetree/error.h"
#include "storage/file/checksum.h"
#include "storage/file/model_output.h"
#include "storage/set/set_description.h"
#include "storage/system/file_calls.h"
#include "storage/system/new_file.h"

namespace planetree::storage {

/// How a model is divided into members.
struct SetDivision {
  /// Maximum length of a member. One page may be longer, and so may be what is before the pages.
  std::uint64_t member_bytes = 0;
  /// Returns the box of the triangles of the pages from the first number to before the second one.
  std::function<std::optional<MemberBox>(std::uint32_t first, std::uint32_t end)> box_of_pages;
};

/// A new set: members beside their set file. The first member has what is before the pages. The
/// name of a member contains the hash of its bytes, so that it never replaces one with other bytes,
/// of another model or of the same in other members.
///
/// All members are durable under their names before the set file appears. Before that, a failure
/// leaves nothing, and a killed process leaves members at most, which a later build of the same set
/// replaces. When the set file of an earlier set is replaced, the members of that set beside it are
/// removed.
///
/// threads  one at a time
class NewSet final : public ModelOutput {
 public:
  /// path     of the set file
  /// replace  whether a file there may be replaced
  /// calls    the system; must outlive the set
  /// errors   kBadArgument: the name is none of a set, or is no UTF-8; those of NewFile::create()
  static Result<std::unique_ptr<ModelOutput>> create(const std::filesystem::path& path,
                                                     SetDivision division, bool replace,
                                                     FileCalls& calls = FileCalls::real());

  Result<void> begin(std::uint64_t pages_start) override;
  std::size_t write_bytes() const noexcept override;
  Result<void> write_at(std::uint64_t offset, std::span<const std::byte> bytes) override;
  /// errors  kBadArgument: there are more members than a set has; those of NewFile::commit()
  Result<void> commit(const FileHeader& header, std::span<const DirectoryPage> pages) override;

 private:
  using Names = std::vector<std::string>;
  struct NewMember {
    NewFile file;
    std::uint64_t bytes = 0;
    Hasher hasher;
  };

  NewSet(std::filesystem::path path, SetDivision division, NewFile description, bool replace,
         FileCalls& calls);
  std::filesystem::path folder() const;
  std::string name_of(std::size_t member, const Hash128& hash) const;
  Result<void> add_member();
  Result<void> hash_first_member();
  Result<void> publish(const SetDescription& description, Names& names);
  SetDescription describe(const FileHeader& header, std::span<const DirectoryPage> pages) const;
  Names members_of_set_file() const;
  void remove_members(const Names& names) const;

  const std::filesystem::path path_;
  const SetDivision division_;
  NewFile set_file_;
  const bool replace_;
  FileCalls& calls_;
  std::uint64_t pages_start_ = 0;
  std::vector<NewMember> members_;
};

}  // namespace planetree::storage
