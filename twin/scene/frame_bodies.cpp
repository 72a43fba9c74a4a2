#include "twin/scene/frame_bodies.h"

#include <memory>

#include "twin/scene/drawn_machine.h"
#include "twin/scene/frame_tool.h"
#include "twin/scene/tool_shape.h"

namespace kerf {

FrameBodies::FrameBodies(const DrawerStart& start, const Projection& projection)
    : projection_(projection),
      track_(start.track),
      shown_(start.shown),
      watch_(start.shown.collisions) {
  const auto fixtures = static_cast<std::size_t>(SceneObject::kFixtures);
  if (start.options.draw.looks[fixtures].is_visible) rays_.set_bodies(*watch_.scene());
  if (shown_.machine)
    watch_.set_machine(std::make_shared<const SceneMachine>(scene_machine(*shown_.machine)));
  if (start.state.stock) part_mm_ = start.state.stock->bounds_mm();
}

void FrameBodies::draw(const PlayerState& state, const std::vector<float>& depths,
                       Picture* picture) {
  if (!rays_.has_bodies()) return;
  if (shown_.machine) {
    const double length_mm = state.cutter ? drawn_height_mm(*tool_shape_of(*state.cutter)) : 0;
    watch_.set_link_poses(machine_poses_at(shown_, *track_, state, length_mm));
  }
  rays_.draw(projection_, watch_.poses(), part_mm_, depths, ray_threads(), picture);
}

}  // namespace kerf
