// Steep smooth flanks, as a ball or a tilted plunge leaves them: how patches of them are lit.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <iostream>
#include <string>
#include <utility>
#include <vector>

#include "surface/tile_relief.h"
#include "tests/stock/patch_samples.h"

namespace kerf {
namespace {

using test::all_patches;

constexpr double kDegrees = 180.0 / 3.14159265358979;
constexpr double kCell_mm = 0.1;
constexpr int kCells = 190;

/// Section of a flank, lengths in cells: a level field is rounded off into a straight fall, which
/// runs out into a level field below.
///
///     ----._          u: the way down, 0 where the upper arc begins
///           \         radius: of both arcs; the lower one is the upper one turned over
///            \        steepest: of the fall, against the level; up to a right angle
///             `---    fall: length of the straight piece
class Flank {
 public:
  Flank(double radius, double steepest_rad, double fall)
      : radius_(radius),
        steepest_rad_(steepest_rad),
        sine_(std::sin(steepest_rad)),
        cosine_(std::cos(steepest_rad)),
        fall_(fall) {}

  double width() const { return 2 * radius_ * sine_ + fall_ * cosine_; }
  double depth() const { return 2 * radius_ * (1 - cosine_) + fall_ * sine_; }

  double height(double u) const {
    const double begin = radius_ * sine_, end = begin + fall_ * cosine_;
    if (u <= 0) return 0;
    if (u >= width()) return -depth();
    if (u < begin) return std::sqrt(radius_ * radius_ - u * u) - radius_;
    if (u < end) return -radius_ * (1 - cosine_) - (u - begin) * sine_ / cosine_;
    const double v = width() - u;
    return -depth() + radius_ - std::sqrt(radius_ * radius_ - v * v);
  }

  /// Of the flank's point that is nearest to the one over u at height z, against the level.
  double slope_rad(double u, double z) const {
    const double du = u - radius_ * sine_, dz = z + radius_ * (1 - cosine_);
    const double along = std::clamp(du * cosine_ - dz * sine_, 0.0, fall_);
    const std::array found{
        on_arc(u, z + radius_),
        std::pair(std::hypot(du - along * cosine_, dz + along * sine_), steepest_rad_),
        on_arc(width() - u, radius_ - (z + depth()))};
    return std::min_element(found.begin(), found.end())->second;
  }

 private:
  /// Distance and slope, of a point as seen from the arc's centre.
  std::pair<double, double> on_arc(double du, double dz) const {
    const double slope_rad = std::clamp(std::atan2(du, dz), 0.0, steepest_rad_);
    return {std::hypot(du - radius_ * std::sin(slope_rad), dz - radius_ * std::cos(slope_rad)),
            slope_rad};
  }

  double radius_, steepest_rad_, sine_, cosine_, fall_;
};

/// Where a flank runs, seen from above: u at a point, and which way it grows; no way (0, 0) about
/// the middle of a round one, where it may end in a point.
struct Plan {
  std::string name;
  std::function<double(const glm::dvec2&)> u;
  std::function<glm::dvec2(const glm::dvec2&)> way;
};

std::vector<Plan> plans() {
  std::vector<Plan> plans;
  const glm::dvec2 center(95.23, 94.64);
  const auto outward = [=](const glm::dvec2& at) {
    return glm::distance(at, center) < 5 ? glm::dvec2(0) : glm::normalize(at - center);
  };
  plans.push_back(
      {"boss", [=](const glm::dvec2& at) { return glm::distance(at, center) - 30.3; }, outward});
  plans.push_back({"pocket", [=](const glm::dvec2& at) { return 80.7 - glm::distance(at, center); },
                   [=](const glm::dvec2& at) { return -outward(at); }});
  for (const double angle_deg : {0.0, 17.0, 45.0, 73.0}) {
    const glm::dvec2 way(std::cos(angle_deg / kDegrees), std::sin(angle_deg / kDegrees));
    plans.push_back({std::to_string(static_cast<int>(angle_deg)) + " deg",
                     [=](const glm::dvec2& at) { return glm::dot(way, at - glm::dvec2(70.4, 69)); },
                     [=](const glm::dvec2&) { return way; }});
  }
  return plans;
}

TileGrid make_part(const Flank& flank, const Plan& plan) {
  TileGrid grid({Vec3(0, 0, -30), Vec3(kCells * kCell_mm, kCells * kCell_mm, 0)}, kCells, kCells);
  std::vector<float> row(kCells);
  for (int j = 0; j < kCells; ++j) {
    for (int i = 0; i < kCells; ++i)
      row[static_cast<std::size_t>(i)] =
          static_cast<float>(kCell_mm * (flank.height(plan.u(glm::dvec2(i + 0.5, j + 0.5))) - 1));
    grid.set_row(j, row.data());
  }
  return grid;
}

/// Angles between the normals that triangles are lit by (in their middle) and the true ones, with
/// the triangles' areas.
class NormalErrors {
 public:
  void add(const Flank& flank, const Plan& plan) {
    constexpr double kMargin = 9;  // cells from the blank's sides, where walls have less to go by
    for (const MeshPatch& patch : all_patches(make_part(flank, plan), 0)) {
      const auto indices = patch.surface_indices();
      for (std::size_t n = 0; n < indices.size(); n += 3) {
        std::array<Vec3, 3> p;
        Vec3 normal(0);
        for (std::size_t k = 0; k < 3; ++k) {
          const MeshVertex& vertex = patch.vertices[indices[n + k]];
          p[k] = Vec3(vertex.position_mm) / kCell_mm + Vec3(0, 0, 1);
          normal += Vec3(unpack_normal(vertex.normal));
        }
        const Vec3 middle = (p[0] + p[1] + p[2]) / 3.0;
        const glm::dvec2 at(middle);
        const double u = plan.u(at);
        if (std::min(at.x, at.y) < kMargin || std::max(at.x, at.y) > kCells - kMargin) continue;
        if (middle.z < -flank.depth() - 1 || u < -3 || u > flank.width() + 3) continue;
        if (plan.way(at) == glm::dvec2(0)) continue;
        const double slope_rad = flank.slope_rad(u, middle.z);
        const Vec3 truth(plan.way(at) * std::sin(slope_rad), std::cos(slope_rad));
        const double cosine = glm::dot(glm::normalize(normal), truth);
        found_.emplace_back(kDegrees * std::acos(std::clamp(cosine, -1.0, 1.0)),
                            0.5 * glm::length(glm::cross(p[1] - p[0], p[2] - p[0])));
        area_ += found_.back().second;
      }
    }
  }
  /// The angle that this part of the area stays below.
  double quantile_deg(double part) {
    std::sort(found_.begin(), found_.end());
    double sum = 0;
    for (const auto& [deg, area] : found_)
      if ((sum += area) >= part * area_) return deg;
    return found_.empty() ? 0 : found_.back().first;
  }
  double part_beyond(double deg) const {
    double sum = 0;
    for (const auto& [off_deg, area] : found_) sum += off_deg > deg ? area : 0;
    return sum / area_;
  }
  std::size_t count() const { return found_.size(); }

