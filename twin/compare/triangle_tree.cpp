#include "twin/compare/triangle_tree.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <utility>

namespace kerf {
namespace {

constexpr std::size_t kLeaf = 4;
constexpr int kBins = 16;
/// Beyond this halves are equal in number, so that the tree is never deeper than this and the
/// logarithm of 2^32.
constexpr int kDepthByArea = 40;
constexpr std::size_t kStack = 96;

constexpr float kInfinity = std::numeric_limits<float>::infinity();

/// Takes `candidate` if the clamped edge is nearer.
void try_edge(const Vec3& from, const Vec3& to, std::size_t edge, const Vec3& p,
              NearestPoint& best) {
  const Vec3 way = to - from;
  const double length2 = glm::dot(way, way);
  const double along = glm::dot(p - from, way);
  NearestPoint candidate;
  const auto feature = [](TriangleFeature first, std::size_t n) {
    return static_cast<TriangleFeature>(static_cast<std::size_t>(first) + n);
  };
  if (!(along > 0)) {
    candidate.point_mm = from;
    candidate.feature = feature(TriangleFeature::kCorner0, edge);
  } else if (along >= length2) {
    candidate.point_mm = to;
    candidate.feature = feature(TriangleFeature::kCorner0, (edge + 1) % 3);
  } else {
    candidate.point_mm = from + way * (along / length2);
    candidate.feature = feature(TriangleFeature::kEdge0, edge);
  }
  const Vec3 off = p - candidate.point_mm;
  candidate.distance2_mm2 = glm::dot(off, off);
  if (candidate.distance2_mm2 < best.distance2_mm2) best = candidate;
}

/// False: not nearer than `best`, or it is by its distance known not to be.
bool improve(const std::array<glm::vec3, 3>& corners, const Vec3& p, NearestPoint& best) {
  const Vec3 a(corners[0]), b(corners[1]), c(corners[2]);
  const Vec3 ab = b - a, ac = c - a, ap = p - a;
  const Vec3 normal = glm::cross(ab, ac);
  const double area2 = glm::dot(normal, normal);
  const double height = glm::dot(ap, normal);
  if (height * height >= best.distance2_mm2 * area2 && area2 > 0) return false;
  // Weights of the corners at the foot of the perpendicular, times area2. A negative one means that
  // the foot is beyond the edge opposite to that corner, and the nearest point is on such an edge.
  const double of_c = glm::dot(glm::cross(ab, ap), normal);
  const double of_b = glm::dot(glm::cross(ap, ac), normal);
  const double of_a = area2 - of_b - of_c;
  const double before = best.distance2_mm2;
  if (area2 > 0 && of_a >= 0 && of_b >= 0 && of_c >= 0) {
    // Of triangles at equal distances, which rounding may not have told above, one is meant
    // throughout.
    const double distance2 = height * height / area2;
    if (!(distance2 < before)) return false;
    best.distance2_mm2 = distance2;
    best.point_mm = p - normal * (height / area2);
    best.feature = TriangleFeature::kFace;
    return true;
  }
  const bool is_flat = !(area2 > 0);
  if (of_c < 0 || is_flat) try_edge(a, b, 0, p, best);
  if (of_a < 0 || is_flat) try_edge(b, c, 1, p, best);
  if (of_b < 0 || is_flat) try_edge(c, a, 2, p, best);
  return best.distance2_mm2 < before;
}

double box_distance2(const std::array<float, 3>& low, const std::array<float, 3>& high,
                     const Vec3& p) {
  double sum = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double at = p[static_cast<int>(axis)];
    const double below = static_cast<double>(low[axis]) - at;
    const double above = at - static_cast<double>(high[axis]);
    const double off = std::max(std::max(below, above), 0.0);
    sum += off * off;
  }
  return sum;
}

bool ray_meets_box(const std::array<float, 3>& low, const std::array<float, 3>& high, const Vec3& p,
                   const Vec3& per_direction) {
  double enter = 0, leave = std::numeric_limits<double>::infinity();
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const int k = static_cast<int>(axis);
    const double t0 = (static_cast<double>(low[axis]) - p[k]) * per_direction[k];
    const double t1 = (static_cast<double>(high[axis]) - p[k]) * per_direction[k];
    enter = std::max(enter, std::min(t0, t1));
    leave = std::min(leave, std::max(t0, t1));
  }
  return enter <= leave;
}

