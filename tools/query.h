#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>

#include "planetree/model.h"
#include "planetree/types.h"
#include "tools/answers/answer_writer.h"
#include "tools/answers/triangle_rows.h"
#include "tools/cli/open_model.h"
#include "tools/cli/subcommand.h"
#include "tools/points/column_names.h"
#include "tools/points/row_shape.h"

namespace CLI {
class App;
}

namespace planetree::tools {

/// Arguments of `planetree query`.
struct QueryArguments {
  std::filesystem::path file;
  RowKind kind = RowKind::kPoint;      ///< what is queried
  std::filesystem::path points = "-";  ///< the rows to query; "-" is standard input
  ColumnChoice columns;                ///< of a text
  std::filesystem::path output = "-";  ///< "-" is standard output
  std::filesystem::path trace;         ///< file for the page trace; empty: none
  bool force = false;                  ///< replace the output
  QueryOptions options;
  bool parts_are_given = false;       ///< else the parts that the layers tell are computed
  bool contains = false;              ///< request the side alone
  TriangleRowsQuery triangles;        ///< if given: request the triangles about each point
  bool attributes = false;            ///< report those of triangles
  std::uint64_t hits = 1;             ///< list at most so many hits of each ray
  std::uint32_t layers = kAllLayers;  ///< layers to open
  EvictionPolicy policy = OpenOptions{}.policy;  ///< how the page to evict is chosen
  std::uint64_t memory_bytes = std::uint64_t{256} << 20;
  std::uint64_t threads = 0;  ///< batch threads; 0: one for each processor
  std::uint64_t wait_limit_ms = OpenOptions().wait_limit_ms;
  bool no_io_uring = false;
  SourceChoice source;  ///< for a URL or a set
  AnswerForm form;
  bool json = false;
  bool quiet = false;
};

/// Answers all rows in the order of the input. Returns the exit status. Without a row, or with
/// one that cannot be read, an output file is not written.
int run_query(const QueryArguments& arguments, Console& console);

/// Adds the subcommand `query` to the command line. If given, parsing sets `action` to a call of
/// run_query().
void add_query(CLI::App& app, Console& console, std::function<int()>& action);

}  // namespace planetree::tools
