#include "viewer/window/tool_mesh.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

namespace kerf {
namespace {

constexpr std::uint32_t kAround = 48;
/// Segments of the outline that meet at a smaller angle share their normal (20 degrees).
constexpr float kSmoothCosine = 0.94f;

/// (radius, height) of the normal of the segment from a to b, outward for an outline that runs
/// upward.
glm::vec2 segment_normal(const ProfilePoint& a, const ProfilePoint& b) {
  const glm::vec2 along(b.radius_mm - a.radius_mm, b.height_mm - a.height_mm);
  return glm::normalize(glm::vec2(along.y, -along.x));
}

class Lathe {
 public:
  explicit Lathe(ToolMesh* mesh) : mesh_(mesh) {}

  ToolMesh::Part add(std::span<const ProfilePoint> outline) {
    const auto first = static_cast<std::uint32_t>(mesh_->indices.size());
    const std::vector<ProfilePoint> points = closed(outline);
    std::vector<glm::vec2> normals;
    for (std::size_t i = 0; i + 1 < points.size(); ++i) {
      normals.push_back(segment_normal(points[i], points[i + 1]));
    }
    for (std::size_t i = 0; i < normals.size(); ++i) {
      add_band(points[i], smooth(normals, i, i == 0 ? i : i - 1), points[i + 1],
               smooth(normals, i, std::min(i + 1, normals.size() - 1)));
    }
    return {first, static_cast<std::uint32_t>(mesh_->indices.size()) - first};
  }

 private:
  /// Starts and ends on the axis, without points that repeat.
  static std::vector<ProfilePoint> closed(std::span<const ProfilePoint> outline) {
    std::vector<ProfilePoint> points;
    if (outline.size() < 2) return points;
    points.push_back({0.0f, outline.front().height_mm});
    points.insert(points.end(), outline.begin(), outline.end());
    points.push_back({0.0f, outline.back().height_mm});
    points.erase(std::unique(points.begin(), points.end()), points.end());
    return points;
  }

  static glm::vec2 smooth(const std::vector<glm::vec2>& normals, std::size_t i, std::size_t other) {
    if (glm::dot(normals[i], normals[other]) < kSmoothCosine) return normals[i];
    return glm::normalize(normals[i] + normals[other]);
  }

  std::uint32_t add_ring(const ProfilePoint& point, const glm::vec2& normal) {
    const auto first = static_cast<std::uint32_t>(mesh_->vertices.size());
    for (std::uint32_t k = 0; k <= kAround; ++k) {
      const float angle =
          2.0f * static_cast<float>(kPi) * static_cast<float>(k % kAround) / kAround;
      const float c = std::cos(angle), s = std::sin(angle);
      const glm::vec3 p(point.radius_mm * c, point.radius_mm * s, point.height_mm);
      mesh_->vertices.push_back({p, pack_normal({normal.x * c, normal.x * s, normal.y})});
      mesh_->bounds_mm.extend(Vec3(p));
    }
    return first;
  }

  void add_band(const ProfilePoint& a, const glm::vec2& a_normal, const ProfilePoint& b,
                const glm::vec2& b_normal) {
    const std::uint32_t low = add_ring(a, a_normal);
    const std::uint32_t high = add_ring(b, b_normal);
    for (std::uint32_t k = 0; k < kAround; ++k) {
      const std::uint32_t quad[] = {low + k, low + k + 1,  high + k + 1,
                                    low + k, high + k + 1, high + k};
      mesh_->indices.insert(mesh_->indices.end(), std::begin(quad), std::end(quad));
    }
  }

  ToolMesh* mesh_;
};

}  // namespace

ToolMesh revolve(const ToolShape& shape) {
  ToolMesh mesh;
  Lathe lathe(&mesh);
  mesh.pieces = {lathe.add(shape.cutter), lathe.add(shape.shank), lathe.add(shape.holder),
                 lathe.add(shape.spindle)};
  return mesh;
}

}  // namespace kerf
