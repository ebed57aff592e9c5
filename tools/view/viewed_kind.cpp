#include "tools/view/viewed_kind.h"

#include <iterator>
#include <string_view>

#include "storage/file/file_layout.h"
#include "tools/cli/input_file.h"

namespace planetree::tools {

Result<ViewedKind> viewed_kind(const std::filesystem::path& file) {
  auto input = InputFile::open(file.string());
  if (!input) return input.error();
  constexpr std::size_t kFrontBytes = 4096;
  const auto front = input->front(kFrontBytes);
  if (!front) return front.error();
  const std::string_view magic(reinterpret_cast<const char*>(storage::kMagic),
                               std::size(storage::kMagic));
  if (front->starts_with(magic)) return ViewedKind::kModel;
  const std::size_t first = front->find_first_not_of(" \t\r\n");
  if (first != std::string_view::npos && (*front)[first] == '{') return ViewedKind::kScene;
  // A damaged file of either kind: what reads it says what is wrong.
  const std::string extension = lower_extension(file);
  if (extension == ".json") return ViewedKind::kScene;
  if (extension == ".ptree") return ViewedKind::kModel;
  return make_error(ErrorCode::kBadInput, Error::kNowhere, Error::kNowhere,
                    "it is neither a .ptree file nor a scene file; give a file that planetree "
                    "build wrote, or a scene as format-spec/scene-v1/spec.md specifies it");
}

}  // namespace planetree::tools
