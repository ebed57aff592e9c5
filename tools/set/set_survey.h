#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "planetree/error.h"
#include "storage/set/set_description.h"
#include "tools/check/file_parts.h"
#include "tools/check/issue.h"

namespace planetree::tools {

/// The members of a set, and what is wrong with them.
class SetSurvey {
 public:
  /// Looks for the members. Returns nothing if `parts` are those of a file rather than a set.
  ///
  /// hashes  whether to read all members and compare their hashes
  static std::optional<SetSurvey> of(const FileParts& parts, bool hashes);

  /// Adds to the issues of `parts`, the set as a file: members that are missing or damaged, and
  /// where the set file is not that of the file.
  void add_issues(FileParts& parts) const;
  /// A list of objects, with the layers whose pages a member has.
  nlohmann::ordered_json json(const FileParts& parts) const;
  /// A line for each member.
  std::string text(const FileParts& parts) const;

 private:
  struct Member {
    storage::SetMember description;
    std::optional<Error> fault;
  };

  bool counts_pages(const FileParts& parts) const;
  std::vector<std::uint32_t> layers(const FileParts& parts) const;

  storage::Hash128 content_id_{};
  std::vector<Member> members_;
};

}  // namespace planetree::tools
