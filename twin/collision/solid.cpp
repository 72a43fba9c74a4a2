#include "twin/collision/solid.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numeric>
#include <utility>

#include "base/portable_math.h"

namespace kerf {
namespace {

constexpr std::uint32_t kPiecesPerLeaf = 4;
/// What grazes a tube goes twenty times as far as this before it is a hundredth deep.
constexpr double kFacet_mm = 0.0005;
constexpr int kMostFacets = 4096;

Vec3 axis_of(char letter) {
  return letter == 'x' ? Vec3{1, 0, 0} : letter == 'y' ? Vec3{0, 1, 0} : Vec3{0, 0, 1};
}

/// A prism, its faces outward.
TriangleMesh mesh_of_bar(const BlankBody& bar) {
  const auto n = static_cast<std::uint32_t>(bar.flats);
  const double reach = bar.diameter_mm / 2 / portable::cos(kPi / n);
  TriangleMesh mesh;
  for (std::uint32_t i = 0; i < n; ++i) {
    const double angle = 2 * kPi * (i + 0.5) / n;
    for (const double z : {bar.bounds_mm.min.z, bar.bounds_mm.max.z})
      mesh.positions_mm.emplace_back(bar.center_mm.x + reach * portable::cos(angle),
                                     bar.center_mm.y + reach * portable::sin(angle), z);
  }
  for (std::uint32_t i = 0; i < n; ++i) {
    const std::uint32_t here = 2 * i, next = 2 * ((i + 1) % n);
    mesh.triangles.push_back({here, next, next + 1});
    mesh.triangles.push_back({here, next + 1, here + 1});
    if (i < 2) continue;
    mesh.triangles.push_back({0, here, here - 2});
    mesh.triangles.push_back({1, here - 1, here + 1});
  }
  return mesh;
}

/// Its faces, outward. Facets lie as far outside of the round as inside.
TriangleMesh mesh_of_tube(const BlankBody& tube) {
  const int along = tube.axis == 'x' ? 0 : tube.axis == 'y' ? 1 : 2;
  const int u = (along + 1) % 3, v = (along + 2) % 3;
  const double radius = tube.diameter_mm / 2;
  const double half_turn = portable::acos(1 - std::min(kFacet_mm / radius, 1.0));
  const int facets = std::clamp(static_cast<int>(std::ceil(kPi / half_turn)), 16, kMostFacets);
  TriangleMesh mesh;
  for (int i = 0; i < facets; ++i) {
    const double angle = 2 * kPi * i / facets;
    for (const double r : {radius, tube.inner_diameter_mm / 2}) {
      const double reach = r / std::sqrt(portable::cos(kPi / facets));
      for (const double end : {tube.bounds_mm.min[along], tube.bounds_mm.max[along]}) {
        glm::dvec3 p{0};
        p[along] = end;
        p[u] = tube.center_mm[u] + reach * portable::cos(angle);
        p[v] = tube.center_mm[v] + reach * portable::sin(angle);
        mesh.positions_mm.emplace_back(p);
      }
    }
  }
  const auto quad = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
    mesh.triangles.push_back({a, b, c});
    mesh.triangles.push_back({a, c, d});
  };
  for (int i = 0; i < facets; ++i) {
    // Of each angle: outer low, outer high, inner low, inner high.
    const auto here = static_cast<std::uint32_t>(4 * i);
    const auto next = static_cast<std::uint32_t>(4 * ((i + 1) % facets));
    quad(here, next, next + 1, here + 1);
    quad(here + 2, here + 3, next + 3, next + 2);
    quad(here + 1, next + 1, next + 3, here + 3);
    quad(here, here + 2, next + 2, next);
  }
  return mesh;
}

bool closed(const TriangleMesh& mesh) {
  // Each edge by its lower corner first, and which way its triangle runs along it.
  std::vector<std::array<std::uint32_t, 3>> edges;
  edges.reserve(3 * mesh.triangles.size());
  for (const auto& triangle : mesh.triangles) {
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t a = triangle[i], b = triangle[(i + 1) % 3];
      edges.push_back({std::min(a, b), std::max(a, b), a < b ? 0U : 1U});
    }
  }
  std::ranges::sort(edges);
  if (edges.empty() || edges.size() % 2 != 0) return false;
  for (std::size_t i = 0; i < edges.size(); i += 2) {
    const auto &one = edges[i], &other = edges[i + 1];
    if (one[0] != other[0] || one[1] != other[1] || one[2] == other[2]) return false;
    if (i + 2 < edges.size() && edges[i + 2][0] == one[0] && edges[i + 2][1] == one[1])
      return false;
  }
  return true;
}

