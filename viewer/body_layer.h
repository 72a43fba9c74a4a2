// viewer/body_layer.h - bodies around a part, laid over its picture. For the sources of viewer/
// only.
#pragma once

#include <glm/vec2.hpp>
#include <span>
#include <utility>

#include "viewer/camera.h"
#include "viewer/gl_objects.h"
#include "viewer/picture.h"

namespace kerf {

/// Their nearest surfaces, lit as the window's, antialiased, seen through. What reaches beyond the
/// camera's depth range is drawn all the same.
class BodyLayer {
 public:
  /// Error: the GL compiler's log.
  static Result<BodyLayer> create();

  /// Into the framebuffer, of the picture's size. `part_depths`: PartRenderer::depths().
  Done draw(std::span<const PictureBody> bodies, const Camera& camera, const GlTexture& part_depths,
            glm::ivec2 picture_px, GLuint target) const;

 private:
  BodyLayer(GlProgram body, GlProgram overlay)
      : body_(std::move(body)), overlay_(std::move(overlay)) {}
  void draw_bodies(std::span<const PictureBody> bodies, const Camera& camera,
                   const GlTexture& part_depths) const;

  GlProgram body_;
  GlProgram overlay_;
};

}  // namespace kerf
