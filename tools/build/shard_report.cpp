#include "tools/build/shard_report.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "tools/cli/file_text.h"
#include "tools/cli/size_text.h"
#include "tools/cli/subcommand.h"

namespace planetree::tools {
namespace {

std::string time_and_memory(const ShardRecord& record) {
  return fmt::format("in {:.1f} s, {} peak memory\n", record.seconds,
                     short_bytes(peak_resident_bytes()));
}

std::string file_of(const ShardRecord& record) {
  return (record.job / fmt::format("{}-{}", record.step, record.shard)).string();
}

}  // namespace

std::string plain_report(const ShardRecord& record, const ShardPlanReport& plan) {
  const std::uint64_t shards = plan.shards;
  return fmt::format(
      "{}: {} triangles in {} shard{}{}; map writes up to {} a shard, reduce about {}; {}",
      record.job.string(), grouped_count(plan.triangles), shards, shards == 1 ? "" : "s",
      plan.was_done ? ", planned before" : "", short_bytes(plan.sorted_bytes / shards),
      short_bytes(plan.built_bytes / shards), time_and_memory(record));
}

std::string plain_report(const ShardRecord& record, const ShardReport& done) {
  const bool built = record.step == "reduce";
  const std::string chunks =
      built ? fmt::format(" in {} chunk{}", grouped_count(done.chunks), done.chunks == 1 ? "" : "s")
            : std::string();
  const std::string bytes =
      done.was_done ? "done before" : short_bytes(done.bytes) + " " + time_and_memory(record);
  return fmt::format("{}: {} triangles {}{}, {}{}", file_of(record), grouped_count(done.triangles),
                     built ? "built" : "sorted", chunks, bytes, done.was_done ? "\n" : "");
}

std::string json_report(const ShardRecord& record, const ShardPlanReport& plan) {
  return json_line({{"step", record.step},
                    {"job", record.job.string()},
                    {"shards", plan.shards},
                    {"triangles", plan.triangles},
                    {"skipped", plan.skipped},
                    {"input_bytes", plan.input_bytes},
                    {"plan_bytes", plan.plan_bytes},
                    {"sorted_bytes", plan.sorted_bytes},
                    {"built_bytes", plan.built_bytes},
                    {"was_done", plan.was_done},
                    {"seconds", record.seconds},
                    {"peak_resident_bytes", peak_resident_bytes()}});
}

std::string json_report(const ShardRecord& record, const ShardReport& done) {
  return json_line({{"step", record.step},
                    {"job", record.job.string()},
                    {"shard", record.shard},
                    {"file", file_of(record)},
                    {"triangles", done.triangles},
                    {"chunks", done.chunks},
                    {"bytes", done.bytes},
                    {"was_done", done.was_done},
                    {"seconds", record.seconds},
                    {"peak_resident_bytes", peak_resident_bytes()}});
}

}  // namespace planetree::tools
