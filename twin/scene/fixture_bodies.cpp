#include "twin/scene/fixture_bodies.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <glm/geometric.hpp>
#include <memory>
#include <unordered_map>

namespace kerf {
namespace {

constexpr int kAround = 72;  // facets of what is round
constexpr int kUpward = 6;   // of the rounded edge of a disc
/// Bluish, and two thirds opaque.
constexpr std::uint32_t kFixtureColor = 0xa8b08a5a;

Pose pose_of_link(const glm::mat4& matrix) {
  const glm::dmat4 m(matrix);
  return {glm::dmat3(m), Vec3(m[3])};
}

struct PointHash {
  std::size_t operator()(const glm::vec3& p) const {
    std::uint64_t hash = 0;
    for (int i = 0; i < 3; ++i) {
      std::uint32_t bits = 0;
      std::memcpy(&bits, &p[i], sizeof bits);
      hash = (hash ^ bits) * 0x9e37'79b9'7f4a'7c15u;
    }
    return static_cast<std::size_t>(hash ^ hash >> 32);
  }
};

class DrawnMesh {
 public:
  void add_box(const Vec3& low, const Vec3& high) {
    std::array<std::uint32_t, 8> corner{};
    for (unsigned i = 0; i < 8; ++i) {
      corner[i] =
          add_point({i & 1u ? high.x : low.x, i & 2u ? high.y : low.y, i & 4u ? high.z : low.z});
    }
    constexpr std::array<std::array<unsigned, 4>, 6> kFaces{
        {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}}};
    for (const auto& f : kFaces) add_quad(corner[f[0]], corner[f[1]], corner[f[2]], corner[f[3]]);
  }

  /// The hull of its discs, as long as they are in order along the axis.
  void add_revolved(const Convex& piece) {
    const Vec3 z = piece.axis;
    const Vec3 across = std::abs(z.x) < 0.9 ? Vec3(1, 0, 0) : Vec3(0, 1, 0);
    const Vec3 y = glm::normalize(glm::cross(z, across)), x = glm::cross(y, z);
    std::vector<std::array<std::uint32_t, kAround>> rings;
    const auto add_ring = [&](double radius, double along) {
      std::array<std::uint32_t, kAround> ring{};
      for (int k = 0; k < kAround; ++k) {
        const double angle = 2 * kPi * k / kAround;
        ring[static_cast<std::size_t>(k)] = add_point(
            piece.origin_mm + along * z + radius * (std::cos(angle) * x + std::sin(angle) * y));
      }
      rings.push_back(ring);
    };
    const auto add_edge = [&](const RoundedDisc& disc, double from_rad) {
      const int steps = disc.round_mm > 0 ? kUpward : 0;
      for (int i = 0; i <= steps; ++i) {
        const double angle = from_rad + (steps > 0 ? 0.5 * kPi * i / steps : 0.0);
        add_ring(disc.radius_mm + disc.round_mm * std::cos(angle),
                 disc.along_mm + disc.round_mm * std::sin(angle));
      }
    };
    if (piece.discs.empty()) return;
    add_edge(piece.discs.front(), -0.5 * kPi);
    for (std::size_t i = 1; i + 1 < piece.discs.size(); ++i) {
      add_ring(piece.discs[i].radius_mm + piece.discs[i].round_mm, piece.discs[i].along_mm);
    }
    add_edge(piece.discs.back(), 0);
    for (std::size_t i = 0; i + 1 < rings.size(); ++i) {
      for (std::size_t k = 0; k < kAround; ++k) {
        const std::size_t next = (k + 1) % kAround;
        add_quad(rings[i][k], rings[i][next], rings[i + 1][next], rings[i + 1][k]);
      }
    }
    add_cap(rings.front(), true);
    add_cap(rings.back(), false);
  }

  void add_triangle(const Vec3& a, const Vec3& b, const Vec3& c) {
    add_triangle(add_shared(a), add_shared(b), add_shared(c));
  }

