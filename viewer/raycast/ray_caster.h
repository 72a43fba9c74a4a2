// viewer/raycast/ray_caster.h - draws workpiece and tool on the CPU, without OpenGL.
#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "surface/height_grid.h"
#include "viewer/orbit_camera.h"
#include "viewer/picture.h"
#include "viewer/raycast/height_surface.h"
#include "viewer/scene.h"

namespace kerf {

class ToolRays;

/// Pixels of one draw().
struct RayCounters {
  std::size_t cast_px = 0;    ///< of the workpiece, cast again
  std::size_t copied_px = 0;  ///< copied and the tool cast over them
  bool is_full = false;       ///< the whole picture was cast
  /// All of them lie in these pixels [low, high), from the upper left.
  glm::ivec2 low_px{0}, high_px{0};
};

/// Casts a ray for each pixel: colour and window depth as the scene renderer of the window draws
/// them for the same projection, with the same light and colours, one sample a pixel.
///
///     kept    the workpiece: cast again in the squares of pixels that a changed block of
///       |                    cells, before and after, projects to
///     shown   a copy, and the tool over it: again there and where the tool was or is
///
/// A local draw gives the same bits as a full one, for any number of threads. A full picture of
/// 1280 x 800 pixels over 2000 x 2000 cells takes about 120 ms of processor time, taking the
/// workpiece over for the first time 60 ms, both shared by the threads.
/// Source: base planes and boxes on the screen as in the Z-map literature; C. Musgrave, "Grid
/// tracing: fast ray tracing for height fields", 1988, for the walk over cells.
class RayCaster {
 public:
  explicit RayCaster(int threads = 2) : threads_(threads) {}

  /// The workpiece as it is now; null: none. To be taken from a snapshot (StockModel::height_grid).
  void set_workpiece(std::shared_ptr<const HeightGrid> grid);
  void set_tool_shape(std::shared_ptr<const ToolShape> shape);
  void set_tool_pose(const std::optional<ToolPose>& pose);

  /// Brings the picture up to date. `is_local` false: casts all of it, for measuring.
  RayCounters draw(const Projection& projection, bool is_local = true);

  /// 8-bit RGB, rows from the top; as of the last draw().
  const Picture& picture() const { return shown_; }
  /// Window depth, rows from the top, 1 where there is nothing.
  std::span<const float> depths() const { return shown_depths_; }
  /// Of the workpiece without the tool.
  std::span<const float> workpiece_depths() const { return kept_depths_; }
  /// The point of the workpiece at a pixel from the upper left, as of the last draw().
  std::optional<Vec3> pick(glm::ivec2 px) const;

 private:
  using Squares = std::vector<bool>;
  struct Light;

  void resize(glm::ivec2 size_px);
  void mark(const Box& box_mm, Squares* squares) const;
  void find_room(const Squares& squares, RayCounters* counters) const;
  template <class Work>
  std::size_t for_squares(const Squares& squares, const Work& work) const;
  void cast_workpiece(const Light& light, std::size_t pixel, const Ray& ray);
  void cast_tool(const Light& light, const ToolRays& tool, std::size_t pixel, const Ray& ray);

  int threads_;
  HeightSurface surface_;
  std::shared_ptr<const ToolShape> tool_shape_;
  std::optional<ToolPose> tool_pose_;
  std::optional<Projection> projection_;
  int squares_x_ = 0, squares_y_ = 0;
  std::vector<Box> changed_mm_;  ///< of the workpiece, since the last draw
  bool tool_changed_ = false;
  Squares tool_squares_;  ///< where the tool is in the picture shown
  Picture kept_, shown_;
  std::vector<float> kept_depths_, shown_depths_;
};

}  // namespace kerf
