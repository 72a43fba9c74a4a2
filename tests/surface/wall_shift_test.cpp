// How near to a wall its corners are moved, against walls that are known: circles, straight ones,
// corners of parts.
#include "surface/wall_shift.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>
#include <glm/trigonometric.hpp>
#include <iostream>
#include <random>
#include <vector>

namespace kerf {
namespace {

constexpr int kReach = WallShift::kMaxReach;

/// Cells 0 .. count-1 in x and y, of which is_high tells which are high: at 1, the others at 0.
class Part {
 public:
  template <class IsHigh>
  Part(int count, const IsHigh& is_high) : count_(count) {
    for (int j = 0; j < count; ++j)
      for (int i = 0; i < count; ++i) high_.push_back(is_high(i + 0.5, j + 0.5));
  }
  int count() const { return count_; }
  bool inside(int i, int j) const { return std::min(i, j) >= 0 && std::max(i, j) < count_; }
  float height(int i, int j) const {
    return inside(i, j) && high_[static_cast<std::size_t>(j * count_ + i)] ? 1.0f : 0.0f;
  }
  glm::vec2 shift(int i, int j, int reach = kReach) const {
    const std::array<float, 4> heights{height(i - 1, j - 1), height(i, j - 1), height(i, j),
                                       height(i - 1, j)};
    std::array<bool, 4> links;
    for (std::size_t q = 0; q < 4; ++q) links[q] = heights[q] == heights[(q + 1) % 4];
    return wall_shift(
        i, j, heights, links, reach, [this](int x, int y) { return height(x, y); },
        [this](int x, int y) { return inside(x, y); });
  }
  /// Calls visit(i, j) for the corners of walls that are at least `margin` cells from the border.
  template <class Visit>
  void visit_corners(int margin, const Visit& visit) const {
    for (int j = margin; j <= count_ - margin; ++j) {
      for (int i = margin; i <= count_ - margin; ++i) {
        const float sum = height(i - 1, j - 1) + height(i, j - 1) + height(i, j) + height(i - 1, j);
        if (sum > 0 && sum < 4) visit(i, j);
      }
    }
  }

