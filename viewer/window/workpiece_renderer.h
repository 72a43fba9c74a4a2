// viewer/window/workpiece_renderer.h - the workpiece by rays and by CSG, for the scene to be drawn
// around. For the sources of viewer/ only.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>

#include "base/result.h"
#include "viewer/gl_objects.h"
#include "viewer/raycast/ray_worker.h"
#include "viewer/scene.h"
#include "viewer/window/csg_view.h"
#include "viewer/window/screen_rect.h"

namespace kerf {

/// Both draw modes make a picture of the workpiece alone, with depth, in two textures; draw() lays
/// it into the scene, whose tool, lines, marks and machine then find their place before, in and
/// behind it by the depth test, as with the mesh.
///
///     raycast   made in another thread (RayWorker) and some frames late: until the picture for
///               this eye is there, the whole scene is drawn as the last picture saw it
///     csg       made by the card, as much of it in a frame as fits (CsgView), and likewise late
///
/// Whatever is missing for a draw mode (its values have not come, the answer was no), the mesh is
/// drawn.
class WorkpieceRenderer {
 public:
  /// `wake`: called from another thread when has_waiting() may have become true.
  static Result<WorkpieceRenderer> create(std::function<void()> wake);

  void apply(const SceneUpdate& update);

  /// What the scene is to be drawn with.
  struct Step {
    DrawMode draw_mode = DrawMode::kMesh;
    Projection projection;
    bool is_all_new = false;  ///< the workpiece has changed everywhere
    ScreenRect changed;       ///< else here at most
  };
  /// Brings the picture of the draw mode up to date as far as it goes in a frame. Error: OpenGL
  /// cannot.
  Result<Step> prepare(const Projection& wanted, DrawMode draw_mode);
  /// Into the framebuffer that is bound, with the depth test that is set. After prepare() has said
  /// a draw mode other than the mesh.
  void draw() const;

  /// There is a picture to be taken, or moves wait: prepare() again.
  bool has_waiting() const;
  /// The picture is that of the eye that prepare() was given last, in all of its pixels.
  bool is_full() const { return is_full_; }
  std::size_t gpu_bytes() const;

 private:
  WorkpieceRenderer(GlProgram program, std::function<void()> wake);
  void release_others(DrawMode draw_mode);
  void cast(const Projection& wanted, Step* step);
  void upload(const RayPicture& picture);

  GlProgram program_;
  GlVertexArray no_vertices_;
  std::function<void()> wake_;
  std::shared_ptr<const DrawAnswer> answer_;
  std::shared_ptr<const HeightGrid> heights_;
  DrawMode draw_mode_ = DrawMode::kMesh;  ///< asked for last
  bool is_full_ = true;

  GlTexture ray_colors_;
  GlTexture ray_depths_;
  glm::ivec2 ray_size_px_{0};
  std::optional<Projection>
      ray_projection_;  ///< of the picture in the textures; none: there is none
  std::unique_ptr<RayWorker> worker_;
  CsgView csg_;
};

}  // namespace kerf
