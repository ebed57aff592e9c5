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

/// The options of attributes on a command line.
struct KeepOptions {
  SubcommandOptions::Option keep, value;

  /// A complaint if options do not go together, or nothing. Once the command line is parsed.
  [[nodiscard]] std::string complaint(std::uint32_t kept) const;
};

/// Declares --keep and --value.
KeepOptions add_keep(SubcommandOptions& subcommand, std::uint32_t& keep,
                     std::string& value_property);

}  // namespace planetree::tools