 private:
  std::vector<std::pair<double, double>> found_;  ///< degrees, area in cells
  double area_ = 0;
};

TEST(PatchFlanks, AreLitAsTheyAreHoweverSteep) {
  // Pictures draw an edge where normals differ by this: on a flank it would be a dark speck.
  constexpr double kEdge_deg = 33;
  struct Limits {
    double radius, most_deg, worst_deg;
  };
  for (const auto& [radius, most_deg, worst_deg] :
       {Limits{8, 18, 30}, Limits{20, 11, 20}, Limits{50, 5.5, 9}}) {
    for (const double steepest_deg : {79.0, 84.0, 87.0, 89.0, 90.0}) {
      SCOPED_TRACE(testing::Message() << "radius " << radius << ", " << steepest_deg << " degrees");
      NormalErrors errors;
      for (const double fall : {5.0, 40.0})
        for (const Plan& plan : plans())
          errors.add(Flank(radius, steepest_deg / kDegrees, fall), plan);
      std::cout << "radius " << radius << ", " << steepest_deg << " deg: median "
                << errors.quantile_deg(0.5) << ", 99 % " << errors.quantile_deg(0.99) << ", worst "
                << errors.quantile_deg(1) << " deg, seen as edges "
                << 100 * errors.part_beyond(kEdge_deg) << " %\n";
      ASSERT_GT(errors.count(), 10000u);
      EXPECT_LT(errors.quantile_deg(0.99), most_deg);
      EXPECT_LT(errors.quantile_deg(1), worst_deg);
      EXPECT_EQ(errors.part_beyond(kEdge_deg), 0);
    }
  }
}

TEST(PatchFlanks, AWallIsWhereTheSurfaceEndsOrLeaps) {
  // Steps along x in cells, and whether each is one surface. The way up and the way down, along x
  // and along y.
  struct Row {
    std::vector<double> steps;
    std::string is_linked;
  };
  for (const Row& row : {
           Row{{0, 1, 2, 4, 9, 20, 21, 8, 3, 1, 0}, "yyyyyyyyyyy"},  // as steep as it likes
           Row{{0, 1, 2, 4, 29, 5, 2, 0}, "yyyynyyy"},               // a leap within a flank
           Row{{0, 1, 3, 7, 0, 0}, "yyynyy"},                        // the foot of a flank
           Row{{0, 9, 9, 0, 0}, "ynnyy"},                            // two steps of a stair
           Row{{0, 0, 9, 0, 0}, "yynyy"},                            // one
           Row{{0, 1, 1, 9, 1, 1, 0}, "yyynyyy"},                    // a wall between chamfers
       }) {
    for (const int sign : {1, -1}) {
      for (const bool along_y : {false, true}) {
        TileGrid grid({Vec3(0, 0, -30), Vec3(4, 4, 0)}, 40, 40);
        std::vector<float> z{-15, -15, -15, -15, -15};
        for (const double step : row.steps)
          z.push_back(z.back() + static_cast<float>(sign * step * kCell_mm));
        z.resize(40, z.back());
        for (int j = 0; j < 40; ++j) {
          const std::vector<float> level(40, z[static_cast<std::size_t>(j)]);
          grid.set_row(j, along_y ? level.data() : z.data());
        }
        const TileRelief relief(grid, 0, 0);
        for (std::size_t n = 0; n < row.steps.size(); ++n) {
          const int cell = 4 + static_cast<int>(n);
          const bool is_linked = along_y ? relief.linked_y(TileRelief::slot(20, cell))
                                         : relief.linked_x(TileRelief::slot(cell, 20));
          EXPECT_EQ(is_linked, row.is_linked[n] == 'y')
              << row.steps[n] << " of " << row.is_linked << " at " << n << ", " << sign;
        }
      }
    }
  }
}

}  // namespace
}  // namespace kerf
