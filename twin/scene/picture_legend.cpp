#include "twin/scene/picture_legend.h"

namespace kerf {

void add_legend(const std::vector<ColorLegendEntry>& legend, std::vector<Stroke>* strokes) {
  constexpr float kWords_px = kLegendWords_px, kNext_px = 1.8f * kWords_px;
  constexpr glm::vec4 kInk{0.10f, 0.11f, 0.13f, 1.0f}, kHalo{1.0f, 1.0f, 1.0f, 0.92f};
  float y = kLegendEdge_px + kWords_px;
  for (const ColorLegendEntry& entry : legend) {
    const auto part = [&](unsigned shift) {
      return static_cast<float>(entry.color >> shift & 0xffu) / 255.0f;
    };
    Stroke square;
    square.from_px = {kLegendEdge_px + kWords_px / 2, y - kWords_px / 2};
    square.to_px = square.from_px + glm::vec2(kWords_px, 0);
    square.width_px = kWords_px;
    square.rgba = {part(0), part(8), part(16), 1.0f};
    strokes->push_back(square);
    add_label(entry.text, {kLegendEdge_px + 3 * kWords_px, y}, {0, 0}, {kWords_px, kInk, kHalo},
              strokes);
    y += kNext_px;
  }
}

}  // namespace kerf
