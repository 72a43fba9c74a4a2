// tests/viewer/test_scene.h - a workpiece made of tiles, for tests and benchmarks of the window.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "viewer/scene.h"

namespace kerf {

/// Heights over a grid of cells of 1 mm, top at 0, cut into patches of kTileCells x kTileCells.
/// Walls and floor of the blank are not drawn.
class TestWorkpiece {
 public:
  static constexpr int kTileCells = 64;

  TestWorkpiece(int cells_x, int cells_y);

  /// A ball-shaped dent.
  void dent(double x_mm, double y_mm, double radius_mm, double depth_mm);

  /// Patches of the tiles changed since the last call; all of them the first time.
  std::vector<std::shared_ptr<const MeshPatch>> take_patches();

  /// Outline, frame at a corner, bounds.
  std::shared_ptr<const SceneSetup> setup() const;
  int cells_x() const { return cells_x_; }
  int cells_y() const { return cells_y_; }

 private:
  float& height(int x, int y);
  std::shared_ptr<const MeshPatch> patch(int tile_x, int tile_y);

  int cells_x_;
  int cells_y_;
  int tiles_x_;
  int tiles_y_;
  std::uint64_t version_ = 0;
  std::vector<float> heights_mm_;  // at the corners of cells
  std::vector<bool> dirty_;
};

/// A ball cutter with shank and holder, 16 radii long.
std::shared_ptr<const ToolShape> test_tool(float radius_mm = 5.0f);

/// A square spiral of feeds over the workpiece, with a traverse at its start.
std::vector<PathVertex> test_path(int cells_x, int cells_y);

/// A path in the chunks that a scene takes.
std::vector<std::shared_ptr<const PathChunk>> path_chunks(const std::vector<PathVertex>& vertices);

}  // namespace kerf
