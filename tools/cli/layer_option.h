#pragma once

#include <cstdint>
#include <string>

#include "planetree/layers.h"
#include "planetree/model.h"
#include "planetree/types.h"
#include "tools/cli/layer_words.h"
#include "tools/cli/subcommand_options.h"

namespace planetree::tools {

/// Declares the option --layers, which sets `layers`. `help` says what the layers are for.
/// Returns the option.
SubcommandOptions::Option add_layers(SubcommandOptions& subcommand, std::uint32_t& layers,
                                     const std::string& help);
/// The same, of a subcommand that opens a model.
SubcommandOptions::Option add_open_layers(SubcommandOptions& subcommand, std::uint32_t& layers);

/// Returns the parts of answers that a model tells by a side rule: the distance alone if sides are
/// unknown because the side layer is not open, else all.
std::uint32_t parts_told(const Model& model, SideRule rule = SideRule::kOfFile);
/// The same of a model with these layers open, of those that its file has.
std::uint32_t parts_told(const ModelInfo& info, std::uint32_t layers,
                         SideRule rule = SideRule::kOfFile);

}  // namespace planetree::tools
