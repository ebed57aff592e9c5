#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "planetree/attributes.h"
#include "tools/cli/subcommand_options.h"

/// Attributes of triangles as words: triangles, color, uv and value.
namespace planetree::tools {

/// Returns the attributes that a list of words with commas names; 0 if it is none.
std::uint32_t attributes_of(const std::string& text);
/// Returns the words of attributes.
std::vector<std::string> attribute_words(std::uint32_t attributes);
/// Returns "unsigned", "signed" or "real".
std::string value_kind_text(ValueKind kind);

/// Declares --keep and --value.
void add_keep(SubcommandOptions& subcommand, std::uint32_t& keep, std::string& value_property);

}  // namespace planetree::tools
