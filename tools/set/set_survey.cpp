#include "tools/set/set_survey.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

#include "storage/file/checksum.h"
#include "storage/set/set_source.h"
#include "storage/system/read_parts.h"
#include "tools/cli/file_text.h"
#include "tools/cli/layer_words.h"
#include "tools/cli/size_text.h"

namespace planetree::tools {
namespace {

using Json = nlohmann::ordered_json;

Result<storage::Hash128> hash_of(const storage::ByteSource& member) {
  storage::Hasher hasher;
  const auto read = storage::read_parts(member, member.size_bytes(),
                                        [&hasher](const auto& part) { hasher.add(part); });
  return read ? Result<storage::Hash128>(hasher.value()) : read.error();
}

std::optional<Error> fault_of(const storage::SetSource& set, std::size_t number, bool hashes) {
  const auto member = set.open_member(number);
  if (!member) return member.error();
  if (!hashes) return {};
  const auto hash = hash_of(**member);
  if (!hash) return hash.error();
  const storage::SetMember& description = set.description().members[number];
  if (*hash == description.hash) return {};
  return make_error(ErrorCode::kDamaged, Error::kNowhere, Error::kNowhere,
                    "member %s: its hash is wrong; copy it again, or build the set again",
                    description.address.c_str());
}

// The layer that a kind of pages belongs to.
std::uint32_t layer_of(storage::PageKind kind) {
  switch (kind) {
    case storage::PageKind::kDistance:
      return kDistanceLayer;
    case storage::PageKind::kField:
      return kFieldLayer;
    case storage::PageKind::kAttributes:
      return kAttributeLayer;
    case storage::PageKind::kCaps:
    case storage::PageKind::kMask:
      break;
  }
  return kSideLayer;
}

Issue issue_of(const char* message) {
  return {IssueCode::kSet, Error::kNowhere, Error::kNowhere, message};
}

// What is wrong with a member, after its box.
const char* fault_word(const std::optional<Error>& fault) {
  if (!fault) return "";
  if (fault->code == ErrorCode::kNotFound) return "; missing";
  const bool is_damaged =
      fault->code == ErrorCode::kDamaged || fault->code == ErrorCode::kTruncated;
  return is_damaged ? "; damaged" : "; cannot be read";
}

std::string corner_text(const double (&corner)[3]) {
  return fmt::format("{:.6g} {:.6g} {:.6g}", corner[0], corner[1], corner[2]);
}

}  // namespace

std::optional<SetSurvey> SetSurvey::of(const FileParts& parts, bool hashes) {
  const storage::SetSource* const set = parts.set();
  if (!set) return {};
  SetSurvey survey;
  const storage::SetDescription& description = set->description();
  survey.content_id_ = description.content_id;
  for (std::size_t i = 0; i < description.members.size(); ++i)
    survey.members_.push_back({description.members[i], fault_of(*set, i, hashes)});
  return survey;
}

void SetSurvey::add_issues(FileParts& parts) const {
  for (const Member& member : members_)
    if (member.fault) parts.add_issue(Issue::from(IssueCode::kSet, *member.fault));
  if (parts.page_count() == 0) return;
  const storage::FileHeader& header = *parts.header();
  if (content_id_ != storage::Hash128{header.content_id[0], header.content_id[1]})
    parts.add_issue(issue_of("the content id of the set file is not that of the first member"));
  if (!counts_pages(parts))
    parts.add_issue(issue_of("the set file counts pages in members that do not have them"));
}

// Each page is in the member in which the set file counts it.
bool SetSurvey::counts_pages(const FileParts& parts) const {
  std::uint64_t page = 0, end = 0;
  for (const Member& member : members_) {
    end += member.description.bytes;
    page += member.description.pages;
    if (page > parts.page_count()) return false;
    if (page > 0) {
      const storage::PageEntry& last = parts.entries()[page - 1];
      if (last.offset + last.stored_bytes > end) return false;
    }
    if (page < parts.page_count() && parts.entries()[page].offset < end) return false;
  }
  return page == parts.page_count();
}

std::vector<std::uint32_t> SetSurvey::layers(const FileParts& parts) const {
  std::vector<std::uint32_t> layers;
  std::uint64_t page = 0;
  for (const Member& member : members_) {
    std::uint32_t found = 0;
    const std::uint64_t end =
        std::min<std::uint64_t>(page + member.description.pages, parts.page_count());
    for (; page < end; ++page)
      found |= layer_of(parts.header()->kind_of(static_cast<std::uint32_t>(page)));
    layers.push_back(found);
  }
  return layers;
}

Json SetSurvey::json(const FileParts& parts) const {
  Json list = Json::array();
  const std::vector<std::uint32_t> layers = this->layers(parts);
  for (std::size_t i = 0; i < members_.size(); ++i) {
    const storage::SetMember& member = members_[i].description;
    Json json = {{"address", member.address},
                 {"bytes", member.bytes},
                 {"pages", member.pages},
                 {"layers", layers[i] == 0 ? std::vector<std::string>() : layer_words(layers[i])},
                 {"box", nullptr},
                 {"fault", nullptr}};
    if (member.box) json["box"] = {member.box->lower, member.box->upper};
    if (members_[i].fault) json["fault"] = members_[i].fault->text;
    list.push_back(std::move(json));
  }
  return list;
}

std::string SetSurvey::text(const FileParts& parts) const {
  std::string text;
  const std::vector<std::uint32_t> layers = this->layers(parts);
  for (std::size_t i = 0; i < members_.size(); ++i) {
    const storage::SetMember& member = members_[i].description;
    const std::string pages =
        member.pages == 0
            ? "headers and directory"
            : fmt::format("{} pages: {}", grouped_count(member.pages), layers_text(layers[i]));
    const std::string box = member.box
                                ? fmt::format("; box {} to {}", corner_text(member.box->lower),
                                              corner_text(member.box->upper))
                                : std::string();
    text += fmt::format("  member {:<4} {}, {}, {}{}{}\n", i, member.address,
                        short_bytes(member.bytes), pages, box, fault_word(members_[i].fault));
  }
  return text;
}

}  // namespace planetree::tools
