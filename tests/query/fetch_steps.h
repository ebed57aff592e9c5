#pragma once

#include <atomic>
#include <memory>

#include "query/model_state.h"
#include "query/probe_state.h"
#include "query/serve/fetch_threads.h"

namespace planetree::query {

/// A clock that stands still: nothing moves.
inline FetchWorker::Seconds still_time() { return FetchWorker::Seconds(0); }

/// The worker of a fetch thread that serves all probes of a model, for a test that takes its
/// steps. The model was opened without fetch threads.
inline FetchWorker fetch_worker(const ModelState& model, FetchWorker::Clock clock,
                                const std::atomic<bool>& stop) {
  return {model.serving().arena.fetch_requests,
          std::make_unique<QueryingFetchProbe>(model.serving(), *model.claim_reader()),
          0,
          1,
          clock,
          stop};
}

}  // namespace planetree::query
