#include "tools/scene.h"

#include <algorithm>
#include <chrono>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

#include "planetree/scene.h"
#include "tools/answer_tally.h"
#include "tools/answers/placed_point.h"
#include "tools/cli/input_file.h"
#include "tools/cli/parts_option.h"
#include "tools/cli/progress.h"
#include "tools/cli/subcommand_options.h"
#include "tools/points/row_reader.h"
#include "tools/scene/opened_scene.h"
#include "tools/scene/scene_description.h"
#include "tools/scene/scene_report.h"

namespace planetree::tools {
namespace {

constexpr std::size_t kChunkPoints = 4096;

int report(const SceneArguments& arguments, const SceneDescription& description,
           const OpenedScene& opened, Console& console) {
  std::vector<ModelShare> shares;
  SceneFailure failure;
  if (!measure_shares(description, opened, shares, failure))
    return console.fail(failure.file.string(), failure.error);
  const std::string file = arguments.file.string();
  console.print(arguments.json ? json_line(scene_json(file, description, opened, shares))
                               : scene_text(file, description, opened, shares));
  return console.finish(kDone);
}

/// Answers points in a scene.
class SceneRun {
 public:
  SceneRun(const SceneArguments& arguments, const OpenedScene& opened, SceneProbe& probe,
           Console& console)
      : arguments_(arguments),
        opened_(opened),
        probe_(probe),
        console_(console),
        progress_(arguments.quiet || (arguments.output == "-" && console.output_is_terminal()),
                  arguments.json),
        tally_(kPointShape) {}

  int run(PointReader& points, AnswerOutput& output) {
    const auto started = std::chrono::steady_clock::now();
    progress_.start("answering", 0, tally_.noun());
    AnswerWriter writer(output, arguments_.form);
    Result<bool> wanted = writer.begin(PlacedPoint());
    std::vector<Vec3> queries(kChunkPoints);
    while (wanted && *wanted) {
      const auto count = points.read(queries);
      if (!count) {
        progress_.finish();
        return console_.fail(points.name(), count.error());
      }
      if (*count == 0) break;
      const auto asked = std::span<const Vec3>(queries).first(*count);
      const std::span<const PlacedPoint> answers = answer(asked);
      tally_.add(*count, answers);
      wanted = writer.write(asked, answers);
      progress_.add(*count);
    }
    if (wanted && *wanted) wanted = writer.finish();
    const auto written = wanted ? output.commit() : Result<void>(wanted.error());
    if (!written) {
      progress_.finish();
      return console_.fail(arguments_.output.string(), written.error());
    }
    return finish(
        std::chrono::duration<double>(std::chrono::steady_clock::now() - started).count());
  }

 private:
  std::span<const PlacedPoint> answer(std::span<const Vec3> queries) {
    answers_.clear();
    for (const Vec3& query : queries) {
      const SceneClosestPoint found = probe_.closest_point(query, arguments_.options);
      PlacedPoint& answer = answers_.emplace_back(PlacedPoint{found});
      if (found.instance != kNoInstance) answer.instance = opened_.index_of(found.instance);
    }
    return answers_;
  }

  int finish(double seconds) {
    progress_.finish(tally_.text(seconds));
    const SceneStats stats = opened_.scene.stats();
    if (arguments_.json) {
      nlohmann::ordered_json json = tally_.json(seconds);
      json["pages_read"] = stats.pages_read;
      json["quarantined_pages"] = stats.quarantined_pages;
      json["waits_given_up"] = stats.waits_given_up;
      json["budget_bytes"] = stats.budget_bytes;
      console_.note(json_line(json));
    }
    const auto error = scene_pages_lost(stats.quarantined_pages);
    return error ? console_.fail(arguments_.file.string(), *error) : kDone;
  }

