#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "planetree/stats.h"
#include "tools/session/session.h"
#include "tools/session/touch_arguments.h"
#include "tools/trace_file/prefetch_figures.h"

namespace planetree::tools {

/// Report of a session, as a JSON object, as its line and as text. Simulated sessions have no times
/// of queries and nothing of the machine.
///
/// prefetch  what became of prefetched pages; null: there was no trace
nlohmann::ordered_json touch_report(const TouchArguments& arguments, const TouchRecord& record,
                                    const Stats& stats, const PrefetchFigures* prefetch);
std::string touch_json(const TouchArguments& arguments, const TouchRecord& record,
                       const Stats& stats, const PrefetchFigures* prefetch);
std::string touch_words(const TouchArguments& arguments, const TouchRecord& record,
                        const Stats& stats, const PrefetchFigures* prefetch);

}  // namespace planetree::tools
