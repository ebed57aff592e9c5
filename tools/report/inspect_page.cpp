#include "tools/report/inspect_page.h"

#include "tools/cli/shell_word.h"
#include "tools/html/html_page.h"
#include "tools/report/inspect_facts.h"
#include "tools/report/inspect_sections.h"

namespace planetree::tools {

std::string inspect_page(const InspectRecord& record, const std::string& command) {
  HtmlPage page;
  page.kind = "planetree inspect: contents of a file";
  page.title = record.file;
  page.body = facts_html(inspect_facts(record)) + issues_section(record);
  // Without a whole header nothing else can be read.
  if (record.summary.contains("triangles"))
    page.body += surface_section(record) + bytes_section(record, page) + memory_section(record) +
                 tree_section(record, page) + mask_section(record, page) +
                 pages_section(record, page);
  page.body += section_html("Command", command_html("To make this page again", command));
  return page_html(page);
}

std::string inspect_command(const std::filesystem::path& file, const std::filesystem::path& html) {
  return "planetree inspect " + shell_word(file.string()) + " --html " + shell_word(html.string()) +
         (html == "-" ? "" : " --force");
}

}  // namespace planetree::tools
