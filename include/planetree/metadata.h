#pragma once

#include <functional>
#include <map>
#include <string>

/// @file
/// What a file says of its model beside the geometry.

namespace planetree {

/// Texts by key. A key has 1 to 64 letters, `a` to `z`, `0` to `9` and `_`. A value is UTF-8
/// without control characters. All together have at most 64 KiB. These keys have a meaning:
///
/// unit       unit of length of the mesh's coordinates: `m`, `mm`, `cm`, `km`, `um`, `in`, `ft`,
///            `us-ft` or another text
/// up         axis that points up: `x`, `y`, `z`, `-x`, `-y` or `-z`
/// crs        coordinate reference system of the mesh's coordinates, such as `EPSG:25832`, or WKT
/// title, description, licence, source
///            free text
/// generator  program that wrote the file, and its version
///
/// format-spec/v1/spec.md, Metadata, specifies how a file has them.
using Metadata = std::map<std::string, std::string, std::less<>>;

}  // namespace planetree
