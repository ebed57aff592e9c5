#pragma once

#include <cstddef>
#include <string>

#include "tests/oracle/built_model.h"

/// Models of as many triangles as a coarse field needs, and more.
namespace planetree::oracle {

/// Number of models of fielded_model().
inline constexpr std::size_t kFieldedModels = 48;

/// A model before it is built.
struct FieldedModel {
  std::string name;
  Soup triangles;  ///< strays are last
  BuildChoices choices;
  double size = 1;   ///< of the core, approximate
  Vec3 middle;       ///< of the core, approximate
  double stray = 0;  ///< distance of the strays; 0 if there is none
};

/// Returns model `number`: closed and open surfaces, sheets, regions, models with strays, scaled
/// and translated ones, and many copies of each nasty and each closed family. Models have 1,100 to
/// 200,000 triangles.
FieldedModel fielded_model(std::size_t number);

}  // namespace planetree::oracle
