#include "tools/report/show_bounds.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <string>

#include "octree/builder/mesh/stream/mesh_text.h"
#include "tools/cli/input_file.h"
#include "tools/cli/progress.h"
#include "tools/report/bounds_export.h"

namespace planetree::tools {
namespace {

std::string bounds_report(const BoundsArguments& arguments, const BoundsExport& found) {
  if (arguments.json)
    return json_line({{"bounds", arguments.output.string()},
                      {"level", arguments.level},
                      {"node_discs", found.node_discs},
                      {"block_discs", found.block_discs},
                      {"boxes", found.boxes},
                      {"vertices", found.vertices},
                      {"faces", found.faces},
                      {"bytes", found.bytes}});
  return fmt::format("{}: level {}, {} discs of nodes, {} of blocks, {} boxes\n",
                     arguments.output.string(), arguments.level, found.node_discs,
                     found.block_discs, found.boxes);
}

}  // namespace

std::string bounds_complaint(const std::string& path) {
  if (path == "-" || lower_extension(path) == ".ply") return {};
  return fmt::format("'{}' is not a .ply; give a name that ends so", octree::printable(path));
}

int show_bounds(const BoundsArguments& arguments, Console& console) {
  const std::string file = arguments.file.string(), output = arguments.output.string();
  auto parts = FileParts::open(arguments.file);
  if (!parts) return console.fail(file, parts.error());
  auto written = OutputFile::create(arguments.output, arguments.may_replace);
  if (!written) return console.fail(output, written.error());
  Progress progress(arguments.quiet, arguments.json);
  progress.start("reading", std::uint64_t{3} * parts->first_cap_page(), "pages");
  std::uint32_t last = 0;
  const auto exported = export_bounds(*parts, static_cast<std::uint32_t>(arguments.level), *written,
                                      [&](std::uint32_t page) {
                                        progress.add(page > last ? page - last : 0);
                                        last = page;
                                      });
  progress.finish();
  if (!exported) return console.fail(file, exported.error());
  if (!exported->written) return console.fail(output, exported->written.error());
  const std::string report = bounds_report(arguments, *exported);
  if (arguments.output == "-")
    console.note(report);
  else
    console.print(report);
  return console.finish(kDone);
}

}  // namespace planetree::tools
