#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "tools/check/file_parts.h"
#include "tools/report/file_survey.h"

/// Pages as `inspect` shows them. Names are those of the tables in format-spec.
namespace planetree::tools {

/// The heading of the lines that page_line() gives.
[[nodiscard]] std::string page_heading();
[[nodiscard]] std::string page_line(const PageRow& row);
[[nodiscard]] nlohmann::ordered_json page_json(const PageRow& row);

/// Everything about the page that `parts` has read last: its table entry, its
/// head, its streams and its nodes. Without `decoded` there are no nodes.
[[nodiscard]] nlohmann::ordered_json page_details(const FileParts& parts, const PageRow& row,
                                                  bool decoded);

/// The same for people: a line for each name and value, a table for each list.
[[nodiscard]] std::string page_details_text(const nlohmann::ordered_json& details);

/// The nodes of the page decoded last: all, or only roots of subtrees. Boxes
/// and planes are relative to the model's centre, in the model frame.
[[nodiscard]] nlohmann::ordered_json nodes_json(const FileParts& parts, bool roots_only);
[[nodiscard]] std::string nodes_text(const nlohmann::ordered_json& nodes);

}  // namespace planetree::tools
