#include "stock/zmap/height_mesh_rim.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cstddef>
#include <optional>

namespace kerf {
namespace {

struct Node {
  int i;
  int j;
};

/// One of the four sides of the lattice, in counter-clockwise order from above (low y, high x, high
/// y, low x), so that seen from outside its nodes go from left to right.
class Side {
 public:
  Side(const Relief& relief, int number) : relief_(relief), number_(number) {}

  /// Nodes along the side, corners of the grid included.
  int length() const { return along_x() ? relief_.width() : relief_.height(); }
  /// depth 0: on the edge of the grid; 1: on the outer cell centres.
  Node at(int step, int depth) const {
    const int i_end = relief_.width() - 1;
    const int j_end = relief_.height() - 1;
    switch (number_) {
      case 0:
        return {step, depth};
      case 1:
        return {i_end - depth, step};
      case 2:
        return {i_end - step, j_end - depth};
      default:
        return {depth, j_end - step};
    }
  }
  /// As x_mm(), of any point.
  double along_mm(const glm::vec3& at) const {
    const auto along = static_cast<double>(along_x() ? at.x : at.y);
    return number_ < 2 ? along : -along;
  }
  /// Grows with `step`.
  double x_mm(int step) const {
    const Node n = at(step, 0);
    const double along = along_x() ? relief_.x_mm(n.i) : relief_.y_mm(n.j);
    return number_ < 2 ? along : -along;
  }

 private:
  bool along_x() const { return number_ % 2 == 0; }
  const Relief& relief_;
  int number_;
};

double area_sign(const ChainPoint& a, const ChainPoint& b, const ChainPoint& c) {
  return (b.x_mm - a.x_mm) * (c.z_mm - a.z_mm) - (c.x_mm - a.x_mm) * (b.z_mm - a.z_mm);
}

class BorderBuilder {
 public:
  BorderBuilder(const Relief& relief, const StepSquares* steps, bool on_floor, NodeMesh& mesh)
      : relief_(relief), steps_(steps), on_floor_(on_floor), mesh_(mesh) {}

  void build() {
    for (int number = 0; number < 4; ++number) add_side(number);
    for (int number = 0; number < 4; ++number) add_corner(number);
  }

 private:
  NodeKey key(Node n) const {
    return on_floor_ ? relief_.floor_key(n.i, n.j) : relief_.top_key(n.i, n.j);
  }
  bool is_level(Node a, Node b) const {
    return relief_.node_mm(a.i, a.j) == relief_.node_mm(b.i, b.j);
  }
  void add(NodeKey a, NodeKey b, NodeKey c) {
    if (a == b || b == c || c == a) return;
    mesh_.add(on_floor_ ? NodeTriangle{a, c, b} : NodeTriangle{a, b, c});
  }

  /// The point on the edge of the grid that carries on chain[at]: the node next to it; but at the
  /// ends of the side the corner of the grid, if the strip is level there. Saves four triangles a
  /// corner.
  NodeKey outer(const Side& side, const std::vector<int>& chain, std::size_t at) const {
    const int step = chain[at];
    const bool first = at == 0 && step == 1;
    const bool last = at + 1 == chain.size() && step == side.length() - 2;
    if (chain.size() < 2 || first == last) return key(side.at(step, 0));
    const Node neighbour = side.at(chain[first ? at + 1 : at - 1], 1);
    const bool level = is_level(side.at(step, 1), neighbour);
    return key(side.at(level ? (first ? 0 : side.length() - 1) : step, 0));
  }

  void add_side(int number) {
    const Side side(relief_, number);
    std::vector<int> chain;  // steps whose cell centres are used
    for (int step = 1; step < side.length() - 1; ++step) {
      if (mesh_.uses(key(side.at(step, 1)))) chain.push_back(step);
    }
    if (chain.empty()) return;
    for (std::size_t at = 0; at + 1 < chain.size(); ++at) {
      const Node a = side.at(chain[at], 1);
      const Node b = side.at(chain[at + 1], 1);
      if (!relief_.node_is_solid(a.i, a.j) && !relief_.node_is_solid(b.i, b.j)) continue;
      if (chain[at + 1] == chain[at] + 1 && is_elsewhere(side, chain[at])) continue;
      const NodeKey outer_a = outer(side, chain, at);
      const NodeKey outer_b = outer(side, chain, at + 1);
      add(outer_a, outer_b, key(b));
      add(outer_a, key(b), key(a));
    }
    const std::size_t n = std::size_t(number);
    first_outer_[n] = outer(side, chain, 0);
    last_outer_[n] = outer(side, chain, chain.size() - 1);
  }

  /// Of the square between two neighbouring nodes and the edge of the grid.
  bool is_elsewhere(const Side& side, int step) const {
    if (!steps_) return false;
    const Node a = side.at(step, 0), b = side.at(step + 1, 1);
    const int i = std::min(a.i, b.i), j = std::min(a.j, b.j);
    return steps_->is_divided(i, j) && (!on_floor_ || steps_->is_open(i, j));
  }

  /// The corner of the grid at the end of a side: level, as all of it has the height of one cell.
  void add_corner(int number) {
    const Side side(relief_, number);
    const Node centre = side.at(side.length() - 2, 1);
    if (!relief_.node_is_solid(centre.i, centre.j)) return;
    const NodeKey corner = key(side.at(side.length() - 1, 0));
    add(key(centre), last_outer_[std::size_t(number)], corner);
    add(key(centre), corner, first_outer_[std::size_t(number + 1) % 4]);
  }

