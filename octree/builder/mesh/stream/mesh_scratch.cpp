#include "octree/builder/mesh/stream/mesh_scratch.h"

#include <system_error>

namespace planetree::octree {
namespace {

// Empty if the system names none. Creating a temporary file then reports the error.
std::filesystem::path temporary_directory() {
  std::error_code ignored;
  return std::filesystem::temp_directory_path(ignored);
}

}  // namespace

MeshScratch::MeshScratch(std::uint64_t memory_bytes)
    : MeshScratch(memory_bytes, temporary_directory()) {}

}  // namespace planetree::octree
