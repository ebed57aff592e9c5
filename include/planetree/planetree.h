#pragma once

/// @file
/// Exact closest-point queries on triangle models larger than memory. Includes all public headers
/// but planetree/eigen.h, which needs Eigen.
///
/// units   lengths and positions are in the units of the mesh that the file was built from.
/// frame   positions and directions are in the frame of that mesh, neither scaled nor moved.

#include "planetree/build.h"
#include "planetree/error.h"
#include "planetree/export.h"
#include "planetree/model.h"
#include "planetree/probe.h"
#include "planetree/stats.h"
#include "planetree/trace.h"
#include "planetree/types.h"