  const Relief& relief_;
  const StepSquares* const steps_;
  const bool on_floor_;
  NodeMesh& mesh_;
  std::array<NodeKey, 4> first_outer_{};
  std::array<NodeKey, 4> last_outer_{};
};

}  // namespace

void NodeMesh::add(std::vector<NodeTriangle>&& more) {
  for (const NodeTriangle& triangle : more) mark(triangle);
  if (triangles_.empty()) {
    triangles_ = std::move(more);
  } else {
    triangles_.insert(triangles_.end(), more.begin(), more.end());
  }
}

void add_border(const Relief& relief, const StepSquares* steps, bool on_floor, NodeMesh& mesh) {
  BorderBuilder(relief, steps, on_floor, mesh).build();
}

void add_walls(const Relief& relief, const StepSquares* steps, NodeMesh& mesh) {
  for (int number = 0; number < 4; ++number) {
    const Side side(relief, number);
    std::vector<ChainPoint> lower;
    std::vector<ChainPoint> upper;
    const auto finish_run = [&] {
      if (upper.size() >= 2) mesh.add(triangulate_between(lower, upper));
      lower.clear();
      upper.clear();
    };
    const auto add_on_floor = [&](const ChainPoint& point) {
      if (!upper.empty()) {
        lower.push_back(point);
        upper.push_back(point);
        if (upper.size() >= 3 || upper.front().key != lower.front().key) finish_run();
      }
      lower.assign(1, point);
      upper.assign(1, point);
    };
    // A run ends where two neighbouring points of the surface lie on the floor: a hole is between
    // them. The points of the floor are not taken into account before the run has begun.
    for (int step = 0; step < side.length(); ++step) {
      if (step > 0 && steps) {
        const Node a = side.at(step - 1, 0), b = side.at(step, 0);
        if (const auto points = steps->points(a.i, a.j, b.i, b.j)) {
          for (const NodeKey key : {points->here, points->there}) {
            const glm::vec3 at = steps->position_mm(key);
            const ChainPoint point{side.along_mm(at), at.z, key};
            if (at.z > relief.floor_mm())
              upper.push_back(point);
            else
              add_on_floor(point);
          }
        }
      }
      const Node n = side.at(step, 0);
      const NodeKey top = relief.top_key(n.i, n.j);
      const NodeKey bottom = relief.floor_key(n.i, n.j);
      const ChainPoint point{side.x_mm(step), relief.floor_mm(), bottom};
      if (top == bottom) {
        if (mesh.uses(bottom)) add_on_floor(point);
        continue;
      }
      if (mesh.uses(bottom)) lower.push_back(point);
      if (mesh.uses(top)) upper.push_back({point.x_mm, relief.node_mm(n.i, n.j), top});
    }
    if (!upper.empty() && upper.back().key != lower.back().key) finish_run();
  }
}

std::vector<NodeTriangle> triangulate_between(const std::vector<ChainPoint>& lower,
                                              const std::vector<ChainPoint>& upper) {
  struct Point {
    ChainPoint at;
    bool is_upper;
  };
  // All points from left to right, the lower of two above each other first.
  std::vector<Point> points;
  points.reserve(lower.size() + upper.size());
  const bool share_first = lower.front().key == upper.front().key;
  const bool share_last = lower.back().key == upper.back().key;
  std::size_t l = share_first ? 1 : 0;
  const std::size_t l_end = lower.size() - (share_last ? 1 : 0);
  for (const ChainPoint& u : upper) {
    for (; l < l_end && lower[l].x_mm <= u.x_mm; ++l) {
      if (points.empty() && share_first) break;
      points.push_back({lower[l], false});
    }
    points.push_back({u, true});
  }

  std::vector<NodeTriangle> triangles;
  triangles.reserve(points.size());
  const auto add = [&](const ChainPoint& a, const ChainPoint& b, const ChainPoint& c) {
    const bool ccw = area_sign(a, b, c) > 0.0;
    triangles.push_back(ccw ? NodeTriangle{a.key, b.key, c.key}
                            : NodeTriangle{a.key, c.key, b.key});
  };
  // Points that wait for the ones to their right: a chain that is hollow seen from the other side.
  std::vector<Point> waiting{points[0], points[1]};
  for (std::size_t p = 2; p < points.size(); ++p) {
    const Point& now = points[p];
    // The last point ends both chains, and sees all that still wait.
    if (p + 1 == points.size() || now.is_upper != waiting.back().is_upper) {
      for (std::size_t w = 0; w + 1 < waiting.size(); ++w) {
        add(now.at, waiting[w].at, waiting[w + 1].at);
      }
      waiting = {waiting.back(), now};
      continue;
    }
    while (waiting.size() >= 2) {
      const ChainPoint& last = waiting.back().at;
      const ChainPoint& before = waiting[waiting.size() - 2].at;
      const double sign = area_sign(before, last, now.at);
      if (now.is_upper ? sign >= 0.0 : sign <= 0.0) break;  // not seen from here
      add(before, last, now.at);
      waiting.pop_back();
    }
    waiting.push_back(now);
  }
  return triangles;
}

}  // namespace kerf