  TriangleMesh mesh;

 private:
  std::uint32_t add_point(const Vec3& p) {
    mesh.positions_mm.emplace_back(p);
    return static_cast<std::uint32_t>(mesh.positions_mm.size() - 1);
  }
  std::uint32_t add_shared(const Vec3& p) {
    const glm::vec3 place = glm::vec3(p) + glm::vec3(0.0f);  // -0 is 0
    const auto [at, is_new] =
        known_.try_emplace(place, static_cast<std::uint32_t>(mesh.positions_mm.size()));
    if (is_new) mesh.positions_mm.push_back(place);
    return at->second;
  }
  void add_triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    if (a != b && b != c && c != a) mesh.triangles.push_back({a, b, c});
  }
  void add_quad(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
    add_triangle(a, b, c);
    add_triangle(a, c, d);
  }
  void add_cap(const std::array<std::uint32_t, kAround>& ring, bool is_lower) {
    for (std::size_t k = 1; k + 1 < kAround; ++k) {
      if (is_lower) {
        add_triangle(ring[0], ring[k + 1], ring[k]);
      } else {
        add_triangle(ring[0], ring[k], ring[k + 1]);
      }
    }
  }

  std::unordered_map<glm::vec3, std::uint32_t, PointHash> known_;
};

}  // namespace

TriangleMesh drawn_mesh(const Solid& solid) {
  DrawnMesh drawn;
  for (const Convex& piece : solid.pieces()) {
    switch (piece.kind) {
      case Convex::Kind::kBox:
        drawn.add_box(piece.corners[0], piece.corners[1]);
        break;
      case Convex::Kind::kRevolved:
        drawn.add_revolved(piece);
        break;
      case Convex::Kind::kHull:
        drawn.add_triangle(piece.corners[0], piece.corners[1], piece.corners[2]);
        break;
    }
  }
  return std::move(drawn.mesh);
}

SceneMachine scene_fixtures(const std::vector<Fixture>& fixtures) {
  SceneMachine scene;
  scene.name = "fixtures";
  for (const Fixture& fixture : fixtures) {
    scene.links.push_back({fixture.name,
                           std::make_shared<const TriangleMesh>(drawn_mesh(*fixture.solid)),
                           kFixtureColor});
  }
  return scene;
}

std::vector<std::optional<Pose>> fixture_places(const std::vector<Fixture>& fixtures,
                                                const SceneMachine& machine,
                                                std::span<const glm::mat4> link_poses) {
  std::vector<std::optional<Pose>> places;
  for (const Fixture& fixture : fixtures) {
    if (fixture.on.empty()) {
      places.emplace_back(fixture.workpiece_from_fixture);
      continue;
    }
    const auto link = std::ranges::find(machine.links, fixture.on, &MachineLink::name);
    const auto number = static_cast<std::size_t>(link - machine.links.begin());
    if (link == machine.links.end() || number >= link_poses.size()) {
      places.emplace_back();
    } else {
      places.emplace_back(pose_of_link(link_poses[number]) * fixture.workpiece_from_fixture);
    }
  }
  return places;
}

std::vector<PictureBody> picture_bodies(const std::vector<Fixture>& fixtures) {
  const SceneMachine scene = scene_fixtures(fixtures);
  std::vector<PictureBody> bodies;
  for (std::size_t i = 0; i < fixtures.size(); ++i) {
    if (!fixtures[i].on.empty()) continue;
    bodies.push_back(
        {scene.links[i].mesh, to_mat4(fixtures[i].workpiece_from_fixture), scene.links[i].color});
  }
  return bodies;
}

std::vector<glm::mat4> fixture_poses(const std::vector<std::optional<Pose>>& places) {
  std::vector<glm::mat4> poses;
  for (const std::optional<Pose>& place : places)
    poses.push_back(place ? to_mat4(*place) : kNotDrawn);
  return poses;
}

}  // namespace kerf
