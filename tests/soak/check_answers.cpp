// Compares the answers of `planetree query` with every triangle of the mesh. A binary mesh need not
// fit into memory.
// usage: check_answers MESH ANSWERS.csv [COUNT]
// Checks the first COUNT answers (default: all). Exit status 1 if any is wrong.

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <string>

#include "tests/oracle/answer_judge.h"

namespace planetree::oracle {
namespace {

int fail(const char* about, const char* why) {
  std::cerr << "check_answers: " << about << ": " << why << '\n';
  return 1;
}

void print_sides(const Judgement& judgement) {
  if (judgement.sides_by_crossings > 0)
    std::printf("sides: %zu by the crossings of a ray, exactly, for the mesh is watertight\n",
                judgement.sides_by_crossings);
  if (judgement.sides_by_solid_angles > 0)
    std::printf("sides: %zu by the sum of all solid angles\n", judgement.sides_by_solid_angles);
  if (judgement.sides_by_crossings + judgement.sides_by_solid_angles == 0)
    std::printf("sides: not checked, for the mesh is not watertight and too large for sums\n");
}

int run(const char* mesh_path, const char* answers_path, std::size_t count) {
  std::ifstream csv(answers_path);
  if (!csv) return fail(answers_path, "cannot be read");
  const auto answers = read_answers(csv, count);
  if (!answers) return fail(answers_path, answers.error().text);
  const auto judgement = judge_answers(mesh_path, *answers);
  if (!judgement) return fail(mesh_path, judgement.error().text);
  for (std::size_t i = 0; i < answers->size(); ++i)
    if (const std::string& fault = judgement->faults[i]; !fault.empty())
      std::cout << "wrong, " << fault << ": " << (*answers)[i].text << '\n';
  const auto right = std::ranges::count(judgement->faults, std::string());
  const std::size_t wrong = answers->size() - static_cast<std::size_t>(right);
  const std::size_t judged = answers->size() - judgement->not_judged;
  if (judged > 0) print_sides(*judgement);
  if (judgement->not_judged > 0)
    std::printf("%zu answers to queries that make no sense: not judged\n", judgement->not_judged);
  std::printf("%zu answers held against all %llu triangles: %zu wrong\n", judged,
              static_cast<unsigned long long>(judgement->triangles), wrong);
  return wrong == 0 && judged > 0 ? 0 : 1;
}

}  // namespace
}  // namespace planetree::oracle

int main(int argc, char** argv) {
  if (argc < 3) {
    std::cerr << "usage: check_answers MESH ANSWERS.csv [COUNT]\n";
    return 2;
  }
  const std::size_t count = argc > 3 ? std::strtoull(argv[3], nullptr, 10) : ~std::size_t{0};
  return planetree::oracle::run(argv[1], argv[2], count);
}
