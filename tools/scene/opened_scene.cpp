#include "tools/scene/opened_scene.h"

#include <algorithm>
#include <cinttypes>
#include <utility>

#include "query/file/scene_frames.h"
#include "storage/file/page_file.h"
#include "storage/set/open_model.h"
#include "tools/cli/layer_option.h"

namespace planetree::tools {

Result<SceneOptions> options_for(const SceneDescription& description, const SceneOptions& wanted,
                                 std::filesystem::path& failed_file) {
  SceneOptions options = wanted;
  options.max_probes = 1;
  options.max_instances = static_cast<std::uint32_t>(description.instances.size());
  options.max_page_bytes = 4096;
  for (const ModelDescription& model : description.models) {
    auto source = storage::open_model_source(model.file);
    const auto file = source ? storage::PageFile::open(*std::move(source))
                             : Result<storage::PageFile>(source.error());
    if (!file) {
      failed_file = model.file;
      return file.error();
    }
    options.max_page_bytes =
        std::max(options.max_page_bytes, query::frame_bytes_for(file->header()));
  }
  return options;
}

std::optional<OpenedScene> OpenedScene::open(const SceneDescription& description,
                                             const std::filesystem::path& file,
                                             const SceneOptions& wanted, SceneFailure& failure) {
  failure.file = file;
  const auto options = options_for(description, wanted, failure.file);
  if (!options) {
    failure.error = options.error();
    return std::nullopt;
  }
  auto scene = Scene::create(*options);
  if (!scene) {
    failure.error = scene.error();
    return std::nullopt;
  }
  OpenedScene opened{*std::move(scene), {}};
  for (const InstanceDescription& instance : description.instances) {
    const ModelDescription& model = description.models[instance.model];
    failure.file = model.file;
    const auto id = opened.scene.add(model.file, instance.pose, model.layers);
    if (!id) {
      failure.error = id.error();
      return std::nullopt;
    }
    opened.ids.push_back(*id);
    if (const auto posed = opened.scene.set_pose(*id, instance.pose, instance.twist); !posed) {
      failure = {file, posed.error()};
      return std::nullopt;
    }
  }
  return opened;
}

std::size_t OpenedScene::index_of(InstanceId id) const {
  const auto found = std::ranges::lower_bound(ids, id);
  const bool is_there = found != ids.end() && *found == id;
  return is_there ? static_cast<std::size_t>(found - ids.begin()) : ids.size();
}

std::uint32_t parts_told_by(const SceneDescription& description, const OpenedScene& opened,
                            std::size_t index) {
  const ModelDescription& model = description.models[description.instances[index].model];
  return parts_told(**opened.scene.info(opened.ids[index]), model.layers);
}

std::optional<Error> scene_pages_lost(std::uint64_t quarantined_pages) {
  if (quarantined_pages == 0) return std::nullopt;
  return make_error(ErrorCode::kDamaged, Error::kNowhere, Error::kNowhere,
                    "%" PRIu64
                    " pages of its models are unreadable, so that answers are degraded; planetree "
                    "verify finds the file",
                    quarantined_pages);
}

}  // namespace planetree::tools
