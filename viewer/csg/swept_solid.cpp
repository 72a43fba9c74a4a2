#include "viewer/csg/swept_solid.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "base/mesh_patch.h"

namespace kerf {
namespace {

constexpr int kMinSides = 8;
constexpr int kMaxSides = 128;
/// A face of the bottom of a solid, seen as the ring below the first one.
constexpr int kDisc = -1;
/// Shorter vectors have no direction.
constexpr double kNoLength_mm = 1e-9;

/// Half the angle of a side whose middle is no more than `tolerance` from its circle.
double half_angle_rad(double radius_mm, double tolerance_mm) {
  return std::acos(1.0 - std::min(1.0, tolerance_mm / radius_mm));
}

}  // namespace

std::vector<SweptMove> chords(const SweptArc& arc, double tolerance_mm) {
  const auto height = [&arc](const Vec3& p) { return glm::dot(p - arc.center_mm, arc.axis); };
  const auto arm = [&](const Vec3& p) { return p - arc.center_mm - height(p) * arc.axis; };
  const Vec3 first = arm(arc.from_mm);
  const Vec3 last = arm(arc.to_mm);
  const double radius = glm::length(first);
  const double end_radius = glm::length(last);
  if (radius < kNoLength_mm || end_radius < kNoLength_mm) {
    return {{arc.from_mm, arc.to_mm, arc.tool}};
  }
  const Vec3 u = first / radius;
  const Vec3 v = glm::cross(arc.axis, u);
  double angle = std::atan2(glm::dot(last, v), glm::dot(last, u));
  if (angle <= kNoLength_mm / radius) angle += 2.0 * kPi;
  angle += 2.0 * kPi * arc.whole_turns;
  const double step = 2.0 * half_angle_rad(std::max(radius, end_radius), tolerance_mm);
  const int count = std::max(1, static_cast<int>(std::ceil(angle / step)));
  std::vector<SweptMove> moves;
  moves.reserve(static_cast<std::size_t>(count));
  Vec3 from = arc.from_mm;
  for (int i = 1; i <= count; ++i) {
    const double share = static_cast<double>(i) / count;
    const double r = radius + share * (end_radius - radius);
    const double z = height(arc.from_mm) + share * (height(arc.to_mm) - height(arc.from_mm));
    const Vec3 to = i == count
                        ? arc.to_mm
                        : arc.center_mm + z * arc.axis +
                              r * (std::cos(share * angle) * u + std::sin(share * angle) * v);
    moves.push_back({from, to, arc.tool});
    from = to;
  }
  return moves;
}

SweepBuilder::SweepBuilder(double tolerance_mm, double material_top_mm, double solid_top_mm)
    : tolerance_mm_(tolerance_mm), material_top_mm_(material_top_mm), solid_top_mm_(solid_top_mm) {}

SolidMesh SweepBuilder::build(const ConvexProfile& piece, Vec3 from_mm, Vec3 to_mm,
                              std::uint32_t color) {
  // The tip above the material removes nothing there; only the part of the move below counts.
  const double room = material_top_mm_ - piece.front().y;
  if (std::min(from_mm.z, to_mm.z) >= room) return {};
  if (from_mm.z > room) {
    from_mm = glm::mix(to_mm, from_mm, (room - to_mm.z) / (from_mm.z - to_mm.z));
  } else if (to_mm.z > room) {
    to_mm = glm::mix(from_mm, to_mm, (room - from_mm.z) / (to_mm.z - from_mm.z));
  }
  profile_ = below(piece, material_top_mm_ - std::min(from_mm.z, to_mm.z));
  if (profile_.empty()) return {};
  from_mm_ = from_mm;
  to_mm_ = to_mm;
  color_ = color;
  top_mm_ = std::max(solid_top_mm_, std::max(from_mm.z, to_mm.z) + profile_.back().y);
  choose_sides(profile_.back().x, to_mm - from_mm);

  SolidMesh mesh;
  add_faces(&mesh);
  add_cap(&mesh);
  add_walls(&mesh);
  for (const SolidVertex& v : mesh.vertices) mesh.bounds_mm.extend(Vec3(v.position_mm));
  return mesh;
}

void SweepBuilder::choose_sides(double radius_mm, const Vec3& move) {
  const double sides = std::ceil(kPi / half_angle_rad(radius_mm, tolerance_mm_));
  int count = static_cast<int>(std::min(sides, static_cast<double>(kMaxSides)));
  count = std::max(kMinSides, count + count % 2);  // even: corners on both sides of the move
  const bool is_level = glm::length(Vec2(move)) > kNoLength_mm;
  const double across = is_level ? std::atan2(move.y, move.x) + 0.5 * kPi : 0.0;
  directions_.clear();
  for (int i = 0; i < count; ++i) {
    const double angle = across + 2.0 * kPi * i / count;
    directions_.emplace_back(std::cos(angle), std::sin(angle));
  }
  const std::size_t corners = static_cast<std::size_t>((rings() + 1) * count);
  vertex_of_corner_.assign(2 * corners, -1);
  is_first_corner_.clear();
  end_of_face_.clear();
  for (int ring = 0; ring < rings(); ++ring) {
    for (int side = 0; side < count; ++side) {
      end_of_face_.push_back(glm::dot(outward(ring, side), move) > 0.0 ? 1 : 0);
    }
  }
}

bool SweepBuilder::is_pointed() const { return profile_.front().x == 0.0; }

/// Of the face above `ring` (of the disc: below the first ring), between corners side and side + 1.
Vec3 SweepBuilder::outward(int ring, int side) const {
  if (ring == kDisc) return {0.0, 0.0, -1.0};
  const std::size_t count = directions_.size();
  const auto i = static_cast<std::size_t>(side);
  const Vec2 middle = 0.5 * (directions_[i] + directions_[(i + 1) % count]);
  const Vec2 across = glm::normalize(middle);
  if (ring + 1 == rings()) return {across, 0.0};
  const Vec2 step =
      profile_[static_cast<std::size_t>(ring) + 1] - profile_[static_cast<std::size_t>(ring)];
  return glm::normalize(Vec3(step.y * across, -step.x * glm::length(middle)));
}

int SweepBuilder::end_of(int ring, int side) const {
  if (ring == kDisc) return to_mm_.z < from_mm_.z ? 1 : 0;
  const int count = static_cast<int>(directions_.size());
  return end_of_face_[static_cast<std::size_t>(ring * count + (side + count) % count)];
}

Vec3 SweepBuilder::position(const Corner& corner) const {
  const Vec3& tip = corner.end == 1 ? to_mm_ : from_mm_;
  const bool is_top = corner.ring == rings();
  const Vec2& at = profile_[static_cast<std::size_t>(is_top ? corner.ring - 1 : corner.ring)];
  const Vec2& direction = directions_[static_cast<std::size_t>(corner.side)];
  return {Vec2(tip) + at.x * direction, is_top ? top_mm_ : tip.z + at.y};
}

std::uint16_t SweepBuilder::vertex(const Corner& corner, SolidMesh* mesh) {
  const int count = static_cast<int>(directions_.size());
  const int side = corner.ring == 0 && is_pointed() ? 0 : corner.side;
  const int slot = (corner.end * (rings() + 1) + corner.ring) * count + side;
  std::int32_t& known = vertex_of_corner_[static_cast<std::size_t>(slot)];
  if (known < 0) {
    known = static_cast<std::int32_t>(mesh->vertices.size());
    mesh->vertices.push_back({glm::vec3(position({corner.end, corner.ring, side})), 0, color_});
    is_first_corner_.push_back(false);
  }
  return static_cast<std::uint16_t>(known);
}

/// As a fan around a corner that is not yet the first one of another face.
void SweepBuilder::add_face(const std::vector<Corner>& corners, const Vec3& outward,
                            SolidMesh* mesh) {
  const std::size_t count = corners.size();
  std::size_t first = 0;
  while (first < count && is_first_corner_[vertex(corners[first], mesh)]) ++first;
  std::uint16_t pivot = 0;
  if (first < count) {
    pivot = vertex(corners[first], mesh);
  } else {
    first = 0;
    pivot = static_cast<std::uint16_t>(mesh->vertices.size());
    mesh->vertices.push_back(mesh->vertices[vertex(corners[0], mesh)]);
    is_first_corner_.push_back(false);
  }
  is_first_corner_[pivot] = true;
  mesh->vertices[pivot].normal = pack_normal(glm::vec3(-outward));
  for (std::size_t i = 1; i + 1 < count; ++i) {
    mesh->indices.insert(mesh->indices.end(), {pivot, vertex(corners[(first + i) % count], mesh),
                                               vertex(corners[(first + i + 1) % count], mesh)});
  }
}

void SweepBuilder::add_faces(SolidMesh* mesh) {
  const int count = static_cast<int>(directions_.size());
  for (int ring = 0; ring < rings(); ++ring) {
    for (int side = 0; side < count; ++side) {
      const int end = end_of(ring, side);
      const int next = (side + 1) % count;
      corners_ = {{end, ring + 1, side}, {end, ring, side}};
      if (ring > 0 || !is_pointed()) corners_.push_back({end, ring, next});
      corners_.push_back({end, ring + 1, next});
      add_face(corners_, outward(ring, side), mesh);
    }
  }
  if (is_pointed()) return;
  corners_.clear();
  for (int side = count; side-- > 0;) corners_.push_back({end_of(kDisc, 0), 0, side});
  add_face(corners_, outward(kDisc, 0), mesh);
}

void SweepBuilder::add_cap(SolidMesh* mesh) {
  const int count = static_cast<int>(directions_.size());
  corners_.clear();
  for (int side = 0; side < count; ++side) {
    const int before = end_of(rings() - 1, side - 1);
    const int after = end_of(rings() - 1, side);
    corners_.push_back({before, rings(), side});
    if (after != before) corners_.push_back({after, rings(), side});
  }
  add_face(corners_, {0.0, 0.0, 1.0}, mesh);
}

void SweepBuilder::add_walls(SolidMesh* mesh) {
  const int count = static_cast<int>(directions_.size());
  for (int ring = 0; ring < rings(); ++ring) {
    for (int side = 0; side < count; ++side) {
      const int end = end_of(ring, side);
      add_wall({0, ring, side}, {0, ring + 1, side}, end_of(ring, side - 1), end, mesh);
      if (ring == 0 && is_pointed()) continue;
      add_wall({0, ring, (side + 1) % count}, {0, ring, side}, end_of(ring - 1, side), end, mesh);
    }
  }
}

/// Joins the edge p-q, which runs so in the face at end_a, to the same edge of the face at end_b.
void SweepBuilder::add_wall(const Corner& p, const Corner& q, int end_a, int end_b,
                            SolidMesh* mesh) {
  if (end_a == end_b) return;
  corners_ = {{end_a, q.ring, q.side},
              {end_a, p.ring, p.side},
              {end_b, p.ring, p.side},
              {end_b, q.ring, q.side}};
  // Two sides may have no length: by its diagonals.
  const Vec3 area = glm::cross(position(corners_[2]) - position(corners_[0]),
                               position(corners_[3]) - position(corners_[1]));
  const double size = glm::length(area);
  const Vec3 outward = size > 0.0 ? area / size : Vec3(0.0, 0.0, 1.0);
  add_face(corners_, outward, mesh);
}

}  // namespace kerf
