// Pictures by rays on the CPU.
#include <algorithm>
#include <thread>
#include <utility>
#include <vector>

#include "base/translate.h"
#include "twin/motion/motion_geometry.h"
#include "twin/scene/drawn_machine.h"
#include "twin/scene/frame_bodies.h"
#include "twin/scene/frame_drawer.h"
#include "twin/scene/frame_lines.h"
#include "twin/scene/frame_tool.h"
#include "twin/scene/tool_shape.h"
#include "viewer/raycast/ray_caster.h"

namespace kerf {
namespace {

constexpr int kMostThreads = 8;

class RaycastDrawer final : public FrameDrawer {
 public:
  explicit RaycastDrawer(const DrawerStart& start)
      : projection_(frame_projection(start)),
        lines_(start, projection_),
        bodies_(start, projection_) {}

  Result<Picture> draw(const std::shared_ptr<const PlayerState>& state) override {
    if (stock_ != state->stock) {
      stock_ = state->stock;
      caster_.set_workpiece(stock_ ? stock_->height_grid() : nullptr);
    }
    tool_.show(*state, caster_);
    caster_.draw(projection_);
    Picture picture = caster_.picture();
    std::vector<float> depths(caster_.depths().begin(), caster_.depths().end());
    lines_.draw(*state, &picture, &depths);
    bodies_.draw(*state, depths, &picture);
    return picture;
  }

 private:
  Projection projection_;
  FrameLines lines_;
  FrameBodies bodies_;
  RayCaster caster_{ray_threads()};
  FrameTool tool_;
  std::shared_ptr<const StockModel> stock_;
};

/// Where the tip goes, and as much around and above it as the largest tool takes.
Box room_of_tools(const DrawerStart& start) {
  Box tips;
  tips.extend(start.state.tip_mm);
  double radius_mm = 0, height_mm = 0;
  const Cutter* last = nullptr;
  for (std::size_t i = 0; i < start.track->size(); ++i) {
    tips.extend(bounds_of(start.track->motion(i)));
    const Cutter* const cutter = start.shown.cuts ? start.shown.cuts->cutter_at(i) : nullptr;
    if (!cutter || cutter == last) continue;
    last = cutter;
    radius_mm = std::max(radius_mm, cutter->radius_mm());
    height_mm = std::max(height_mm, drawn_height_mm(*tool_shape_of(*cutter)));
  }
  tips.extend(tips.min - Vec3(radius_mm, radius_mm, 0));
  tips.extend(tips.max + Vec3(radius_mm, radius_mm, height_mm));
  return tips;
}

}  // namespace

Result<std::unique_ptr<FrameDrawer>> make_raycast_drawer(DrawerStart start) {
  if (start.state.stock && !start.state.stock->height_grid()) {
    return Error{
        trf("--draw raycast: a {} workpiece has no heights to cast rays at; --draw mesh draws it",
            start.state.stock->name())};
  }
  return std::unique_ptr<FrameDrawer>(std::make_unique<RaycastDrawer>(start));
}

int ray_threads() {
  return std::clamp(static_cast<int>(std::thread::hardware_concurrency()), 1, kMostThreads);
}

void FrameTool::show(const PlayerState& state, RayCaster& caster) {
  if (state.cutter != shown_) {
    shown_ = state.cutter;
    caster.set_tool_shape(shown_ ? tool_shape_of(*shown_) : nullptr);
  }
  caster.set_tool_pose(ToolPose{state.tip_mm, Vec3(0, 0, 1)});
}

Projection frame_projection(const DrawerStart& start) {
  const Box room = room_of_tools(start);
  const Box shown = start.state.stock ? start.state.stock->bounds_mm() : room;
  Box depth_box = shown;
  depth_box.extend(room);
  OrbitCamera camera;
  camera.set_perspective(start.options.perspective);
  camera.look_from(start.options.view);
  camera.fit(shown, start.options.size_px);
  return camera.projection(depth_box, start.options.size_px);
}

}  // namespace kerf
