#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "storage/file/file_layout.h"
#include "tests/storage/system/temporary_directory.h"
#include "tests/tools/cli/captured_console.h"
#include "tools/cli/file_text.h"
#include "tools/command.h"

namespace planetree::tools {
namespace {

namespace fs = std::filesystem;

const fs::path kManual = PLANETREE_MANUAL;

std::string text_of(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

bool is_installed(const std::string& program) {
  return std::system(("command -v " + program + " >/dev/null 2>&1").c_str()) == 0;
}

/// What a shell command writes to standard output and error.
std::string output_of(const std::string& command) {
  const storage::TemporaryDirectory folder;
  const fs::path output = folder / "output";
  const std::string redirected = "{ " + command + "\n} >" + output.string() + " 2>&1";
  EXPECT_EQ(std::system(redirected.c_str()), 0) << command << '\n' << text_of(output);
  return text_of(output);
}

/// The proposals for the last of these words, each in a line of its own, in the order of the
/// script.
std::string completed(const std::string& words) {
  const storage::TemporaryDirectory folder;
  const fs::path script = folder / "complete.bash";
  std::ofstream(script) << "source " << kManual / "planetree.bash"
                        << "\nCOMP_WORDS=(" << words << ")\nCOMP_CWORD=$((${#COMP_WORDS[@]} - 1))\n"
                        << "_planetree\nprintf '%s\\n' \"${COMPREPLY[@]}\"\n";
  return output_of("bash " + script.string());
}

TEST(Help, ShowsVersionOfProjectAndFormat) {
  const Outcome result = run({"--version"});
  EXPECT_EQ(result.status, 0);
  EXPECT_EQ(result.output, "planetree " PLANETREE_VERSION " (file format " +
                               format_version_text(storage::kFormatVersion) + ")\n");
  EXPECT_EQ(run({"build", "--version"}).status, kCommandLineAtFault);
}

TEST(Help, FitsIntoEightyColumns) {
  std::vector<std::vector<std::string>> commands = {{"--help"}};
  for (const CommandSummary& each : command_summary().subcommands)
    commands.push_back({each.name, "--help"});
  EXPECT_GT(commands.size(), 6u);
  for (const std::vector<std::string>& command : commands) {
    const Outcome help = run(command);
    EXPECT_EQ(help.status, 0);
    for (const std::string& line : lines_of(help.output)) EXPECT_LE(line.size(), 80u) << line;
    EXPECT_NE(help.output.find("Exit status: 0 done, 1 the data is"), std::string::npos);
  }
}

TEST(Help, StatesValuesDefaultsAndRequirements) {
  const std::string generate = run({"generate", "--help"}).output;
  EXPECT_NE(generate.find("Usage: planetree generate [options] OUT.ply --triangles N\n"),
            std::string::npos);
  EXPECT_NE(generate.find("  --shape statue|sphere|cylinder|cone|terrain|soup\n"),
            std::string::npos);
  EXPECT_NE(generate.find("Default: 1."), std::string::npos);
  const std::string inspect = run({"inspect", "--help"}).output;
  EXPECT_NE(inspect.find("Requires --slice."), std::string::npos);
  EXPECT_NE(run({"query", "--help"}).output.find("query [options] FILE [POINTS]\n"),
            std::string::npos);
}

// A page names every option, and nothing in it is an error or a warning to roff.
TEST(ManPages, NameEveryOption) {
  const CommandSummary command = command_summary();
  const std::string overview = text_of(kManual / "planetree.1");
  for (const CommandSummary& subcommand : command.subcommands) {
    EXPECT_NE(overview.find(".B " + subcommand.name + '\n'), std::string::npos);
    const std::string page = text_of(kManual / ("planetree-" + subcommand.name + ".1"));
    EXPECT_GT(subcommand.options.size(), 2u);
    for (const OptionSummary& option : subcommand.options) {
      std::string name = option.names.back();
      for (std::size_t at = 0; (at = name.find('-', at)) != std::string::npos; at += 2)
        name.insert(at, 1, '\\');
      EXPECT_NE(page.find(name), std::string::npos) << subcommand.name << ' ' << name;
    }
  }
}

TEST(ManPages, AreRightRoff) {
  if (!is_installed("groff")) GTEST_SKIP() << "groff is not installed";
  int pages = 0;
  for (const fs::directory_entry& entry : fs::directory_iterator(kManual)) {
    if (entry.path().extension() != ".1") continue;
    ++pages;
    EXPECT_EQ(output_of("groff -man -ww -z " + entry.path().string()), "") << entry.path();
  }
  EXPECT_EQ(pages, 1 + static_cast<int>(command_summary().subcommands.size()));
  const std::string build =
      output_of("groff -man -Tascii -P-cbou " + (kManual / "planetree-build.1").string());
  EXPECT_NE(build.find("planetree build [options] IN... --output OUT.ptree"), std::string::npos);
  EXPECT_NE(build.find("--temp-dir DIR"), std::string::npos);
}

TEST(BashCompletion, CompletesSubcommandsOptionsAndValues) {
  if (!is_installed("bash")) GTEST_SKIP() << "bash is not installed";
  EXPECT_EQ(completed("planetree bui"), "build\n");
  EXPECT_EQ(completed("planetree build --memo"), "--memory\n");
  EXPECT_EQ(completed("planetree generate out.ply --shape s"), "statue\nsphere\nsoup\n");
  EXPECT_EQ(completed("planetree generate --shape = c"), "cylinder\ncone\n");
  EXPECT_EQ(completed("planetree verify --mem"), "\n");
  EXPECT_EQ(completed("planetree build --threads 1"), "\n");
  const std::string folder = kManual.string();
  EXPECT_EQ(completed("planetree query " + folder + "/planetree.b"), folder + "/planetree.bash\n");
  EXPECT_EQ(completed("planetree build --temp-dir " + folder), folder + '\n');
  EXPECT_EQ(completed("planetree build --temp-dir " + folder + "/planetree.b"), "\n");
}

}  // namespace
}  // namespace planetree::tools
