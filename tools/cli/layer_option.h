#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "planetree/layers.h"
#include "planetree/model.h"
#include "planetree/types.h"
#include "tools/cli/subcommand_options.h"

namespace planetree::tools {

/// Returns the layers in a list of their words, such as "distance,side", with the distance layer. 0
/// if it is no such list.
std::uint32_t layers_of(const std::string& text);

/// Returns the words of layers, in the order distance, side, field, attributes.
std::vector<std::string> layer_words(std::uint32_t layers);
/// The same as text, with commas.
std::string layers_text(std::uint32_t layers);

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
