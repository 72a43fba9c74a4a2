#include "twin/collision/solid_sweep.h"

#include <algorithm>
#include <array>
#include <glm/geometric.hpp>
#include <limits>
#include <utility>
#include <vector>

namespace kerf {
namespace {

/// Of boxes about pieces: they only say where it is worth to look.
constexpr double kBoxExact_mm = 0.1;
constexpr double kPieceExact_mm = 1e-3;
/// Who goes deeper than known by less is not measured again.
constexpr double kDeeper_mm = 0.005;
/// A way is halved before a box is, where it bends by more than this part of the box.
constexpr double kBend = 0.25;
/// Halvings of a way at most, for boxes.
constexpr int kMostParts = 24;

/// Nodes that wait on the way down a tree: two a level, of a tree that is halved at each.
constexpr std::size_t kDeepest = 128;

/// The box about a node of a tree, as a solid.
class NodeBox {
 public:
  explicit NodeBox(const Box& box) : corners_{box.min, box.max} {
    solid_.kind = Convex::Kind::kBox;
    solid_.corners = corners_;
  }
  NodeBox(const NodeBox&) = delete;
  NodeBox& operator=(const NodeBox&) = delete;
  const Convex& solid() const { return solid_; }

 private:
  std::array<Vec3, 2> corners_;
  Convex solid_;
};

/// From t0 to t1 of another way.
class PartOfWay final : public RigidWay {
 public:
  PartOfWay(const RigidWay& whole, double t0, double t1) : whole_(whole), t0_(t0), t1_(t1) {}
  double at(double t) const { return t >= 1 ? t1_ : t0_ + t * (t1_ - t0_); }
  Pose pose(double t) const override { return whole_.pose(at(t)); }
  double slack_mm(double from, double to, double reach_mm) const override {
    return whole_.slack_mm(at(from), at(to), reach_mm);
  }
  double turning_mm(double from, double to, double reach_mm) const override {
    return whole_.turning_mm(at(from), at(to), reach_mm);
  }
  double travel_mm(double from, double to, double reach_mm) const override {
    return whole_.travel_mm(at(from), at(to), reach_mm);
  }

 private:
  const RigidWay& whole_;
  double t0_, t1_;
};

/// Walks the tree of the moving body and its way at once, and leaves out what stays farther away
/// than `cutoff()`. `Leaf` looks at single pieces on what is left of the way.
template <class Leaf>
class WayWalk {
 public:
  WayWalk(const Solid& moving, const RigidWay& way, const Solid& still, Leaf& leaf)
      : moving_(moving), way_(way), still_(still), leaf_(leaf) {}

  void walk() {
    if (moving_.nodes().empty() || still_.nodes().empty()) return;
    visit(0, 0, way_.pose(0), 1, way_.pose(1), 0);
  }

 private:
  void visit(std::uint32_t at, double t0, const Pose& from, double t1, const Pose& to, int depth) {
    if (leaf_.is_over(t0)) return;
    const Solid::Node& node = moving_.nodes()[at];
    const NodeBox box(node.box_mm);
    const double slack = way_.slack_mm(t0, t1, reach_of(box.solid()));
    const double cutoff = leaf_.cutoff_mm();
    const ConvexGap gap = still_.gap_to({box.solid(), from, to}, cutoff + slack, kBoxExact_mm);
    if (gap.low_mm - slack > cutoff) return;
    if (slack > kBend * glm::length(node.box_mm.size()) && depth < kMostParts) {
      const double middle = (t0 + t1) / 2;
      const Pose there = way_.pose(middle);
      visit(at, t0, from, middle, there, depth + 1);
      visit(at, middle, there, t1, to, depth + 1);
      return;
    }
    if (node.count == 0) {
      visit(at + 1, t0, from, t1, to, depth);
      visit(node.first, t0, from, t1, to, depth);
      return;
    }
    const PartOfWay part(way_, t0, t1);
    for (std::uint32_t i = node.first; i < node.first + node.count; ++i)
      leaf_.look(moving_.pieces()[i], part);
  }

