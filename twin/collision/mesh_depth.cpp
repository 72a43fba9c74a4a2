#include "twin/collision/mesh_depth.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>
#include <limits>
#include <queue>
#include <vector>

namespace kerf {
namespace {

constexpr double kMeshDepthExact_mm = 0.1;
constexpr int kMostPoses = 32;
/// Of places on surfaces.
constexpr double kPlaceExact_mm = 0.05;
constexpr int kMostPlaces = 500;
/// Distances of points from surfaces.
constexpr double kPointExact_mm = 1e-3;

/// A piece of a surface that waits: a node of its tree, or a triangle or part of one.
struct Patch {
  double most_mm = 0;  ///< none of it is deeper
  std::uint32_t node = 0;
  bool is_node = false;
  std::array<Vec3, 3> corners{};  ///< in the frame of the body
  bool operator<(const Patch& other) const { return most_mm < other.most_mm; }
};

/// The deepest place of one surface in another body, the most promising pieces first.
class DeepestPlace {
 public:
  DeepestPlace(const Solid& surface, const Pose& body_from_surface, const Solid& body)
      : surface_(surface), pose_(body_from_surface), body_(body) {
    dot_.kind = Convex::Kind::kHull;
    dot_.corners = place_;
  }

  double find() {
    push_node(0);
    while (!open_.empty() && places_ < kMostPlaces) {
      const Patch next = open_.top();
      open_.pop();
      if (next.most_mm <= deepest_ + kPlaceExact_mm) break;
      if (!next.is_node) {
        halve(next.corners);
        continue;
      }
      const Solid::Node& node = surface_.nodes()[next.node];
      if (node.count == 0) {
        push_node(next.node + 1);
        push_node(node.first);
        continue;
      }
      for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
        const auto c = surface_.pieces()[i].corners;
        push_triangle({pose_.point(c[0]), pose_.point(c[1]), pose_.point(c[2])});
      }
    }
    return deepest_;
  }

 private:
  /// No place in `box` is deeper in the body's own box.
  double most_in(const Box& box) const {
    double most = std::numeric_limits<double>::infinity();
    for (int i = 0; i < 3; ++i) {
      const double low = body_.box_mm().min[i], high = body_.box_mm().max[i];
      const double middle = std::clamp((low + high) / 2, box.min[i], box.max[i]);
      most = std::min({most, middle - low, high - middle});
    }
    return most;
  }
  void push(const Patch& patch) {
    if (patch.most_mm > deepest_ + kPlaceExact_mm) open_.push(patch);
  }
  void push_node(std::uint32_t at) {
    push({most_in(box_around(pose_, surface_.nodes()[at].box_mm)), at, true, {}});
  }
  void push_triangle(const std::array<Vec3, 3>& c) {
    Box box;
    for (const Vec3& corner : c) box.extend(corner);
    const double most = most_in(box);
    if (most <= deepest_ + kPlaceExact_mm) return;
    const Vec3 middle = (c[0] + c[1] + c[2]) / 3.0;
    double reach = 0;
    for (const Vec3& corner : c) reach = std::max(reach, glm::length(corner - middle));
    push({std::min(most, depth_at(middle, reach) + reach), 0, false, c});
  }
  /// Across its longest side.
  void halve(std::array<Vec3, 3> c) {
    for (int turn = 0; turn < 2; ++turn) {
      const double first = glm::length(c[1] - c[0]);
      if (first >= glm::length(c[2] - c[1]) && first >= glm::length(c[0] - c[2])) break;
      std::rotate(c.begin(), c.begin() + 1, c.end());
    }
    const Vec3 middle = (c[0] + c[1]) / 2.0;
    push_triangle({c[0], middle, c[2]});
    push_triangle({middle, c[1], c[2]});
  }
  /// Below 0: outside, by so much or more than `enough_mm`.
  double depth_at(const Vec3& point, double enough_mm) {
    ++places_;
    place_[0] = point;
    const Pose here;
    const bool inside = body_.encloses(point);
    const double cutoff = inside ? most_in({point, point}) + kPlaceExact_mm : enough_mm;
    const ConvexGap gap = body_.gap_to({dot_, here, here}, cutoff, kPointExact_mm, guess_);
    guess_ = gap.direction;
    if (!inside) return -gap.low_mm;
    deepest_ = std::max(deepest_, gap.low_mm);
    return gap.low_mm;
  }

  const Solid& surface_;
  const Pose& pose_;
  const Solid& body_;
  std::array<Vec3, 1> place_{};
  Convex dot_;
  Vec3 guess_{0};
  std::priority_queue<Patch> open_;
  double deepest_ = 0;
  int places_ = 0;
};

}  // namespace

double mesh_depth_at_mm(const Solid& a, const Pose& b_from_a, const Solid& b) {
  if (!a.is_closed() || !b.is_closed()) return 0;
  const double in_b = DeepestPlace(a, b_from_a, b).find();
  const Pose a_from_b = b_from_a.inverse();
  const double in_a = DeepestPlace(b, a_from_b, a).find();
  return in_a > 0 && in_b > 0 ? std::min(in_a, in_b) : std::max(in_a, in_b);
}

double mesh_depth_mm(const Solid& moving, const RigidWay& way, const Solid& still,
                     double known_mm) {
  if (!moving.is_closed() || !still.is_closed()) return known_mm;
  double reach = 0;
  for (const Convex& piece : moving.pieces()) reach = std::max(reach, reach_of(piece));
  double depth = known_mm;
  const auto look = [&](double t) {
    const double here = mesh_depth_at_mm(moving, way.pose(t), still);
    depth = std::max(depth, here);
    return here;
  };
  struct Part {
    double t0, t1, most_mm;
  };
  std::vector<Part> parts;
  const auto add = [&](double t0, double t1, double here_mm) {
    const double most = here_mm + way.travel_mm(t0, t1, reach) / 2;
    if (most > depth + kMeshDepthExact_mm) parts.push_back({t0, t1, most});
  };
  // Where a motion ends it is deepest more often than elsewhere.
  const double end = look(1);
  if (end + way.travel_mm(0, 1, reach) <= depth + kMeshDepthExact_mm) return depth;
  add(0, 1, look(0.5));
  for (int poses = 2; !parts.empty() && poses < kMostPoses; poses += 2) {
    const auto next = std::ranges::max_element(parts, {}, &Part::most_mm);
    const Part part = *next;
    parts.erase(next);
    if (part.most_mm <= depth + kMeshDepthExact_mm) break;
    const double middle = (part.t0 + part.t1) / 2;
    add(part.t0, middle, look((part.t0 + middle) / 2));
    add(middle, part.t1, look((middle + part.t1) / 2));
  }
  return depth;
}

}  // namespace kerf
