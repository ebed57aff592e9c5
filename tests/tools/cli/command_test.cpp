#include "tools/command.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <algorithm>
#include <string>

#include "tests/tools/cli/command_fixture.h"
#include "tools/cli/file_text.h"

namespace planetree::tools {
namespace {

struct Refused {
  std::vector<std::string> arguments;
  int status;
  std::string line;
};

// People and scripts see these lines: each names the file, the position in it, the cause and the
// remedy.
TEST_F(Command, EveryErrorIsOneLine) {
  write("bad_index.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 1 2 7\n");
  write("short.csv", "x,y,z\n1,2,3\n1,2\n");
  write("word.csv", "1,2,3\n1,two,3\n");
  write("odd.f64", std::string(25, '\0'));
  write("cut.ptree", std::string(100, '\0').replace(0, 8, "\x89PTREE\r\n", 8));
  const std::vector<Refused> cases = {
      {{}, 2, "planetree: no subcommand; planetree --help lists them"},
      {{"frobnicate"}, 2, "planetree: no subcommand 'frobnicate'; planetree --help lists them"},
      {{"build", "mesh.obj"},
       2,
       "planetree: build: --output is required; see planetree build --help"},
      {{"build", "mesh.obj", "-o", "tree.ptree"},
       2,
       "planetree: tree.ptree: the file exists; use --force to replace it, or another name"},
      {{"build", "none.obj", "-o", "new.ptree"},
       2,
       "planetree: none.obj: no such file; check the path"},
      {{"build", "mesh.obj", "-o", "none/new.ptree"},
       2,
       "planetree: none/new.ptree: its directory does not exist; create it first"},
      {{"build", "mesh.obj", "-o", "mesh.obj", "--force"},
       2,
       "planetree: mesh.obj: this is the input itself; name another output"},
      {{"build", "mesh.obj", "-o", "."}, 2, "planetree: .: this is a directory; name a file in it"},
      {{"build", "mesh.obj", "-o", "new.ptree", "--page-size", "5000"},
       2,
       "planetree: build: --page-size: 5000 is not a page size; give a power of two from 4K to "
       "256K; see planetree build --help"},
      {{"build", "mesh.obj", "-o", "new.ptree", "--threads", "1025"},
       2,
       "planetree: build: --threads: 1025 is too large; give at most 1024; see planetree build "
       "--help"},
      {{"build", "mesh.obj", "-o", "new.ptree", "--memory", "100M"},
       2,
       "planetree: build: --memory: 104857600 is too little for a build; give 160M or more; see "
       "planetree build --help"},
      {{"build", "mesh.obj", "-o", "new.ptree", "--box", "0,0,0,1,1"},
       2,
       "planetree: build: --box: '0,0,0,1,1' is not a box; give X0,Y0,Z0,X1,Y1,Z1, finite numbers "
       "with X0 <= X1, Y0 <= Y1 and Z0 <= Z1; see planetree build --help"},
      {{"build", "mesh.obj", "-o", "new.ptree", "--box", "500,500,500,501,501,501"},
       2,
       "planetree: mesh.obj: no triangle touches the box; that of the whole model is "
       "0,0,0,14,14,0.875"},
      {{"build", "mesh.obj", "-o", "new.ptree", "--temp-dir", "none"},
       2,
       "planetree: none: no such directory for temporary files; create it first"},
      {{"build", "bad_index.obj", "-o", "new.ptree", "--strict"},
       1,
       "planetree: bad_index.obj: line 5: vertex index 7 is out of range, the mesh has 3 vertices; "
       "repair the mesh or build without --strict"},
      {{"query", "none.ptree"},
       2,
       "planetree: none.ptree: cannot open the file: No such file or directory; check the path"},
      {{"query", "tree.ptree", "none.csv"},
       2,
       "planetree: none.csv: cannot open it: No such file or directory; check the path"},
      {{"query", "tree.ptree", "short.csv"},
       1,
       "planetree: short.csv: line 3: it has fewer than three numbers; give x,y,z, one point a "
       "line"},
      {{"query", "tree.ptree", "word.csv"},
       1,
       "planetree: word.csv: line 2: 'two' is not a number; give x,y,z, one point a line"},
      {{"query", "tree.ptree", "odd.f64"},
       1,
       "planetree: odd.f64: at byte 24: the file ends 1 bytes into a point of 24 bytes; write "
       "whole points"},
      {{"query", "tree.ptree", "--max-error", "-1"},
       2,
       "planetree: query: --max-error: '-1' is not a length; give a number of 0 or more, in model "
       "units; see planetree query --help"},
      {{"query", "tree.ptree", "--memory", "lots"},
       2,
       "planetree: query: --memory: 'lots' is not a size; give a whole number of bytes such as "
       "4096, 64K, 256M or 1.5G (K and KiB are 1024, KB is 1000); see planetree query --help"},
      {{"inspect", "tree.ptree", "--page", "99"},
       2,
       "planetree: tree.ptree: there is no page 99; the last page is " +
           std::to_string(entries_.size() - 1)},
      {{"inspect", "tree.ptree", "--node", "7:1:2"},
       2,
       "planetree: inspect: --node: '7:1:2' is not an octcode; give 0x... or level:x:y:z; see "
       "planetree inspect --help"},
      {{"inspect", "tree.ptree", "--node", "9:1:2:3"},
       2,
       "planetree: tree.ptree: no page has that octcode; --pages lists the octcodes of all pages"},
      {{"inspect", "tree.ptree", "--slice", "z=1"},
       2,
       "planetree: inspect: --slice requires --image; see planetree inspect --help"},
      {{"inspect", "cut.ptree"},
       1,
       "planetree: cut.ptree: FILE_LENGTH: at byte 100: the file should have at least 2048 bytes "
       "and has 100; restore it from a copy or build it again"},
      {{"verify", "none.ptree"},
       2,
       "planetree: none.ptree: cannot open the file: No such file or directory; check the path"},
  };
  for (const Refused& each : cases) {
    const Outcome result = run(each.arguments);
    EXPECT_EQ(result.errors, each.line + "\n");
    EXPECT_EQ(result.status, each.status) << each.line;
  }
  EXPECT_FALSE(fs::exists("new.ptree"));
}

TEST_F(Command, HelpListsSubcommandsAndFlags) {
  const Outcome all = run({"--help"});
  EXPECT_EQ(all.status, 0);
  for (const char* subcommand : {"generate", "build", "query", "inspect", "verify"}) {
    EXPECT_NE(all.output.find(subcommand), std::string::npos);
    const Outcome one = run({subcommand, "--help"});
    EXPECT_EQ(one.status, 0);
    EXPECT_NE(one.output.find("--json"), std::string::npos) << subcommand;
    EXPECT_NE(one.output.find("--quiet"), std::string::npos) << subcommand;
    EXPECT_EQ(one.errors, "");
  }
}

TEST_F(Command, BuildsAndReports) {
  // As build_sample() does: without metadata.
  const Outcome result = run({"build", "mesh.obj", "-o", "new.ptree", "--page-size", "4K",
                              "--threads", "1", "--json", "--meta", "generator="});
  ASSERT_EQ(result.status, 0) << result.errors;
  EXPECT_EQ(result.errors, "");
  const Json report = Json::parse(result.output);
  EXPECT_EQ(report["triangles"], kTriangles);
  EXPECT_EQ(report["skipped"], 0);
  EXPECT_EQ(report["watertight"], false);
  EXPECT_EQ(report["unbalanced_edges"], 4 * kSide);
  EXPECT_EQ(report["first_skipped"], nullptr);
  EXPECT_EQ(report["file_bytes"], fs::file_size("new.ptree"));
  EXPECT_EQ(report["page_bytes"], 4096);
  EXPECT_GT(report["seconds"], 0);
  EXPECT_GT(report["peak_resident_bytes"], 0);
  EXPECT_EQ(report["sha256"].get<std::string>().size(), 64u);
  EXPECT_EQ(storage::read_bytes("new.ptree"), storage::read_bytes("tree.ptree"));
  const Outcome again = run({"build", "mesh.obj", "-o", "new.ptree", "--force"});
  EXPECT_EQ(again.status, 0);
  EXPECT_EQ(lines_of(again.output).size(), 1u);
}

TEST_F(Command, BuildsTheSameFileWithLittleMemory) {
  fs::create_directory("spilled");
  ASSERT_EQ(run({"build", "mesh.obj", "-o", "much.ptree", "--memory", "8G"}).status, 0);
  ASSERT_EQ(
      run({"build", "mesh.obj", "-o", "little.ptree", "--memory", "160M", "--temp-dir", "spilled"})
          .status,
      0);
  EXPECT_EQ(storage::read_bytes("much.ptree"), storage::read_bytes("little.ptree"));
  EXPECT_TRUE(fs::is_empty("spilled"));
}

TEST_F(Command, BuildReportsSecondsByPhase) {
  const Outcome result = run({"build", "mesh.obj", "-o", "new.ptree", "--json"});
  ASSERT_EQ(result.status, 0) << result.errors;
  const Json report = Json::parse(result.output);
  double sum = 0;
  for (const auto& [phase, seconds] : report["seconds_by_phase"].items())
    sum += seconds.get<double>();
  EXPECT_TRUE(report["seconds_by_phase"].contains("reading"));
  EXPECT_TRUE(report["seconds_by_phase"].contains("writing"));
  EXPECT_LE(sum, report["seconds"].get<double>());
}

TEST_F(Command, BuildNamesTheFirstSkippedRecord) {
  write_mesh("holes.obj", 3, "f 1 2 99\nf 1 2 3 98\n");
  const Outcome result = run({"build", "holes.obj", "-o", "holes.ptree", "--json"});
  EXPECT_EQ(result.status, 0);
  EXPECT_EQ(
      result.errors,
      "planetree: warning: holes.obj: 3 triangles of bad records skipped, the first: line "
      "35: vertex index 99 is out of range, the mesh has 16 vertices; repair the mesh, or use "
      "--strict to refuse it\n");
  const Json report = Json::parse(result.output);
  EXPECT_EQ(report["skipped"], 3);
  EXPECT_EQ(report["first_skipped"], 18);
}

TEST_F(Command, QueryAnswersInTheOrderOfTheInput) {
  const Outcome result = run({"query", "tree.ptree"}, "0,0,3\n\nnan,0,0\n0,0,1e308\n8,8,0\n");
  ASSERT_EQ(result.status, 0) << result.errors;
  const auto lines = lines_of(result.output);
  ASSERT_EQ(lines.size(), 5u);
  EXPECT_EQ(lines[0], "x,y,z,distance,lower,upper,side,px,py,pz,nx,ny,nz,triangle,feature,status");
  EXPECT_EQ(lines[1].substr(0, 6), "0,0,3,");
  EXPECT_EQ(lines[2], "nan,0,0,inf,0,inf,unknown,0,0,0,0,0,1,,face,bad_query");
  EXPECT_TRUE(lines[3].starts_with("0,0,1e+308,")) << lines[3];
  for (const std::string& line : lines) EXPECT_EQ(std::count(line.begin(), line.end(), ','), 15);
  EXPECT_TRUE(lines[4].ends_with(",exact"));
}

TEST_F(Command, QueryAnswersThePointsBeforeABadLine) {
  const Outcome result = run({"query", "tree.ptree"}, "x,y,z\n1,1,1\n2,2,2\n3;3;3\n4,4,4\n");
  EXPECT_EQ(result.status, 1);
  EXPECT_EQ(lines_of(result.output).size(), 3u);
  EXPECT_EQ(result.errors,
            "planetree: standard input: line 4: '3;3;3' is not a number; give x,y,z, one point a "
            "line\n");
}

TEST_F(Command, QueryObeysItsLimits) {
  const Outcome far =
      run({"query", "tree.ptree", "--max-distance", "2", "--side", "solid"}, "4,4,9\n");
  EXPECT_EQ(lines_of(far.output).back(),
            "4,4,9,inf,2,inf,outside,0,0,0,0,0,1,,face,beyond_max_distance");
  const Outcome coarse =
      run({"query", "tree.ptree", "--max-error", "100", "--side", "solid"}, "7,7,30\n");
  EXPECT_TRUE(lines_of(coarse.output).back().ends_with("within_error"));
}

TEST_F(Command, QueryContainsGivesSidesOnly) {
  write("solid.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n");
  build_sample("solid.obj", "solid.ptree");
  const Outcome result = run({"query", "solid.ptree", "--contains", "--json"},
                             "0.25,0.25,0.25\n1,1,1\n0,0,0\nnan,0,0\n");
  EXPECT_EQ(lines_of(result.output),
            (std::vector<std::string>{"x,y,z,side,status", "0.25,0.25,0.25,inside,exact",
                                      "1,1,1,outside,exact", "0,0,0,on_surface,exact",
                                      "nan,0,0,unknown,bad_query"}));
  EXPECT_EQ(Json::parse(result.errors)["sides"]["inside"], 1);
  const Outcome whole = run({"query", "solid.ptree"}, "2,0.25,0.25\n");
  EXPECT_NE(lines_of(whole.output).back().find(",outside,"), std::string::npos);
  EXPECT_TRUE(run({"query", "tree.ptree", "--contains"}, "1,1,1\n")
                  .output.ends_with("1,1,1,outside,exact\n"));
}

TEST_F(Command, QueryReportsOnStandardError) {
  const Outcome result =
      run({"query", "tree.ptree", "--json", "--format", "jsonl", "--wait-limit", "60000"},
          "1,1,1\ninf,1,1\n");
  EXPECT_EQ(result.status, 0);
  const Json report = Json::parse(result.errors);
  EXPECT_EQ(report["waits_given_up"], 0);
  EXPECT_EQ(report["points"], 2);
  EXPECT_EQ(report["exact"], 1);
  EXPECT_EQ(report["bad_query"], 1);
  const auto lines = lines_of(result.output);
  ASSERT_EQ(lines.size(), 2u);
  EXPECT_EQ(Json::parse(lines[0])["status"], "exact");
  EXPECT_EQ(Json::parse(lines[1])["x"], nullptr);
}

TEST_F(Command, QueryGivesTheSameForEveryInputFormat) {
  write("points.csv", "id,z,y,x\n7,3,2,1\n8,6,5,4.5\n");
  write("points.ply",
        "ply\nformat ascii 1.0\nelement vertex 2\nproperty double x\nproperty double y\nproperty "
        "double z\nend_header\n1 2 3\n4.5 5 6\n");
  const double triples[] = {1, 2, 3, 4.5, 5, 6};
  write("points.f64", std::string(reinterpret_cast<const char*>(triples), sizeof triples));
  const std::string expected = run({"query", "tree.ptree"}, "1,2,3\n4.5,5,6").output;
  ASSERT_EQ(lines_of(expected).size(), 3u);
  for (const char* name : {"points.csv", "points.ply", "points.f64"})
    EXPECT_EQ(run({"query", "tree.ptree", name}).output, expected) << name;
}

TEST_F(Command, QueryReportsUnreadablePages) {
  flip("tree.ptree", entries_[1].offset);
  std::string points;
  for (int i = 0; i <= 14; ++i) points += std::to_string(i) + "," + std::to_string(i) + ",0.5\n";
  const Outcome result = run({"query", "tree.ptree"}, points);
  EXPECT_EQ(result.status, 1);
  EXPECT_NE(result.output.find(",degraded\n"), std::string::npos);
  EXPECT_EQ(lines_of(result.output).size(), 16u);
  EXPECT_TRUE(result.errors.starts_with("planetree: tree.ptree: 1 of its pages cannot be read"));
}

TEST_F(Command, QueryWarnsOfADamagedHeaderAndGoesOn) {
  flip("tree.ptree", 50);
  const Outcome result = run({"query", "tree.ptree"}, "1,1,1\n");
  EXPECT_EQ(result.status, 0);
  EXPECT_EQ(lines_of(result.output).size(), 2u);
  EXPECT_EQ(result.errors,
            "planetree: warning: tree.ptree: one of its two headers is damaged; copy the file or "
            "build it again\n");
}

TEST_F(Command, ReportsAFullDevice) {
  std::FILE* full = std::fopen("/dev/full", "w");
  CapturedConsole captured;
  Console console(captured.console().input(), full, captured.console().errors());
  const char* argv[] = {"planetree", "verify", "tree.ptree", nullptr};
  EXPECT_EQ(run_command(3, argv, console), 3);
  std::fclose(full);
  EXPECT_EQ(captured.errors(),
            "planetree: standard output: cannot write the answer: No space left on device; free "
            "some space or choose another device\n");
}

#ifdef PLANETREE_COMMAND
// The second point comes later than progress stays silent.
TEST_F(Command, WritesProgressAsJsonUnlessQuiet) {
  const std::string query = std::string("{ echo 1,1,1; sleep 5.2; echo 2,2,2; } | ") +
                            PLANETREE_COMMAND + " query tree.ptree --json ";
  const std::string line =
      query + "--quiet 2>quiet.txt >quiet.csv & " + query + "2>told.txt >told.csv; wait";
  ASSERT_EQ(std::system(line.c_str()), 0);
  const auto loud = lines_of(text_of("told.txt")), quiet = lines_of(text_of("quiet.txt"));
  ASSERT_EQ(loud.size(), 2u);
  const Json event = Json::parse(loud[0]);
  EXPECT_EQ(event["phase"], "answering");
  EXPECT_EQ(event["done"], 2);
  EXPECT_EQ(event["total"], nullptr);
  EXPECT_EQ(Json::parse(loud[1])["points"], 2);
  ASSERT_EQ(quiet.size(), 1u);
  EXPECT_EQ(Json::parse(quiet[0])["points"], 2);
}

TEST_F(Command, EndsQuietlyWhenItsOutputIsClosed) {
  std::string points;
  for (int i = 0; i < 5000; ++i) points += "1,1,1\n";
  write("points.csv", points);
  const std::string line =
      std::string("exec ") + PLANETREE_COMMAND + " query tree.ptree points.csv 2>errors.txt";
  std::FILE* pipe = popen(line.c_str(), "r");
  ASSERT_NE(pipe, nullptr);
  EXPECT_EQ(std::fgetc(pipe), 'x');
  const int status = pclose(pipe);
  EXPECT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 0);
  EXPECT_EQ(fs::file_size("errors.txt"), 0u);
}
#endif

}  // namespace
}  // namespace planetree::tools
