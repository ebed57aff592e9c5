#include "storage/file/model_output.h"

#include <utility>

#include "storage/system/new_file.h"

namespace planetree::storage {
namespace {

class NewModelFile final : public ModelOutput {
 public:
  explicit NewModelFile(NewFile file) noexcept : file_(std::move(file)) {}

  Result<void> begin(std::uint64_t /*pages_start*/) override { return {}; }
  Result<void> write_at(std::uint64_t offset, std::span<const std::byte> bytes) override {
    return file_.write_at(offset, bytes);
  }
  Result<void> commit(const FileHeader& /*header*/,
                      std::span<const DirectoryPage> /*pages*/) override {
    return file_.commit();
  }

 private:
  NewFile file_;
};

}  // namespace

Result<std::unique_ptr<ModelOutput>> new_model_file(const std::filesystem::path& path, bool replace,
                                                    FileCalls& calls) {
  Result<NewFile> file = NewFile::create(path, replace, calls);
  if (!file) return file.error();
  return std::unique_ptr<ModelOutput>(new NewModelFile(*std::move(file)));
}

}  // namespace planetree::storage
