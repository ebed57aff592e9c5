#pragma once

#include <cstdint>
#include <string>

#include "planetree/error.h"

namespace planetree::octree {

/// An error of the content of a glTF file.
inline Error gltf_error(const std::string& cause,
                        const char* remedy = "copy or export the glTF again") {
  return make_error(ErrorCode::kBadInput, Error::kNowhere, Error::kNowhere, "%s; %s", cause.c_str(),
                    remedy);
}

/// As above, at a byte of the file.
inline Error gltf_error_at(std::uint64_t offset, const std::string& cause,
                           const char* remedy = "copy or export the glTF again") {
  return make_error(ErrorCode::kBadInput, Error::kNowhere, offset, "byte %s: %s; %s",
                    std::to_string(offset).c_str(), cause.c_str(), remedy);
}

}  // namespace planetree::octree
