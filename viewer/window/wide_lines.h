// viewer/window/wide_lines.h - lines wider than a pixel. For the sources of viewer/ only.
#pragma once

#include <array>
#include <glm/vec4.hpp>
#include <optional>
#include <span>

#include "viewer/gl_objects.h"
#include "viewer/orbit_camera.h"
#include "viewer/window/move_paint.h"

namespace kerf {

/// OpenGL's own lines have one pixel in its core profile, which is too fine for fine displays.
/// These are rectangles with round ends, which the card makes of the same buffers: of 16 bytes a
/// vertex, position (3 floats) and 4 bytes, which are the segment's kind and move, or its colour,
/// and count at its end. Several times the work of plain lines, so those are drawn where a pixel is
/// wide enough, and the program is compiled where one is not.
class WideLines {
 public:
  static bool are_needed(const Projection& projection) { return projection.line_px > 1.0f; }

  /// Comes before all else. A driver that refuses the program is told as an error of OpenGL. Lines
  /// are smooth until set_smooth() says otherwise.
  void use(const Projection& projection, float towards_eye) const;
  /// Of kinds, past and future by turns: PathColors.
  void set_kind_colors(std::span<const glm::vec4, 6> rgba) const;
  /// With kinds: feeds have the colours of their moves.
  void set_move_colors(const MovePaint& paint) const { set_moves(*program_, paint); }
  void set_past(bool is_past) const { program_->set("is_past", is_past ? 1 : 0); }
  /// Colours of the vertices, RGBA.
  void set_own_colors(float opacity) const;
  void set_smooth(bool is_smooth) const { program_->set("is_smooth", is_smooth ? 1 : 0); }

  /// Draws from this buffer, whose texture it is, from now on. Any vertex array must be bound.
  void bind(const GlTexture& texture, const GlBuffer& vertices) const;
  /// Strips are of vertices with the numbers that this buffer has, 16 bits each; else of all.
  void set_numbered(bool is_numbered) const;
  void bind_numbers(const GlTexture& texture, const GlBuffer& numbers) const;
  /// One strip through the vertices [first, first + count), or through those numbers.
  void draw_strip(int first, int count) const;
  /// Lines between the vertices 0 and 1, 2 and 3 ..
  void draw_pairs(int count) const;
  void draw_one(int from, int to) const;

 private:
  mutable std::optional<GlProgram> program_;  ///< none until it is needed
};

}  // namespace kerf
