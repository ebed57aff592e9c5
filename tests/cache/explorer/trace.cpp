#include "tests/cache/explorer/trace.h"

namespace planetree::explorer {

std::string Trace::text() const {
  std::string text;
  for (const Line& line : lines_) {
    text += "  thread " + std::to_string(line.thread) + ": " + line.what + ' ' +
            std::to_string(line.number);
    if (line.how != nullptr) text += ", " + std::to_string(line.value) + ", " + line.how;
    if (line.newer_stores > 0) {
      text += " (" + std::to_string(line.newer_stores) + " newer there)";
    }
    text += '\n';
  }
  return text;
}

}  // namespace planetree::explorer