  const SceneArguments& arguments_;
  const OpenedScene& opened_;
  SceneProbe& probe_;
  Console& console_;
  Progress progress_;
  AnswerTally tally_;
  std::vector<PlacedPoint> answers_;
};

int answer_points(const SceneArguments& arguments, const OpenedScene& opened, Console& console) {
  const std::string name = arguments.points->string();
  auto probe = SceneProbe::create(opened.scene);
  if (!probe) return console.fail(arguments.file.string(), probe.error());
  const auto points = open_points(name, console.input());
  if (!points) return console.fail(points_name(name), points.error());
  auto output = AnswerOutput::open(arguments.output, arguments.force, console);
  if (!output) return console.fail(arguments.output.string(), output.error());
  return SceneRun(arguments, opened, *probe, console).run(**points, *output);
}

/// Sets the format by its name or else by the output's extension. Returns what is wrong with it.
std::string take_format(const std::string& name, SceneArguments& arguments) {
  const std::string extension = lower_extension(arguments.output);
  if (name.empty() &&
      (extension == ".f64" || extension == ".npy" || extension == ".ply" || extension == ".vtp"))
    return "answers of a scene have the formats csv and jsonl; name another output";
  const bool is_jsonl = name.empty() ? extension == ".jsonl" : name == "jsonl";
  arguments.form.format = is_jsonl ? AnswerFormat::kJsonLines : AnswerFormat::kCsv;
  return {};
}

}  // namespace

int run_scene(const SceneArguments& arguments, Console& console) {
  const auto description = read_scene(arguments.file);
  if (!description) return console.fail(arguments.file.string(), description.error());
  SceneOptions options;
  options.memory_budget_bytes = description->budget_bytes(arguments.memory_bytes);
  SceneFailure failure;
  const auto opened = OpenedScene::open(*description, arguments.file, options, failure);
  if (!opened) return console.fail(failure.file.string(), failure.error);
  if (!arguments.points) return report(arguments, *description, *opened, console);
  return console.finish(answer_points(arguments, *opened, console));
}

void add_scene(CLI::App& app, Console& console, std::function<int()>& action) {
  struct Options {
    SceneArguments arguments;
    std::filesystem::path points;
    std::uint64_t memory_bytes = 0;
    std::string format;  // empty: that of the output's extension
  };
  const auto options = std::make_shared<Options>();
  SceneArguments& arguments = options->arguments;
  SubcommandOptions subcommand(app, "scene",
                               "Report what the models of a scene take in memory, or find the "
                               "nearest surface point of any of them");
  subcommand.require(subcommand.path(
      "file", "FILE", arguments.file,
      "Scene file: a JSON object that format-spec/scene-v1/spec.md specifies, of models and the "
      "places where they stand"));
  const auto points = subcommand.path(
      "points", "POINTS", options->points,
      "Points to answer, in the coordinates of the scene, in a file that planetree query reads; - "
      "is standard input. Without it the scene is reported: bytes by model and layer, and what "
      "leaving layers out saves");
  const auto output = subcommand.default_text(
      subcommand.path("-o,--output", "OUT", arguments.output,
                      "File to write; it appears only when it is complete; - is standard output"),
      "-");
  const auto format = subcommand.default_text(
      subcommand.word(
          "--format", {"csv", "jsonl"},
          [options](const std::string& name) { options->format = name; },
          "The columns are those of planetree query, and the position of the instance in the scene "
          "file, from 0"),
      "the extension of OUT; csv if it is none of these");
  const auto force = subcommand.flag("--force", arguments.force, "Replace the output if it exists");
  const auto parts = SubcommandOptions::default_text(
      add_parts(
          subcommand,
          [&arguments](std::uint32_t given) {
            arguments.options.parts = arguments.form.parts = given;
          },
          "The other columns of csv are empty, the other keys of jsonl are left out. The side is "
          "that of the nearest instance; alone, it tells whether the point is inside of any"),
      parts_text(kAllParts));
  const auto max_error = subcommand.default_text(
      subcommand.length("--max-error", arguments.options.max_error, false,
                        "Tolerance of the distance, in the scene's unit; 0 means exact"),
      "0");
  const auto max_distance = subcommand.default_text(
      subcommand.length("--max-distance", arguments.options.max_distance, true,
                        "Search no farther than this, in the scene's unit"),
      "inf");
  const auto memory = subcommand.default_text(
      subcommand.bytes("--memory", options->memory_bytes, "Maximum memory for the scene"),
      "what the scene file says, or 256M");
  for (const auto of_points : {output, format, force, parts, max_error, max_distance})
    subcommand.need(of_points, points);
  subcommand.flag("--json", arguments.json,
                  "Report as one JSON object: of the scene on standard output, of the answers on "
                  "standard error");
  subcommand.flag("--quiet", arguments.quiet, "Show no progress");
  subcommand.on_given([options, points, memory, &console, &action] {
    if (SubcommandOptions::given(points)) options->arguments.points = options->points;
    if (SubcommandOptions::given(memory)) options->arguments.memory_bytes = options->memory_bytes;
    action = [options, &console] { return run_scene(options->arguments, console); };
    return take_format(options->format, options->arguments);
  });
}

}  // namespace planetree::tools