bool ray_meets_triangle(const std::array<glm::vec3, 3>& corners, const Vec3& p,
                        const Vec3& direction) {
  const Vec3 a = Vec3(corners[0]) - p, b = Vec3(corners[1]) - p, c = Vec3(corners[2]) - p;
  // Volumes spanned by the ray and the edges: of one sign if it goes between them. Edges shared by
  // two triangles give equal numbers to both, so that no ray slips through between them.
  const auto side = [&](const Vec3& u, const Vec3& v) {
    const auto before = [](const Vec3& x, const Vec3& y) {
      return x.x != y.x ? x.x < y.x : x.y != y.y ? x.y < y.y : x.z < y.z;
    };
    const bool turned = before(v, u);
    const double volume = glm::dot(direction, turned ? glm::cross(v, u) : glm::cross(u, v));
    return (turned ? -volume : volume) > 0;
  };
  const bool ab = side(a, b), bc = side(b, c), ca = side(c, a);
  if (ab != bc || bc != ca) return false;
  const Vec3 normal = glm::cross(b - a, c - a);
  const double facing = glm::dot(normal, direction);
  return facing != 0 && glm::dot(normal, a) / facing > 0;
}

}  // namespace

struct TriangleTree::Bounds {
  std::array<float, 3> low{kInfinity, kInfinity, kInfinity};
  std::array<float, 3> high{-kInfinity, -kInfinity, -kInfinity};
  void extend(const Bounds& other) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      low[axis] = std::min(low[axis], other.low[axis]);
      high[axis] = std::max(high[axis], other.high[axis]);
    }
  }
  double half_area() const {
    if (!(low[0] <= high[0])) return 0;
    const double x = static_cast<double>(high[0]) - static_cast<double>(low[0]);
    const double y = static_cast<double>(high[1]) - static_cast<double>(low[1]);
    const double z = static_cast<double>(high[2]) - static_cast<double>(low[2]);
    return x * y + y * z + z * x;
  }
};

struct TriangleTree::Item {
  Bounds bounds;
  std::uint32_t number = 0;
  float middle(std::size_t axis) const { return 0.5f * (bounds.low[axis] + bounds.high[axis]); }
};

NearestPoint nearest_on_triangle(const std::array<glm::vec3, 3>& corners, const Vec3& p) {
  NearestPoint best;
  improve(corners, p, best);
  return best;
}

TriangleTree::TriangleTree(const TriangleMesh& mesh) {
  std::vector<Item> items(mesh.triangles.size());
  for (std::size_t t = 0; t < items.size(); ++t) {
    items[t].number = static_cast<std::uint32_t>(t);
    for (const std::uint32_t corner : mesh.triangles[t]) {
      const glm::vec3& at = mesh.positions_mm[corner];
      items[t].bounds.extend({{at.x, at.y, at.z}, {at.x, at.y, at.z}});
      box_mm_.extend(Vec3(at));
    }
  }
  nodes_.reserve(items.size());
  build(items, 0, 0);
  nodes_.shrink_to_fit();
  triangles_.reserve(items.size());
  numbers_.reserve(items.size());
  for (const Item& item : items) {
    const std::array<std::uint32_t, 3>& corners = mesh.triangles[item.number];
    triangles_.push_back({mesh.positions_mm[corners[0]], mesh.positions_mm[corners[1]],
                          mesh.positions_mm[corners[2]]});
    numbers_.push_back(item.number);
  }
}

/// Sorts the items into two parts and returns the size of the first.
std::size_t TriangleTree::split(std::span<Item> items, int depth) {
  Bounds middles;
  for (const Item& item : items) {
    const std::array<float, 3> m{item.middle(0), item.middle(1), item.middle(2)};
    middles.extend({m, m});
  }
  std::size_t axis = 0;
  for (std::size_t k = 1; k < 3; ++k) {
    if (middles.high[k] - middles.low[k] > middles.high[axis] - middles.low[axis]) axis = k;
  }
  const float low = middles.low[axis], extent = middles.high[axis] - low;
  const auto bin_of = [&](const Item& item) {
    const auto bin = static_cast<int>((item.middle(axis) - low) / extent * kBins);
    return static_cast<std::size_t>(std::clamp(bin, 0, kBins - 1));
  };
  if (extent > 0 && depth < kDepthByArea) {
    std::array<Bounds, kBins> bounds;
    std::array<std::size_t, kBins> counts{};
    for (const Item& item : items) {
      bounds[bin_of(item)].extend(item.bounds);
      ++counts[bin_of(item)];
    }
    std::array<double, kBins> cost{};  // of a cut before the bin
    const auto sweep = [&](bool from_below) {
      Bounds all;
      std::size_t count = 0;
      for (std::size_t n = 0; n + 1 < kBins; ++n) {
        const std::size_t bin = from_below ? n : kBins - 1 - n;
        all.extend(bounds[bin]);
        count += counts[bin];
        cost[from_below ? bin + 1 : bin] += all.half_area() * static_cast<double>(count);
      }
    };
    sweep(true);
    sweep(false);
    const auto best =
        static_cast<std::size_t>(std::min_element(cost.begin() + 1, cost.end()) - cost.begin());
    const auto cut = std::partition(items.begin(), items.end(),
                                    [&](const Item& item) { return bin_of(item) < best; });
    const auto first = static_cast<std::size_t>(cut - items.begin());
    if (first > 0 && first < items.size()) return first;
  }
  const std::size_t half = items.size() / 2;
  std::nth_element(items.begin(), items.begin() + static_cast<std::ptrdiff_t>(half), items.end(),
                   [&](const Item& x, const Item& y) { return x.middle(axis) < y.middle(axis); });
  return half;
}

