// Writes open sheets as PLY files.
// usage: write_sheets FOLDER

#include <cstdio>
#include <filesystem>

#include "tests/oracle/built_model.h"
#include "tests/oracle/sheet_models.h"

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: write_sheets FOLDER\n");
    return 2;
  }
  namespace oracle = planetree::oracle;
  const std::filesystem::path folder = argv[1];
  oracle::write_ply(folder / "hills.ply", oracle::hills(60));
  oracle::write_ply(folder / "bowl.ply", oracle::bowl(60));
  oracle::write_ply(folder / "half_pipe.ply", oracle::half_pipe(60));
  oracle::write_ply(folder / "moebius_strip.ply", oracle::moebius_strip(200));
  oracle::write_ply(folder / "holed_panel.ply", oracle::holed_panel(30));
  return 0;
}
