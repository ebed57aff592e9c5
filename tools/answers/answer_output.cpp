#include "tools/answers/answer_output.h"

#include <span>

namespace planetree::tools {

Result<AnswerOutput> AnswerOutput::open(const std::filesystem::path& path, bool may_replace,
                                        Console& console) {
  AnswerOutput output(console);
  if (path == "-") return output;
  auto file = OutputFile::create(path, may_replace);
  if (!file) return file.error();
  output.file_.emplace(*std::move(file));
  return output;
}

Result<bool> AnswerOutput::write(std::string_view text) {
  if (!file_) return console_->print(text);
  if (const auto written = file_->write(std::as_bytes(std::span(text))); !written)
    return written.error();
  return true;
}

Result<void> AnswerOutput::commit() { return file_ ? file_->commit() : Result<void>{}; }

}  // namespace planetree::tools
