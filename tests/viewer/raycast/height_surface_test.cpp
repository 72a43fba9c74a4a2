// Where rays meet the surface: against closed forms, and against every triangle of the patches.
#include "viewer/raycast/height_surface.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <optional>

#include "tests/stock/random_part.h"
#include "tests/viewer/raycast/sample_grids.h"

namespace kerf {
namespace {

using test::make_grid;

const Box kBox{Vec3(-3, 5, -10), Vec3(17, 20, 0)};

HeightSurface surface_of(std::shared_ptr<const HeightGrid> grid) {
  HeightSurface surface;
  surface.update(std::move(grid), 1);
  return surface;
}

std::optional<Vec3> meet(const HeightSurface& surface, const Vec3& from, const Vec3& to) {
  const Ray ray{from, to - from, 0.0};
  SurfaceHit hit;
  if (!surface.trace(ray, &hit)) return std::nullopt;
  return from + hit.t * (to - from);
}

glm::vec3 normal_at(const HeightSurface& surface, const Vec3& from, const Vec3& to) {
  const Ray ray{from, to - from, 0.0};
  SurfaceHit hit;
  EXPECT_TRUE(surface.trace(ray, &hit));
  return surface.normal(ray, hit);
}

Vec3 random_point(std::mt19937& random, const Box& box) {
  std::uniform_real_distribution<double> share(0, 1);
  const Vec3 size = box.size();
  return box.min + Vec3{share(random) * size.x, share(random) * size.y, share(random) * size.z};
}

TEST(HeightSurface, ABlockIsABox) {
  for (const int cells : {20, 150}) {
    const HeightSurface surface =
        surface_of(make_grid(kBox, cells, cells * 3 / 4, [](double, double) { return -2.0; }));
    Box block = kBox;
    block.max.z = -2.0;
    std::mt19937 random(1);
    Box around = kBox;
    around.extend(kBox.min - Vec3(15));
    around.extend(kBox.max + Vec3(15));
    int hits = 0;
    for (int n = 0; n < 20000; ++n) {
      const Vec3 from = random_point(random, around), to = random_point(random, kBox);
      if (from.x > block.min.x && from.x < block.max.x && from.y > block.min.y &&
          from.y < block.max.y && from.z > block.min.z && from.z < block.max.z)
        continue;
      // Slabs.
      double in = 0, out = 1e9;
      for (int axis = 0; axis < 3; ++axis) {
        const double d = to[axis] - from[axis];
        const double a = (block.min[axis] - from[axis]) / d, b = (block.max[axis] - from[axis]) / d;
        in = std::max(in, std::min(a, b));
        out = std::min(out, std::max(a, b));
      }
      const std::optional<Vec3> met = meet(surface, from, to);
      ASSERT_EQ(met.has_value(), in < out) << n;
      if (!met) continue;
      ++hits;
      ASSERT_LT(glm::length(*met - (from + in * (to - from))), 1e-9) << n;
      const glm::vec3 normal = normal_at(surface, from, to);
      for (int axis = 0; axis < 3; ++axis) {
        const double face = normal[axis] > 0 ? block.max[axis] : block.min[axis];
        if (std::abs(normal[axis]) > 0.5f) {
          // Beside an edge it may be that of the other face.
          ASSERT_NEAR((*met)[axis], face, 1e-4);
        }
      }
      ASSERT_NEAR(glm::length(normal), 1.0f, 1e-3f);
    }
    EXPECT_GT(hits, 8000);
  }
}

TEST(HeightSurface, ARampIsAPlane) {
  const auto z = [](double x, double y) { return -4 + 0.2 * x - 0.1 * y; };
  const HeightSurface surface = surface_of(make_grid(kBox, 200, 150, z));
  std::mt19937 random(2);
  // Not at the rim: there the outer cells' corners are at their own heights.
  const Box middle{Vec3(-2, 6, -12), Vec3(16, 19, -12)};
  for (int n = 0; n < 5000; ++n) {
    const Vec3 to = random_point(random, middle);
    const Vec3 at(to.x, to.y, z(to.x, to.y));
    const Vec3 from = at + 5.0 * (random_point(random, {Vec3(-1, -1, 0.5), Vec3(1, 1, 2)}));
    const std::optional<Vec3> met = meet(surface, from, at + 0.1 * (at - from));
    ASSERT_TRUE(met);
    ASSERT_LT(glm::length(*met - at), 2e-5) << n;
    const glm::vec3 normal = normal_at(surface, from, at);
    ASSERT_LT(glm::length(normal - glm::normalize(glm::vec3(-0.2f, 0.1f, 1))), 4e-3f) << n;
  }
}

TEST(HeightSurface, ABowlIsRoundWithinTheCell) {
  const Vec3 center(7, 12, 3);
  constexpr double kRadius = 7.0;
  const auto bowl = [&](double x, double y) {
    const double r2 = kRadius * kRadius - (x - 7) * (x - 7) - (y - 12) * (y - 12);
    return r2 > 0 ? std::min(0.0, 3 - std::sqrt(r2)) : 0.0;
  };
  for (const int cells : {100, 400}) {
    const double cell = 20.0 / cells;
    const HeightSurface surface = surface_of(make_grid(kBox, cells, cells * 3 / 4, bowl));
    std::mt19937 random(3);
    double worst = 0, worst_cosine = 1;
    for (int n = 0; n < 5000; ++n) {
      const Vec3 from = center + random_point(random, {Vec3(-3, -3, 0), Vec3(3, 3, 4)});
      const Vec3 to = center + random_point(random, {Vec3(-3, -3, -8), Vec3(3, 3, -6)});
      const std::optional<Vec3> met = meet(surface, from, to);
      ASSERT_TRUE(met);
      worst = std::max(worst, std::abs(glm::length(*met - center) - kRadius));
      worst_cosine = std::min(
          worst_cosine, glm::dot(Vec3(normal_at(surface, from, to)), (center - *met) / kRadius));
    }
    // Flat triangles under a sphere, their corners the means of four cells: 3/4 of cell^2 / radius.
    EXPECT_LT(worst, 0.75 * cell * cell / kRadius);
    EXPECT_GT(worst_cosine, 0.997);
  }
}

TEST(HeightSurface, AWallStandsOnTheLineBetweenCells) {
  // A step at x = 7: 0 on the left, -6 on the right.
  const HeightSurface surface =
      surface_of(make_grid(kBox, 80, 60, [](double x, double) { return x < 7 ? 0.0 : -6.0; }));
  for (const double z : {-0.001, -1.0, -3.3, -5.999}) {
    const std::optional<Vec3> met = meet(surface, Vec3(16, 11, z), Vec3(0, 12.3, z));
    ASSERT_TRUE(met);
    EXPECT_NEAR(met->x, 7.0, 1e-9);
    EXPECT_NEAR(met->z, z, 1e-9);
    const glm::vec3 normal = normal_at(surface, Vec3(16, 11, z), Vec3(0, 12.3, z));
    EXPECT_LT(glm::length(normal - glm::vec3(1, 0, 0)), 1e-6f);
  }
  // Over the edge, and below the lower floor.
  EXPECT_FALSE(meet(surface, Vec3(25, 11, 0.001), Vec3(-9, 11, 0.001)));
  const std::optional<Vec3> side = meet(surface, Vec3(25, 11, -6.001), Vec3(-9, 11, -6.001));
  ASSERT_TRUE(side);
  EXPECT_NEAR(side->x, 17.0, 1e-9);
}

TEST(HeightSurface, LooksThroughAHoleFromBothSides) {
  // No material for 5 < x < 9, 10 < y < 14.
  const HeightSurface surface = surface_of(make_grid(kBox, 80, 60, [](double x, double y) {
    return x > 5 && x < 9 && y > 10 && y < 14 ? -10.0 : 0.0;
  }));
  EXPECT_FALSE(meet(surface, Vec3(6, 12, 5), Vec3(8, 12.5, -15)));
  EXPECT_FALSE(meet(surface, Vec3(6, 12, -15), Vec3(8, 12.5, 5)));
  const std::optional<Vec3> wall = meet(surface, Vec3(6, 12, -15), Vec3(12, 12, 5));
  ASSERT_TRUE(wall);
  EXPECT_NEAR(wall->x, 9.0, 1e-9);
  const std::optional<Vec3> floor = meet(surface, Vec3(11, 12, -15), Vec3(11, 13, 5));
  ASSERT_TRUE(floor);
  EXPECT_NEAR(floor->z, -10.0, 1e-9);
  EXPECT_EQ(normal_at(surface, Vec3(11, 12, -15), Vec3(11, 13, 5)), glm::vec3(0, 0, -1));
}

TEST(HeightSurface, NoMaterialAndNoGridAreMet) {
  const HeightSurface nothing = surface_of(nullptr);
  EXPECT_FALSE(meet(nothing, Vec3(0, 0, 50), Vec3(0, 0, -50)));
  const HeightSurface empty =
      surface_of(make_grid(kBox, 80, 60, [](double, double) { return -10.0; }));
  EXPECT_FALSE(meet(empty, Vec3(0, 10, 50), Vec3(0, 10, -50)));
  EXPECT_FALSE(meet(empty, Vec3(0, 10, -50), Vec3(0, 10, 50)));
}

/// Ray against all triangles of all patches, in double precision.
class Triangles {
 public:
  explicit Triangles(const StockModel& model) {
    for (std::uint32_t tile = 0; tile < model.tile_count(); ++tile) {
      const MeshPatch patch = model.patch(tile, 0);
      const auto indices = patch.surface_indices();
      for (std::size_t n = 0; n < indices.size(); n += 3) {
        const auto corner = [&](std::size_t k) {
          const MeshVertex& vertex = patch.vertices[indices[n + k]];
          return std::pair{Vec3(vertex.position_mm), Vec3(unpack_normal(vertex.normal))};
        };
        triangles_.push_back({corner(0), corner(1), corner(2)});
      }
    }
  }
  std::size_t size() const { return triangles_.size(); }

