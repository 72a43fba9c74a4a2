// twin/scene/frame_bodies.h - what stands around the workpiece, for pictures that are not made from
// a mesh.
#pragma once

#include <vector>

#include "twin/scene/body_watch.h"
#include "twin/scene/frame_drawer.h"
#include "viewer/picture.h"
#include "viewer/raycast/body_rays.h"

namespace kerf {

/// Fixtures as the mesh draw mode has them, but that none is red; those on a link of a machine go
/// with it, though it is not drawn itself. Not drawn where the looks hide them.
class FrameBodies {
 public:
  FrameBodies(const DrawerStart& start, const Projection& projection);

  /// Over a picture and its window depths, as the program stands.
  void draw(const PlayerState& state, const std::vector<float>& depths, Picture* picture);

 private:
  Projection projection_;
  std::shared_ptr<const ProgramTrack> track_;
  ViewedProgram shown_;
  BodyWatch watch_;
  BodyRays rays_;
  Box part_mm_;
};

}  // namespace kerf
