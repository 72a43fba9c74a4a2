#include "viewer/raycast/scene_lines.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <optional>
#include <utility>

namespace kerf {
namespace {

// As scene_renderer.cpp and marker_store.cpp have them: traverses, feeds, planned.
constexpr std::array<glm::vec3, 3> kPathColors{
    glm::vec3(0.80f, 0.22f, 0.16f), glm::vec3(0.10f, 0.42f, 0.78f), glm::vec3(0.45f, 0.45f, 0.48f)};
constexpr float kFutureShare = 0.45f;
constexpr glm::vec3 kPaper{0.88f, 0.89f, 0.91f};
constexpr glm::vec4 kBlankColor{70 / 255.0f, 96 / 255.0f, 150 / 255.0f, 190 / 255.0f};
constexpr std::array<glm::vec4, 3> kAxisColors{
    glm::vec4(214 / 255.0f, 48 / 255.0f, 42 / 255.0f, 1.0f),
    glm::vec4(44 / 255.0f, 148 / 255.0f, 56 / 255.0f, 1.0f),
    glm::vec4(40 / 255.0f, 84 / 255.0f, 214 / 255.0f, 1.0f)};
constexpr double kFrameShare = 0.22;
constexpr double kFrameWithoutBlank_mm = 20.0;
constexpr float kBarb = 0.12f;
constexpr glm::vec4 kErrorColor{222 / 255.0f, 32 / 255.0f, 32 / 255.0f, 1.0f};
constexpr glm::vec4 kWarningColor{245 / 255.0f, 158 / 255.0f, 24 / 255.0f, 1.0f};
constexpr glm::vec4 kNoteColor{60 / 255.0f, 130 / 255.0f, 220 / 255.0f, 1.0f};
constexpr float kMarkRadius_px = 5.5f;
// A darker rim, so that a mark is seen on any ground.
constexpr float kRimBegins = 0.7f;
constexpr float kRimShade = 0.45f;

/// Where lines are cut off that come from behind the eye.
constexpr float kLeastW = 1e-4f;
constexpr float kLeastSegment_px = 1.0f;
/// Of a pixel: less is not seen.
constexpr float kLeastCover = 1.0f / 255;

/// Pixels from the upper left, and window depth.
using Place = glm::vec3;

/// Blends over the picture what a line covers of a pixel.
class Canvas {
 public:
  Canvas(Picture* picture, std::vector<float>* depths, float line_px)
      : picture_(*picture), depths_(*depths), reach_px_(0.5f * line_px + 0.5f) {}

  void draw(Place a, Place b, const glm::vec4& rgba) const {
    const bool is_steep = std::abs(b.y - a.y) > std::abs(b.x - a.x);
    if (is_steep) {
      std::swap(a.x, a.y);
      std::swap(b.x, b.y);
    }
    if (a.x > b.x) std::swap(a, b);
    const float run = b.x - a.x;
    if (!(run > 0.0f)) return;
    const float slope = (b.y - a.y) / run;
    const float across = 1.0f / std::sqrt(1.0f + slope * slope);  // of a step beside it
    const int columns = is_steep ? picture_.height_px : picture_.width_px;
    const int rows = is_steep ? picture_.width_px : picture_.height_px;
    const float last = std::min(b.x, static_cast<float>(columns));
    for (float x = std::floor(std::max(a.x, 0.0f)); x < last; x += 1.0f) {
      const float share = std::min(x + 1.0f, b.x) - std::max(x, a.x);
      const float along = (std::clamp(x + 0.5f, a.x, b.x) - a.x) / run;
      const float middle = a.y + along * (b.y - a.y);
      const float depth = a.z + along * (b.z - a.z);
      const float margin = reach_px_ / across + 1.0f;
      if (!(middle > -margin && middle < static_cast<float>(rows) + margin)) continue;
      const int first = static_cast<int>(std::floor(middle - reach_px_ / across - 0.5f));
      for (int y = std::max(first, 0); y < rows; ++y) {
        const float aside = (static_cast<float>(y) + 0.5f - middle) * across;
        if (aside >= reach_px_) break;
        const float cover = std::clamp(reach_px_ - std::abs(aside), 0.0f, 1.0f) * share;
        if (cover < kLeastCover) continue;
        const int column = static_cast<int>(x);
        blend(is_steep ? y : column, is_steep ? column : y, depth, cover, rgba);
      }
    }
  }

