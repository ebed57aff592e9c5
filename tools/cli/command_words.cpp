#include "tools/cli/command_words.h"

namespace planetree::tools {
namespace {

struct Rewording {
  std::string_view library, command;
};

// Longer phrases precede those that are part of them.
constexpr Rewording kRewordings[] = {
    {"a memory budget of ", "--memory of "},
    {", or lower max_probes", ""},
    {"raise the memory budget by them, or remove a file", "raise --memory by them"},
    {"raise the memory budget", "raise --memory"},
    {"lower the memory budget", "lower --memory"},
    {"free memory or lower fetch_threads", "free memory"},
    {"lower batch_threads", "give fewer --threads"},
    {"open it with kAttributeLayer", "add attributes to --layers"},
    {"see Stats::quarantined_pages", "see planetree verify"}};

}  // namespace

std::string in_command_words(std::string_view text) {
  std::string words(text);
  for (const Rewording& each : kRewordings)
    if (const std::size_t at = words.find(each.library); at != std::string::npos)
      words.replace(at, each.library.size(), each.command);
  return words;
}

}  // namespace planetree::tools
