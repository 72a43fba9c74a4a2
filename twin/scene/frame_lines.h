// twin/scene/frame_lines.h - the lines of a program for pictures that are not made from a mesh.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "twin/scene/frame_drawer.h"
#include "twin/scene/track_path.h"
#include "viewer/picture.h"
#include "viewer/raycast/scene_lines.h"

namespace kerf {

/// Toolpath, outline of the blank, work offset, machine zero and marks of findings, as the mesh
/// draw mode has them. Makes all of the path at once: 16 bytes a vertex.
class FrameLines {
 public:
  FrameLines(const DrawerStart& start, const Projection& projection);

  /// With path and findings as they are at a place of the program, over a picture and its window
  /// depths.
  void draw(const PlayerState& state, Picture* picture, std::vector<float>* depths);

 private:
  Projection projection_;
  LineNearness nearness_;
  TrackPath path_;
  SceneLines lines_;
  bool shows_findings_;
  std::vector<std::string> files_;
  std::shared_ptr<const std::vector<Finding>> shown_findings_;
};

}  // namespace kerf