  /// A round mark, whatever lies before it.
  void draw_mark(const Place& at, const glm::vec4& rgba) const {
    const glm::vec4 rim(kRimShade * glm::vec3(rgba), rgba.a);
    const float radius_px = kMarkRadius_px * (2.0f * reach_px_ - 1.0f);
    const auto first = [radius_px](float middle) {
      return std::max(0, static_cast<int>(std::floor(middle - radius_px)));
    };
    const auto end = [radius_px](float middle, int size) {
      return std::min(size, static_cast<int>(std::ceil(middle + radius_px)) + 1);
    };
    for (int y = first(at.y); y < end(at.y, picture_.height_px); ++y) {
      for (int x = first(at.x); x < end(at.x, picture_.width_px); ++x) {
        const float off_px =
            std::hypot(static_cast<float>(x) + 0.5f - at.x, static_cast<float>(y) + 0.5f - at.y);
        const float cover = std::clamp(radius_px + 0.5f - off_px, 0.0f, 1.0f);
        if (cover < kLeastCover) continue;
        mix(pixel_at(x, y), cover, off_px > kRimBegins * radius_px ? rim : rgba);
      }
    }
  }

 private:
  std::size_t pixel_at(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(picture_.width_px) +
           static_cast<std::size_t>(x);
  }

  void blend(int x, int y, float depth, float cover, const glm::vec4& rgba) const {
    const std::size_t pixel = pixel_at(x, y);
    if (depth >= 1.0f || depth > depths_[pixel]) return;
    mix(pixel, cover, rgba);
    // The faint rim of a line hides nothing.
    if (cover >= 0.5f) depths_[pixel] = depth;
  }

  void mix(std::size_t pixel, float cover, const glm::vec4& rgba) const {
    const float alpha = cover * rgba.a;
    for (int k = 0; k < 3; ++k) {
      std::uint8_t& byte = picture_.rgb[3 * pixel + static_cast<std::size_t>(k)];
      const float mixed = static_cast<float>(byte) * (1 - alpha) + 255.0f * rgba[k] * alpha;
      byte = static_cast<std::uint8_t>(std::clamp(mixed, 0.0f, 255.0f) + 0.5f);
    }
  }

  Picture& picture_;
  std::vector<float>& depths_;
  float reach_px_;  ///< from the middle of a line to where nothing of it is left
};

/// Takes points of the scene to places of the picture.
class Lens {
 public:
  Lens(const Projection& projection, float towards_eye)
      : clip_from_world_(projection.clip_from_world),
        size_px_(projection.size_px),
        towards_eye_(towards_eye) {}

  glm::vec4 clip(const glm::vec3& point_mm) const {
    glm::vec4 at = clip_from_world_ * glm::vec4(point_mm, 1.0f);
    at.z -= towards_eye_;
    return at;
  }
  Place place(const glm::vec4& clip) const {
    const glm::vec3 ndc = glm::vec3(clip) / clip.w;
    return {(0.5f + 0.5f * ndc.x) * size_px_.x, (0.5f - 0.5f * ndc.y) * size_px_.y,
            std::clamp(0.5f + 0.5f * ndc.z, 0.0f, 1.0f)};
  }
  /// The part before the eye; none: all of it is behind.
  std::optional<std::pair<Place, Place>> places(glm::vec4 a, glm::vec4 b) const {
    if (a.w < kLeastW && b.w < kLeastW) return std::nullopt;
    const glm::vec4 way = b - a;
    if (a.w < kLeastW) a += way * ((kLeastW - a.w) / way.w);
    if (b.w < kLeastW) b -= way * ((b.w - kLeastW) / way.w);
    return std::pair(place(a), place(b));
  }

