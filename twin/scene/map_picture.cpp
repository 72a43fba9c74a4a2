#include "twin/scene/map_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <utility>
#include <vector>

#include "base/translate.h"
#include "viewer/labels.h"
#include "viewer/raycast/stroke_raster.h"

namespace kerf {
namespace {

struct Rgb {
  std::uint8_t r = 0, g = 0, b = 0;
};

constexpr int kMapWidth_px = 1280, kMostHeight_px = 1280;
constexpr float kMapWords_px = 16, kMapEdge_px = 26, kMapLine_px = 1.9f * kMapWords_px;
constexpr glm::vec4 kMapInk{0.10f, 0.11f, 0.13f, 1.0f};
constexpr Rgb kPaper{246, 246, 244}, kUncut{216, 217, 219};
/// From little of the edge to half of it.
constexpr std::array<Rgb, 6> kAngles{{{49, 104, 178},
                                      {78, 165, 176},
                                      {126, 190, 108},
                                      {241, 205, 76},
                                      {236, 132, 52},
                                      {200, 42, 42}}};
constexpr Rgb kPlunge{112, 52, 140};
constexpr double kAngleStep_deg = 30;
constexpr Rgb kDoneColor{203, 219, 204}, kByNoneColor{200, 42, 42};
constexpr std::array<Rgb, 8> kToolColors{{{49, 104, 178},
                                          {236, 140, 40},
                                          {56, 150, 110},
                                          {142, 86, 170},
                                          {230, 190, 50},
                                          {70, 175, 195},
                                          {150, 100, 60},
                                          {225, 120, 170}}};

struct MapLegend {
  Rgb color;
  std::string text;
};

void fill(Picture& picture, int x, int y, const Rgb& color) {
  const std::size_t at =
      3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(picture.width_px) +
           static_cast<std::size_t>(x));
  picture.rgb[at] = color.r, picture.rgb[at + 1] = color.g, picture.rgb[at + 2] = color.b;
}

void write(const std::string& text, glm::vec2 at_px, glm::vec2 anchor,
           std::vector<Stroke>& strokes) {
  add_label(text, at_px, anchor, {kMapWords_px, kMapInk}, &strokes);
}

void add_line(glm::vec2 from, glm::vec2 to, std::vector<Stroke>& strokes) {
  Stroke stroke;
  stroke.from_px = from, stroke.to_px = to;
  stroke.width_px = 1.2f;
  stroke.rgba = kMapInk;
  strokes.push_back(stroke);
}

/// `color_of(i0, i1, j0, j1)`: of the cells from i0 and j0 up to i1 and j1, which are not in it.
Picture draw_map(const Box& bounds, int nx, int ny, const std::vector<MapLegend>& legend,
                 const std::string& words,
                 const std::function<Rgb(int i0, int i1, int j0, int j1)>& color_of) {
  Picture picture;
  float legend_px = 0;
  for (const MapLegend& entry : legend)
    legend_px = std::max(legend_px, label_width_px(entry.text, kMapWords_px));
  legend_px += 3 * kMapWords_px + kMapEdge_px;
  // The map stands right of the legend, over two lines of words.
  const float left = legend_px + kMapEdge_px, top = kMapEdge_px + kMapLine_px;
  const float wide = std::max(100.0f, kMapWidth_px - left - kMapEdge_px);
  const float below_px = 2.6f * kMapLine_px + kMapEdge_px;
  const float high = kMostHeight_px - top - below_px;
  const Vec3 size = bounds.size();
  const double px_mm =
      std::min(static_cast<double>(wide) / size.x, static_cast<double>(high) / size.y);
  const int width = std::max(1, static_cast<int>(size.x * px_mm));
  const int height = std::max(1, static_cast<int>(size.y * px_mm));
  const float legend_high = kMapLine_px * static_cast<float>(legend.size());
  picture.width_px = kMapWidth_px;
  picture.height_px =
      static_cast<int>(top + below_px + std::max(static_cast<float>(height), legend_high));
  for (int k = 0; k < picture.width_px * picture.height_px; ++k)
    picture.rgb.insert(picture.rgb.end(), {kPaper.r, kPaper.g, kPaper.b});
  const int x0 = static_cast<int>(left), y0 = static_cast<int>(top);
  const auto cells = [](int k, int pixels, int count) {
    const int from = static_cast<int>(static_cast<std::int64_t>(k) * count / pixels);
    const int to = static_cast<int>(static_cast<std::int64_t>(k + 1) * count / pixels);
    return std::pair(from, std::max(from + 1, to));
  };
  for (int y = 0; y < height; ++y) {
    const auto [j0, j1] = cells(height - 1 - y, height, ny);
    for (int x = 0; x < width; ++x) {
      const auto [i0, i1] = cells(x, width, nx);
      fill(picture, x0 + x, y0 + y, color_of(i0, i1, j0, j1));
    }
  }
  std::vector<Stroke> strokes;
  const glm::vec2 low(static_cast<float>(x0), static_cast<float>(y0));
  const glm::vec2 end = low + glm::vec2(static_cast<float>(width), static_cast<float>(height));
  add_line(low, {end.x, low.y}, strokes);
  add_line({end.x, low.y}, end, strokes);
  add_line(end, {low.x, end.y}, strokes);
  add_line({low.x, end.y}, low, strokes);
  const float below = end.y + 1.6f * kMapWords_px;
  write(fmt::format("X{:.5g} Y{:.5g}", bounds.min.x, bounds.min.y), {low.x, below}, {0, 0},
        strokes);
  write(fmt::format("X{:.5g} Y{:.5g} mm", bounds.max.x, bounds.max.y),
        {end.x, low.y - 0.6f * kMapWords_px}, {1, 0}, strokes);
  float y = top + kMapWords_px;
  for (const MapLegend& entry : legend) {
    const int side = static_cast<int>(kMapWords_px);
    for (int dy = 0; dy < side; ++dy)
      for (int dx = 0; dx < side; ++dx)
        fill(picture, static_cast<int>(kMapEdge_px) + dx, static_cast<int>(y) - side + dy,
             entry.color);
    write(entry.text, {kMapEdge_px + 1.8f * kMapWords_px, y}, {0, 0}, strokes);
    y += kMapLine_px;
  }
  const float bottom = static_cast<float>(picture.height_px) - kMapEdge_px;
  write(words, {kMapEdge_px, bottom}, {0, 0}, strokes);
  draw_strokes(strokes, std::vector<float>(picture.rgb.size() / 3, 1.0f), &picture);
  return picture;
}

Rgb color_of_angle(float angle_rad) {
  if (angle_rad <= 0) return kUncut;
  if (angle_rad > 1.5 * kPi) return kPlunge;
  const double steps = static_cast<double>(angle_rad) * 180 / kPi / kAngleStep_deg;
  return kAngles[std::min(static_cast<std::size_t>(steps), kAngles.size() - 1)];
}

}  // namespace

