#pragma once

#include "tests/oracle/nasty_models.h"

/// Open sheets of size about 1, with their front upward where they have one.
namespace planetree::oracle {

/// Hills over the square from (-1, -1) to (1, 1), with 2 * steps^2 faces.
Soup hills(unsigned steps);
/// A paraboloid over the same square, open upward.
Soup bowl(unsigned steps);
/// Half of a cylinder about the y axis, open upward; its inner side is the front.
Soup half_pipe(unsigned steps);
/// A strip of one half twist. It has no front as a whole: where its ends meet, the orientation
/// changes.
Soup moebius_strip(unsigned steps);
/// A flat square in the plane z = 0 without every ninth pair of its faces.
Soup holed_panel(unsigned steps);

}  // namespace planetree::oracle