  struct Met {
    double t = 0;
    Vec3 normal{0};
  };
  std::optional<Met> first(const Ray& ray) const {
    constexpr double kSlack = 1e-9;  // of the barycentric numbers: edges are hit from both sides
    std::optional<Met> best;
    for (const auto& [a, b, c] : triangles_) {
      const Vec3 e = b.first - a.first, f = c.first - a.first;
      const Vec3 p = glm::cross(ray.direction_mm, f);
      const double det = glm::dot(e, p);
      if (det == 0) continue;
      const Vec3 s = ray.origin_mm - a.first;
      const double u = glm::dot(s, p) / det;
      const Vec3 q = glm::cross(s, e);
      const double v = glm::dot(ray.direction_mm, q) / det;
      if (u < -kSlack || v < -kSlack || u + v > 1 + kSlack) continue;
      const double t = glm::dot(f, q) / det;
      if (t <= ray.t_min || (best && best->t <= t)) continue;
      best = {t, glm::normalize((1 - u - v) * a.second + u * b.second + v * c.second)};
    }
    return best;
  }

 private:
  using Corner = std::pair<Vec3, Vec3>;
  struct Triangle {
    Corner a, b, c;
  };
  std::vector<Triangle> triangles_;
};

struct Facing {
  int met = 0, turned = 0;  ///< rays; those of them where the surface faces another way
};

/// Of rays from one box to another that meet triangles whose normal's z lies between these.
Facing compare_facing(const ZMap& part, const Box& from, const Box& to, double least_z,
                      double most_z) {
  const Triangles triangles(part);
  const HeightSurface surface = surface_of(part.height_grid());
  std::mt19937 random(11);
  Facing facing;
  for (int n = 0; n < 1500; ++n) {
    const Vec3 origin = random_point(random, from);
    const Ray ray{origin, random_point(random, to) - origin, 0.0};
    SurfaceHit hit;
    const std::optional<Triangles::Met> wanted = triangles.first(ray);
    if (!wanted || !surface.trace(ray, &hit)) continue;
    if (const double z = std::abs(wanted->normal.z); z < least_z || z > most_z) continue;
    ++facing.met;
    facing.turned += glm::dot(wanted->normal, Vec3(surface.normal(ray, hit))) < 0.9999;
  }
  return facing;
}

TEST(HeightSurface, WallsFaceAsTheTrianglesDo) {
  const std::unique_ptr<ZMap> part = test::make_map("box:0,0,-8:24,18,0", 0.11);
  const Vec3 center(11.3, 9.2, -5);
  std::vector<CutMove> moves;
  const auto cut_to = [&](const Vec3& from, const Vec3& to) {
    CutMove& move = moves.emplace_back();
    move.from_mm = from;
    move.to_mm = to;
  };
  constexpr int kSides = 180;
  for (int n = 0; n < kSides; ++n) {
    const auto at = [&](int side) {
      const double turn = 2 * 3.14159265358979 * side / kSides;
      return center + 4.7 * Vec3(std::cos(turn), std::sin(turn), 0);
    };
    cut_to(at(n), at(n + 1));
  }
  cut_to(Vec3(2, 3, -4), Vec3(21, 6, -3));
  test::cut(*part, *parse_shape("flat:4"), moves);
  test::finish(*part);
  const Facing walls = compare_facing(*part, {Vec3(5, 4, 1), Vec3(18, 15, 4)},
                                      {Vec3(3, 2, -5), Vec3(20, 17, -2)}, 0, 1e-3);
  EXPECT_GT(walls.met, 300);
  EXPECT_LE(walls.turned, 1);  // a ray through an edge, by rounding
}

TEST(HeightSurface, SteepFlanksFaceAsTheTrianglesDo) {
  // A ball goes up by 84 degrees, several times beside each other.
  const std::unique_ptr<ZMap> part = test::make_map("box:0,0,-12:12,18,0", 0.11);
  std::vector<CutMove> moves;
  for (int n = 0; n < 8; ++n) {
    CutMove& move = moves.emplace_back();
    move.from_mm = Vec3(1.5 * n, 8.3 + 0.1 * n, -10);
    move.to_mm = move.from_mm + Vec3(0, 1.05, 10);
  }
  test::cut(*part, *parse_shape("ball:6"), moves);
  test::finish(*part);
  const Facing steep =
      compare_facing(*part, {Vec3(1, 2, 1), Vec3(11, 5, 4)}, {Vec3(1, 11, -9), Vec3(11, 13, -1)},
                     1e-3, 1 / std::hypot(1.0, static_cast<double>(SurfaceSlopes::kSteepest)));
  EXPECT_GT(steep.met, 300);
  EXPECT_LE(steep.turned, 1);
}

class AgainstPatches : public testing::TestWithParam<int> {};

TEST_P(AgainstPatches, MeetsWhatTheTrianglesShow) {
  const int number = GetParam();
  const std::unique_ptr<ZMap> part =
      test::random_part(static_cast<unsigned>(number), 0.31, number % 3 == 2);
  const Triangles triangles(*part);
  ASSERT_GT(triangles.size(), 4000u);
  const HeightSurface surface = surface_of(part->height_grid());
  constexpr glm::ivec2 kSize_px{72, 54};
  const RayFrame frame(test::view_of(part->bounds_mm(), number, kSize_px).clip_from_world,
                       kSize_px);
  int hits = 0, elsewhere = 0, turned = 0;
  for (int y = 0; y < kSize_px.y; ++y) {
    for (int x = 0; x < kSize_px.x; ++x) {
      const Ray ray = frame.ray(x + 0.5, y + 0.5);
      SurfaceHit hit;
      const bool is_met = surface.trace(ray, &hit);
      const std::optional<Triangles::Met> wanted = triangles.first(ray);
      hits += wanted.has_value();
      const double length = glm::length(ray.direction_mm);
      if (is_met != wanted.has_value() || (is_met && std::abs(hit.t - wanted->t) * length > 1e-4)) {
        ++elsewhere;
        continue;
      }
      if (is_met && glm::dot(wanted->normal, Vec3(surface.normal(ray, hit))) < 0.9999) ++turned;
    }
  }
  EXPECT_GT(hits, 800);
  EXPECT_LE(elsewhere, 1);  // a ray through an edge, by rounding
  EXPECT_LE(turned, hits / 100);
}

INSTANTIATE_TEST_SUITE_P(Views, AgainstPatches, testing::Range(0, 20));

}  // namespace
}  // namespace kerf
