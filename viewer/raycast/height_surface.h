// viewer/raycast/height_surface.h - the surface of a height grid, and where rays meet it.
#pragma once

#include <glm/vec3.hpp>
#include <memory>
#include <optional>
#include <vector>

#include "base/geometry.h"
#include "surface/height_grid.h"
#include "surface/surface_tile.h"
#include "viewer/raycast/ray_frame.h"

namespace kerf {

/// Where a ray meets the workpiece.
struct SurfaceHit {
  double t = 0.0;      ///< on the ray
  int i = 0, j = 0;    ///< of the cell whose top it is; its corners may be moved
  bool floor = false;  ///< from below
};

/// The surface that the patches of the workpiece show (surface_tile.h), without triangles: top,
/// walls, sides and floor. Rays walk over the base plane, from where they enter the box of the
/// workpiece to where they leave it, and look only at cells under their way:
///
///    ray \                        tiles (64 cells), blocks (8) and cells; of those that the ray
///     ....\.............           passes above their greatest height, no cell is looked at
///    |     \  _____     |
///    |______\|     |____|
///    |__________________|
///     > > > > walk
///
/// Memory: 10 bytes a cell, for level tiles none; more where there are many walls.
class HeightSurface {
 public:
  /// Takes over a new state of the workpiece. Only tiles whose heights have changed, and those
  /// beside them, are made anew, by `threads` threads. Returns boxes around everything that can
  /// look different; none if nothing can. `grid` may be null: no workpiece.
  std::vector<Box> update(std::shared_ptr<const HeightGrid> grid, int threads);

  /// The first point of the surface on the ray. No side effects, no allocation: any number of
  /// threads may call it. What it finds depends on the ray alone, bit for bit. A ray that begins
  /// inside the material meets it at its beginning.
  bool trace(const Ray& ray, SurfaceHit* hit) const;
  /// Unit normal, out of the material, as the patches have it there: on tops between the normals of
  /// the corners, on walls level and across the wall's course (WallCourse). O(1).
  glm::vec3 normal(const Ray& ray, const SurfaceHit& hit) const;
  /// That of the top where the ray is at t, if it is no farther above or below it than that; none:
  /// it is, or there is no top, or one with moved corners. O(1).
  std::optional<glm::vec3> normal_beside(const Ray& ray, double t, double within_mm) const;

  const HeightGrid* grid() const { return grid_.get(); }

 private:
  struct GridRay;
  GridRay to_grid(const Ray& ray) const;
  bool enter(const GridRay& ray, double* t0, double* t1, bool* through_floor) const;
  const SurfaceTile& tile(int tx, int ty) const {
    return tiles_[static_cast<std::size_t>(ty * tiles_x_ + tx)];
  }
  CellTop cell(int i, int j) const;
  /// Calls visit(i, j, top) for the cell and those about it that have material.
  template <class Visit>
  void visit_about(int i, int j, const Visit& visit) const;
  bool meet_moved(const GridRay& ray, int i, int j, double t0, double t1, SurfaceHit* hit) const;
  bool is_over_material(const Vec2& at, int* i, int* j) const;
  glm::vec3 moved_normal(const GridRay& ray, const SurfaceHit& hit, const CellTop& top) const;
  glm::vec3 top_normal(int i, int j, const CellTop& top, double u, double v) const;
  std::vector<Box> changes(const HeightGrid& next, std::vector<int>* tiles) const;
  void make_tiles(const std::vector<int>& tiles, int threads);
  glm::vec3 wall_normal(int i, int j, bool across_x, int step, double along) const;

  std::shared_ptr<const HeightGrid> grid_;
  std::vector<SurfaceTile> tiles_;
  std::vector<float> tile_tops_;  ///< SurfaceTile::top, close together
  int tiles_x_ = 0, tiles_y_ = 0;
  float top_ = SurfaceTile::kNothing;
  Vec2 cell_mm_{1.0}, per_cell_mm_{1.0};
};

}  // namespace kerf
