#include "twin/process/milling/workpiece_surface.h"

#include <algorithm>
#include <utility>

#include "twin/collision/solid_sweep.h"

namespace kerf {
namespace {

/// Surfaces of so many tiles are kept at once: some ten MB.
constexpr std::size_t kMostTiles = 24;

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

const Solid& WorkpieceSurface::tile(std::uint32_t number) {
  const std::uint64_t version = stock_.patch_version(number);
  const auto known = tiles_.find(number);
  if (known != tiles_.end() && known->second.version == version) return *known->second.solid;
  if (known == tiles_.end() && tiles_.size() >= kMostTiles) tiles_.clear();
  const MeshPatch patch = stock_.patch(number, 0);
  TriangleMesh mesh;
  mesh.positions_mm.reserve(patch.vertices.size());
  for (const MeshVertex& vertex : patch.vertices) mesh.positions_mm.push_back(vertex.position_mm);
  for (std::size_t i = 0; i + 2 < patch.skirt_begin; i += 3)
    mesh.triangles.push_back({patch.indices[i], patch.indices[i + 1], patch.indices[i + 2]});
  Tile& tile = tiles_[number];
  tile = {version, Solid::of_mesh(mesh)};
  return *tile.solid;
}

void WorkpieceSurface::gather(const Box& box, double within_mm) {
  near_.clear();
  complete_();
  const std::size_t count = stock_.tile_count();
  for (std::uint32_t number = 0; number < count; ++number)
    if (box_gap_mm(box, stock_.tile_box(number)) <= within_mm) near_.push_back(number);
}

std::optional<double> WorkpieceSurface::first_touch(const Solid& moving, const RigidWay& way,
                                                    double thinner_mm) {
  gather(box_of_way(moving, way), 0);
  std::optional<double> first;
  for (const std::uint32_t number : near_) {
    if (!kerf::first_touch(moving, way, tile_box(number), thinner_mm)) continue;
    const auto t = kerf::first_touch(moving, way, tile(number), thinner_mm);
    if (t && (!first || *t < *first)) first = t;
  }
  return first;
}

double WorkpieceSurface::gap_at(const Solid& moving, const Pose& pose, double cutoff_mm) {
  gather(box_around(pose, moving.box_mm()), cutoff_mm);
  double gap = cutoff_mm;
  for (const std::uint32_t number : near_) {
    if (kerf::gap_at(moving, pose, tile_box(number), gap) >= gap) continue;
    gap = kerf::gap_at(moving, pose, tile(number), gap);
  }
  return gap;
}

double WorkpieceSurface::touch_depth_mm(const Solid& moving, const RigidWay& way, double known_mm) {
  gather(box_of_way(moving, way), 0);
  double depth = known_mm;
  for (const std::uint32_t number : near_) {
    if (!kerf::first_touch(moving, way, tile_box(number), 0)) continue;
    depth = std::max(depth, kerf::touch_depth_mm(moving, way, tile(number), depth));
  }
  return depth;
}

}  // namespace kerf
