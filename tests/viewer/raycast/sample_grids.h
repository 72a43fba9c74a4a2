// tests/viewer/raycast/sample_grids.h - height grids and views for tests of the ray caster.
#pragma once

#include <memory>
#include <vector>

#include "surface/height_grid.h"
#include "viewer/orbit_camera.h"

namespace kerf::test {

/// A grid with heights of its own: height(x_mm, y_mm) at the middle of each cell.
template <class Height>
std::shared_ptr<const HeightGrid> make_grid(const Box& bounds, int nx, int ny,
                                            const Height& height) {
  constexpr int kCells = HeightGrid::kTileCells;
  const int tiles_x = (nx + kCells - 1) / kCells, tiles_y = (ny + kCells - 1) / kCells;
  constexpr std::size_t kFloats = kCells * kCells;
  struct Kept {
    std::vector<float> heights;
    std::vector<const float*> tiles;
  };
  const auto kept = std::make_shared<Kept>();
  kept->heights.resize(static_cast<std::size_t>(tiles_x * tiles_y) * kFloats, -1e30f);
  for (int n = 0; n < tiles_x * tiles_y; ++n)
    kept->tiles.push_back(kept->heights.data() + static_cast<std::size_t>(n) * kFloats);
  for (int j = 0; j < ny; ++j) {
    for (int i = 0; i < nx; ++i) {
      const double x = bounds.min.x + (i + 0.5) * bounds.size().x / nx;
      const double y = bounds.min.y + (j + 0.5) * bounds.size().y / ny;
      const auto tile = static_cast<std::size_t>(j / kCells * tiles_x + i / kCells);
      kept->heights[tile * kFloats + HeightGrid::offset(i, j)] = static_cast<float>(height(x, y));
    }
  }
  return std::make_shared<const HeightGrid>(bounds, nx, ny, kept->tiles.data(), kept);
}

/// Views from all around, above and below, near and far, in turns perspective and orthographic.
inline Projection view_of(const Box& box, int number, glm::ivec2 size_px) {
  OrbitCamera camera;
  constexpr StandardView kViews[] = {StandardView::kIsometric, StandardView::kTop,
                                     StandardView::kFront, StandardView::kBottom};
  camera.set_perspective(number % 2 == 0);
  camera.look_from(kViews[number / 2 % 4]);
  camera.fit(box, size_px);
  // Not straight along the axes, other than the first ones.
  if (number >= 8) {
    const auto turn = static_cast<float>(number);
    camera.orbit({17.0f * turn, 5.0f * turn}, size_px);
    camera.zoom(1.0 + 0.3 * (number % 5), {0.4f * static_cast<float>(size_px.x), 20.0f}, size_px);
  }
  Box room = box;
  room.extend(box.min - 0.25 * box.size());
  room.extend(box.max + 0.25 * box.size());
  return camera.projection(room, size_px);
}

}  // namespace kerf::test
