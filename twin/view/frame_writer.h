// twin/view/frame_writer.h - pictures of a program as it runs, without a window.
#pragma once

#include <functional>
#include <glm/vec2.hpp>
#include <stop_token>
#include <string>

#include "base/result.h"
#include "twin/playback/player.h"
#include "twin/view/player_scene.h"
#include "viewer/picture.h"
#include "viewer/window/orbit_camera.h"
#include "viewer/window/scene_renderer.h"

namespace kerf {

struct FrameOptions {
  glm::ivec2 size_px{1280, 720};
  StandardView view = StandardView::kIsometric;
  bool perspective = true;
  DrawOptions draw;
};

/// Draws what the window would show of a player's states, by the same renderer, on the CPU where
/// there is no graphics card. One thread, which must not have another OpenGL context.
class FrameRenderer {
 public:
  /// Error: no OpenGL, with each road that was tried.
  static Result<FrameRenderer> create(const FrameOptions& options, const PlayerState& state,
                                      std::shared_ptr<const ProgramTrack> track,
                                      ViewedProgram shown);
  FrameRenderer(FrameRenderer&&) noexcept;
  FrameRenderer& operator=(FrameRenderer&&) noexcept;
  ~FrameRenderer();

  /// All patches and the whole path are there in the picture.
  Result<Picture> draw(const std::shared_ptr<const PlayerState>& state);

 private:
  struct Impl;
  explicit FrameRenderer(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
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
