#include "twin/process/milling/workpiece_surface.h"

#include <algorithm>
#include <cassert>
#include <utility>

#include "twin/collision/solid_sweep.h"

namespace kerf {
namespace {

/// So many are kept of tiles that no body is near: some 10 MB.
constexpr std::size_t kKeptTriangles = 50'000;
/// Tiles are side by side in time (WorkpieceSurface) up to here: bodies that are not asked for on
/// the way go no farther.
constexpr double kNear_mm = WorkpieceSurface::kFarthest_mm;

Box grown(const Box& box, double by_mm) { return {box.min - Vec3(by_mm), box.max + Vec3(by_mm)}; }

/// Around the body, over all of its way.
Box box_of_way(const Solid& moving, const RigidWay& way) {
  double reach = 0;
  for (const Convex& piece : moving.pieces()) reach = std::max(reach, reach_of(piece));
  Box box = box_around(way.pose(0), moving.box_mm());
  box.extend(box_around(way.pose(1), moving.box_mm()));
  return grown(box, way.slack_mm(0, 1, reach));
}

}  // namespace

const Box& WorkpieceSurface::box_mm() {
  if (!box_mm_) box_mm_ = stock_.bounds_mm();
  return *box_mm_;
}

const Solid& WorkpieceSurface::tile_box(std::uint32_t number) {
  SolidPointer& box = boxes_[number];
  if (!box) {
    BlankBody body;
    body.bounds_mm = stock_.tile_box(number);
    box = Solid::of_bodies({&body, 1});
  }
  return *box;
}

void WorkpieceSurface::make(std::uint32_t number, Tile& tile) {
  const MeshPatch patch = stock_.patch(number, 0);
  TriangleMesh mesh;
  mesh.positions_mm.reserve(patch.vertices.size());
  for (const MeshVertex& vertex : patch.vertices) mesh.positions_mm.push_back(vertex.position_mm);
  mesh.triangles.reserve(patch.skirt_begin / 3);
  for (std::size_t i = 0; i + 2 < patch.skirt_begin; i += 3)
    mesh.triangles.push_back({patch.indices[i], patch.indices[i + 1], patch.indices[i + 2]});
  if (tile.solid) triangles_ -= tile.solid->pieces().size();
  tile.solid = Solid::of_mesh(mesh);
  triangles_ += tile.solid->pieces().size();
}

/// Drops what is not near.
void WorkpieceSurface::make_room() {
  if (triangles_ <= kKeptTriangles) return;
  std::erase_if(tiles_, [&](const auto& entry) {
    if (std::ranges::binary_search(near_, entry.first)) return false;
    triangles_ -= entry.second.solid->pieces().size();
    return true;
  });
}

bool WorkpieceSurface::renew() {
  complete_();
  ++time_;
  bool changed = false;
  for (const std::uint32_t number : near_) {
    const std::uint64_t version = stock_.patch_version(number);
    Tile& tile = tiles_[number];
    if (!tile.solid || tile.version != version) {
      make(number, tile);
      changed = true;
    }
    tile.version = version;
    tile.time = time_;
  }
  return changed;
}

template <class IsNear>
void WorkpieceSurface::gather(const Box& box, const IsNear& is_near) {
  near_.clear();
  const std::size_t count = stock_.tile_count();
  for (std::uint32_t number = 0; number < count; ++number) {
    const Solid& around = tile_box(number);
    if (box_gap_mm(box, around.box_mm()) <= kNear_mm && is_near(around)) near_.push_back(number);
  }
  if (near_.empty()) return;
  const auto time_of = [&](std::uint32_t number) {
    const auto known = tiles_.find(number);
    return known == tiles_.end() ? std::uint64_t{0} : known->second.time;
  };
  const std::uint64_t time = time_of(near_.front());
  const bool is_one =
      time > 0 && std::ranges::all_of(near_, [&](auto number) { return time_of(number) == time; });
  if (!is_one) renew();
  make_room();
}

void WorkpieceSurface::gather_along(const Solid& moving, const RigidWay& way) {
  gather(box_of_way(moving, way),
         [&](const Solid& around) { return least_gap(moving, way, around, kNear_mm).has_value(); });
}

std::optional<double> WorkpieceSurface::touch_of_near(const Solid& moving, const RigidWay& way,
                                                      double thinner_mm) {
  std::optional<double> first;
  for (const std::uint32_t number : near_) {
    const auto t = kerf::first_touch(moving, way, surface(number), thinner_mm);
    if (t && (!first || *t < *first)) first = t;
  }
  return first;
}

std::optional<double> WorkpieceSurface::first_touch(const Solid& moving, const RigidWay& way,
                                                    double thinner_mm) {
  gather_along(moving, way);
  const auto before = touch_of_near(moving, way, thinner_mm);
  if (!before || !renew()) return before;
  return touch_of_near(moving, way, thinner_mm);
}

double WorkpieceSurface::gap_of_near(const Solid& moving, const Pose& pose, double cutoff_mm) {
  double gap = cutoff_mm;
  for (const std::uint32_t number : near_) {
    gap = kerf::gap_at(moving, pose, surface(number), gap);
  }
  return gap;
}

double WorkpieceSurface::gap_at(const Solid& moving, const Pose& pose, double cutoff_mm) {
  assert(cutoff_mm <= kNear_mm);
  gather(box_around(pose, moving.box_mm()), [&](const Solid& around) {
    return kerf::gap_at(moving, pose, around, kNear_mm) < kNear_mm;
  });
  const double before = gap_of_near(moving, pose, cutoff_mm);
  if (before > 0 || !renew()) return before;
  return gap_of_near(moving, pose, cutoff_mm);
}

double WorkpieceSurface::touch_depth_mm(const Solid& moving, const RigidWay& way, double known_mm) {
  gather_along(moving, way);
  renew();
  double depth = known_mm;
  for (const std::uint32_t number : near_) {
    depth = std::max(depth, kerf::touch_depth_mm(moving, way, surface(number), depth));
  }
  return depth;
}

}  // namespace kerf
