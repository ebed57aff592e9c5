#include "tools/cli/layer_option.h"

#include <fmt/format.h>

#include "octree/builder/mesh/stream/mesh_text.h"

namespace planetree::tools {
namespace {

std::string complaint_of(const std::string& text) {
  if (layers_of(text) != 0) return {};
  return fmt::format(
      "'{}' is not a list of layers; give distance, side, field, attributes or several of them, "
      "with commas",
      octree::printable(text));
}

}  // namespace

SubcommandOptions::Option add_layers(SubcommandOptions& subcommand, std::uint32_t& layers,
                                     const std::string& help) {
  const auto take = [&layers](const std::string& text) { layers = layers_of(text); };
  return SubcommandOptions::default_text(
      subcommand.text("--layers", "LAYERS", complaint_of, take, help), layers_text(kAllLayers));
}

SubcommandOptions::Option add_open_layers(SubcommandOptions& subcommand, std::uint32_t& layers) {
  return add_layers(
      subcommand, layers,
      "Open only these layers of the file, to save memory and reads: distance (always "
      "opened), side (sides of solids), field (answers within an error, and degraded ones), "
      "attributes (what the file keeps of triangles), with commas between them. Without "
      "side, answers have the distance alone, unless "
      "the surface is a sheet");
}

std::uint32_t parts_told(const Model& model, SideRule rule) {
  return parts_told(model.info(), model.stats().layers, rule);
}

std::uint32_t parts_told(const ModelInfo& info, std::uint32_t layers, SideRule rule) {
  const bool is_sheet = rule == SideRule::kSurface ||
                        (rule == SideRule::kOfFile && info.side_rule == SideRule::kSurface);
  return is_sheet || (layers & info.layers & kSideLayer) != 0 ? kAllParts : kDistance;
}

}  // namespace planetree::tools
