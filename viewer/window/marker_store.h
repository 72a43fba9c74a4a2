// viewer/window/marker_store.h - outline of the blank, frames, markers of findings on the graphics
// card. For the sources of viewer/ only.
#pragma once

#include <cstddef>
#include <span>

#include "viewer/gl_objects.h"
#include "viewer/orbit_camera.h"
#include "viewer/scene.h"
#include "viewer/window/wide_lines.h"

namespace kerf {

/// Few vertices, so they are always drawn all.
class MarkerStore {
 public:
  static Result<MarkerStore> create();

  void set_setup(const SceneSetup& setup);
  void set_findings(std::span<const SceneFinding> findings);

  struct Opacities {
    float blank = 1.0f;  ///< 0: hidden
    float frames = 1.0f;
    float findings = 1.0f;
  };
  void draw(const Projection& projection, const Opacities& opacities, bool may_smooth) const;

 private:
  struct Batch {
    GlVertexArray array;
    GlBuffer vertices;
    GlTexture texture;  ///< of the buffer
    GLsizei count = 0;
  };

  explicit MarkerStore(GlProgram program) : program_(std::move(program)) {}
  void draw_lines(const Batch& batch, const Projection& projection, double nearer_px, float opacity,
                  bool may_smooth) const;
  void draw_batch(const Batch& batch, GLenum shape, float opacity) const;

  GlProgram program_;
  WideLines wide_;
  Batch blank_;
  Batch frames_;
  Batch findings_;
};

}  // namespace kerf
