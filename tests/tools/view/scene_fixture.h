#pragma once

#include "tests/tools/cli/command_fixture.h"

namespace planetree::tools {

/// Scene files of a tetrahedron and a bumpy square.
class SceneFiles : public Command {
 protected:
  void SetUp() override {
    Command::SetUp();
    write("solid.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n");
    build_sample("solid.obj", "solid.ptree");
    write("scene.json", R"({"format": "planetree-scene", "version": 1, "memory": "16M",
      "models": {"solid": {"file": "solid.ptree"},
                 "mesh": {"file": "tree.ptree", "layers": "distance"},
                 "unused": {"file": "solid.ptree", "layers": "distance,side"}},
      "instances": [{"model": "solid"},
                    {"name": "turned", "model": "solid", "translation": [5, 0, 0],
                     "rotation": [1, 0, 0, 1]},
                    {"model": "mesh", "translation": [0, 100, 0]}]})");
    write("lean.json", R"({"format": "planetree-scene", "version": 1, "memory": "16M",
      "models": {"solid": {"file": "solid.ptree", "layers": "distance"},
                 "whole": {"file": "solid.ptree"}},
      "instances": [{"model": "solid"}, {"model": "whole", "translation": [5, 0, 0]}]})");
    write("one.json", squares(""));
    write("two.json", squares(R"(, {"model": "mesh", "translation": [40, 0, 0],
                                    "rotation": [1, 0, 1, 0]})"));
  }

 private:
  static std::string squares(const std::string& other) {
    return R"({"format": "planetree-scene", "version": 1, "memory": "16M",
               "models": {"mesh": {"file": "tree.ptree"}},
               "instances": [{"model": "mesh"})" +
           other + "]}";
  }
};

}  // namespace planetree::tools