  const Solid& moving_;
  const RigidWay& way_;
  const Solid& still_;
  Leaf& leaf_;
};

struct LeastLeaf {
  const Solid& still;
  LeastGap least;
  Vec3 guess{0};
  bool is_over(double) const { return false; }
  double cutoff_mm() const { return least.mm; }
  void look(const Convex& piece, const PartOfWay& part) {
    if (least.mm <= 0) return;
    if (const auto gap = least_gap(piece, part, still, least.mm, least.mm, guess))
      least = {gap->mm, part.at(gap->t)};
  }
};

struct TouchLeaf {
  const Solid& still;
  double thinner_mm = 0;
  double first = std::numeric_limits<double>::infinity();
  Vec3 guess{0};
  std::vector<RoundedDisc> discs{};
  std::array<Vec3, 2> corners{};
  bool is_over(double t0) const { return t0 >= first; }
  double cutoff_mm() const { return 0; }
  void look(const Convex& piece, const PartOfWay& part) {
    const Convex thin = eroded(piece, thinner_mm, discs, corners);
    if (const auto t = first_touch(thin, part, still, guess)) first = std::min(first, part.at(*t));
  }
};

}  // namespace

double gap_at(const Solid& moving, const Pose& pose, const Solid& still, double cutoff_mm) {
  if (moving.nodes().empty() || still.nodes().empty()) return cutoff_mm;
  struct Open {
    std::uint32_t node;
    double low_mm;
  };
  std::array<Open, kDeepest> open{};
  std::size_t count = 0;
  // No pair of pieces is nearer than `low`; some are no farther than `high`.
  double low = cutoff_mm, high = cutoff_mm;
  Vec3 guess{0};
  const auto push = [&](std::uint32_t at) {
    const NodeBox box(moving.nodes()[at].box_mm);
    const double gap = still.gap_to({box.solid(), pose, pose}, high, kBoxExact_mm).low_mm;
    if (gap < high && count < open.size()) open[count++] = {at, gap};
  };
  push(0);
  while (count > 0) {
    const Open next = open[--count];
    if (next.low_mm >= high) continue;
    const Solid::Node& node = moving.nodes()[next.node];
    if (node.count == 0) {
      const std::size_t before = count;
      push(next.node + 1);
      push(node.first);
      // The nearer one comes first.
      if (count == before + 2 && open[before].low_mm < open[before + 1].low_mm)
        std::swap(open[before], open[before + 1]);
      continue;
    }
    for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
      const ConvexGap gap =
          still.gap_to({moving.pieces()[i], pose, pose}, high, kPieceExact_mm, guess);
      guess = gap.direction;
      low = std::min(low, gap.low_mm);
      high = std::min(high, gap.high_mm);
      if (high <= 0) return 0;
    }
  }
  return std::min(low, high);
}

std::optional<LeastGap> least_gap(const Solid& moving, const RigidWay& way, const Solid& still,
                                  double below_mm) {
  LeastLeaf leaf{still, {below_mm, -1}};
  WayWalk(moving, way, still, leaf).walk();
  if (leaf.least.t < 0) return std::nullopt;
  return leaf.least;
}

std::optional<double> first_touch(const Solid& moving, const RigidWay& way, const Solid& still,
                                  double thinner_mm) {
  TouchLeaf leaf{still, thinner_mm};
  WayWalk(moving, way, still, leaf).walk();
  if (leaf.first > 1) return std::nullopt;
  return leaf.first;
}

double touch_depth_mm(const Solid& moving, const RigidWay& way, const Solid& still,
                      double known_mm) {
  double depth = known_mm;
  std::vector<RoundedDisc> discs;
  std::array<Vec3, 2> corners{};
  Vec3 guess{0};
  for (const Convex& piece : moving.pieces()) {
    const double deeper = depth > 0 ? depth + kDeeper_mm : 0;
    if (deeper >= half_thickness_mm(piece)) continue;
    if (!first_touch(eroded(piece, deeper, discs, corners), way, still, guess)) continue;
    depth = std::max(depth, touch_depth_mm(piece, way, still));
  }
  return depth;
}

bool encloses_any(const Solid& closed, const Pose& pose, const Solid& other) {
  if (!closed.is_closed()) return false;
  bool mesh_seen = false;
  for (const Convex& piece : other.pieces()) {
    if (piece.kind == Convex::Kind::kHull && std::exchange(mesh_seen, true)) continue;
    const Vec3 inside = piece.kind == Convex::Kind::kRevolved
                            ? piece.origin_mm + piece.discs.front().along_mm * piece.axis
                            : piece.corners.front();
    if (closed.encloses(pose.point(inside))) return true;
  }
  return false;
}

bool has_triangles(const Solid& solid) {
  return std::ranges::any_of(solid.pieces(),
                             [](const Convex& piece) { return piece.kind == Convex::Kind::kHull; });
}

}  // namespace kerf
