#pragma once

#include <chrono>
#include <nlohmann/json.hpp>
#include <thread>

#include "tools/view/view_source.h"

namespace planetree::tools {

/// The answer of a source when all pages that it needs have come, or the last one of a minute.
inline nlohmann::json settled_answer(ViewSource& source, const PointQuestion& question) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::minutes(1);
  while (true) {
    nlohmann::json answer = nlohmann::json::parse(source.answer(question));
    const bool is_settled = answer["status"] == "exact" &&
                            (question.within == 0 || answer["contacts_complete"] == true);
    if (is_settled || std::chrono::steady_clock::now() >= end) return answer;
    std::this_thread::yield();
  }
}

}  // namespace planetree::tools
