#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <vector>

#include "octree/page/frame.h"
#include "storage/file/file_layout.h"

namespace planetree::oracle {

/// Every page of a .ptree file, decoded, to inspect nodes and blocks as a traversal sees them. For
/// small files. A failure ends the program.
class TreePages {
 public:
  explicit TreePages(const std::filesystem::path& path);

  [[nodiscard]] const storage::ModelRecord& model() const { return model_; }
  [[nodiscard]] octree::Point centre() const {
    return {model_.centre[0], model_.centre[1], model_.centre[2]};
  }
  [[nodiscard]] std::size_t count() const { return frames_.size(); }
  [[nodiscard]] std::uint32_t root_link() const { return root_link_; }

  [[nodiscard]] const octree::Node& node(std::uint32_t link) const;
  [[nodiscard]] octree::BlockView block(std::uint32_t link) const;

  /// Calls `visit` with every node, parents first.
  void each_node(const std::function<void(const octree::Node&)>& visit) const;
  /// All triangles below a link, in the model frame.
  [[nodiscard]] std::vector<octree::Triangle> triangles(std::uint32_t link) const;

 private:
  struct Free {
    void operator()(std::byte* bytes) const { ::operator delete[](bytes, std::align_val_t{64}); }
  };
  [[nodiscard]] const std::byte* record(std::uint32_t link) const;

  storage::ModelRecord model_{};
  octree::BlockShape shape_;
  octree::LinkFormat links_ = octree::LinkFormat::numbered(storage::kMinPageBytes);
  std::uint32_t root_link_ = 0;
  std::vector<std::unique_ptr<std::byte[], Free>> frames_;
};

}  // namespace planetree::oracle
