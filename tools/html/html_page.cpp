#include "tools/html/html_page.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "tools/html/html_text.h"
#include "tools/html/page_script.h"
#include "tools/html/page_style.h"

namespace planetree::tools {
namespace {

constexpr const char* kPolicy =
    "default-src 'none'; style-src 'unsafe-inline'; script-src 'unsafe-inline'";

std::string figures_json(const HtmlPage& page) {
  auto json = nlohmann::ordered_json::object();
  for (const auto& [key, figures] : page.figures)
    json[key] = {{"title", figures.title}, {"values", figures.values}};
  return script_json(json);
}

}  // namespace

std::string page_html(const HtmlPage& page) {
  const std::string title = html_text(page.title), kind = html_text(page.kind);
  return fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta http-equiv=\"Content-Security-Policy\" content=\"{}\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
      "<meta name=\"color-scheme\" content=\"light dark\">\n"
      "<title>{} - {}</title>\n<style>\n{}</style>\n</head>\n<body>\n<main>\n"
      "<header><p class=\"kind\">{}</p><h1><bdi>{}</bdi></h1></header>\n{}</main>\n"
      "<script type=\"application/json\" id=\"figures\">{}</script>\n<script>\n{}</script>\n"
      "</body>\n</html>\n",
      kPolicy, title, kind, kPageStyle, kind, title, page.body, figures_json(page), kPageScript);
}

std::string paragraph_html(const std::string& text) {
  return fmt::format("<p>{}</p>\n", html_text(text));
}

std::string section_html(const std::string& heading, const std::string& html) {
  return fmt::format("<section>\n<h2>{}</h2>\n{}</section>\n", html_text(heading), html);
}

std::string row_of_plots_html(const std::string& html) {
  return fmt::format("<div class=\"plots\">\n{}</div>\n", html);
}

std::string plot_cell_html(const std::string& html) { return "<div>\n" + html + "</div>\n"; }

std::string facts_html(const HtmlFigures& facts) {
  std::string html = fmt::format("<dl class=\"facts\" aria-label=\"{}\">", html_text(facts.title));
  for (const auto& [name, value] : facts.values)
    html += fmt::format("<div><dt>{}</dt><dd>{}</dd></div>", html_text(name), html_text(value));
  return html + "</dl>\n";
}

std::string command_html(const std::string& purpose, const std::string& command) {
  return fmt::format(
      "<p class=\"purpose\">{}</p>\n<pre class=\"command\" tabindex=\"0\"><code>{}"
      "</code></pre>\n",
      html_text(purpose), html_text(command));
}

}  // namespace planetree::tools
