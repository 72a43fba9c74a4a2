#include "viewer/window/tool_mesh.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <utility>

namespace kerf {
namespace {

constexpr std::uint32_t kAround = 48;
/// Segments of the outline that meet at a smaller angle share their normal (20 degrees).
constexpr float kSmoothCosine = 0.94f;
/// Of a plate's edges so much is seen from above, and so much does the rest stand higher.
constexpr float kLand_mm = 0.5f, kRaised_mm = 0.03f;

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

/// What of a convex outline lies at least `inset` behind its edges that cut.
std::vector<glm::vec2> behind_edges(const std::vector<ToolPlate::Corner>& corners, float inset) {
  std::vector<glm::vec2> inner;
  for (const ToolPlate::Corner& corner : corners) inner.push_back(corner.zx_mm);
  for (std::size_t i = 0; i < corners.size(); ++i) {
    if (!corners[i].cuts) continue;
    const glm::vec2 from = corners[i].zx_mm, to = corners[(i + 1) % corners.size()].zx_mm;
    const glm::vec2 along = glm::normalize(to - from);
    const auto depth = [&](const glm::vec2& p) {
      return glm::dot(p - from, glm::vec2(-along.y, along.x)) - inset;
    };
    std::vector<glm::vec2> rest;
    for (std::size_t k = 0; k < inner.size(); ++k) {
      const glm::vec2 here = inner[k], next = inner[(k + 1) % inner.size()];
      const float d = depth(here), d_next = depth(next);
      if (d >= 0) rest.push_back(here);
      if ((d >= 0) != (d_next >= 0)) rest.push_back(here + d / (d - d_next) * (next - here));
    }
    inner = std::move(rest);
  }
  return inner;
}

class PlateMaker {
 public:
  explicit PlateMaker(ToolMesh* mesh) : mesh_(mesh) {}

  /// What of the plates belongs to the piece.
  void add(std::span<const ToolPlate> plates, ToolPiece piece) {
    for (const ToolPlate& plate : plates) {
      if (plate.corners.size() < 3) continue;
      if (piece == ToolPiece::kShank && !plate.is_holder) {
        add_middle(plate);
      } else if (piece == (plate.is_holder ? ToolPiece::kHolder : ToolPiece::kCutter)) {
        add_block(plate);
      }
    }
  }

 private:
  std::uint32_t corner(const glm::vec2& zx, float y, const glm::vec3& normal) {
    const glm::vec3 p(zx.y, y, zx.x);
    mesh_->vertices.push_back({p, pack_normal(normal)});
    mesh_->bounds_mm.extend(Vec3(p));
    return static_cast<std::uint32_t>(mesh_->vertices.size()) - 1;
  }

  /// A chain that is counter-clockwise with z to the right and x up is so seen from +y.
  void add_face(const std::vector<glm::vec2>& chain, float y, float side) {
    if (chain.size() < 3) return;
    std::vector<std::uint32_t> rim;
    for (const glm::vec2& zx : chain) rim.push_back(corner(zx, y, {0.0f, side, 0.0f}));
    for (std::size_t i = 1; i + 1 < rim.size(); ++i) {
      const std::size_t second = side > 0 ? i : i + 1, third = side > 0 ? i + 1 : i;
      mesh_->indices.insert(mesh_->indices.end(), {rim[0], rim[second], rim[third]});
    }
  }

  void add_block(const ToolPlate& plate) {
    std::vector<glm::vec2> chain;
    for (const ToolPlate::Corner& at : plate.corners) chain.push_back(at.zx_mm);
    add_face(chain, plate.high_y_mm, 1.0f);
    add_face(chain, plate.low_y_mm, -1.0f);
    std::vector<glm::vec2> normals;
    for (std::size_t i = 0; i < chain.size(); ++i) {
      const glm::vec2 along = glm::normalize(chain[(i + 1) % chain.size()] - chain[i]);
      normals.emplace_back(along.y, -along.x);
    }
    for (std::size_t i = 0; i < chain.size(); ++i) {
      const std::size_t before = (i + chain.size() - 1) % chain.size();
      const std::size_t next = (i + 1) % chain.size();
      const glm::vec2 begin = smooth(normals[i], normals[before]);
      const glm::vec2 end = smooth(normals[i], normals[next]);
      const auto at = [&](const glm::vec2& zx, float y, const glm::vec2& n) {
        return corner(zx, y, {n.y, 0.0f, n.x});
      };
      const std::uint32_t a = at(chain[i], plate.low_y_mm, begin);
      const std::uint32_t b = at(chain[next], plate.low_y_mm, end);
      const std::uint32_t c = at(chain[next], plate.high_y_mm, end);
      const std::uint32_t d = at(chain[i], plate.high_y_mm, begin);
      mesh_->indices.insert(mesh_->indices.end(), {a, b, c, a, c, d});
    }
  }

  void add_middle(const ToolPlate& plate) {
    add_face(behind_edges(plate.corners, kLand_mm), plate.high_y_mm + kRaised_mm, 1.0f);
  }

  static glm::vec2 smooth(const glm::vec2& normal, const glm::vec2& other) {
    return glm::dot(normal, other) < kSmoothCosine ? normal : glm::normalize(normal + other);
  }

  ToolMesh* mesh_;
};

}  // namespace

ToolMesh tool_mesh(const ToolShape& shape) {
  ToolMesh mesh;
  Lathe lathe(&mesh);
  PlateMaker plates(&mesh);
  const std::array<std::span<const ProfilePoint>, kToolPieceCount> outlines{
      shape.cutter, shape.shank, shape.holder, shape.spindle};
  for (std::size_t i = 0; i < kToolPieceCount; ++i) {
    mesh.pieces[i] = lathe.add(outlines[i]);
    plates.add(shape.plates, static_cast<ToolPiece>(i));
    mesh.pieces[i].index_count =
        static_cast<std::uint32_t>(mesh.indices.size()) - mesh.pieces[i].first_index;
  }
  return mesh;
}

}  // namespace kerf
