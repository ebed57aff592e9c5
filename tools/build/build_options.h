#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "planetree/build.h"
#include "tools/cli/attribute_option.h"
#include "tools/cli/subcommand_options.h"

/// Options of subcommands that build. The references must stay valid until the command line is
/// parsed.
namespace planetree::tools {

/// Values that are read from the command line before they become options.
struct BuildOptionTexts {
  std::uint64_t threads = 0;
  std::uint64_t page_bytes = BuildOptions{}.page_bytes;
  std::vector<std::string> metadata;
  bool set = false;
  std::uint64_t member_bytes = std::uint64_t{4} << 30;
};

/// --threads and --memory, on which no byte of the file depends.
void add_resources(SubcommandOptions& subcommand, BuildOptions& options, BuildOptionTexts& texts);
/// --set and --member-size.
void add_set(SubcommandOptions& subcommand, BuildOptionTexts& texts);
/// Sets the options that add_set() read. Returns a complaint, or an empty text.
std::string take_set(const BuildOptionTexts& texts, const std::filesystem::path& output,
                     BuildOptions& options);
/// --box.
void add_box(SubcommandOptions& subcommand, BuildOptions& options);
/// --side, --layers, --keep, --page-size, --float64, --unit, --strict and the like: what the file
/// is to contain.
KeepOptions add_content(SubcommandOptions& subcommand, BuildOptions& options,
                        BuildOptionTexts& texts);

/// Sets the options that were read into `texts`. Returns a complaint, or an empty text.
std::string take_texts(const BuildOptionTexts& texts, const KeepOptions& keep,
                       BuildOptions& options);
/// As above, of a subcommand without add_content().
std::string take_texts(const BuildOptionTexts& texts, BuildOptions& options);

}  // namespace planetree::tools
