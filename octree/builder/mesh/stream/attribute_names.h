#pragma once

#include <string>

#include "octree/builder/mesh/stream/corner_attributes.h"
#include "planetree/error.h"

/// Attributes in messages.
namespace planetree::octree {

struct AttributeName {
  std::uint32_t attribute;
  const char* noun;    ///< "colours"
  const char* option;  ///< that keeps it
  const char* inputs;  ///< that have it
};

inline constexpr AttributeName kAttributeNames[] = {
    {kKeepColor, "colours", "--keep color", "PLY, OBJ or glTF"},
    {kKeepUv, "texture coordinates", "--keep uv", "PLY, OBJ or glTF"},
    {kKeepValue, "values of triangles", "--keep value", "PLY"}};

/// Refuses the first attribute of `keep`, if there is any.
/// input  that has none of them, such as "an STL".
inline Result<void> refuse_attributes(const std::string& input, std::uint32_t keep) {
  for (const AttributeName& name : kAttributeNames)
    if ((keep & name.attribute) != 0)
      return make_error(ErrorCode::kBadInput, Error::kNowhere, Error::kNowhere,
                        "%s has no %s that are read; give a %s for %s", input.c_str(), name.noun,
                        name.inputs, name.option);
  return {};
}

/// The error of a mesh without an attribute that its format can have.
/// attribute  one of kMeshAttributes.
/// cause      what was looked for.
inline Error missing_attribute(std::uint32_t attribute, const std::string& cause) {
  for (const AttributeName& name : kAttributeNames)
    if (name.attribute == attribute)
      return make_error(ErrorCode::kBadInput, Error::kNowhere, Error::kNowhere,
                        "no %s: %s; build the mesh without %s", name.noun, cause.c_str(),
                        name.option);
  return {};
}

}  // namespace planetree::octree
