// viewer/stroke_font.h - lettering made of pen strokes, as on a technical drawing. Needs no font
// file, and looks the same on every host.
#pragma once

#include <glm/vec2.hpp>
#include <string_view>
#include <vector>

namespace kerf {

/// x right, y up from the base line; capital letters are kCapHeight high, the pen is about
/// kPenWidth wide.
struct Glyph {
  float width = 0.0f;
  std::vector<std::vector<glm::vec2>> strokes;  ///< Polylines; curves are already divided.
};

inline constexpr float kCapHeight = 14.0f;
inline constexpr float kPenWidth = 1.75f;
inline constexpr float kLetterGap = 4.0f;  ///< Between the widths of two neighbours.
inline constexpr float kSpaceWidth = 4.5f;

/// Glyphs of `utf8_text` in order: printable ASCII, the letters of German, and the degree,
/// multiplication, diameter and micro signs; any other code point, and bytes that are no UTF-8, are
/// an empty box.
std::vector<const Glyph*> glyphs_of(std::string_view utf8_text);

}  // namespace kerf
