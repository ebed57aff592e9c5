#include "storage/set/new_set.h"

#include <fcntl.h>

#include <algorithm>
#include <cassert>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <utility>

#include "storage/set/member_address.h"
#include "storage/system/byte_source.h"
#include "storage/system/read_parts.h"

namespace planetree::storage {
namespace {

constexpr const char* kMemberExtension = ".part";

Error bad_argument(const char* cause) {
  return make_error(ErrorCode::kBadArgument, Error::kNowhere, Error::kNowhere, "%s", cause);
}

bool is_utf8(const std::string& text) {
  try {
    static_cast<void>(nlohmann::json(text).dump());
    return true;
  } catch (const nlohmann::json::exception&) {
    return false;
  }
}

}  // namespace

Result<std::unique_ptr<ModelOutput>> NewSet::create(const std::filesystem::path& path,
                                                    SetDivision division, bool replace,
                                                    FileCalls& calls) {
  if (!is_set_name(path.native()))
    return bad_argument("the name of a set ends in .ptreeset; give it such a name");
  if (!is_utf8(path.stem().string()))
    return bad_argument("the name of a set has to be UTF-8; give it another name");
  auto description = NewFile::create(path, replace, calls);
  if (!description) return description.error();
  return std::unique_ptr<ModelOutput>(
      new NewSet(path, std::move(division), *std::move(description), replace, calls));
}

NewSet::NewSet(std::filesystem::path path, SetDivision division, NewFile description, bool replace,
               FileCalls& calls)
    : path_(std::move(path)),
      division_(std::move(division)),
      set_file_(std::move(description)),
      replace_(replace),
      calls_(calls) {}

std::string NewSet::name_of(std::size_t member, const Hash128& hash) const {
  char rest[64];
  std::snprintf(rest, sizeof rest, ".%03zu.%016llx", member,
                static_cast<unsigned long long>(hash.high));
  return path_.stem().string() + rest + kMemberExtension;
}

Result<void> NewSet::add_member() {
  if (members_.size() == SetDescription::kMaxMembers)
    return bad_argument("a set has at most 256 members; give a larger size of members");
  // It gets its name when its hash is known.
  auto file = NewFile::create(folder() / name_of(members_.size(), {}), true, calls_);
  if (!file) return file.error();
  members_.push_back({*std::move(file), 0, {}});
  return {};
}

std::filesystem::path NewSet::folder() const {
  return path_.has_parent_path() ? path_.parent_path() : ".";
}

Result<void> NewSet::begin(std::uint64_t pages_start) {
  pages_start_ = pages_start;
  if (const auto added = add_member(); !added) return added;
  members_.front().bytes = pages_start;
  return add_member();
}

std::size_t NewSet::write_bytes() const noexcept {
  return static_cast<std::size_t>(std::min<std::uint64_t>(division_.member_bytes, kMaxWriteBytes));
}

Result<void> NewSet::write_at(std::uint64_t offset, std::span<const std::byte> bytes) {
  if (offset < pages_start_) return members_.front().file.write_at(offset, bytes);
  const bool is_full = members_.back().bytes > 0 &&
                       bytes.size() > division_.member_bytes -
                                          std::min(division_.member_bytes, members_.back().bytes);
  if (is_full)
    if (const auto added = add_member(); !added) return added;
  NewMember& member = members_.back();
  const auto written = member.file.write_at(member.bytes, bytes);
  member.bytes += bytes.size();
  member.hasher.add(bytes);
  return written;
}

// What is before the pages was not written in order.
Result<void> NewSet::hash_first_member() {
  NewMember& first = members_.front();
  return read_parts(first.file.file(), first.bytes,
                    [&first](const auto& part) { first.hasher.add(part); });
}

Result<void> NewSet::commit(const FileHeader& header, std::span<const DirectoryPage> pages) {
  if (const auto hashed = hash_first_member(); !hashed) return hashed;
  const SetDescription description = describe(header, pages);
  const Names earlier = replace_ ? members_of_set_file() : Names();
  const std::string text = description.text();
  const auto written = set_file_.write_at(0, std::as_bytes(std::span(text)));
  if (!written) return written;
  Names names;
  const auto published = publish(description, names);
  // A failed commit may have replaced the set file. Members that it names then stay.
  remove_members(published ? earlier : names);
  return published;
}

/// names  receives the names that members have by now
Result<void> NewSet::publish(const SetDescription& description, Names& names) {
  for (std::size_t i = 0; i < members_.size(); ++i) {
    names.push_back(description.members[i].address);
    members_[i].file.rename(names.back());
    if (const auto committed = members_[i].file.commit(); !committed) return committed;
  }
  return set_file_.commit();
}

SetDescription NewSet::describe(const FileHeader& header,
                                std::span<const DirectoryPage> pages) const {
  SetDescription description;
  description.content_id = {header.content_id[0], header.content_id[1]};
  std::uint64_t end = 0, page_end = 0;  // of the member and of the pages so far
  std::uint32_t page = 0;
  for (const NewMember& member : members_) {
    // The pages are behind the first member.
    end += description.members.empty() ? 0 : member.bytes;
    const std::uint32_t first = page;
    for (; page < pages.size() && page_end + pages[page].stored_bytes <= end; ++page)
      page_end += pages[page].stored_bytes;
    const Hash128 hash = member.hasher.value();
    description.members.push_back({.address = name_of(description.members.size(), hash),
                                   .bytes = member.bytes,
                                   .hash = hash,
                                   .pages = page - first,
                                   .box = division_.box_of_pages(first, page)});
  }
  assert(page == pages.size());
  return description;
}

/// Names of members that the set file under the name of this one has, as far as they are beside it
/// and named like its members.
NewSet::Names NewSet::members_of_set_file() const {
  Names names;
  const auto file = open_file_source(path_.c_str(), calls_);
  const auto description =
      file ? SetDescription::read(**file) : Result<SetDescription>(file.error());
  if (!description) return names;
  for (const SetMember& member : description->members)
    if (member.address.starts_with(path_.stem().string() + ".") &&
        member.address.ends_with(kMemberExtension) && member.address.find('/') == std::string::npos)
      names.push_back(member.address);
  return names;
}

/// Removes members, but not those of the set file. A name that cannot be removed is left.
void NewSet::remove_members(const Names& names) const {
  const Names kept = members_of_set_file();
  for (const std::string& name : names)
    if (std::find(kept.begin(), kept.end(), name) == kept.end())
      calls_.unlinkat(AT_FDCWD, (folder() / name).c_str(), 0);
}

}  // namespace planetree::storage
