#pragma once

#include <limits>
#include <utility>

#include "collisions/CGenericCollision.h"
#include "examples/chai3d/segment_collision.h"
#include "world/CGenericObject.h"

/// A collision detector of CHAI3D whose triangles are those of a model of planetree. Give it to an
/// object with setCollisionDetector(), for CHAI3D's finger-proxy algorithm.
///
/// The frame of the model is that of the object, and its units those of the world. The pages of the
/// model are read as the proxy needs them, within the budget of the model. An event is a shape, not
/// a triangle: the object has no arrays of triangles that haptic shading or textures could read.
/// Its index is that of the triangle in the mesh, or -1 if that is not known.
///
/// threads  one at a time, which is the haptic one
class PlanetreeCollision : public chai3d::cGenericCollision {
 public:
  explicit PlanetreeCollision(planetree::Probe probe) : segments_(std::move(probe)) {}

  bool computeCollision(chai3d::cGenericObject* object, chai3d::cVector3d& from,
                        chai3d::cVector3d& to, chai3d::cCollisionRecorder& recorder,
                        chai3d::cCollisionSettings& settings) override {
    const auto contact = segments_.first({from.x(), from.y(), from.z()}, {to.x(), to.y(), to.z()},
                                         settings.m_collisionRadius);
    if (!contact) return false;
    chai3d::cCollisionEvent event;
    event.clear();
    event.m_type = chai3d::C_COL_SHAPE;
    event.m_object = object;
    event.m_index = index_of(contact->triangle);
    event.m_localPos.set(contact->centre.x, contact->centre.y, contact->centre.z);
    event.m_localNormal.set(contact->normal.x, contact->normal.y, contact->normal.z);
    event.m_squareDistance = contact->square_distance;
    event.m_adjustedSegmentAPoint = from;
    if (!settings.m_returnMinimalCollisionData) {
      event.m_globalPos = object->getGlobalPos() + object->getGlobalRot() * event.m_localPos;
      event.m_globalNormal = object->getGlobalRot() * event.m_localNormal;
    }
    if (!settings.m_checkForNearestCollisionOnly) recorder.m_collisions.push_back(event);
    if (event.m_squareDistance <= recorder.m_nearestCollision.m_squareDistance)
      recorder.m_nearestCollision = event;
    return true;
  }

 private:
  static int index_of(std::uint64_t triangle) {
    constexpr auto kMax = static_cast<std::uint64_t>(std::numeric_limits<int>::max());
    return triangle <= kMax ? static_cast<int>(triangle) : -1;
  }

  SegmentCollision segments_;
};
