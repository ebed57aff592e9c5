#include "tools/check/issue.h"

#include <fmt/format.h>

#include <array>
#include <nlohmann/json.hpp>

namespace planetree::tools {
namespace {

constexpr std::array<std::string_view, kIssueCodeCount> kNames = {"NOT_PLANETREE",
                                                                  "FORMAT_UNSUPPORTED",
                                                                  "FILE_LENGTH",
                                                                  "HEADER_LOST",
                                                                  "HEADER_COPY",
                                                                  "HEADER_FIELD",
                                                                  "DIRECTORY",
                                                                  "PAGE_ENTRY",
                                                                  "PAGE_READ",
                                                                  "PAGE_CHECKSUM",
                                                                  "PAGE_CODEC",
                                                                  "PAGE_STRUCTURE",
                                                                  "LINK_TARGET",
                                                                  "LINK_TWICE",
                                                                  "SUBTREE_UNLINKED",
                                                                  "SUBTREE_BOX",
                                                                  "ROOT_BOX",
                                                                  "HEIGHT",
                                                                  "COUNT",
                                                                  "TRIANGLE_RANGE",
                                                                  "TRIANGLE_TWICE",
                                                                  "VERTEX_OUTSIDE_BOX",
                                                                  "VERTEX_OUTSIDE_PLANES",
                                                                  "MOMENTS",
                                                                  "MODEL_BOX",
                                                                  "SAMPLE",
                                                                  "UNBALANCED_EDGES",
                                                                  "OPENNESS",
                                                                  "MASK_CORNER",
                                                                  "MASK_COLOUR",
                                                                  "MASK_PLANES",
                                                                  "MASK_BLOCKS",
                                                                  "MASK_SLAB",
                                                                  "BLOCK_HEIGHT_FIELD",
                                                                  "REGION",
                                                                  "CAPS",
                                                                  "FIELD",
                                                                  "ATTRIBUTES",
                                                                  "EXTENSION",
                                                                  "SET"};
static_assert(!kNames.back().empty());

}  // namespace

std::string_view issue_name(IssueCode code) { return kNames[static_cast<std::size_t>(code)]; }

Issue Issue::from(IssueCode code, const Error& error) {
  return {code, error.page, error.offset, error.text};
}

nlohmann::ordered_json issue_json(const Issue& issue) {
  nlohmann::ordered_json json = {{"code", issue_name(issue.code)}, {"page", nullptr}};
  if (issue.page != Error::kNowhere) json["page"] = issue.page;
  if (issue.offset != Error::kNowhere) json["offset"] = issue.offset;
  json["message"] = issue.message;
  return json;
}

std::string issue_text(const Issue& issue) {
  std::string text = fmt::format("{}: ", issue_name(issue.code));
  if (issue.page != Error::kNowhere) text += fmt::format("page {}", issue.page);
  if (issue.offset != Error::kNowhere)
    text += fmt::format("{}at byte {}", issue.page != Error::kNowhere ? ", " : "", issue.offset);
  if (issue.page != Error::kNowhere || issue.offset != Error::kNowhere) text += ": ";
  return text + issue.message;
}

}  // namespace planetree::tools
