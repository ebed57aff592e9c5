#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "octree/builder/mesh/stream/mesh_text.h"
#include "tools/cli/input_file.h"
#include "tools/cli/layer_option.h"
#include "tools/cli/parts_option.h"
#include "tools/cli/policy_option.h"
#include "tools/cli/side_option.h"
#include "tools/cli/subcommand_options.h"
#include "tools/query.h"

namespace planetree::tools {
namespace {

constexpr std::uint64_t kMaxWaitMs = std::uint64_t{24} * 60 * 60 * 1000;
constexpr std::uint64_t kMaxNearest = 1000000;
constexpr std::uint64_t kMaxHits = 1000000;
constexpr std::uint64_t kMaxWork = QueryOptions::kNoLimit - 1;

struct Options {
  QueryArguments arguments;
  std::string columns;
  std::optional<AnswerFormat> format;  // empty: as the output's extension tells
  bool ray = false, sweep = false;
  std::vector<SubcommandOptions::Option> only_of_points;
  std::uint64_t max_work = QueryOptions::kNoLimit;
  bool never_wait = false;
};

const std::map<std::string, AnswerFormat>& formats() {
  static const std::map<std::string, AnswerFormat> all = {
      {"csv", AnswerFormat::kCsv}, {"jsonl", AnswerFormat::kJsonLines},
      {"f64", AnswerFormat::kF64}, {"npy", AnswerFormat::kNpy},
      {"ply", AnswerFormat::kPly}, {"vtp", AnswerFormat::kVtp}};
  return all;
}

AnswerFormat format_of(const std::filesystem::path& output) {
  const std::string extension = lower_extension(output);
  const auto named = formats().find(extension.empty() ? extension : extension.substr(1));
  return named == formats().end() ? AnswerFormat::kCsv : named->second;
}

void add_files(SubcommandOptions& subcommand, Options& options) {
  QueryArguments& arguments = options.arguments;
  subcommand.require(subcommand.path("file", "FILE", arguments.file,
                                     "File that planetree build wrote, or a URL of one"));
  subcommand.default_text(
      subcommand.path(
          "points", "POINTS", arguments.points,
          "Query points, in model units: text with one point a line (see --columns), PLY (its "
          "vertices), LAS, .npy (a NumPy array of three columns) or .f64 (raw little-endian "
          "float64 "
          "triples); - is standard input, all but .f64. With --ray or --sweep: rays or sweeps, as "
          "text, .npy or .f64"),
      "-");
  subcommand.text(
      "--columns", "X,Y,Z",
      [](const std::string& text) { return text.empty() ? "give names or numbers" : ""; },
      [&options](const std::string& text) { options.columns = text; },
      "The columns of x, y and z in a text (or of all numbers of a ray or a sweep, in their "
      "order), by their names in its header or by numbers from 1. "
      "Without it a header must name x, y and z (X [m], Point_X, pos.x, Points:0 or easting, "
      "northing, height will do), and without a header they are the first three. Commas, "
      "semicolons, tabs or blanks separate columns; lines that begin with # or // are comments; "
      "numbers may have a decimal comma where that leaves no doubt");
  subcommand.default_text(
      subcommand.path("-o,--output", "OUT", arguments.output,
                      "File to write; it appears only when it is complete, and not at all if a "
                      "point cannot be read; - is standard output"),
      "-");
  subcommand.path("--trace", "OUT.trace", arguments.trace,
                  "Write the page trace of the queries here, in the format of "
                  "format-spec/trace-v1/spec.md: page lookups, pages read and evicted. Its memory "
                  "comes on top of --memory, and points are answered in smaller batches");
  subcommand.flag("--force", arguments.force, "Replace the output and the trace if they exist");
}

void add_answers(SubcommandOptions& subcommand, Options& options) {
  QueryArguments& arguments = options.arguments;
  AnswerForm& form = arguments.form;
  const auto contains =
      subcommand.flag("--contains", arguments.contains, "Report only the side of each point");
  const auto nearest = subcommand.count(
      "--nearest", arguments.triangles.nearest, kMaxNearest,
      "Report so many triangles about each point, the nearest first: a row for each, with the "
      "distance from it and its own normal");
  const auto within = subcommand.length(
      "--within", arguments.triangles.radius, false,
      "Report the triangles within this distance of each point, in model units, at most 100,000 or "
      "what --nearest says. A row without a triangle says that there is none "
      "(beyond_max_distance) or that more may be near (degraded)");
  const auto contacts = subcommand.length(
      "--contacts", arguments.triangles.contact_radius, false,
      "Report the contacts of a ball of this radius about each point, in model units: the local "
      "minima of the distance, the nearest first, with rows as those of --within. --max-error "
      "leaves out those that rise by no more than that, as noise makes them");
  const auto is_signed = subcommand.flag(
      "--signed", form.signed_distance,
      "Report the distance as signed_distance: negative inside, NaN where the side is unknown. The "
      "interval of lower and upper is that of the distance without its sign");
  const auto parts = add_parts(
      subcommand,
      [&arguments](std::uint32_t given) {
        arguments.options.parts = given;
        arguments.parts_are_given = true;
      },
      "The other columns of csv are empty, the other keys of jsonl are left out, the other numbers "
      "of f64 are NaN");
  const auto side = add_side(subcommand, arguments.options.side_rule);
  static const std::map<std::string, NormalRule> normals = {
      {"outward", NormalRule::kOutward}, {"toward-query", NormalRule::kTowardQuery}};
  const auto normal = subcommand.default_text(
      subcommand.word(
          "--normals", {"outward", "toward-query"},
          [&arguments](const std::string& name) {
            arguments.options.normal_rule = normals.at(name);
          },
          "outward: out of the solid, or as a sheet's faces are oriented; toward-query: to the "
          "point's side of the surface"),
      "outward");
  subcommand.exclude(normal, contains);
  const auto attributes = subcommand.flag(
      "--attributes", arguments.attributes,
      "Report what the file keeps of the triangle (build --keep), in further columns: red, green, "
      "blue and alpha from 0 to 255 and u and v, interpolated at the point, and value");
  subcommand.exclude(attributes, contains);
  for (const auto triangles : {nearest, within})
    for (const auto other : {contains, normal}) subcommand.exclude(triangles, other);
  for (const auto other : {contains, nearest, within}) subcommand.exclude(contacts, other);
  subcommand.exclude(is_signed, contains);
  subcommand.exclude(parts, contains);
  options.only_of_points = {contains, nearest, within, contacts,  is_signed,
                            parts,    side,    normal, attributes};
  subcommand.default_text(
      subcommand.word(
          "--format", {"csv", "jsonl", "f64", "npy", "ply", "vtp"},
          [&options](const std::string& name) { options.format = formats().at(name); },
          "csv: a header and a row for each answer; jsonl: an object for each, with null for "
          "numbers that are not finite; f64: 14 little-endian float64 for each point (x y z "
          "distance lower upper side px py pz nx ny nz triangle; side is -1 inside, 0 on the "
          "surface, 1 outside; NaN means an unknown side or no triangle), with --contains 4 (x y z "
          "side), with --ray 20 and with --sweep 19 (all columns; t_min and t_max too; feature is "
          "0 "
          "face, 1 edge, 2 vertex; status is 0 exact, 2 degraded, 3 beyond_max_distance, 4 "
          "bad_query); npy: the columns of csv as the fields of a NumPy array, with numbers for "
          "words; ply: the surface points that were found, as a binary PLY of doubles with "
          "normals and distance or t; vtp: these points with all columns, as a VTK file"),
      "the extension of OUT; csv if it is none of these");
}

void add_limits(SubcommandOptions& subcommand, Options& options) {
  QueryArguments& arguments = options.arguments;
  const auto max_error = subcommand.default_text(
      subcommand.length("--max-error", arguments.options.max_error, false,
                        "Tolerance of the distance, in model units: the search may stop once the "
                        "interval is this narrow; 0 means exact"),
      "0");
  options.only_of_points.push_back(max_error);
  subcommand.default_text(subcommand.length("--max-distance", arguments.options.max_distance, true,
                                            "Search no farther than this, in model units"),
                          "inf");
  subcommand.default_text(
      subcommand.count("--max-work", options.max_work, kMaxWork,
                       "Visit at most this many records of the tree and the mask for each point. "
                       "After them the answer is degraded, with an interval that holds"),
      "no limit; 4096 with --never-wait");
  subcommand.flag(
      "--never-wait", options.never_wait,
      "Answer as in real time, only from the pages that are in memory, while the others "
      "are being read. Answers are degraded where pages are missing, and may differ "
      "from run to run");
  subcommand.default_text(
      subcommand.count("--wait-limit", arguments.wait_limit_ms, kMaxWaitMs,
                       "Longest wait for one page, in milliseconds. After it the answer is "
                       "degraded, with an interval that holds; other answers are not affected"),
      "10000");
  subcommand.flag("--no-io-uring", arguments.no_io_uring,
                  "Do not wait for pages by io_uring but poll for them: for systems that end a "
                  "process that tries");
  subcommand.default_text(
      subcommand.bytes("--memory", arguments.memory_bytes, "Maximum memory for the model"), "256M");
  add_policy(subcommand, arguments.policy);
  add_open_layers(subcommand, arguments.layers);
  add_http_cache(subcommand, arguments.source);
  add_missing_members(subcommand, arguments.source);
  subcommand.default_text(
      subcommand.count(
          "--threads", arguments.threads, OpenOptions::kMaxBatchThreads,
          "Number of threads; 0 means one for each processor. Answers do not depend on it"),
      "0");
}

void add_ways(SubcommandOptions& subcommand, Options& options) {
  const auto ray = subcommand.flag(
      "--ray", options.ray,
      "Find the first triangle that each ray passes through. A row is x,y,z,dx,dy,dz: the origin "
      "and the direction, of any length; t_min,t_max may follow. The ray's points are origin + t * "
      "direction. In .f64 a ray has all 8 numbers, and t_max may be infinite");
  const auto sweep = subcommand.flag(
      "--sweep", options.sweep,
      "Find the first contact of each moving ball. A row is x0,y0,z0,x1,y1,z1,radius: the centre "
      "goes straight from the first point to the second while t goes from 0 to 1. In .f64 a sweep "
      "has these 7 numbers");
  const auto hits = subcommand.default_text(
      subcommand.count("--hits", options.arguments.hits, kMaxHits,
                       "List at most so many hits of each ray, in the order in which they are hit: "
                       "a row for each. A ray that hits nothing has one row, with t inf"),
      "1");
  subcommand.need(hits, ray);
  subcommand.exclude(sweep, ray);
  for (const auto other : options.only_of_points)
    for (const auto way : {ray, sweep}) subcommand.exclude(other, way);
}

/// Reads the kind of rows and their columns. Returns what is wrong with them.
std::string take_rows(const Options& options, QueryArguments& arguments) {
  if (options.ray) arguments.kind = RowKind::kRay;
  if (options.sweep) arguments.kind = RowKind::kSweep;
  if (options.columns.empty()) return {};
  auto columns = ColumnChoice::parse(options.columns, shape_of(arguments.kind));
  if (!columns)
    return "--columns: '" + octree::printable(options.columns) + "': " + columns.error().text;
  arguments.columns = *std::move(columns);
  return {};
}

/// What is wrong with the options together.
std::string complaint_of(const QueryArguments& arguments) {
  if (arguments.hits == 0) return "--hits 0 finds nothing; give 1 or more";
  if (arguments.triangles.nearest == 0) return "--nearest 0 finds nothing; give 1 or more";
  const std::uint32_t parts = arguments.options.parts;
  const bool has_both =
      (parts & kNormal) != 0 || (parts & (kDistance | kSide)) == (kDistance | kSide);
  const bool has_points = !arguments.contains && (parts & (kDistance | kNormal)) != 0;
  if (arguments.form.format == AnswerFormat::kPly && !has_points)
    return "--format ply needs surface points; omit --contains, or add distance to --parts";
  if (arguments.form.format == AnswerFormat::kVtp && !has_points && !arguments.contains)
    return "--format vtp needs points; give --contains, or add distance to --parts";
  if (arguments.attributes && arguments.form.format == AnswerFormat::kPly)
    return "--format ply has no attributes; give csv, jsonl, f64, npy or vtp";
  if (arguments.attributes && !has_points)
    return "--attributes are those of the nearest triangle; add distance to --parts";
  if (arguments.attributes && (arguments.layers & kAttributeLayer) == 0)
    return "--attributes needs the layer attributes; add it to --layers";
  if (arguments.trace == "-") return "--trace needs a file; standard output is for the answers";
  return !arguments.form.signed_distance || has_both
             ? std::string()
             : "--signed needs the distance and the side; add both to --parts";
}

}  // namespace

void add_query(CLI::App& app, Console& console, std::function<int()>& action) {
  const auto options = std::make_shared<Options>();
  QueryArguments& arguments = options->arguments;
  SubcommandOptions subcommand(app, "query",
                               "Find the nearest surface point and the side of each point, or "
                               "what rays and moving balls hit first");
  add_files(subcommand, *options);
  add_answers(subcommand, *options);
  add_limits(subcommand, *options);
  add_ways(subcommand, *options);
  subcommand.flag("--json", arguments.json,
                  "Report at the end as one JSON object, the last line on standard error; progress "
                  "as JSON lines there too");
  subcommand.flag("--quiet", arguments.quiet, "Show no progress");
  subcommand.on_given([options, &console, &action] {
    QueryArguments& given = options->arguments;
    given.options.max_work = static_cast<std::uint32_t>(options->max_work);
    given.options.wait = options->never_wait ? Wait::kNever : Wait::kForPages;
    given.form.parts = given.options.parts;
    given.form.format = options->format.value_or(format_of(given.output));
    action = [options, &console] { return run_query(options->arguments, console); };
    const std::string complaint = take_rows(*options, given);
    return complaint.empty() ? complaint_of(given) : complaint;
  });
}

}  // namespace planetree::tools
