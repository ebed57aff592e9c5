// Compiles the adapter against CHAI3D's headers.

#include "examples/chai3d/planetree_collision.h"

chai3d::cGenericCollision* make_detector(planetree::Probe probe) {
  return new PlanetreeCollision(std::move(probe));
}
