// twin/scene/frame_drawer.h - the three ways to a picture of a player's state: mesh, rays, CSG. For
// frame_writer.cpp and tests; everybody else takes FrameRenderer.
#pragma once

#include <memory>

#include "base/result.h"
#include "twin/scene/frame_writer.h"
#include "viewer/orbit_camera.h"

namespace kerf {

class FrameDrawer {
 public:
  virtual ~FrameDrawer() = default;
  /// Error: draw() cannot draw this place of the program, nor those behind it.
  virtual Done can_reach(const TrackPosition&) { return std::monostate{}; }
  virtual Result<Picture> draw(const std::shared_ptr<const PlayerState>& state) = 0;
  /// FrameRenderer::color().
  virtual void color(const std::vector<float>& /*removed_mm3*/,
                     std::shared_ptr<const LoadRecord> /*loads*/) {}
};

/// What a drawer begins with.
struct DrawerStart {
  const FrameOptions& options;
  const PlayerState& state;  ///< at the start of the program
  std::shared_ptr<const ProgramTrack> track;
  ViewedProgram shown;
};

/// All objects, through the window's renderer. Error: no OpenGL.
Result<std::unique_ptr<FrameDrawer>> make_mesh_drawer(DrawerStart start);
/// Workpiece, tool, path, outline of the blank, frames, findings and fixtures, by rays. Never
/// touches OpenGL.
Result<std::unique_ptr<FrameDrawer>> make_raycast_drawer(DrawerStart start);
/// The same objects, the workpiece by image-space CSG from the moves. Error: no OpenGL; the blank
/// is not a box; a cutter whose outline cannot be subtracted.
Result<std::unique_ptr<FrameDrawer>> make_csg_drawer(DrawerStart start);

/// For drawers without a mesh: looks at the blank as the window's "fit" does, and covers blank and
/// tool in depth wherever the program goes, so that a place gives the same picture whatever was
/// drawn before. Reads the whole track.
Projection frame_projection(const DrawerStart& start);

}  // namespace kerf
