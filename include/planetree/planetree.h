#pragma once

/// Exact closest-point queries on triangle models larger than memory.
///
/// Lengths and positions are in the units and frame of the mesh the file was
/// built from. Directions and frames are neither scaled nor moved.

#include "planetree/error.h"
#include "planetree/model.h"
#include "planetree/probe.h"
#include "planetree/stats.h"
#include "planetree/trace.h"
#include "planetree/types.h"
