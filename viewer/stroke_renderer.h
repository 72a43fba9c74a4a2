// viewer/stroke_renderer.h - draws strokes (lines, lettering) over a picture.
#pragma once

#include <glm/vec2.hpp>
#include <span>

#include "viewer/gl_objects.h"
#include "viewer/labels.h"

namespace kerf {

/// Antialiased by coverage in the fragment shader, so it needs no multisampling. For the sources of
/// viewer/ only.
class StrokeRenderer {
 public:
  static Result<StrokeRenderer> create();

  /// Draws in order, blended, into the framebuffer bound now. `depths` is the depth of the part
  /// (window depth), of the picture's size: where it is nearer than a stroke, the stroke fades to
  /// its hidden_alpha.
  void draw(std::span<const Stroke> strokes, glm::ivec2 picture_px, const GlTexture& depths) const;

 private:
  explicit StrokeRenderer(GlProgram program) : program_(std::move(program)) {}
  GlProgram program_;
};

}  // namespace kerf
