#include "viewer/window/surface_colors.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

#include "viewer/deviation_colors.h"
#include "viewer/window/texts.h"

namespace kerf {
namespace {

/// Every OpenGL 3.3 has textures of at least 1024 x 1024.
constexpr int kRow = 1024;

using Stops = std::array<glm::vec3, 5>;
/// Of rising brightness, so that heights are told apart in grey as well.
constexpr Stops kHeightStops{glm::vec3(0.16f, 0.14f, 0.46f), glm::vec3(0.10f, 0.42f, 0.66f),
                             glm::vec3(0.12f, 0.66f, 0.58f), glm::vec3(0.62f, 0.82f, 0.30f),
                             glm::vec3(0.99f, 0.91f, 0.42f)};
const Stops& stops_of(ColorBy mode) {
  return mode == ColorBy::kDeviation ? kDeviationStops : kHeightStops;
}

glm::vec3 rgb_of(std::uint32_t color) {
  return glm::vec3(color & 0xffu, color >> 8 & 0xffu, color >> 16 & 0xffu) / 255.0f;
}

std::uint32_t packed(const glm::vec3& rgb) {
  const auto byte = [](float v) { return static_cast<std::uint32_t>(std::lround(255.0f * v)); };
  return 0xff000000u | byte(rgb.z) << 16 | byte(rgb.y) << 8 | byte(rgb.x);
}

std::string text_of(const LegendRange& range, ColorBy mode, const Measures& measures) {
  if (range.kind == LegendRange::Kind::kStraightDown) return text(Text::kStraightDown);
  if (range.kind == LegendRange::Kind::kBeyondLimit)
    return fmt::format("> {}: {}", measures.value(mode, range.from), text(Text::kBeyondLimit));
  return range.from > 0 ? measures.values(mode, range.from, range.to)
                        : fmt::format("<= {}", measures.value(mode, range.to));
}

/// A legend that came in mm, in what is shown.
std::vector<ColorLegendEntry> in_units(std::vector<ColorLegendEntry> entries, ColorBy mode,
                                       const Measures& measures) {
  for (ColorLegendEntry& entry : entries) {
    if (entry.mm3_per_s) entry.text = measures.rate_up_to(*entry.mm3_per_s);
    if (entry.range) entry.text = text_of(*entry.range, mode, measures);
  }
  return entries;
}

}  // namespace

void SurfaceColors::set(std::shared_ptr<const CutColors> colors) {
  colors_ = std::move(colors);
  GLint largest = kRow;
  glGetIntegerv(GL_MAX_TEXTURE_SIZE, &largest);
  const std::size_t most = static_cast<std::size_t>(kRow) * static_cast<std::size_t>(largest);
  std::vector<std::uint32_t> texels = colors_->of_move;
  texels.resize(std::min(texels.size(), most));
  move_count_ = static_cast<int>(texels.size());
  const int rows = std::max(1, (move_count_ + kRow - 1) / kRow);
  texels.resize(static_cast<std::size_t>(rows) * kRow, colors_->other);
  allocate_texture(texture_, GL_RGBA8, GL_RGBA, GL_UNSIGNED_BYTE, {kRow, rows}, GL_NEAREST);
  glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, kRow, rows, GL_RGBA, GL_UNSIGNED_BYTE, texels.data());
  gpu_bytes_ = texels.size() * sizeof(std::uint32_t);
}

ColorBy SurfaceColors::available(ColorBy wanted) const {
  if (wanted == ColorBy::kPlain || needs(wanted) != VertexData::kCutBy) return wanted;
  return colors_ && colors_->mode == wanted ? wanted : ColorBy::kPlain;
}

VertexData SurfaceColors::needs(ColorBy mode) {
  if (mode == ColorBy::kHeight) return VertexData::kNone;
  return mode == ColorBy::kDeviation ? VertexData::kDeviation : VertexData::kCutBy;
}

ScenePrograms::Paint SurfaceColors::paint(ColorBy mode) {
  if (mode == ColorBy::kPlain) return ScenePrograms::Paint::kCutOrNot;
  const bool goes_by_moves = needs(mode) == VertexData::kCutBy;
  return goes_by_moves ? ScenePrograms::Paint::kMove : ScenePrograms::Paint::kMeasure;
}

void SurfaceColors::bind(const GlProgram& program, ColorBy mode, const ColorScale& scale) const {
  switch (paint(mode)) {
    case ScenePrograms::Paint::kOne:
      break;
    case ScenePrograms::Paint::kCutOrNot:
      program.set("other_rgb", kCut);
      program.set("not_cut_rgb", kNotCut);
      break;
    case ScenePrograms::Paint::kMove:
      program.set("move_count", move_count_);
      program.set("other_rgb", rgb_of(colors_->other));
      program.set("not_cut_rgb", rgb_of(colors_->not_cut));
      bind_texture(0, texture_);
      program.set("move_colors", 0);
      break;
    case ScenePrograms::Paint::kMeasure: {
      program.set("is_deviation", mode == ColorBy::kDeviation ? 1 : 0);
      const double range = std::max(scale.highest_mm - scale.lowest_mm, 1e-6);
      program.set("heights",
                  glm::vec2(static_cast<float>(scale.lowest_mm), static_cast<float>(1.0 / range)));
      program.set("tolerance_mm", static_cast<float>(scale.tolerance_mm));
      const Stops& stops = stops_of(mode);
      for (std::size_t i = 0; i < stops.size(); ++i) {
        program.set(fmt::format("stops[{}]", i).c_str(), stops[i]);
      }
      break;
    }
  }
}

MovePaint SurfaceColors::path_paint() const {
  MovePaint paint;
  paint.texture = &texture_;
  paint.count = move_count_;
  paint.other = rgb_of(colors_->other);
  return paint;
}

std::vector<ColorLegendEntry> SurfaceColors::legend(ColorBy mode, const ColorScale& scale,
                                                    const Measures& measures) const {
  std::vector<ColorLegendEntry> entries;
  const VertexData data = needs(mode);
  if (mode == ColorBy::kPlain) return entries;
  if (data == VertexData::kCutBy) {
    return colors_ ? in_units(colors_->legend, mode, measures) : entries;
  }
  const Stops& stops = stops_of(mode);
  if (data == VertexData::kDeviation) {
    const double tolerance = scale.tolerance_mm;
    const int digits = measures.digits_for(tolerance);
    const double full = kFullDeviation * tolerance;
    const std::array<std::string, 5> texts{
        "< " + measures.length(-full, digits), measures.length(-tolerance, digits),
        measures.length(0.0, 0), measures.signed_length(tolerance, digits),
        "> " + measures.signed_length(full, digits)};
    for (std::size_t i = 0; i < stops.size(); ++i) entries.push_back({packed(stops[i]), texts[i]});
    return entries;
  }
  const double step = (scale.highest_mm - scale.lowest_mm) / (stops.size() - 1);
  for (std::size_t i = 0; i < stops.size(); ++i) {
    const double z = scale.lowest_mm + step * static_cast<double>(i);
    entries.push_back({packed(stops[i]), measures.length(z, measures.digits_for(step))});
  }
  return entries;
}

}  // namespace kerf
