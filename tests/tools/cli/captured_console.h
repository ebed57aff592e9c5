#pragma once

#include <cstdio>
#include <cstdlib>
#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

#include "tools/cli/subcommand.h"
#include "tools/command.h"

namespace planetree::tools {

/// A console whose streams are in memory.
class CapturedConsole {
 public:
  explicit CapturedConsole(std::string_view input = {})
      : input_(std::tmpfile()),
        output_(open_memstream(&output_text_, &output_size_)),
        errors_(open_memstream(&error_text_, &error_size_)),
        console_(input_, output_, errors_) {
    std::fwrite(input.data(), 1, input.size(), input_);
    std::rewind(input_);
  }
  CapturedConsole(const CapturedConsole&) = delete;
  CapturedConsole& operator=(const CapturedConsole&) = delete;
  ~CapturedConsole() {
    for (std::FILE* stream : {input_, output_, errors_}) std::fclose(stream);
    std::free(output_text_);
    std::free(error_text_);
  }

  Console& console() { return console_; }
  std::string output() {
    std::fflush(output_);
    return {output_text_, output_size_};
  }
  std::string errors() {
    std::fflush(errors_);
    return {error_text_, error_size_};
  }

 private:
  char* output_text_ = nullptr;
  char* error_text_ = nullptr;
  std::size_t output_size_ = 0, error_size_ = 0;
  std::FILE* input_;
  std::FILE* output_;
  std::FILE* errors_;
  Console console_;
};

/// Result of a run of the command.
struct Outcome {
  int status = 0;
  std::string output;
  std::string errors;
};

/// Runs `planetree` with these arguments, in this process.
inline Outcome run(const std::vector<std::string>& arguments, std::string_view input = {}) {
  CapturedConsole captured(input);
  std::vector<const char*> argv = {"planetree"};
  for (const std::string& argument : arguments) argv.push_back(argument.c_str());
  argv.push_back(nullptr);
  Outcome result;
  result.status = run_command(static_cast<int>(argv.size()) - 1, argv.data(), captured.console());
  result.output = captured.output();
  result.errors = captured.errors();
  return result;
}

inline std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::size_t begin = 0;
  while (begin < text.size()) {
    const std::size_t end = text.find('\n', begin);
    lines.push_back(text.substr(begin, end - begin));
    begin = end == std::string::npos ? text.size() : end + 1;
  }
  return lines;
}

}  // namespace planetree::tools
