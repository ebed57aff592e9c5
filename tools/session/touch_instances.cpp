#include "tools/session/touch_instances.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <numeric>

#include "octree/builder/mesh/stream/mesh_text.h"
#include "tools/cli/size_text.h"
#include "tools/html/html_page.h"
#include "tools/html/html_table.h"
#include "tools/html/html_text.h"

namespace planetree::tools {
namespace {

/// Limits of what people read, and of the size of a page.
constexpr std::size_t kMaxLines = 10, kMaxRows = 100;

double percent_of_ticks(std::uint64_t ticks, const TouchOutcome& outcome) {
  const std::size_t all = std::max<std::size_t>(outcome.record.ticks.size(), 1);
  return 100 * static_cast<double>(ticks) / static_cast<double>(all);
}

std::size_t moving_instances(const TouchOutcome& outcome) {
  return static_cast<std::size_t>(std::ranges::count_if(
      outcome.instances, [](const TouchInstance& each) { return each.moves; }));
}

}  // namespace

std::size_t position_of(InstanceId id, std::span<const TouchInstance> instances) {
  const auto found = std::ranges::lower_bound(instances, id, {}, &TouchInstance::id);
  const bool is_there = found != instances.end() && found->id == id;
  return is_there ? static_cast<std::size_t>(found - instances.begin()) : instances.size();
}

InstanceTally::InstanceTally(const TouchOutcome& outcome) : ticks_(outcome.instances.size()) {
  for (const Tick& tick : outcome.record.ticks) {
    const std::size_t position = position_of(tick.instance, outcome.instances);
    ++(position < ticks_.size() ? ticks_[position] : none_);
  }
}

std::vector<std::size_t> InstanceTally::leading(std::size_t most) const {
  std::vector<std::size_t> positions(ticks_.size());
  std::iota(positions.begin(), positions.end(), std::size_t{0});
  std::erase_if(positions, [this](std::size_t position) { return ticks_[position] == 0; });
  std::ranges::stable_sort(positions, std::ranges::greater(),
                           [this](std::size_t position) { return ticks_[position]; });
  if (positions.size() > most) positions.resize(most);
  return positions;
}

nlohmann::ordered_json instances_json(const TouchOutcome& outcome) {
  const InstanceTally tally(outcome);
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (std::size_t i = 0; i < outcome.instances.size(); ++i) {
    const TouchInstance& instance = outcome.instances[i];
    list.push_back({{"name", instance.name},
                    {"model", instance.model},
                    {"moves", instance.moves},
                    {"ticks", tally.ticks()[i]}});
  }
  return list;
}

std::string instances_words(const TouchArguments& arguments, const TouchOutcome& outcome) {
  const InstanceTally tally(outcome);
  const char* const role = arguments.radius > 0 ? "stopped the ball" : "nearest";
  std::string text =
      fmt::format("{} instances, of which {} move\n", grouped_count(outcome.instances.size()),
                  grouped_count(moving_instances(outcome)));
  std::uint64_t rest = outcome.record.ticks.size() - tally.none();
  const std::vector<std::size_t> leading = tally.leading(kMaxLines);
  for (const std::size_t position : leading) {
    const TouchInstance& instance = outcome.instances[position];
    const std::uint64_t ticks = tally.ticks()[position];
    rest -= ticks;
    text += fmt::format("  instance {}{}, of {}: {} in {} ticks ({:.1f} %)\n", position,
                        instance.name.empty() ? "" : ' ' + octree::printable(instance.name),
                        octree::printable(instance.model), role, grouped_count(ticks),
                        percent_of_ticks(ticks, outcome));
  }
  if (rest > 0)
    text += fmt::format("  other instances: {} in {} ticks\n", role, grouped_count(rest));
  if (tally.none() > 0)
    text += fmt::format("  no instance: {} ticks\n", grouped_count(tally.none()));
  return text;
}

std::string instances_section(const TouchArguments& arguments, const TouchOutcome& outcome) {
  const InstanceTally tally(outcome);
  HtmlTable table{arguments.radius > 0 ? "Ticks in which an instance stopped the ball."
                                       : "Ticks in which an instance was the nearest.",
                  {{"", "instance"},
                   {"", "name", HtmlColumn::Kind::kText},
                   {"", "model", HtmlColumn::Kind::kText},
                   {"", "ticks"},
                   {"", "share, %"},
                   {"", "moves", HtmlColumn::Kind::kText}},
                  {}};
  const std::vector<std::size_t> leading = tally.leading(kMaxRows);
  for (const std::size_t position : leading) {
    const TouchInstance& instance = outcome.instances[position];
    const std::uint64_t ticks = tally.ticks()[position];
    table.rows.push_back(
        {"",
         false,
         "",
         {grouped_count(position), octree::printable(instance.name),
          octree::printable(instance.model), grouped_count(ticks),
          number_text(percent_of_ticks(ticks, outcome)), instance.moves ? "yes" : "no"}});
  }
  std::string text =
      fmt::format("{} of {} instances move. The table has {} of those that answered",
                  grouped_count(moving_instances(outcome)), grouped_count(outcome.instances.size()),
                  grouped_count(leading.size()));
  text += tally.none() > 0 ? fmt::format("; {} ticks had no instance.", grouped_count(tally.none()))
                           : std::string(".");
  return section_html("Instances", paragraph_html(text) + table_html(table));
}

}  // namespace planetree::tools
