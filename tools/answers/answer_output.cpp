#include "tools/answers/answer_output.h"

#include <span>
#include <system_error>

namespace planetree::tools {

Result<AnswerOutput> AnswerOutput::open(const std::filesystem::path& path, bool may_replace,
                                        Console& console) {
  AnswerOutput output(console);
  if (path == "-") return output;
  auto file = OutputFile::create(path, may_replace);
  if (!file) return file.error();
  output.file_.emplace(*std::move(file));
  output.folder_ = path.has_parent_path() ? path.parent_path() : ".";
  return output;
}

Result<bool> AnswerOutput::write(std::string_view text) {
  if (!file_) return console_->print(text);
  if (const auto written = file_->write(std::as_bytes(std::span(text))); !written)
    return written.error();
  return true;
}

Result<void> AnswerOutput::rewrite_front(std::string_view text) {
  return file_->rewrite_front(std::as_bytes(std::span(text)));
}

std::filesystem::path AnswerOutput::temporary_folder() const {
  if (can_rewrite()) return folder_;
  std::error_code none;
  const std::filesystem::path folder = std::filesystem::temp_directory_path(none);
  return none ? "/tmp" : folder;
}

Result<void> AnswerOutput::commit() { return file_ ? file_->commit() : Result<void>{}; }

}  // namespace planetree::tools
