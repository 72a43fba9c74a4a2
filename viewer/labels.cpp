#include "viewer/labels.h"

#include "viewer/stroke_font.h"

namespace kerf {
namespace {

constexpr float kHaloWidth = 5.5f;  // pen width of the halo, in units of the font

void add_glyphs(const std::vector<const Glyph*>& glyphs, glm::vec2 origin_px, float scale,
                float pen, const glm::vec4& rgba, std::vector<Stroke>* strokes) {
  float x = 0.0f;
  for (const Glyph* glyph : glyphs) {
    for (const auto& line : glyph->strokes) {
      for (std::size_t i = 0; i + 1 < line.size(); ++i) {
        Stroke stroke;
        stroke.from_px = origin_px + scale * glm::vec2(x + line[i].x, -line[i].y);
        stroke.to_px = origin_px + scale * glm::vec2(x + line[i + 1].x, -line[i + 1].y);
        stroke.width_px = scale * pen;
        stroke.rgba = rgba;
        strokes->push_back(stroke);
      }
    }
    x += glyph->width + kLetterGap;
  }
}

float width_of(const std::vector<const Glyph*>& glyphs) {
  float width = glyphs.empty() ? 0.0f : -kLetterGap;
  for (const Glyph* glyph : glyphs) width += glyph->width + kLetterGap;
  return width;
}

}  // namespace

float label_width_px(std::string_view text, float cap_height_px) {
  return width_of(glyphs_of(text)) * cap_height_px / kCapHeight;
}

void add_label(std::string_view text, glm::vec2 at_px, glm::vec2 anchor, const LabelStyle& style,
               std::vector<Stroke>* strokes) {
  const auto glyphs = glyphs_of(text);
  const float scale = style.cap_height_px / kCapHeight;
  const glm::vec2 origin_px =
      at_px + glm::vec2(-anchor.x * width_of(glyphs) * scale, anchor.y * style.cap_height_px);
  if (style.halo_rgba.a > 0.0f) {
    add_glyphs(glyphs, origin_px, scale, kHaloWidth, style.halo_rgba, strokes);
  }
  add_glyphs(glyphs, origin_px, scale, kPenWidth, style.rgba, strokes);
}

}  // namespace kerf