/// What lies on the far side of a plane, seen from a solid on its way, across `direction`. Where
/// the two lie slanted beside each other, boxes overlap and this tells them apart.
class Slab {
 public:
  Slab(const ConvexSweep& sweep, const Vec3& direction) {
    const double length = glm::length(direction);
    if (!(length > 0)) return;
    normal_ = direction / length;
    from_mm_ = glm::dot(normal_, sweep.support(-normal_));
  }
  double gap_mm(const Convex& piece) const {
    return from_mm_ - glm::dot(normal_, piece.support(normal_));
  }
  /// Nothing in the box is nearer to the solid.
  double gap_mm(const Box& box) const {
    double reach = 0;
    for (int axis = 0; axis < 3; ++axis)
      reach += std::max(normal_[axis] * box.min[axis], normal_[axis] * box.max[axis]);
    return from_mm_ - reach;
  }

 private:
  Vec3 normal_{0};
  double from_mm_ = 0;  ///< without a direction: 0 of all boxes
};

}  // namespace

double box_gap_mm(const Box& a, const Box& b) {
  double sum = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const double gap = std::max({a.min[axis] - b.max[axis], b.min[axis] - a.max[axis], 0.0});
    sum += gap * gap;
  }
  return std::sqrt(sum);
}

Box box_of(const MovingConvex& moving) {
  Box box;
  const Convex& solid = moving.solid;
  for (const Pose* pose : {&moving.from, &moving.to}) {
    if (solid.kind == Convex::Kind::kRevolved) {
      Convex placed = solid;
      placed.origin_mm = pose->point(solid.origin_mm);
      placed.axis = pose->direction(solid.axis);
      box.extend(placed.box_mm());
    } else {
      box.extend(box_around(*pose, solid.box_mm()));
    }
  }
  return box;
}

SolidPointer Solid::of_bodies(std::span<const BlankBody> bodies) {
  std::shared_ptr<Solid> solid(new Solid);
  for (const BlankBody& body : bodies) {
    switch (body.kind) {
      case BlankBody::Kind::kBox:
        solid->add_box(body.bounds_mm);
        break;
      case BlankBody::Kind::kTube:
        solid->add_mesh(mesh_of_tube(body));
        break;
      case BlankBody::Kind::kBar:
        solid->add_mesh(mesh_of_bar(body));
        break;
      case BlankBody::Kind::kCylinder: {
        const Vec3 axis = axis_of(body.axis);
        Vec3 foot = body.center_mm;
        foot -= glm::dot(foot, axis) * axis;
        const double radius = body.diameter_mm / 2;
        const std::array<RoundedDisc, 2> ends{
            RoundedDisc{radius, glm::dot(body.bounds_mm.min, axis), 0},
            RoundedDisc{radius, glm::dot(body.bounds_mm.max, axis), 0}};
        solid->add_revolved(ends, foot, axis);
        break;
      }
    }
  }
  solid->is_closed_ = bodies.size() == 1 && bodies[0].kind == BlankBody::Kind::kTube;
  solid->finish();
  return solid;
}

SolidPointer Solid::of_mesh(const TriangleMesh& mesh) {
  std::shared_ptr<Solid> solid(new Solid);
  solid->add_mesh(mesh);
  solid->is_closed_ = closed(mesh);
  solid->finish();
  return solid;
}

SolidPointer Solid::of_hulls(std::span<const std::vector<RoundedDisc>> hulls) {
  std::shared_ptr<Solid> solid(new Solid);
  for (const std::vector<RoundedDisc>& hull : hulls) solid->add_revolved(hull, Vec3{0}, {0, 0, 1});
  solid->finish();
  return solid;
}

