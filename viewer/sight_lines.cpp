#include "viewer/sight_lines.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat4x4.hpp>
#include <glm/matrix.hpp>

namespace kerf {
namespace {

/// Lines to a side of the box each way: a link that comes before it step by step fades in steps of
/// a hundredth.
constexpr int kLinesEachWay = 6;
/// Of the box's size.
constexpr double kBefore = 1e-3;

}  // namespace

std::vector<SightLine> sight_lines(const Box& box, const Projection& eye, double reach_mm) {
  std::vector<SightLine> lines;
  if (box.empty()) return lines;
  const glm::dmat4 world_from_view = glm::inverse(glm::dmat4(eye.view_from_world));
  const glm::dmat4 clip_from_view = glm::dmat4(eye.clip_from_world) * world_from_view;
  const bool is_perspective = std::abs(clip_from_view[2][3]) > 0.5;
  const Vec3 at(world_from_view[3]), back = glm::normalize(Vec3(world_from_view[2]));
  const Vec3 size = box.size();
  const double before_mm = kBefore * glm::length(size);
  double sum = 0.0;
  for (int side = 0; side < 6; ++side) {
    const int axis = side / 2, u = (axis + 1) % 3, v = (axis + 2) % 3;
    const double outwards = side % 2 == 0 ? -1.0 : 1.0;
    for (int cell = 0; cell < kLinesEachWay * kLinesEachWay; ++cell) {
      Vec3 to(0.0);
      to[axis] = side % 2 == 0 ? box.min[axis] : box.max[axis];
      to[u] = box.min[u] + (cell % kLinesEachWay + 0.5) / kLinesEachWay * size[u];
      to[v] = box.min[v] + (cell / kLinesEachWay + 0.5) / kLinesEachWay * size[v];
      const Vec3 from = is_perspective ? at : to + reach_mm * back;
      const Vec3 way = from - to;
      const double length_mm = glm::length(way);
      const double cosine = length_mm > 0.0 ? outwards * way[axis] / length_mm : 0.0;
      // The side as large as it appears.
      const double near = is_perspective ? 1.0 / (length_mm * length_mm) : 1.0;
      const double share = cosine * size[u] * size[v] * near;
      if (!(share > 0.0) || length_mm <= before_mm) continue;
      lines.push_back({from, to + before_mm / length_mm * way, share});
      sum += share;
    }
  }
  for (SightLine& line : lines) line.share /= sum;
  return lines;
}

float most_opacity(const MeshRays& body, const glm::mat4& pose, std::span<const SightLine> lines) {
  const glm::dmat4 body_from_world = glm::inverse(glm::dmat4(pose));
  const auto in_body = [&](const Vec3& at) { return Vec3(body_from_world * glm::dvec4(at, 1.0)); };
  double hidden = 0.0;
  for (const SightLine& line : lines) {
    if (body.hits(in_body(line.from_mm), in_body(line.to_mm))) hidden += line.share;
  }
  const double faded = std::clamp((hidden - kMayHide) / (kHidesAll - kMayHide), 0.0, 1.0);
  return glm::mix(1.0f, kClearest, static_cast<float>(faded));
}

}  // namespace kerf
