// viewer/window/move_paint.h - the path in the colours of its moves. For the sources of viewer/
// only.
#pragma once

#include <glm/vec3.hpp>

#include "viewer/gl_objects.h"

namespace kerf {

/// A texture of colours, row by row, by the number of the move (PathVertex::move).
struct MovePaint {
  const GlTexture* texture = nullptr;  ///< Null: the path has the colours of its kinds.
  int count = 0;
  glm::vec3 other{0.6f};      ///< of moves beyond them
  glm::vec3 ground{0.0f};     ///< with this what is not past is mixed ..
  float ground_share = 0.0f;  ///< .. by this share
  bool operator==(const MovePaint&) const = default;
};

/// Of a program for paths, which is in use: path.vert, line.vert. The texture is bound to unit 1.
inline void set_moves(const GlProgram& program, const MovePaint& paint) {
  constexpr int kUnit = 1;
  program.set("by_move", paint.texture != nullptr ? 1 : 0);
  program.set("move_colors", kUnit);  // the other sampler of line.vert is of another kind
  if (paint.texture == nullptr) return;
  program.set("move_count", paint.count);
  program.set("other_rgb", paint.other);
  program.set("ground", glm::vec4(paint.ground, paint.ground_share));
  bind_texture(kUnit, *paint.texture);
}

}  // namespace kerf