void Solid::add_box(const Box& box) {
  boxes_.push_back(std::make_unique<std::array<Vec3, 2>>(std::array{box.min, box.max}));
  Convex piece;
  piece.kind = Convex::Kind::kBox;
  piece.corners = *boxes_.back();
  pieces_.push_back(piece);
}

void Solid::add_revolved(std::span<const RoundedDisc> discs, const Vec3& origin, const Vec3& axis) {
  discs_.push_back(std::make_unique<std::vector<RoundedDisc>>(discs.begin(), discs.end()));
  Convex piece;
  piece.kind = Convex::Kind::kRevolved;
  piece.discs = *discs_.back();
  piece.origin_mm = origin;
  piece.axis = axis;
  pieces_.push_back(piece);
}

void Solid::add_mesh(const TriangleMesh& mesh) {
  // The corners' place in memory may change while they are added: finish() points at them.
  for (const auto& triangle : mesh.triangles) {
    for (const std::uint32_t corner : triangle) corners_.emplace_back(mesh.positions_mm[corner]);
    pieces_.emplace_back();
  }
}

void Solid::finish() {
  std::size_t corner = 0;
  for (Convex& piece : pieces_) {
    if (piece.kind != Convex::Kind::kHull) continue;
    piece.corners = std::span(corners_).subspan(corner, 3);
    corner += 3;
  }
  std::vector<Box> boxes;
  boxes.reserve(pieces_.size());
  for (const Convex& piece : pieces_) {
    boxes.push_back(piece.box_mm());
    box_mm_.extend(boxes.back());
  }
  // Pieces and boxes in one order.
  std::vector<std::uint32_t> order(pieces_.size());
  std::iota(order.begin(), order.end(), 0U);
  struct Range {
    std::uint32_t begin, end;
  };
  std::vector<Range> open{{0, static_cast<std::uint32_t>(order.size())}};
  while (!open.empty()) {
    const Range range = open.back();
    open.pop_back();
    if (range.end - range.begin <= kPiecesPerLeaf) continue;
    Box middles;
    for (std::uint32_t i = range.begin; i < range.end; ++i)
      middles.extend((boxes[order[i]].min + boxes[order[i]].max) / 2.0);
    const Vec3 size = middles.size();
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const std::uint32_t middle = range.begin + (range.end - range.begin) / 2;
    std::nth_element(order.begin() + range.begin, order.begin() + middle, order.begin() + range.end,
                     [&](std::uint32_t a, std::uint32_t b) {
                       return boxes[a].min[axis] + boxes[a].max[axis] <
                              boxes[b].min[axis] + boxes[b].max[axis];
                     });
    open.push_back({range.begin, middle});
    open.push_back({middle, range.end});
  }
  std::vector<Convex> sorted_pieces;
  std::vector<Box> sorted_boxes;
  sorted_pieces.reserve(order.size());
  sorted_boxes.reserve(order.size());
  for (const std::uint32_t i : order) {
    sorted_pieces.push_back(pieces_[i]);
    sorted_boxes.push_back(boxes[i]);
  }
  pieces_ = std::move(sorted_pieces);
  if (!pieces_.empty()) build(0, static_cast<std::uint32_t>(pieces_.size()), sorted_boxes);
}

/// Halves as finish() has sorted them.
std::uint32_t Solid::build(std::uint32_t begin, std::uint32_t end, std::span<const Box> boxes) {
  const auto at = static_cast<std::uint32_t>(nodes_.size());
  nodes_.emplace_back();
  if (end - begin <= kPiecesPerLeaf) {
    for (std::uint32_t i = begin; i < end; ++i) nodes_[at].box_mm.extend(boxes[i]);
    nodes_[at].first = begin;
    nodes_[at].count = end - begin;
    return at;
  }
  const std::uint32_t middle = begin + (end - begin) / 2;
  const std::uint32_t left = build(begin, middle, boxes);
  const std::uint32_t right = build(middle, end, boxes);
  nodes_[at].box_mm = nodes_[left].box_mm;
  nodes_[at].box_mm.extend(nodes_[right].box_mm);
  nodes_[at].first = right;
  return at;
}

