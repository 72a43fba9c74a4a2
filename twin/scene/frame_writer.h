// twin/scene/frame_writer.h - pictures of a program as it runs, without a window.
#pragma once

#include <functional>
#include <glm/vec2.hpp>
#include <memory>
#include <stop_token>
#include <string>

#include "base/result.h"
#include "twin/playback/player.h"
#include "twin/scene/player_scene.h"
#include "viewer/orbit_camera.h"
#include "viewer/picture.h"
#include "viewer/section.h"
#include "viewer/window/scene_renderer.h"

namespace kerf {

struct FrameOptions {
  glm::ivec2 size_px{1280, 720};
  StandardView view = StandardView::kIsometric;
  bool perspective = true;
  SectionKind section = SectionKind::kNone;  ///< of kMesh
  /// All three look from the same place at the same workpiece. kMesh: the window's renderer, all
  /// that the window shows; on the CPU where there is no graphics card. kRaycast: without OpenGL,
  /// no machine, no colours, no section. kCsg: as that, with OpenGL; does not look at the
  /// workpiece's cells, so walls are smooth at any cell size; at most 20 000 moves, and the blank
  /// must be a box.
  DrawMode draw_mode = DrawMode::kMesh;
  DrawOptions draw;                    ///< of kMesh
  LengthUnit units = LengthUnit::kMm;  ///< of the legend
};

class FrameDrawer;

/// Draws what the window would show of a player's states. One thread, which must not have another
/// OpenGL context.
class FrameRenderer {
 public:
  /// `state`: at the start of the program. Error: no OpenGL, with each draw mode that was tried; a
  /// blank that the draw mode cannot draw.
  static Result<FrameRenderer> create(const FrameOptions& options, const PlayerState& state,
                                      std::shared_ptr<const ProgramTrack> track,
                                      ViewedProgram shown);
  FrameRenderer(FrameRenderer&&) noexcept;
  FrameRenderer& operator=(FrameRenderer&&) noexcept;
  ~FrameRenderer();

  /// Error: draw() will refuse this place: too many moves up to there.
  Done can_reach(const TrackPosition& place);
  /// All patches and the whole path are there in the picture. Cheaper for a place that lies behind
  /// the one drawn before than for one before it. Error: as can_reach(); OpenGL failed.
  Result<Picture> draw(const std::shared_ptr<const PlayerState>& state);
  /// Before draw(), where DrawOptions::color_by goes by moves: what the player knows of them; the
  /// legend is in the picture then. Of kMesh; else without effect.
  void color(const Player& player);

 private:
  explicit FrameRenderer(std::unique_ptr<FrameDrawer> draw_mode);
  std::unique_ptr<FrameDrawer> draw_mode_;
};

/// Frames of a film.
struct FilmOptions {
  std::string folder;  ///< frame_000000.png, ...; made if it is not there
  double fps = 25;
  double speed = 1;  ///< program seconds a second of the film
};

/// Plays from where the player stands to the end of the program. Each frame is written under a
/// temporary name first. `on_frame` gets the share that is done, 0..1. Returns the number of
/// frames; stops early when asked to.
Result<std::size_t> write_film(Player& player, FrameRenderer& renderer, const FilmOptions& options,
                               std::stop_token stop, const std::function<void(double)>& on_frame);

}  // namespace kerf