/// The node of these items, which begin at `offset` among all.
std::uint32_t TriangleTree::build(std::span<Item> items, std::size_t offset, int depth) {
  const auto number = static_cast<std::uint32_t>(nodes_.size());
  nodes_.emplace_back();
  const std::size_t first = items.size() <= kLeaf ? items.size() : split(items, depth);
  const std::array<std::span<Item>, 2> parts{items.first(first), items.subspan(first)};
  for (std::size_t side = 0; side < 2; ++side) {
    // A part without items has an endless negative box, which nothing is near to.
    Bounds bounds;
    for (const Item& item : parts[side]) bounds.extend(item.bounds);
    const std::size_t begin = side == 0 ? offset : offset + first;
    const bool is_leaf = parts[side].size() <= kLeaf;
    const auto child =
        is_leaf ? static_cast<std::uint32_t>(begin) : build(parts[side], begin, depth + 1);
    Node& node = nodes_[number];
    node.low[side] = bounds.low;
    node.high[side] = bounds.high;
    node.first[side] = child;
    node.count[side] = is_leaf ? static_cast<std::uint32_t>(parts[side].size()) : 0;
  }
  return number;
}

NearestPoint TriangleTree::nearest(const Vec3& p, std::uint32_t hint) const {
  NearestPoint best;
  improve(triangles_[hint], p, best);
  best.triangle = hint;
  struct Waiting {
    std::uint32_t node;
    double distance2;
  };
  std::array<Waiting, kStack> stack;
  std::size_t waiting = 0;
  std::uint32_t at = 0;
  for (;;) {
    const Node& node = nodes_[at];
    const std::array<double, 2> off{box_distance2(node.low[0], node.high[0], p),
                                    box_distance2(node.low[1], node.high[1], p)};
    const std::size_t nearer = off[1] < off[0] ? 1 : 0;
    bool goes_down = false;
    for (const std::size_t side : {nearer, 1 - nearer}) {
      if (!(off[side] < best.distance2_mm2)) continue;
      const std::uint32_t first = node.first[side], count = node.count[side];
      for (std::uint32_t t = first; t < first + count; ++t) {
        if (improve(triangles_[t], p, best)) best.triangle = t;
      }
      if (count > 0) continue;
      if (goes_down) {
        stack[waiting++] = {first, off[side]};
      } else {
        at = first;
        goes_down = true;
      }
    }
    while (!goes_down) {
      if (waiting == 0) return best;
      const Waiting& next = stack[--waiting];
      goes_down = next.distance2 < best.distance2_mm2;
      at = next.node;
    }
  }
}

std::size_t TriangleTree::crossings(const Vec3& p, const Vec3& direction) const {
  const Vec3 per_direction = 1.0 / direction;
  std::size_t crossed = 0;
  std::array<std::uint32_t, kStack> stack;
  std::size_t waiting = 0;
  stack[waiting++] = 0;
  while (waiting > 0) {
    const Node& node = nodes_[stack[--waiting]];
    for (std::size_t side = 0; side < 2; ++side) {
      if (!(node.low[side][0] <= node.high[side][0])) continue;
      if (!ray_meets_box(node.low[side], node.high[side], p, per_direction)) continue;
      const std::uint32_t first = node.first[side], count = node.count[side];
      for (std::uint32_t t = first; t < first + count; ++t) {
        crossed += ray_meets_triangle(triangles_[t], p, direction) ? 1 : 0;
      }
      if (count == 0) stack[waiting++] = first;
    }
  }
  return crossed;
}

}  // namespace kerf
