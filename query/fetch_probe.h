#pragma once

#include <memory>
#include <utility>

#include "query/probe_state.h"
#include "query/serve/fetch_worker.h"

namespace planetree::query {

/// The probe of a fetch thread. It makes pages resident by running blocking queries.
class QueryingFetchProbe final : public FetchProbe {
 public:
  QueryingFetchProbe(const ServingModel& model, cache::Reader reader)
      : probe_(ProbeState::create(model, std::move(reader))) {}

  void fetch_pages(const Vec3& query, const QueryOptions& options, bool is_prefetch,
                   const std::atomic<bool>& stop) noexcept override {
    probe_->fetch_pages(query, options, is_prefetch, stop);
  }
  bool read_awaited_page() noexcept override { return probe_->reader().help(); }

 private:
  std::unique_ptr<ProbeState> probe_;
};

}  // namespace planetree::query
