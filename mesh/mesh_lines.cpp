#include "mesh/mesh_lines.h"

#include <algorithm>

namespace kerf {
namespace {

struct Crossing {
  std::uint32_t line;
  std::uint32_t triangle;
  float at;
  int turn;  ///< 1: the line enters, -1: it leaves
};

/// Towards -X, far more towards +Y, and far more than that towards +Z, as each axis sees it: y z,
/// z x, x y.
constexpr LineNudge kNudges[3] = {{1, 1, true}, {1, -1, false}, {-1, 1, true}};

}  // namespace

MeshLines::MeshLines(const TriangleMesh& mesh, int axis, const ColumnGrid& grid)
    : first_(grid.size() + 1, 0) {
  const int x = (axis + 1) % 3, y = (axis + 2) % 3;
  std::vector<Crossing> found;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    std::array<glm::vec3, 3> corners;
    for (std::size_t k = 0; k < 3; ++k) {
      const glm::vec3& p = mesh.positions_mm[mesh.triangles[t][k]];
      corners[k] = glm::vec3(p[x], p[y], p[axis]);
    }
    each_column_line(
        corners, grid,
        [&](std::size_t line, float at, int up) {
          found.push_back({static_cast<std::uint32_t>(line), t, at, -up});
        },
        kNudges[axis]);
  }
  std::vector<std::size_t> begin(grid.size() + 1, 0);
  for (const Crossing& c : found) ++begin[c.line + 1];
  for (std::size_t n = 1; n < begin.size(); ++n) begin[n] += begin[n - 1];
  std::vector<Crossing> sorted(found.size());
  {
    std::vector<std::size_t> next(begin.begin(), begin.end() - 1);
    for (const Crossing& c : found) sorted[next[c.line]++] = c;
  }
  std::vector<Crossing>().swap(found);
  ends_.reserve(sorted.size());
  for (std::size_t line = 0; line < grid.size(); ++line) {
    first_[line] = ends_.size();
    const auto from = sorted.begin() + static_cast<std::ptrdiff_t>(begin[line]);
    const auto to = sorted.begin() + static_cast<std::ptrdiff_t>(begin[line + 1]);
    // Where one part ends and another begins, nothing is between them.
    std::sort(from, to, [](const Crossing& a, const Crossing& b) {
      return a.at != b.at ? a.at < b.at
                          : (a.turn != b.turn ? a.turn > b.turn : a.triangle < b.triangle);
    });
    int winding = 0;
    for (auto c = from; c != to; ++c) {
      const int before = winding;
      winding += c->turn;
      if ((before > 0) != (winding > 0)) ends_.push_back({c->at, c->triangle});
    }
    // Not of a closed mesh.
    if ((ends_.size() - first_[line]) % 2 != 0) ends_.pop_back();
  }
  first_.back() = ends_.size();
}

}  // namespace kerf