 private:
  int count_;
  std::vector<char> high_;
};

/// Distances from a wall that `distance(x, y)` tells of: of the corners, and where they are moved.
struct Distances {
  std::vector<double> before, after;
  template <class Distance>
  void add(const Part& part, int margin, const Distance& distance) {
    part.visit_corners(margin, [&](int i, int j) {
      const glm::dvec2 to = glm::dvec2(i, j) + glm::dvec2(part.shift(i, j));
      before.push_back(std::abs(distance(i, j)));
      after.push_back(std::abs(distance(to.x, to.y)));
    });
  }
  static double rms(const std::vector<double>& all) {
    double sum = 0;
    for (const double d : all) sum += d * d;
    return std::sqrt(sum / static_cast<double>(all.size()));
  }
  static double percentile(std::vector<double> all, double share) {
    std::sort(all.begin(), all.end());
    return all[static_cast<std::size_t>(share * static_cast<double>(all.size() - 1))];
  }
};

TEST(WallShift, BringsCornersToACircle) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> part_of_cell(0, 1);
  for (const double radius : {6.0, 10.0, 20.0, 50.0, 90.0, 200.0}) {
    SCOPED_TRACE(radius);
    const int count = static_cast<int>(2 * radius) + 30;
    Distances found;
    for (int round = 0; round < 8; ++round) {
      const double cx = 0.5 * count + part_of_cell(random), cy = 0.5 * count + part_of_cell(random);
      const auto distance = [&](double x, double y) { return std::hypot(x - cx, y - cy) - radius; };
      const bool is_pocket = round % 2 == 0;
      const Part part(count, [&](double x, double y) { return (distance(x, y) < 0) != is_pocket; });
      found.add(part, 1, distance);
    }
    EXPECT_GT(Distances::rms(found.before), 0.36);
    EXPECT_LT(Distances::rms(found.after), radius < 8 ? 0.15 : 0.13);
    EXPECT_LT(Distances::percentile(found.after, 0.5), 0.1);
    EXPECT_LT(Distances::percentile(found.after, 0.95), 0.27);
    std::cout << "circle " << radius << ": rms " << Distances::rms(found.before) << " -> "
              << Distances::rms(found.after) << ", median "
              << Distances::percentile(found.after, 0.5) << ", 95 % "
              << Distances::percentile(found.before, 0.95) << " -> "
              << Distances::percentile(found.after, 0.95) << "\n";
  }
}

TEST(WallShift, BringsCornersToAStraightWall) {
  std::mt19937 random(6);
  std::uniform_real_distribution<double> part_of_cell(-1, 1), any_angle(0, 2 * glm::pi<double>());
  Distances found;
  for (int round = 0; round < 200; ++round) {
    const double angle = any_angle(random), c = std::cos(angle), s = std::sin(angle);
    const double off = part_of_cell(random);
    const auto distance = [&](double x, double y) { return c * (x - 40) + s * (y - 40) - off; };
    const Part part(80, [&](double x, double y) { return distance(x, y) > 0; });
    found.add(part, kReach + 1, distance);
  }
  std::cout << "straight: rms " << Distances::rms(found.before) << " -> "
            << Distances::rms(found.after) << ", 95 % " << Distances::percentile(found.after, 0.95)
            << "\n";
  EXPECT_GT(Distances::rms(found.before), 0.33);
  EXPECT_LT(Distances::rms(found.after), 0.13);
  EXPECT_LT(Distances::percentile(found.after, 0.95), 0.25);
}

TEST(WallShift, LeavesWallsAlongAnAxisWhereTheyAre) {
  // Islands and pockets of every width from one cell on, each corner of them.
  for (int width = 1; width <= 20; ++width) {
    for (int length = width; length <= 20; length += 3) {
      for (const bool is_pocket : {false, true}) {
        const Part part(50, [&](double x, double y) {
          return (x > 15 && x < 15 + width && y > 15 && y < 15 + length) != is_pocket;
        });
        part.visit_corners(1, [&](int i, int j) {
          EXPECT_EQ(part.shift(i, j), glm::vec2(0))
              << width << " x " << length << " at " << i << " " << j;
        });
      }
    }
  }
}

TEST(WallShift, MeetsAtObliqueCorners) {
  // Two walls at right angles, turned: up to the corner, each is where it is.
  for (const double angle_deg : {12.0, 30.0, 45.0, 61.0, 83.0}) {
    SCOPED_TRACE(angle_deg);
    const double c = std::cos(glm::radians(angle_deg)), s = std::sin(glm::radians(angle_deg));
    const auto distance = [&](double x, double y) {
      const double u = std::abs(c * (x - 50.3) + s * (y - 49.8));
      const double v = std::abs(-s * (x - 50.3) + c * (y - 49.8));
      return std::max(u, v) - 30;
    };
    const Part part(100, [&](double x, double y) { return distance(x, y) > 0; });
    Distances near_corners;
    part.visit_corners(1, [&](int i, int j) {
      const double u = std::abs(c * (i - 50.3) + s * (j - 49.8));
      const double v = std::abs(-s * (i - 50.3) + c * (j - 49.8));
      if (std::min(u, v) < 26) return;
      const glm::dvec2 to = glm::dvec2(i, j) + glm::dvec2(part.shift(i, j));
      near_corners.before.push_back(std::abs(distance(i, j)));
      near_corners.after.push_back(std::abs(distance(to.x, to.y)));
    });
    ASSERT_GT(near_corners.after.size(), 20u);
    std::cout << "corner at " << angle_deg << ": rms " << Distances::rms(near_corners.before)
              << " -> " << Distances::rms(near_corners.after) << ", worst "
              << Distances::percentile(near_corners.after, 1) << "\n";
    EXPECT_LT(Distances::rms(near_corners.after), 0.25);
    EXPECT_LT(Distances::percentile(near_corners.after, 1), 0.75);
  }
}

TEST(WallShift, IsSmallEnoughForAnyHeights) {
  // Whatever the cells are, no corner goes half a cell far, one of the two diagonals of each cell
  // turns no triangle over, and has_rising_diagonal() tells which.
  const auto cross = [](const glm::vec2& a, const glm::vec2& b) { return a.x * b.y - a.y * b.x; };
  std::mt19937 random(7);
  for (int round = 0; round < 60; ++round) {
    const auto rarity = static_cast<int>(2 + random() % 12);
    const Part part(40, [&](double x, double y) {
      return (random() % static_cast<unsigned>(rarity) == 0) !=
             (std::hypot(x - 20, y - 20) < 5 + rarity);
    });
    for (int j = 0; j < 40; ++j) {
      for (int i = 0; i < 40; ++i) {
        const std::array<glm::vec2, 4> shift{part.shift(i, j), part.shift(i + 1, j),
                                             part.shift(i + 1, j + 1), part.shift(i, j + 1)};
        const std::array<glm::vec2, 4> at{shift[0], shift[1] + glm::vec2(1, 0),
                                          shift[2] + glm::vec2(1, 1), shift[3] + glm::vec2(0, 1)};
        for (const glm::vec2& by : shift)
          ASSERT_LE(std::max(std::abs(by.x), std::abs(by.y)), WallShift::kMost * 1.00001f);
        const bool is_rising = has_rising_diagonal({0, 0, 0, 0}, 0, shift);
        const std::size_t from = is_rising ? 0 : 1;
        EXPECT_GT(cross(at[from + 1] - at[from], at[from + 2] - at[from]), 0.01f);
        EXPECT_GT(cross(at[from + 2] - at[from], at[(from + 3) % 4] - at[from]), 0.01f);
      }
    }
  }
}

TEST(WallShift, DependsOnNothingButTheCellsAround) {
  // The same wherever the part lies, and whatever is beyond the reach.
  const auto is_high = [](double x, double y) { return std::hypot(x - 31.3, y - 28.9) < 13.7; };
  const Part part(60, is_high);
  for (const int by : {1, 7}) {
    const Part moved(80, [&](double x, double y) { return is_high(x - by, y - 2 * by); });
    part.visit_corners(
        1, [&](int i, int j) { EXPECT_EQ(moved.shift(i + by, j + 2 * by), part.shift(i, j)); });
  }
  for (const int reach : {4, 8}) {
    part.visit_corners(1, [&](int i, int j) {
      const Part around(60, [&](double x, double y) {
        const bool is_near = std::max(std::abs(x - i), std::abs(y - j)) < reach;
        return is_near ? is_high(x, y) : std::fmod(std::floor(x) + std::floor(y), 2) == 0;
      });
      EXPECT_EQ(around.shift(i, j, reach), part.shift(i, j, reach));
    });
  }
}

TEST(WallShift, StaysOnTheGridsBorder) {
  const auto distance = [](double x, double y) { return 0.6 * (x - 9.2) + 0.8 * (y - 7.1); };
  const Part part(40, [&](double x, double y) { return std::abs(distance(x, y)) < 4; });
  int moved = 0;
  for (int k = 0; k <= 40; ++k) {
    for (const glm::ivec2 at : {glm::ivec2(0, k), {40, k}, {k, 0}, {k, 40}}) {
      const glm::vec2 by = part.shift(at.x, at.y);
      if (at.x % 40 == 0) {
        EXPECT_EQ(by.x, 0);
      }
      if (at.y % 40 == 0) {
        EXPECT_EQ(by.y, 0);
      }
      if (by == glm::vec2(0)) continue;
      ++moved;
      const glm::dvec2 to = glm::dvec2(at) + glm::dvec2(by);
      EXPECT_LT(std::abs(std::abs(distance(to.x, to.y)) - 4), 0.4);
    }
  }
  EXPECT_GE(moved, 2);
}

}  // namespace
}  // namespace kerf