 private:
  glm::mat4 clip_from_world_;
  glm::vec2 size_px_;
  float towards_eye_;
};

std::size_t kind_index(PathKind kind) {
  return std::min<std::size_t>(static_cast<std::size_t>(kind), 2);
}

glm::vec4 path_color(PathKind kind, bool is_past) {
  const glm::vec3& color = kPathColors[kind_index(kind)];
  return {is_past ? color : glm::mix(kPaper, color, kFutureShare), 1.0f};
}

/// Segments until the next one of another colour or a pixel away are drawn as one.
void draw_chunk(const PathChunk& chunk, std::uint64_t past_vertices,
                const std::array<bool, 3>& is_shown, const Lens& lens, const Canvas& canvas) {
  const std::vector<PathVertex>& vertices = chunk.vertices;
  const std::uint64_t first = std::uint64_t{chunk.index} * kPathChunkSegments;
  const auto color_of = [&](std::size_t i) {
    return path_color(vertices[i].kind, first + i < past_vertices);
  };
  if (vertices.size() < 2) return;
  glm::vec4 from = lens.clip(vertices.front().position_mm);
  for (std::size_t i = 1; i < vertices.size(); ++i) {
    const glm::vec4 to = lens.clip(vertices[i].position_mm);
    const auto ends = lens.places(from, to);
    const bool may_grow = i + 1 < vertices.size() && color_of(i + 1) == color_of(i);
    if (ends && may_grow &&
        glm::distance(glm::vec2(ends->first), glm::vec2(ends->second)) < kLeastSegment_px) {
      continue;
    }
    if (ends && is_shown[kind_index(vertices[i].kind)]) {
      canvas.draw(ends->first, ends->second, color_of(i));
    }
    from = to;
  }
}

}  // namespace

void SceneLines::set_setup(const SceneSetup& setup) {
  markers_.clear();
  for (const LineSegment& line : setup.blank_outline) {
    markers_.push_back({line.from_mm, line.to_mm, kBlankColor});
  }
  const Vec3 size = setup.bounds_mm.size();
  const double usual_mm = setup.bounds_mm.empty()
                              ? kFrameWithoutBlank_mm
                              : kFrameShare * std::max({size.x, size.y, size.z});
  for (const SceneFrame& frame : setup.frames) {
    const auto length = static_cast<float>(frame.length_mm > 0.0 ? frame.length_mm : usual_mm);
    const std::array<glm::vec3, 3> axes{glm::vec3(frame.x_axis), glm::vec3(frame.y_axis),
                                        glm::vec3(glm::cross(frame.x_axis, frame.y_axis))};
    const glm::vec3 origin(frame.origin_mm);
    for (std::size_t k = 0; k < 3; ++k) {
      const glm::vec3 tip = origin + length * axes[k];
      markers_.push_back({origin, tip, kAxisColors[k]});
      for (const std::size_t side : {(k + 1) % 3, (k + 2) % 3}) {
        for (const float sign : {-0.4f, 0.4f}) {
          const glm::vec3 barb = tip + kBarb * length * (sign * axes[side] - axes[k]);
          markers_.push_back({tip, barb, kAxisColors[k]});
        }
      }
    }
  }
}

void SceneLines::set_findings(std::span<const SceneFinding> findings) {
  marks_.clear();
  for (const SceneFinding& finding : findings) {
    if (!finding.position_mm) continue;
    const glm::vec4& rgba = finding.severity == Severity::kError     ? kErrorColor
                            : finding.severity == Severity::kWarning ? kWarningColor
                                                                     : kNoteColor;
    marks_.push_back({glm::vec3(*finding.position_mm), rgba});
  }
}

void SceneLines::draw(const Projection& projection, const LineNearness& nearness,
                      std::uint64_t past_vertices, Picture* picture,
                      std::vector<float>* depths) const {
  const Canvas canvas(picture, depths, projection.line_px);
  const Lens path_lens(projection, nearness.path);
  for (const auto& chunk : path_) draw_chunk(*chunk, past_vertices, is_shown_, path_lens, canvas);
  const Lens marker_lens(projection, nearness.markers);
  for (const Line& line : markers_) {
    const auto ends =
        marker_lens.places(marker_lens.clip(line.from_mm), marker_lens.clip(line.to_mm));
    if (ends) canvas.draw(ends->first, ends->second, line.rgba);
  }
  for (const Mark& mark : marks_) {
    const glm::vec4 at = marker_lens.clip(mark.at_mm);
    if (at.w >= kLeastW) canvas.draw_mark(marker_lens.place(at), mark.rgba);
  }
}

}  // namespace kerf
