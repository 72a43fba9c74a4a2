#include "viewer/csg/csg_blank.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include "base/translate.h"

namespace kerf {
namespace {

/// Equal positions get the same number.
std::vector<std::uint32_t> welded(const std::vector<glm::vec3>& positions) {
  const auto key = [](const glm::vec3& p) { return std::array{p.x, p.y, p.z}; };
  std::map<std::array<float, 3>, std::uint32_t> number_of;
  std::vector<std::uint32_t> numbers;
  numbers.reserve(positions.size());
  for (const glm::vec3& p : positions) {
    numbers.push_back(
        number_of.try_emplace(key(p), static_cast<std::uint32_t>(number_of.size())).first->second);
  }
  return numbers;
}

/// Edges that are walked more often in one direction than in the other.
std::size_t open_edges(const TriangleMesh& mesh) {
  const std::vector<std::uint32_t> number = welded(mesh.positions_mm);
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> balance;
  for (const auto& triangle : mesh.triangles) {
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t a = number[triangle[i]], b = number[triangle[(i + 1) % 3]];
      balance[std::minmax(a, b)] += a < b ? 1 : a > b ? -1 : 0;
    }
  }
  return static_cast<std::size_t>(std::count_if(balance.begin(), balance.end(),
                                                [](const auto& edge) { return edge.second != 0; }));
}

}  // namespace

CsgBlank box_blank(const Box& box) {
  CsgBlank blank;
  for (unsigned i = 0; i < 8; ++i) {
    blank.mesh.positions_mm.emplace_back((i & 1u) ? box.max.x : box.min.x,
                                         (i & 2u) ? box.max.y : box.min.y,
                                         (i & 4u) ? box.max.z : box.min.z);
  }
  blank.mesh.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                          {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  return blank;
}

Done check(const CsgBlank& blank) {
  const TriangleMesh& mesh = blank.mesh;
  if (mesh.triangles.empty()) return Error{tr("the blank has no triangles")};
  if (blank.convexity < 1 || blank.convexity > kMaxConvexity) {
    return Error{trf("convexity {} of the blank is not allowed; must be 1 to {}", blank.convexity,
                     kMaxConvexity)};
  }
  for (const glm::vec3& p : mesh.positions_mm) {
    if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z)) {
      return Error{tr("the blank has a corner that is not finite")};
    }
  }
  for (const auto& triangle : mesh.triangles) {
    for (const std::uint32_t corner : triangle) {
      if (corner >= mesh.positions_mm.size()) {
        return Error{
            trf("the blank names corner {}, but has {} only", corner, mesh.positions_mm.size())};
      }
    }
  }
  if (const std::size_t count = open_edges(mesh); count > 0) {
    return Error{trf("the blank is not closed: {} edges do not join two triangles", count)};
  }
  return std::monostate{};
}

}  // namespace kerf