bool Solid::encloses(const Vec3& point) const {
  if (!is_closed_ || nodes_.empty()) return false;
  if (box_gap_mm({point, point}, box_mm_) > 0) return false;
  // A ray in no direction that drawings have; how often it crosses the surface.
  const Vec3 ray = glm::normalize(Vec3{0.0123, 0.0271, 1.0});
  int crossed = 0;
  std::array<std::uint32_t, 64> stack{};
  int open = 1;
  while (open > 0) {
    const std::uint32_t at = stack[static_cast<std::size_t>(--open)];
    const Node& node = nodes_[at];
    double enters = 0, leaves = std::numeric_limits<double>::infinity();
    for (int axis = 0; axis < 3; ++axis) {
      const double a = (node.box_mm.min[axis] - point[axis]) / ray[axis];
      const double b = (node.box_mm.max[axis] - point[axis]) / ray[axis];
      enters = std::max(enters, a);
      leaves = std::min(leaves, b);
    }
    if (enters > leaves) continue;
    if (node.count == 0) {
      stack[static_cast<std::size_t>(open++)] = at + 1;
      stack[static_cast<std::size_t>(open++)] = node.first;
      continue;
    }
    for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
      const std::span<const Vec3> c = pieces_[i].corners;
      const Vec3 ab = c[1] - c[0], ac = c[2] - c[0];
      const Vec3 across = glm::cross(ray, ac);
      const double determinant = glm::dot(ab, across);
      if (determinant == 0) continue;
      const Vec3 from = point - c[0];
      const double u = glm::dot(from, across) / determinant;
      const Vec3 other = glm::cross(from, ab);
      const double v = glm::dot(ray, other) / determinant;
      const double t = glm::dot(ac, other) / determinant;
      if (u >= 0 && v >= 0 && u + v <= 1 && t > 0) ++crossed;
    }
  }
  return crossed % 2 == 1;
}

ConvexGap Solid::gap_to(const MovingConvex& moving, double cutoff_mm, double exact_mm,
                        const Vec3& guess) const {
  ConvexGap best{cutoff_mm, std::numeric_limits<double>::infinity(), guess};
  if (nodes_.empty()) return best;
  const Box box = box_of(moving);
  const double whole_mm = box_gap_mm(box, nodes_[0].box_mm);
  if (whole_mm > cutoff_mm) return {whole_mm, best.high_mm, guess};
  const ConvexSweep sweep(moving);
  Slab slab(sweep, guess);
  struct Open {
    std::uint32_t node;
    double gap_mm;
  };
  std::array<Open, 64> stack{};
  int open = 0;
  stack[static_cast<std::size_t>(open++)] = {0, whole_mm};
  // What is not looked at is no nearer than this.
  double nearest = cutoff_mm;
  double low_mm = std::numeric_limits<double>::infinity();
  while (open > 0) {
    const Open next = stack[static_cast<std::size_t>(--open)];
    const Node& node = nodes_[next.node];
    const double gap_mm = next.gap_mm > nearest ? next.gap_mm : slab.gap_mm(node.box_mm);
    if (gap_mm > nearest) {
      low_mm = std::min(low_mm, gap_mm);
      continue;
    }
    if (node.count == 0) {
      Open left{next.node + 1, box_gap_mm(box, nodes_[next.node + 1].box_mm)};
      Open right{node.first, box_gap_mm(box, nodes_[node.first].box_mm)};
      if (left.gap_mm < right.gap_mm) std::swap(left, right);
      stack[static_cast<std::size_t>(open++)] = left;
      stack[static_cast<std::size_t>(open++)] = right;
      continue;
    }
    for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
      const double apart_mm = slab.gap_mm(pieces_[i]);
      if (apart_mm > nearest) {
        low_mm = std::min(low_mm, apart_mm);
        continue;
      }
      const ConvexGap gap = gap_of(sweep, pieces_[i], nearest, exact_mm, best.direction);
      if (gap.low_mm < low_mm) {
        low_mm = gap.low_mm;
        best.direction = gap.direction;
        slab = Slab(sweep, gap.direction);
      }
      best.high_mm = std::min(best.high_mm, gap.high_mm);
      nearest = std::min(nearest, best.high_mm);
      if (gap.high_mm <= 0) return {0, 0, best.direction};
    }
  }
  best.low_mm = low_mm;
  return best;
}

}  // namespace kerf
