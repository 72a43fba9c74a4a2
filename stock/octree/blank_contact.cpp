#include "stock/octree/blank_contact.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <optional>

#include "base/portable_math.h"
#include "base/translate.h"

namespace kerf::octree {
namespace {

constexpr int kBlock = kBrick / 2;
/// Each projection goes on into the tool, at first by kInto_mm, then by less: a tool's point is not
/// come near to from below otherwise.
constexpr int kMostSteps = 96;
constexpr double kInto_mm = 0.02, kIntoShrinks = 0.86;
/// After so many steps it must have come nearer by a tenth.
constexpr int kLookEvery = 16;
constexpr double kStill_mm = 1e-7;
/// Whoever looks for the nearest point goes on while so many steps bring it nearer by this.
constexpr double kCloser_mm = 1e-4;
/// Points of the tool's own surface are not inside of it, whatever rounding says.
constexpr double kInside_mm = 1e-7;
static_assert(kLanes == 8, "one lane for each eighth of a block");

int axis_of(const BlankBody& body) { return body.axis == 'x' ? 0 : body.axis == 'y' ? 1 : 2; }

/// Nearest point of the body less `in_mm` on every side, but for its ends.
Vec3 into_round(const BlankBody& body, double in_mm, const Vec3& p) {
  if (body.kind == BlankBody::Kind::kBox) return p;
  Vec3 out = p - body.center_mm;
  const int axis = axis_of(body);
  const double along = out[axis];
  out[axis] = 0;
  const double distance = glm::length(out);
  const double low = body.kind == BlankBody::Kind::kTube ? body.inner_diameter_mm / 2 + in_mm : 0;
  const double wanted = std::max(std::min(distance, body.diameter_mm / 2 - in_mm), low);
  if (wanted == distance || distance == 0) return p;
  out *= wanted / distance;
  out[axis] = along;
  return body.center_mm + out;
}

Vec3 into(const Box& box, const Vec3& p) { return glm::max(box.min, glm::min(box.max, p)); }

}  // namespace

bool BlankContact::is_near(const Sweep& sweep, const Box& block, double within_mm) {
  const Vec3 middle = 0.5 * (block.min + block.max);
  std::fill(std::begin(x_), std::end(x_), middle.x);
  std::fill(std::begin(y_), std::end(y_), middle.y);
  std::fill(std::begin(z_), std::end(z_), middle.z);
  kernel_.distance(sweep, 1, x_, y_, z_, f_);
  return f_[0] - sweep.shrink_mm <= 0.5 * glm::length(block.size()) + within_mm;
}

BlankContact::Lanes BlankContact::lanes_of(const BlankBody& body, const Box& block, double in_mm) {
  Lanes lanes;
  const Vec3 half = 0.5 * block.size();
  for (int l = 0; l < kLanes; ++l) {
    Box part;
    part.min = block.min + half * Vec3(l & 1, l >> 1 & 1, l >> 2);
    part.max = part.min + half;
    Box& box = lanes.boxes[l];
    box.min = glm::max(part.min, body.bounds_mm.min + Vec3(in_mm));
    box.max = glm::min(part.max, body.bounds_mm.max - Vec3(in_mm));
    lanes.searching[l] = box.min.x <= box.max.x && box.min.y <= box.max.y && box.min.z <= box.max.z;
    lanes.at[l] = lanes.searching[l] ? 0.5 * (box.min + box.max) : part.min;
    lanes.any |= lanes.searching[l];
  }
  return lanes;
}

/// Each lane begins in the middle of its eighth of the block.
bool BlankContact::search(const Sweep& sweep, const BlankBody& body, const Box& block,
                          Vec3& found_mm) {
  const double in = std::max(sweep.shrink_mm, kStill_mm);
  auto [boxes, at, searching, any] = lanes_of(body, block, in);
  double nearest[kLanes], nearest_before[kLanes];
  std::fill(std::begin(nearest), std::end(nearest), std::numeric_limits<double>::infinity());
  std::copy(std::begin(nearest), std::end(nearest), nearest_before);
  double deeper = kInto_mm;
  for (int step = 0; any && step < kMostSteps; ++step, deeper *= kIntoShrinks) {
    for (int l = 0; l < kLanes; ++l) {
      x_[l] = at[l].x;
      y_[l] = at[l].y;
      z_[l] = at[l].z;
    }
    kernel_.gradient(sweep, kLanes, x_, y_, z_, f_, gx_, gy_, gz_);
    any = false;
    for (int l = 0; l < kLanes; ++l) {
      if (!searching[l]) continue;
      const double f = f_[l] - sweep.shrink_mm;
      const Vec3 round = into_round(body, in, at[l]);
      const bool within = glm::length(round - at[l]) <= kStill_mm;
      if (f < -kInside_mm && within) {
        found_mm = at[l];
        return true;
      }
      nearest[l] = std::min(nearest[l], f);
      const Vec3 slope(gx_[l], gy_[l], gz_[l]);
      const Vec3 inward = at[l] - (std::max(f, 0.0) + deeper + 2 * kInside_mm) * slope;
      at[l] = into(boxes[l], into_round(body, in, inward));
      if (step % kLookEvery == kLookEvery - 1) {
        searching[l] = nearest[l] < 0.9 * nearest_before[l] || nearest[l] < 2 * deeper;
        nearest_before[l] = nearest[l];
      }
      any |= searching[l];
    }
  }
  return false;
}

/// By projecting to and fro: to what is swept, and back to the body.
std::optional<BlankContact::Nearest> BlankContact::nearest_in(const Sweep& sweep, const Box& block,
                                                              double below_mm) {
  if (!is_near(sweep, block, below_mm)) return std::nullopt;
  Nearest least{below_mm, Vec3(0)};
  for (const BlankBody& body : bodies_) {
    auto [boxes, at, searching, any] = lanes_of(body, block, kStill_mm);
    double before = std::numeric_limits<double>::infinity();
    for (int step = 0; any && step < kMostSteps; ++step) {
      for (int l = 0; l < kLanes; ++l) {
        x_[l] = at[l].x;
        y_[l] = at[l].y;
        z_[l] = at[l].z;
      }
      kernel_.gradient(sweep, kLanes, x_, y_, z_, f_, gx_, gy_, gz_);
      for (int l = 0; l < kLanes; ++l) {
        if (!searching[l]) continue;
        const double f = f_[l] - sweep.shrink_mm;
        const Vec3 round = into_round(body, kStill_mm, at[l]);
        if (f < least.mm && glm::length(round - at[l]) <= kStill_mm) least = {f, at[l]};
        const Vec3 inward = at[l] - std::max(f, 0.0) * Vec3(gx_[l], gy_[l], gz_[l]);
        at[l] = into(boxes[l], into_round(body, kStill_mm, inward));
      }
      if (step % kLookEvery != kLookEvery - 1) continue;
      if (least.mm <= 0 || least.mm > before - kCloser_mm) break;
      before = least.mm;
    }
  }
  return least.mm < below_mm ? std::optional(least) : std::nullopt;
}

Box BlankContact::block_of(int bx, int by, int bz, int number) const {
  const int brick[3] = {bx, by, bz};
  Box block;
  for (int axis = 0; axis < 3; ++axis) {
    const int first = brick[axis] * kBrick + (number >> axis & 1) * kBlock;
    block.min[axis] = lattice_.place_mm(axis, first);
    block.max[axis] = lattice_.place_mm(axis, first + kBlock);
  }
  return block;
}

std::optional<Vec3> BlankContact::point_in(const Sweep& sweep, const Box& block) {
  if (!is_near(sweep, block)) return std::nullopt;
  Vec3 found;
  for (const BlankBody& body : bodies_)
    if (search(sweep, body, block, found)) return found;
  return std::nullopt;
}

bool BlankContact::touches(const Sweep& sweep, int bx, int by, int bz, unsigned blocks) {
  for (; blocks != 0; blocks &= blocks - 1)
    if (point_in(sweep, block_of(bx, by, bz, std::countr_zero(blocks)))) return true;
  return false;
}

bool BlankContact::is_untouched_above(const BrickTree& tree, const Vec3& point_mm) const {
  int node[3];
  for (int axis = 0; axis < 3; ++axis)
    node[axis] = static_cast<int>(
        std::floor((point_mm[axis] - lattice_.origin_mm[axis]) / lattice_.cell_mm[axis]));
  for (; node[2] <= lattice_.cells[2]; node[2] += kBlock) {
    int block = 0;
    for (int axis = 0; axis < 3; ++axis) block |= (node[axis] % kBrick / kBlock) << axis;
    const unsigned bits = tree.untouched(node[0] / kBrick, node[1] / kBrick, node[2] / kBrick);
    if ((bits >> block & 1u) == 0) return false;
    node[2] -= node[2] % kBlock;
  }
  return true;
}

double BlankContact::plunge_depth_mm(const BrickTree& tree, const Vec3& tip_mm) const {
  if (bodies_.size() != 1) return 0;
  const BlankBody& body = bodies_[0];
  const Box& box = body.bounds_mm;
  if (tip_mm.x <= box.min.x || tip_mm.x >= box.max.x || tip_mm.y <= box.min.y ||
      tip_mm.y >= box.max.y) {
    return 0;
  }
  if (body.kind != BlankBody::Kind::kBox) {
    const double from_axis =
        portable::hypot(tip_mm.x - body.center_mm.x, tip_mm.y - body.center_mm.y);
    const double inner = body.kind == BlankBody::Kind::kTube ? body.inner_diameter_mm / 2 : -1;
    if (body.axis != 'z' || from_axis >= body.diameter_mm / 2 || from_axis <= inner) return 0;
  }
  const Vec3 lowest{tip_mm.x, tip_mm.y, std::max(tip_mm.z, box.min.z)};
  if (lowest.z >= box.max.z || !is_untouched_above(tree, lowest)) return 0;
  return box.max.z - lowest.z;
}

double BlankContact::depth_mm(const BrickTree& tree, std::span<const Sweep> sweeps) {
  constexpr std::size_t kMostSweeps = 64;
  constexpr int kHalvings = 30;
  if (bodies_.size() != 1 || bodies_[0].kind != BlankBody::Kind::kBox) return 0;
  const Box& blank = bodies_[0].bounds_mm;
  double depth = 0;
  for (const Sweep& sweep : sweeps.first(std::min(sweeps.size(), kMostSweeps))) {
    if (!sweep.body->endless || !std::isfinite(sweep.bottom_mm)) continue;
    if (blank.max.z - sweep.bottom_mm <= depth) continue;
    Vec3 lowest;
    if (!search(sweep, bodies_[0], blank, lowest)) continue;
    Box below = blank;
    double none = std::max(sweep.bottom_mm, blank.min.z);
    for (int n = 0; n < kHalvings && lowest.z > none; ++n) {
      below.max.z = 0.5 * (none + lowest.z);
      if (!search(sweep, bodies_[0], below, lowest)) none = below.max.z;
    }
    const bool through =
        sweep.bottom_mm <= blank.min.z && lowest.z - blank.min.z < 2 * sweep.shrink_mm;
    if (is_untouched_above(tree, lowest))
      depth = std::max(depth, blank.max.z - (through ? blank.min.z : lowest.z));
  }
  return depth;
}

}  // namespace kerf::octree
