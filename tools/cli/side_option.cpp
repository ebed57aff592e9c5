#include "tools/cli/side_option.h"

#include <string>

namespace planetree::tools {

SubcommandOptions::Option add_side(SubcommandOptions& subcommand, SideRule& rule) {
  return subcommand.default_text(
      subcommand.word(
          "--side", {name_of(SideRule::kSolid), name_of(SideRule::kSurface)},
          [&rule](const std::string& name) {
            rule = name == name_of(SideRule::kSolid) ? SideRule::kSolid : SideRule::kSurface;
          },
          "solid: a point is inside by its winding number; surface: inside means behind the "
          "nearest face, edge or vertex, as its normal points, for terrains and other open sheets"),
      "as the file says");
}

const char* name_of(SideRule rule) { return rule == SideRule::kSurface ? "surface" : "solid"; }

}  // namespace planetree::tools
