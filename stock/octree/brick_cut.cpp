#include "stock/octree/brick_cut.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <glm/geometric.hpp>

namespace kerf::octree {
namespace {

/// The faces of a film look away from each other to within 45 degrees; those of the ridges between
/// passes, and of edges, meet less steeply.
constexpr double kOpposed = 0.7;

}  // namespace

BrickCutter::BrickCutter(const Lattice& lattice, const SweepKernel& kernel, bool additive)
    : lattice_(lattice), kernel_(kernel) {
  half_diagonal_ = glm::length(lattice.cell_mm) * kBrick / 2;
  work_.block_clear_mm = half_diagonal_ / 2 + kBlockSlack_mm;
  work_.half_diagonal_mm = half_diagonal_;
  work_.place_slack_mm =
      std::max({lattice.cell_mm.x, lattice.cell_mm.y, lattice.cell_mm.z}) / kEdgeParts;
  work_.additive = additive;
  for (int axis = 0; axis < 3; ++axis) {
    work_.origin_mm[axis] = lattice.origin_mm[axis];
    work_.cell_mm[axis] = lattice.cell_mm[axis];
    work_.cells[axis] = lattice.cells[static_cast<std::size_t>(axis)];
  }
  static_assert(kPointRoom > kSide * kSide * kSide + kLanes);
}

void BrickCutter::set_place(int bx, int by, int bz) {
  const int brick[3] = {bx, by, bz};
  for (int axis = 0; axis < 3; ++axis) {
    work_.first[axis] = brick[axis] * kBrick;
    for (int n = 0; n < kSide; ++n)
      work_.place_mm[axis][n] = lattice_.place_mm(axis, work_.first[axis] + n);
  }
  work_.reached = 0;
  if (!work_.additive) return;
  // Material is added within the blank only.
  const auto within = [&](int axis, int n) {
    const int node = work_.first[axis] + n;
    return node >= 1 && node <= work_.cells[axis];
  };
  unsigned inside_z = 0;
  for (int k = 0; k < kSide; ++k) inside_z |= within(2, k) ? 1u << k : 0u;
  work_.at_end = false;
  for (int j = 0; j < kSide; ++j) {
    for (int i = 0; i < kSide; ++i) {
      const unsigned mask = within(0, i) && within(1, j) ? inside_z : 0u;
      work_.may_clear[j * kSide + i] = static_cast<std::uint16_t>(mask);
      work_.at_end |= mask != kFullColumn;
    }
  }
}

/// Of the crossings in lost_edges, those whose face and the sweep's look away from each other.
void BrickCutter::note_films(const OpenBrick& brick) {
  const EdgeList& lost = work_.lost_edges;
  struct Found {
    unsigned order;
    Film film;
  };
  std::vector<Found> found;
  for (int n = 0; n < lost.count; ++n) {
    const unsigned edge = lost.edge[n] & (kLowerIsSolid - 1);
    const int axis = static_cast<int>(edge / kBrickNodes);
    const Vec3 face(unpack_direction(brick.direction[edge]));
    if (glm::dot(face, Vec3(work_.gx[n], work_.gy[n], work_.gz[n])) < kOpposed) continue;
    // Edges along each axis meet a face as often as it looks that way, so a share of each by that
    // part of its normal is an area, whichever way it looks. Sums of these go by their order: by
    // columns, then axes.
    const unsigned column = edge % kBrickNodes / kBrick;
    found.push_back({(column * 3 + static_cast<unsigned>(axis)) * kBrick + edge % kBrick,
                     {Vec3(work_.x[n], work_.y[n], work_.z[n]), std::abs(face[axis]), work_.f[n]}});
  }
  std::sort(found.begin(), found.end(),
            [](const Found& a, const Found& b) { return a.order < b.order; });
  for (const Found& each : found) films_.push_back(each.film);
}

void BrickCutter::drop_films(const Sweep& sweep) {
  std::size_t left = 0;
  for (std::size_t first = 0; first < films_.size(); first += kPointRoom - kLanes) {
    const std::size_t count = std::min<std::size_t>(films_.size() - first, kPointRoom - kLanes);
    for (std::size_t n = 0; n < count; ++n) {
      work_.x[n] = films_[first + n].at_mm.x;
      work_.y[n] = films_[first + n].at_mm.y;
      work_.z[n] = films_[first + n].at_mm.z;
    }
    kernel_.distance(sweep, static_cast<int>(count), work_.x, work_.y, work_.z, work_.f);
    for (std::size_t n = 0; n < count; ++n)
      if (work_.f[n] > kLeastFilm_mm + work_.place_slack_mm) films_[left++] = films_[first + n];
  }
  films_.resize(left);
}

/// A floor that this or another level move has cut already is by far the most frequent case.
bool BrickCutter::passes_above(const Sweep& sweep, OpenBrick& brick) const {
  if (brick.top_node < 0 || brick.top_node == kBrick) return false;
  const double* const z = work_.place_mm[2];
  return z[brick.top_node] < sweep.bottom_mm - kBlockSlack_mm &&
         z[0] + lattice_.cell_mm.z * brick.top() / kEdgeParts <
             sweep.bottom_mm + 0.9 * work_.place_slack_mm;
}

bool BrickCutter::apply(const Sweep& sweep, OpenBrick& brick) {
  if (passes_above(sweep, brick)) return false;
  if (!kernel_.remove(work_, sweep, brick)) return false;
  if (work_.lost_edges.count > 0) note_films(brick);
  return true;
}

bool BrickCutter::touches(const Sweep& sweep, OpenBrick& brick) {
  return !passes_above(sweep, brick) && kernel_.meets(work_, sweep, brick);
}

}  // namespace kerf::octree