Picture engagement_picture(const Engagement& engagement, const std::string& name) {
  const EngagementMap none;
  const EngagementMap& map = engagement.map ? *engagement.map : none;
  std::vector<MapLegend> legend;
  for (std::size_t k = 0; k < kAngles.size(); ++k) {
    const double from = kAngleStep_deg * static_cast<double>(k), to = from + kAngleStep_deg;
    // Of the diameter, of a tool with a wall on one side.
    const double share = 50 * (1 - std::cos(to * kPi / 180));
    legend.push_back({kAngles[k], trf("{:.0f}..{:.0f}°, to {:.0f} % of Ø", from, to, share)});
  }
  legend.push_back({kPlunge, tr("straight down")});
  legend.push_back({kUncut, tr("not cut, or not measured")});
  return draw_map(
      map.bounds_mm, map.nx, map.ny, legend,
      trf("{}: how much of its edge the tool had in material that cut there last", name),
      [&](int i0, int, int j0, int) {
        return color_of_angle(
            map.angle_rad[static_cast<std::size_t>(j0) * static_cast<std::size_t>(map.nx) +
                          static_cast<std::size_t>(i0)]);
      });
}

Picture rest_picture(const Rest& rest, const std::string& name) {
  const RestMap& map = rest.map;
  std::vector<MapLegend> legend;
  legend.push_back({kDoneColor, trf("up to {:g} mm thick", rest.thickness_mm)});
  std::size_t looked_at = 0;
  for (std::size_t n = 0; n < rest.tools.size(); ++n) {
    if (!rest.tools[n].left_out.empty()) continue;
    if (++looked_at > 20) break;
    legend.push_back(
        {kToolColors[n % kToolColors.size()],
         fmt::format("T{} {}", rest.tools[n].number, rest.tools[n].shape.substr(0, 24))});
  }
  legend.push_back({kByNoneColor, tr("left by all tools")});
  return draw_map(
      map.bounds_mm, map.nx, map.ny, legend,
      rest.regions_in_all == 0
          ? trf("{}: nothing is thicker than {:g} mm above the design", name, rest.thickness_mm)
          : trf("{}: {:.1f} mm3 thicker than {:g} mm above the design, {:.1f} mm3 out of reach",
                name, rest.volume_mm3, rest.thickness_mm, rest.by_none_mm3),
      [&](int i0, int i1, int j0, int j1) {
        // What is left shows, however small it is.
        std::uint8_t found = RestMap::kNothing;
        for (int j = j0; j < j1; ++j) {
          for (int i = i0; i < i1; ++i) {
            const std::uint8_t cell =
                map.cells[static_cast<std::size_t>(j) * static_cast<std::size_t>(map.nx) +
                          static_cast<std::size_t>(i)];
            if (cell == RestMap::kByNone) return kByNoneColor;
            found = std::max(found, cell);
          }
        }
        if (found == RestMap::kNothing) return kPaper;
        if (found == RestMap::kDone) return kDoneColor;
        return kToolColors[static_cast<std::size_t>(found - RestMap::kByTool) % kToolColors.size()];
      });
}

}  // namespace kerf
