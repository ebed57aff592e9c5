#include "tools/build/build.h"

#include <memory>
#include <string>

#include "tools/build/build_meter.h"
#include "tools/build/build_options.h"
#include "tools/build/build_report.h"
#include "tools/cli/subcommand_options.h"

namespace planetree::tools {

int run_build(const BuildArguments& arguments, Console& console) {
  BuildMeter meter(arguments.output, arguments.quiet, arguments.json, console);
  const auto report =
      build(BuildInput(arguments.inputs), arguments.output, meter.observed(arguments.options));
  return report_build(report, meter, {arguments.inputs, arguments.output}, arguments.json, console);
}

void add_build(CLI::App& app, Console& console, std::function<int()>& action) {
  struct Options {
    BuildArguments arguments;
    BuildOptionTexts texts;
  };
  const auto options = std::make_shared<Options>();
  BuildArguments& arguments = options->arguments;
  SubcommandOptions subcommand(app, "build", "Build the .ptree file of a mesh");
  subcommand.require(
      subcommand.paths("input", "IN...", arguments.inputs,
                       "Mesh to read: PLY, STL or OFF (ascii or binary), glTF or GLB, "
                       "or OBJ, as it is or compressed by gzip or zstd. Several files, of any of "
                       "these formats, are one mesh: their triangles follow each other"));
  subcommand.require(subcommand.path("-o,--output", "OUT.ptree", arguments.output,
                                     "File to write; it appears only when it is complete"));
  add_resources(subcommand, arguments.options, options->texts);
  subcommand.path(
      "--temp-dir", "DIR", arguments.options.temp_directory,
      "Directory for temporary files; by default that of the output. They take about "
      "120 bytes a triangle if memory is short, or 200 with double coordinates. The content of a "
      "compressed mesh takes its length. They have no names and vanish with the process, except "
      "for the checkpoint of --resume. The build does not begin if space is too short");
  add_box(subcommand, arguments.options);
  const KeepOptions keep = add_content(subcommand, arguments.options, options->texts);
  subcommand.flag(
      "--resume", arguments.options.resume,
      "Keep a checkpoint in the directory OUT.ptree.work, next to the output or in --temp-dir, "
      "until the file is complete. Resume from the checkpoint of an interrupted build with "
      "--resume of the same input and options. The file does not depend on it");
  subcommand.flag("--force", arguments.options.replace, "Replace the output if it exists");
  subcommand.flag("--json", arguments.json,
                  "Report as one JSON object; progress as JSON lines, on standard error");
  subcommand.flag("--quiet", arguments.quiet, "Show no progress");
  subcommand.on_given([options, keep, &console, &action] {
    action = [options, &console] { return run_build(options->arguments, console); };
    return take_texts(options->texts, keep, options->arguments.options);
  });
}

}  // namespace planetree::tools
