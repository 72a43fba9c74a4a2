// twin/view/frame_lines.h - the lines of a program for pictures that are not made from a mesh.
#pragma once

#include <vector>

#include "twin/view/frame_road.h"
#include "twin/view/track_path.h"
#include "viewer/picture.h"
#include "viewer/raycast/scene_lines.h"

namespace kerf {

/// Toolpath, outline of the blank, work offset and machine zero, as the mesh road has them. Makes
/// all of the path at once: 16 bytes a vertex.
class FrameLines {
 public:
  FrameLines(const RoadStart& start, const Projection& projection);

  /// With the path as it is at a place of the program, over a picture and its window depths.
  void draw(const TrackPlace& place, Picture* picture, std::vector<float>* depths) const;

 private:
  Projection projection_;
  LineNearness nearness_;
  TrackPath path_;
  SceneLines lines_;
};

}  // namespace kerf
