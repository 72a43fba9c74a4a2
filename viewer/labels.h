// viewer/labels.h - text as strokes in the picture plane.
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <string_view>
#include <vector>

namespace kerf {

/// A straight line with round ends, in pixels of the picture (from the upper left, y down).
struct Stroke {
  glm::vec2 from_px{0.0f};
  glm::vec2 to_px{0.0f};
  float from_depth = -1.0f;  ///< Window depth; below 0: in front of everything.
  float to_depth = -1.0f;
  float width_px = 1.0f;
  glm::vec4 rgba{0.0f, 0.0f, 0.0f, 1.0f};
  float hidden_alpha = 0.0f;  ///< Factor on alpha where the part covers the stroke.
};

struct LabelStyle {
  float cap_height_px = 16.0f;
  glm::vec4 rgba{0.0f, 0.0f, 0.0f, 1.0f};
  glm::vec4 halo_rgba{0.0f};  ///< Wider strokes underneath, for text over the part; alpha 0: none.
};

/// Width of one line of text, in pixels. `text` is UTF-8.
float label_width_px(std::string_view text, float cap_height_px);

/// Appends the strokes of one line of text. `anchor` says which point of the box around the
/// capitals lies on `at_px`: (0, 0) its left end on the base line, (0.5, 0.5) the middle, (1, 1)
/// the upper right corner.
void add_label(std::string_view text, glm::vec2 at_px, glm::vec2 anchor, const LabelStyle& style,
               std::vector<Stroke>* strokes);

}  // namespace kerf
