#pragma once

#include <string>

#include "planetree/stats.h"
#include "tools/session/session.h"
#include "tools/session/touch_arguments.h"
#include "tools/trace_file/prefetch_figures.h"

namespace planetree::tools {

/// Report of a session, as one JSON object or as text. Simulated sessions have no times of queries
/// and nothing of the machine.
///
/// prefetch  what became of prefetched pages; null: there was no trace
std::string touch_json(const TouchArguments& arguments, const TouchRecord& record,
                       const Stats& stats, const PrefetchFigures* prefetch);
std::string touch_words(const TouchArguments& arguments, const TouchRecord& record,
                        const Stats& stats, const PrefetchFigures* prefetch);

}  // namespace planetree::tools
