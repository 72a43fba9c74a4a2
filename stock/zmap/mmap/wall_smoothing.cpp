#include "stock/zmap/mmap/wall_smoothing.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "base/wall_course.h"

namespace kerf {
namespace {

constexpr int kRounds = 4;
/// In cells. Below a quarter no triangle of the surface between four corners can turn over.
constexpr float kFarthest = 0.22f;

/// Walls leave a corner of cells in up to four directions: +x, +y, -x, -y.
constexpr std::array<std::array<int, 2>, 4> kWays{{{1, 0}, {0, 1}, {-1, 0}, {0, -1}}};

class Corners {
 public:
  Corners(const TileGrid& grid, const TriangleMesh& mesh)
      : grid_(grid), width_(grid.nx() + 1), height_(grid.ny() + 1), ways_(count(), 0) {
    for (const auto& [a, b, c] : mesh.triangles) {
      for (const auto& [p, q] : {std::pair{a, b}, std::pair{b, c}, std::pair{c, a}}) {
        // Two corners with a third above one of them: a piece of a wall.
        const std::uint32_t r = p == a ? (q == b ? c : b) : (p == b ? a : b);
        const std::array<int, 2> from = corner(mesh.positions_mm[p]);
        const std::array<int, 2> to = corner(mesh.positions_mm[q]);
        const std::array<int, 2> third = corner(mesh.positions_mm[r]);
        if (from == to || (third != from && third != to)) continue;
        for (int way = 0; way < 4; ++way) {
          if (from[0] + kWays[index(way)][0] != to[0] || from[1] + kWays[index(way)][1] != to[1])
            continue;
          ways_[at(from)] |= static_cast<std::uint8_t>(1 << way);
          ways_[at(to)] |= static_cast<std::uint8_t>(1 << (way + 2) % 4);
        }
      }
    }
  }

  /// Displacements in cells.
  std::vector<std::array<float, 2>> smooth() const {
    std::vector<std::array<float, 2>> shift(count(), {0, 0}), last;
    std::vector<std::array<int, 2>> moving;
    for (int j = 1; j + 1 < height_; ++j)
      for (int i = 1; i + 1 < width_; ++i)
        if (may_move({i, j})) moving.push_back({i, j});
    for (int round = 0; round < kRounds; ++round) {
      last = shift;
      for (const std::array<int, 2>& c : moving) {
        std::array<float, 2> middle{0, 0};
        for (int way = 0; way < 4; ++way) {
          if ((ways_[at(c)] >> way & 1) == 0) continue;
          const std::array<int, 2> other = beyond(c, way);
          for (std::size_t axis = 0; axis < 2; ++axis) {
            middle[axis] +=
                0.5f * (static_cast<float>(other[axis] - c[axis]) + last[at(other)][axis]);
          }
        }
        for (std::size_t axis = 0; axis < 2; ++axis) {
          shift[at(c)][axis] =
              std::clamp(0.5f * (last[at(c)][axis] + middle[axis]), -kFarthest, kFarthest);
        }
      }
    }
    return shift;
  }

  std::array<int, 2> corner(const glm::vec3& p) const {
    const Box& box = grid_.bounds_mm();
    return {
        static_cast<int>(std::lround((static_cast<double>(p.x) - box.min.x) / grid_.cell_x_mm())),
        static_cast<int>(std::lround((static_cast<double>(p.y) - box.min.y) / grid_.cell_y_mm()))};
  }
  std::size_t at(const std::array<int, 2>& c) const {
    return index(c[1]) * index(width_) + index(c[0]);
  }

 private:
  static std::size_t index(int i) { return static_cast<std::size_t>(i); }
  std::size_t count() const { return index(width_) * index(height_); }
  static std::array<int, 2> beyond(const std::array<int, 2>& c, int way) {
    return {c[0] + kWays[index(way)][0], c[1] + kWays[index(way)][1]};
  }
  bool has_two_ways(const std::array<int, 2>& c) const {
    const unsigned w = ways_[at(c)];
    return w != 0 && (w & (w - 1)) != 0 && ((w & (w - 1)) & ((w & (w - 1)) - 1)) == 0;
  }
  /// Cells that the wall goes straight on from here, up to kLongRun.
  int run(std::array<int, 2> c, int way) const {
    int length = 0;
    while (length < WallCourse::kLongRun && (ways_[at(c)] >> way & 1) != 0) {
      c = beyond(c, way);
      ++length;
    }
    return length;
  }
  bool may_move(const std::array<int, 2>& c) const {
    if (!has_two_ways(c)) return false;
    const unsigned w = ways_[at(c)];
    if (w == 5 || w == 10) return true;  // straight on
    int shortest = WallCourse::kLongRun;
    for (int way = 0; way < 4; ++way)
      if ((w >> way & 1) != 0) shortest = std::min(shortest, run(c, way));
    return shortest < WallCourse::kLongRun;
  }

  const TileGrid& grid_;
  int width_, height_;
  std::vector<std::uint8_t> ways_;  ///< a bit for each of kWays
};

}  // namespace

void smooth_walls(const TileGrid& grid, TriangleMesh& mesh) {
  const Corners corners(grid, mesh);
  const std::vector<std::array<float, 2>> shift = corners.smooth();
  for (glm::vec3& p : mesh.positions_mm) {
    const std::array<float, 2> by = shift[corners.at(corners.corner(p))];
    p.x += by[0] * static_cast<float>(grid.cell_x_mm());
    p.y += by[1] * static_cast<float>(grid.cell_y_mm());
  }
}

}  // namespace kerf
