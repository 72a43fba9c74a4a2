#include "stock/octree/brick_cut.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <glm/geometric.hpp>
#include <limits>

namespace kerf::octree {
namespace {

/// Blocks this close to wholly inside or outside are looked at node by node, so that rounding never
/// decides differently for a block than for its nodes.
constexpr double kBlockSlack_mm = 1e-6;
constexpr int kNodeBlock = kBrick / 2;
/// Roots are found to this part of an edge: far below a crossing's 1 / kEdgeParts.
constexpr double kRootPart = 1e-7;
constexpr int kNewtonSteps = 12, kMaxRootSteps = 60;
/// What is no thicker is no film: positions of programs are rounded.
constexpr double kLeastFilm_mm = 0.01;
/// The faces of a film look away from each other to within 45 degrees; those of the ridges between
/// passes, and of edges, meet less steeply.
constexpr double kOpposed = 0.7;

/// F is convex and its gradient exact to rounding: a tangent plane is nowhere above it.
bool is_convex(Sweep::Kind kind) {
  return kind == Sweep::Kind::kLevel || kind == Sweep::Kind::kBall || kind == Sweep::Kind::kSphere;
}

}  // namespace

BrickCutter::BrickCutter(const Lattice& lattice, const SweepKernel& kernel, bool additive)
    : lattice_(lattice), kernel_(kernel), additive_(additive) {
  half_diagonal_ = glm::length(lattice.cell_mm) * kBrick / 2;
  block_half_diagonal_ = half_diagonal_ / 2;
  place_slack_ = std::max({lattice.cell_mm.x, lattice.cell_mm.y, lattice.cell_mm.z}) / kEdgeParts;
  static_assert(kPoints > kSide * kSide * kSide + kLanes);
}

void BrickCutter::set_place(int bx, int by, int bz) {
  const int brick[3] = {bx, by, bz};
  double* const places[3] = {x_, y_, z_};
  for (int axis = 0; axis < 3; ++axis) {
    first_[axis] = brick[axis] * kBrick;
    for (int n = 0; n < kSide; ++n) places[axis][n] = lattice_.place_mm(axis, first_[axis] + n);
  }
  for (Near& near : nears_) near.group = nullptr;
  reached_ = 0;
  if (!additive_) return;
  // Material is added within the blank only.
  const auto within = [&](int axis, int n) {
    const int node = first_[axis] + n;
    return node >= 1 && node <= lattice_.cells[static_cast<std::size_t>(axis)];
  };
  unsigned inside_z = 0;
  for (int k = 0; k < kSide; ++k) inside_z |= within(2, k) ? 1u << k : 0u;
  at_end_ = false;
  for (int j = 0; j < kSide; ++j) {
    for (int i = 0; i < kSide; ++i) {
      const unsigned mask = within(0, i) && within(1, j) ? inside_z : 0u;
      may_clear_[j * kSide + i] = static_cast<std::uint16_t>(mask);
      at_end_ |= mask != kFullColumn;
    }
  }
}

/// Which of the 2 x 2 x 2 blocks F decides at once, as it cannot change faster than by 1 mm a mm.
void BrickCutter::sort_blocks(const Sweep& sweep, const Near* near) {
  points_ = 0;
  const auto middle = [](const double* places, int block) {
    return 0.5 * (places[block * kNodeBlock] + places[(block + 1) * kNodeBlock]);
  };
  for (int b = 0; b < 8; ++b)
    push_point(middle(x_, b & 1), middle(y_, b >> 1 & 1), middle(z_, b >> 2));
  kernel_.gradient(sweep, 8, px_, py_, pz_, f_, gx_, gy_, gz_);
  const double clear = block_half_diagonal_ + kBlockSlack_mm;
  const bool convex = is_convex(sweep.kind);
  for (int b = 0; b < 8; ++b) {
    blocks_[b] = f_[b] > clear ? kOutside : f_[b] < -clear ? kInside : kMixed;
    const Vec3 slope(gx_[b], gy_[b], gz_[b]);
    planes_[b] = {-std::numeric_limits<double>::infinity(), slope};
    if (convex) planes_[b].at = f_[b] - glm::dot(slope, Vec3(px_[b], py_[b], pz_[b]));
    if (near && near->outside[b]) blocks_[b] = kOutside;
    if (f_[b] <= clear + kReachMargin_mm) reached_ |= 1u << b;
  }
}

/// Sets columns_; true if a node has been cleared.
bool BrickCutter::find_nodes(const Sweep& sweep, const OpenBrick& brick, const Near* near) {
  std::memcpy(columns_, brick.columns, sizeof columns_);
  points_ = 0;
  bool cleared = false;
  for (int j = 0; j < kSide; ++j) {
    for (int i = 0; i < kSide; ++i) {
      const int column = j * kSide + i;
      unsigned solid = brick.columns[column];
      if (additive_ && at_end_) solid &= may_clear_[column];
      if (solid == 0) continue;
      const int block = std::min(i / kNodeBlock, 1) + 2 * std::min(j / kNodeBlock, 1);
      for (int upper = 0; upper < 2; ++upper) {
        const Side side = blocks_[block + 4 * upper];
        const LowerPlane& plane = planes_[block + 4 * upper];
        unsigned bits = solid & (upper ? 0x1f0u : 0x00fu);
        if (side == kOutside || bits == 0) continue;
        if (side == kInside) {
          columns_[column] = static_cast<std::uint16_t>(columns_[column] & ~bits);
          cleared = true;
          continue;
        }
        if (near) {
          for (unsigned far = bits & ~near->columns[column]; far != 0; far &= far - 1) {
            const int at = column << 4 | std::countr_zero(far);
            node_f_[at] = static_cast<double>(near->bounds[at]);
          }
          bits &= near->columns[column];
        }
        for (; bits != 0; bits &= bits - 1) {
          const int k = std::countr_zero(bits);
          const double under = plane.under(x_[i], y_[j], z_[k]);
          if (under > kBlockSlack_mm) {
            node_f_[column << 4 | k] = under;
            continue;
          }
          nodes_[points_] = static_cast<std::uint16_t>(column << 4 | k);
          push_point(x_[i], y_[j], z_[k]);
        }
      }
    }
  }
  kernel_.distance(sweep, points_, px_, py_, pz_, f_);
  for (int n = 0; n < points_; ++n) {
    node_f_[nodes_[n]] = f_[n];
    if (!(f_[n] < 0)) continue;
    std::uint16_t& column = columns_[nodes_[n] >> 4];
    column = static_cast<std::uint16_t>(column & ~(1u << (nodes_[n] & 15)));
    cleared = true;
  }
  return cleared;
}

unsigned BrickCutter::edges(const std::uint16_t* columns, int axis, int i, int j) const {
  const unsigned c = columns[j * kSide + i];
  const unsigned next = axis == 0   ? columns[j * kSide + i + 1]
                        : axis == 1 ? columns[(j + 1) * kSide + i]
                                    : c >> 1;
  return (c ^ next) & 0xffu;
}

/// Sorts the crossed edges near the sweep into those that were crossed before and those that are
/// now; and those that are no more.
void BrickCutter::find_edges(const Sweep& sweep, const OpenBrick& brick) {
  kept_.clear();
  open_.clear();
  lost_.clear();
  // An endless tool that stands upright leaves nothing above.
  const bool takes_roofs = sweep.body->endless && std::isfinite(sweep.bottom_mm);
  for (int j = 0; j < kBrick; ++j) {
    for (int i = 0; i < kBrick; ++i) {
      const int block = i / kNodeBlock + 2 * (j / kNodeBlock);
      const unsigned near =
          (blocks_[block] != kOutside ? 0x0fu : 0u) | (blocks_[block + 4] != kOutside ? 0xf0u : 0u);
      if (near == 0) continue;
      for (int axis = 0; axis < 3; ++axis) {
        const unsigned before = edges(brick.columns, axis, i, j) & near;
        const unsigned after = edges(columns_, axis, i, j) & near;
        if (after != 0) push_edges(brick, axis, i, j, after & before, after & ~before);
        if (!seeks_films_) continue;
        unsigned lost = before & ~after;
        if (axis == 2 && takes_roofs) lost &= brick.columns[j * kSide + i] >> 1;
        if (lost != 0) push_lost(brick, axis, i, j, lost);
      }
    }
  }
}

void BrickCutter::push_edges(const OpenBrick& brick, int axis, int i, int j, unsigned kept,
                             unsigned fresh) {
  const double length = lattice_.cell_mm[axis];
  for (unsigned bits = kept | fresh; bits != 0; bits &= bits - 1) {
    const int k = std::countr_zero(bits);
    Crossing c{};
    c.edge = axis * kBrickNodes + (j * kBrick + i) * kBrick + k;
    c.axis = axis;
    c.solid_is_lower = (columns_[j * kSide + i] >> k & 1u) != 0;
    c.sign = c.solid_is_lower ? 1 : -1;
    int solid[3] = {i, j, k};
    if (!c.solid_is_lower) ++solid[axis];
    c.from_mm = Vec3(x_[solid[0]], y_[solid[1]], z_[solid[2]]);
    c.reach = length;
    if (additive_ && at_end_) {
      const int node = first_[axis] + solid[axis];
      // Air beyond the blank's face stays: the crossing is not before the face.
      if (node == 0 || node > lattice_.cells[static_cast<std::size_t>(axis)]) c.start = length / 2;
    }
    if (!(kept >> k & 1u)) {
      open_.push_back(c);
      continue;
    }
    const int lower = brick.place[c.edge];
    c.reach = length * (c.solid_is_lower ? lower : kEdgeParts - lower) / kEdgeParts;
    if (c.reach > c.start && may_be_inside(c, solid)) kept_.push_back(c);
  }
}

/// Edges whose solid node has gone, so that the crossing may be the far face of a film.
void BrickCutter::push_lost(const OpenBrick& brick, int axis, int i, int j, unsigned lost) {
  const double length = lattice_.cell_mm[axis];
  for (unsigned bits = lost; bits != 0; bits &= bits - 1) {
    const int k = std::countr_zero(bits);
    // All of the edge is inside of the sweep.
    if (blocks_[i / kNodeBlock + 2 * (j / kNodeBlock) + 4 * (k / kNodeBlock)] == kInside) continue;
    Crossing c{};
    c.edge = axis * kBrickNodes + (j * kBrick + i) * kBrick + k;
    c.axis = axis;
    c.solid_is_lower = (brick.columns[j * kSide + i] >> k & 1u) != 0;
    c.sign = c.solid_is_lower ? 1 : -1;
    int solid[3] = {i, j, k};
    if (!c.solid_is_lower) ++solid[axis];
    const int lower = brick.place[c.edge];
    c.reach = length * (c.solid_is_lower ? lower : kEdgeParts - lower) / kEdgeParts;
    const int block = std::min(solid[0] / kNodeBlock, 1) + 2 * std::min(solid[1] / kNodeBlock, 1) +
                      4 * std::min(solid[2] / kNodeBlock, 1);
    const double f = node_f_[(solid[1] * kSide + solid[0]) * 16 + solid[2]];
    if (blocks_[block] == kMixed && f + c.reach <= kLeastFilm_mm) continue;
    c.from_mm = Vec3(x_[solid[0]], y_[solid[1]], z_[solid[2]]);
    lost_.push_back(c);
  }
}

/// False if the crossing is so near to the solid end, and that so far from the sweep, that F cannot
/// be negative there.
bool BrickCutter::may_be_inside(const Crossing& c, const int solid[3]) const {
  if (additive_) return true;
  int block = 0;
  for (int axis = 0; axis < 3; ++axis) block |= (solid[axis] >= kNodeBlock ? 1 : 0) << axis;
  if (blocks_[block] != kMixed) return true;
  Vec3 at = c.from_mm;
  at[c.axis] += c.sign * c.reach;
  // The block is that of the solid end; a bound by a plane holds everywhere.
  if (planes_[block].under(at.x, at.y, at.z) > kBlockSlack_mm - place_slack_) return false;
  return node_f_[(solid[1] * kSide + solid[0]) * 16 + solid[2]] < c.reach;
}

/// Moves those of kept_ whose crossing lies inside the sweep to open_, and leaves in lost_ those
/// that lie outside of it.
void BrickCutter::keep_deeper(const Sweep& sweep) {
  points_ = 0;
  for (const Crossing& c : kept_) push_point(c, c.reach);
  for (const Crossing& c : lost_) push_point(c, c.reach);
  kernel_.distance(sweep, points_, px_, py_, pz_, f_);
  // By more than a crossing's place is good for, so that a second cut changes nothing.
  for (std::size_t n = 0; n < kept_.size(); ++n)
    if (f_[n] < -place_slack_) open_.push_back(kept_[n]);
  std::size_t left = 0;
  for (std::size_t n = 0; n < lost_.size(); ++n)
    if (f_[kept_.size() + n] > kLeastFilm_mm + place_slack_) lost_[left++] = lost_[n];
  lost_.resize(left);
}

/// Of the crossings in lost_, those whose face and the sweep's look away from each other.
void BrickCutter::find_films(const Sweep& sweep, const OpenBrick& brick) {
  points_ = 0;
  for (const Crossing& c : lost_) push_point(c, c.reach);
  kernel_.gradient(sweep, points_, px_, py_, pz_, f_, gx_, gy_, gz_);
  for (std::size_t n = 0; n < lost_.size(); ++n) {
    const Vec3 face(unpack_direction(brick.direction[lost_[n].edge]));
    if (glm::dot(face, Vec3(gx_[n], gy_[n], gz_[n])) < kOpposed) continue;
    // Edges along each axis meet a face as often as it looks that way, so a share of each by that
    // part of its normal is an area, whichever way it looks.
    films_.push_back({Vec3(px_[n], py_[n], pz_[n]), std::abs(face[lost_[n].axis]), f_[n]});
  }
}

void BrickCutter::drop_films(const Sweep& sweep) {
  points_ = 0;
  for (const Film& film : films_) push_point(film.at_mm.x, film.at_mm.y, film.at_mm.z);
  kernel_.distance(sweep, points_, px_, py_, pz_, f_);
  std::size_t left = 0;
  for (std::size_t n = 0; n < films_.size(); ++n)
    if (f_[n] > kLeastFilm_mm + place_slack_) films_[left++] = films_[n];
  films_.resize(left);
}

/// Where F is 0 on each edge of open_, from its solid end (F >= 0) on. Newton's steps from there
/// never pass the root, as F is convex along a line (all kinds but arcs and turns); where they
/// would, the bracket holds them.
void BrickCutter::solve(const Sweep& sweep) {
  roots_.resize(open_.size());
  active_.clear();
  points_ = 0;
  for (std::size_t n = 0; n < open_.size(); ++n) {
    roots_[n].tried = open_[n].start;
    roots_[n].high = open_[n].reach;
    push_point(open_[n], open_[n].start);
    active_.push_back(static_cast<int>(n));
  }
  for (int step = 0; !active_.empty(); ++step) {
    kernel_.gradient(sweep, points_, px_, py_, pz_, f_, gx_, gy_, gz_);
    std::size_t left = 0;
    points_ = 0;
    for (std::size_t a = 0; a < active_.size(); ++a) {
      const std::size_t n = static_cast<std::size_t>(active_[a]);
      if (!next_place(open_[n], roots_[n], f_[a], Vec3(gx_[a], gy_[a], gz_[a]), step)) continue;
      active_[left++] = static_cast<int>(n);
      push_point(open_[n], roots_[n].tried);
    }
    active_.resize(left);
  }
}

/// Takes in F and its gradient at root.tried; false if the root is found, else sets the next place.
bool BrickCutter::next_place(const Crossing& c, Root& root, double f, const Vec3& gradient,
                             int step) const {
  const double length = lattice_.cell_mm[c.axis];
  const bool first = step == 0;
  if (first && c.start > 0 && f < 0) {
    root.low = c.start;  // the blank's face
    root.normal = Vec3(0);
    root.normal[c.axis] = -c.sign;
    return false;
  }
  if (f >= 0 || first) {
    root.low = root.tried;
    root.f_low = std::max(0.0, f);
    root.slope = c.sign * gradient[c.axis];
    root.normal = gradient;
  } else {
    root.high = root.tried;
  }
  const double newton = root.slope < 0 ? root.low - root.f_low / root.slope : root.high;
  if (root.f_low <= kRootPart * length || root.high - root.low <= kRootPart * length ||
      step >= kMaxRootSteps) {
    root.low = std::min(newton, root.high);
    return false;
  }
  // Beyond the bracket, or too slow: halve it.
  root.tried = newton < root.high && step <= kNewtonSteps ? newton : 0.5 * (root.low + root.high);
  return true;
}

void BrickCutter::write(const Sweep& sweep, OpenBrick& brick) {
  for (std::size_t n = 0; n < open_.size(); ++n) {
    const Crossing& c = open_[n];
    const std::size_t e = static_cast<std::size_t>(c.edge);
    const double part = roots_[n].low / lattice_.cell_mm[c.axis];
    const double lower = c.solid_is_lower ? part : 1 - part;
    brick.place[e] = static_cast<std::uint16_t>(
        std::clamp(std::lround(lower * kEdgeParts), 0L, static_cast<long>(kEdgeParts - 1)));
    brick.direction[e] = pack_direction(-glm::vec3(roots_[n].normal));
    brick.id[e] = sweep.cut_id;
    const int node = c.edge % kBrickNodes;
    std::uint8_t& changed = changed_[node / kBrick];
    changed = static_cast<std::uint8_t>(changed | 1u << (node % kBrick));
  }
}

/// Takes the new state over and measures what is gone.
void BrickCutter::account(OpenBrick& brick) {
  const std::int64_t volume = brick.volume;
  unsigned difference[kSide * kSide];
  for (int c = 0; c < kSide * kSide; ++c) difference[c] = brick.columns[c] ^ columns_[c];
  std::memcpy(brick.columns, columns_, sizeof columns_);
  for (int j = 0; j < kBrick; ++j) {
    for (int i = 0; i < kBrick; ++i) {
      const int column = j * kBrick + i, c = j * kSide + i;
      const unsigned own = difference[c] | difference[c] >> 1 | changed_[column];
      const unsigned all = (own | difference[c + 1] | difference[c + kSide]) & 0xffu;
      heights_[column] = 0;
      if (all == 0) continue;
      brick.update_volume(i, j, all);
      if ((own & 0xffu) == 0) continue;
      const std::int32_t height = brick.height_of[column];
      brick.update_height(i, j);
      heights_[column] = height - brick.height_of[column];
    }
  }
  removed_ = volume - brick.volume;
  brick.update_top();
}

/// Null where it saves nothing.
BrickCutter::Near* BrickCutter::near_of(const TurnGroup* group, const OpenBrick& brick) {
  if (!group || additive_) return nullptr;
  Near* near = nullptr;
  for (Near& known : nears_)
    if (known.group == group) near = &known;
  if (!near) {
    near = &nears_[next_near_++ % kNears];
    near->group = group;
    look_near(*group, brick, *near);
    near->any = near->nodes || any_edge_near(brick, *near);
    near->changes = changes_;
  } else if (near->changes != changes_) {
    near->any = near->nodes || any_edge_near(brick, *near);
    near->changes = changes_;
  }
  return near;
}

void BrickCutter::look_near(const TurnGroup& group, const OpenBrick& brick, Near& near) {
  // The pieces' poses are so far from those of the whole, as points of this brick see them.
  const Vec3 middle(0.5 * (x_[0] + x_[kBrick]), 0.5 * (y_[0] + y_[kBrick]),
                    0.5 * (z_[0] + z_[kBrick]));
  const double reach = glm::length(middle - group.middle_mm) + group.tips_mm + half_diagonal_;
  const double off = 1.01 * (group.off_mm + group.off_rad * reach) + kBlockSlack_mm;
  Sweep whole = group.whole;
  whole.bend_mm = bend_mm(reach, group.way_mm, group.turn_rad);
  points_ = 0;
  for (int b = 0; b < 8; ++b)
    push_point(0.5 * (x_[(b & 1) * kNodeBlock] + x_[((b & 1) + 1) * kNodeBlock]),
               0.5 * (y_[(b >> 1 & 1) * kNodeBlock] + y_[((b >> 1 & 1) + 1) * kNodeBlock]),
               0.5 * (z_[(b >> 2) * kNodeBlock] + z_[((b >> 2) + 1) * kNodeBlock]));
  const double clear = block_half_diagonal_ + kReachMargin_mm + off;
  kernel_.turn_bound(whole, clear, 8, px_, py_, pz_, f_);
  for (int b = 0; b < 8; ++b) near.outside[b] = f_[b] > clear;
  points_ = 0;
  near.nodes = false;
  for (int column = 0; column < kSide * kSide; ++column) {
    near.columns[column] = 0;
    const int i = column % kSide, j = column / kSide;
    const int block = std::min(i / kNodeBlock, 1) + 2 * std::min(j / kNodeBlock, 1);
    for (unsigned bits = brick.columns[column]; bits != 0; bits &= bits - 1) {
      const int k = std::countr_zero(bits);
      if (near.outside[block + 4 * std::min(k / kNodeBlock, 1)]) continue;
      nodes_[points_] = static_cast<std::uint16_t>(column << 4 | k);
      push_point(x_[i], y_[j], z_[k]);
    }
  }
  kernel_.turn_bound(whole, off, points_, px_, py_, pz_, f_);
  for (int n = 0; n < points_; ++n) {
    near.bounds[nodes_[n]] = static_cast<float>(f_[n] - off);
    if (f_[n] > off) continue;
    near.columns[nodes_[n] >> 4] |= static_cast<std::uint16_t>(1u << (nodes_[n] & 15));
    near.nodes = true;
  }
}

/// Some crossing lies no farther from its solid node than a piece may come to that.
bool BrickCutter::any_edge_near(const OpenBrick& brick, const Near& near) const {
  for (int j = 0; j < kBrick; ++j) {
    for (int i = 0; i < kBrick; ++i) {
      for (int axis = 0; axis < 3; ++axis) {
        for (unsigned bits = edges(brick.columns, axis, i, j); bits != 0; bits &= bits - 1) {
          const int k = std::countr_zero(bits);
          int solid[3] = {i, j, k};
          const bool lower_is = (brick.columns[j * kSide + i] >> k & 1u) != 0;
          if (!lower_is) ++solid[axis];
          const int block = std::min(solid[0] / kNodeBlock, 1) +
                            2 * std::min(solid[1] / kNodeBlock, 1) +
                            4 * std::min(solid[2] / kNodeBlock, 1);
          if (near.outside[block]) {
            // The edge's own block may be the other one, which is near.
            if (near.outside[i / kNodeBlock + 2 * (j / kNodeBlock) + 4 * (k / kNodeBlock)])
              continue;
            return true;
          }
          const int lower = brick.place[axis * kBrickNodes + (j * kBrick + i) * kBrick + k];
          const double reach =
              lattice_.cell_mm[axis] * (lower_is ? lower : kEdgeParts - lower) / kEdgeParts;
          const float bound = near.bounds[(solid[1] * kSide + solid[0]) * 16 + solid[2]];
          if (static_cast<double>(bound) < reach) return true;
        }
      }
    }
  }
  return false;
}

/// A floor that this or another level move has cut already is by far the most frequent case.
bool BrickCutter::passes_above(const Sweep& sweep, const OpenBrick& brick) const {
  if (brick.top_node < 0 || brick.top_node == kBrick) return false;
  return z_[brick.top_node] < sweep.bottom_mm - kBlockSlack_mm &&
         z_[0] + lattice_.cell_mm.z * brick.top / kEdgeParts < sweep.bottom_mm + 0.9 * place_slack_;
}

bool BrickCutter::apply(const Sweep& sweep, OpenBrick& brick, const TurnGroup* group) {
  if (passes_above(sweep, brick)) return false;
  const Near* const near = near_of(group, brick);
  if (near && !near->any) {
    for (int b = 0; b < 8; ++b)
      if (!near->outside[b]) reached_ |= 1u << b;
    return false;
  }
  sort_blocks(sweep, near);
  const bool cleared = find_nodes(sweep, brick, near);
  find_edges(sweep, brick);
  keep_deeper(sweep);
  if (!lost_.empty()) find_films(sweep, brick);
  if (!cleared && open_.empty()) return false;
  std::memset(changed_, 0, sizeof changed_);
  solve(sweep);
  write(sweep, brick);
  account(brick);
  ++changes_;
  return true;
}

bool BrickCutter::touches(const Sweep& sweep, const OpenBrick& brick, const TurnGroup* group) {
  if (passes_above(sweep, brick)) return false;
  const Near* const near = near_of(group, brick);
  if (near && !near->any) return false;
  sort_blocks(sweep, near);
  if (find_nodes(sweep, brick, near)) return true;
  find_edges(sweep, brick);
  keep_deeper(sweep);
  return !open_.empty();
}

}  // namespace kerf::octree
