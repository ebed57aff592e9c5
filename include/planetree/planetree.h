#pragma once

/// @file
/// Closest-point and inside-outside queries on triangle meshes that may be larger than memory, and
/// building their files. Includes all public headers but planetree/eigen.h, which needs Eigen.
///
/// units   lengths and positions are in the units of the mesh that the file was built from.
/// axes    positions and directions are in the coordinate system of that mesh.

#include "planetree/attributes.h"
#include "planetree/build.h"
#include "planetree/contact.h"
#include "planetree/error.h"
#include "planetree/eviction_policy.h"
#include "planetree/export.h"
#include "planetree/layers.h"
#include "planetree/metadata.h"
#include "planetree/model.h"
#include "planetree/point_shell.h"
#include "planetree/pose.h"
#include "planetree/probe.h"
#include "planetree/scene.h"
#include "planetree/scene_shell.h"
#include "planetree/shard.h"
#include "planetree/stats.h"
#include "planetree/trace.h"
#include "planetree/types.h"
