#pragma once

#include "tests/layering/source_text.h"

#include <string>
#include <string_view>
#include <vector>

/// Names of types that the linker sees. Two types of one name make undefined programs, without any
/// message: the linker takes the functions of one for both.
namespace planetree::layering {

/// The classes, structs, unions and enums that have a body in `text`, with their namespaces:
/// "planetree::tools::Console". Types in anonymous namespaces, in other types and in functions are
/// left out, and so are specializations.
std::vector<std::string> types_with_bodies(std::string_view text);

/// One line for each type that has a body in more than one source, with the paths.
std::vector<std::string> types_in_several(const std::vector<SourceText>& sources);

}  // namespace planetree::layering
