#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "tools/check/file_parts.h"
#include "tools/report/file_survey.h"

/// Reports of pages for `inspect`. Names are those of the tables in format-spec.
namespace planetree::tools {

/// The heading for lines of page_line().
[[nodiscard]] std::string page_heading();
[[nodiscard]] std::string page_line(const PageRow& row);
[[nodiscard]] nlohmann::ordered_json page_json(const PageRow& row);

/// Table entry, head, streams and nodes of the page that `parts` has read last. Without `decoded`
/// there are no nodes.
[[nodiscard]] nlohmann::ordered_json page_details(const FileParts& parts, const PageRow& row,
                                                  bool decoded);

/// The text form of page_details(): a line for each name and value, a table for each list.
[[nodiscard]] std::string page_details_text(const nlohmann::ordered_json& details);

/// The nodes of the page decoded last: all, or roots of subtrees only. Boxes and discs are in the
/// model frame, relative to the model's centre.
[[nodiscard]] nlohmann::ordered_json nodes_json(const FileParts& parts, bool roots_only);
[[nodiscard]] std::string nodes_text(const nlohmann::ordered_json& nodes);

}  // namespace planetree::tools
