#include "viewer/window/moving_bodies.h"

#include "viewer/window/body_mark.h"

namespace kerf {

void MovingBodies::apply(const SceneUpdate& update) {
  if (update.tool_shape) tool_.set_shape(*update.tool_shape);
  if (update.machine) machine_.set_machine(update.machine);
  if (update.fixtures) fixtures_.set_machine(update.fixtures);
  if (!update.moment) return;
  const Moment& moment = *update.moment;
  tool_.set_pose(moment.tool_pose);
  tool_.set_marks(tool_marks(moment.contacts));
  machine_.set_poses(moment.link_poses);
  machine_.set_marks(link_marks(moment.contacts));
  fixtures_.set_poses(moment.fixture_poses);
  fixtures_.set_marks(fixture_marks(moment.contacts));
  contacts_.set_contacts(moment.contacts);
}

Box MovingBodies::bounds_mm() const {
  Box box = machine_.bounds_mm();
  box.extend(fixtures_.bounds_mm());
  box.extend(tool_.bounds_mm());
  box.extend(contacts_.bounds_mm());
  return box;
}

std::size_t MovingBodies::upload(std::size_t budget_bytes) {
  std::size_t bytes = machine_.upload(budget_bytes);
  if (bytes < budget_bytes) bytes += fixtures_.upload(budget_bytes - bytes);
  return bytes;
}

std::size_t MovingBodies::gpu_bytes() const {
  return machine_.gpu_bytes() + fixtures_.gpu_bytes() + tool_.gpu_bytes() + contacts_.gpu_bytes();
}

ToolLook MovingBodies::tool_look() const {
  const ObjectLook& cutter = look(SceneObject::kCutter);
  const ObjectLook& holder = look(SceneObject::kHolder);
  return {cutter.is_visible, holder.is_visible, cutter.opacity, holder.opacity};
}

ScreenRect MovingBodies::take_changed(const Projection& projection, const Looks& looks,
                                      const Box& part_mm) {
  projection_ = projection;
  looks_ = looks;
  ScreenRect changed;
  const ScreenRect tool_rect = tool_.rect(projection_, tool_look());
  if (tool_.take_changed() || tool_rect != tool_rect_) {
    changed.extend(tool_rect_);
    changed.extend(tool_rect);
  }
  tool_rect_ = tool_rect;
  const ScreenRect machine_rect = machine_.take_changed(projection_, part_mm);
  if (look(SceneObject::kMachine).is_visible) changed.extend(machine_rect);
  const ScreenRect fixtures_rect = fixtures_.take_changed(projection_, part_mm);
  if (look(SceneObject::kFixtures).is_visible) changed.extend(fixtures_rect);
  const ScreenRect contacts_rect = contacts_.rect(projection_);
  if (contacts_.take_changed() || contacts_rect != contacts_rect_) {
    changed.extend(contacts_rect_);
    changed.extend(contacts_rect);
  }
  contacts_rect_ = contacts_rect;
  return changed;
}

void MovingBodies::draw(const ScreenRect& rect, const GlProgram& program, bool opaque_parts) const {
  program.use();
  program.set("up_view", up_view(projection_));
  const ObjectLook& machine = look(SceneObject::kMachine);
  if (machine.is_visible) {
    machine_.draw(projection_, program, machine.opacity, opaque_parts, rect);
  }
  const ObjectLook& fixtures = look(SceneObject::kFixtures);
  if (fixtures.is_visible) {
    fixtures_.draw(projection_, program, fixtures.opacity, opaque_parts, rect);
  }
  if (tool_rect_.intersects(rect)) {
    glEnable(GL_CULL_FACE);  // tools are closed; what others drew of a machine may not be
    tool_.draw(projection_, program, tool_look(), opaque_parts);
    if (opaque_parts) glDisable(GL_CULL_FACE);
  }
  if (!opaque_parts && look(SceneObject::kFindings).is_visible) {
    contacts_.draw(projection_, program, kLeastMarkedOpacity);
  }
}

void MovingBodies::draw_hidden_marks(const ScreenRect& rect, const GlProgram& program) const {
  program.use();
  program.set("up_view", up_view(projection_));
  glDepthFunc(GL_GREATER);
  glDepthMask(GL_FALSE);
  glEnable(GL_CULL_FACE);
  glEnable(GL_BLEND);
  glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
  if (look(SceneObject::kMachine).is_visible) machine_.draw_marked(projection_, program, rect);
  if (look(SceneObject::kFixtures).is_visible) fixtures_.draw_marked(projection_, program, rect);
  if (tool_rect_.intersects(rect)) tool_.draw_marked(projection_, program, tool_look());
  if (look(SceneObject::kFindings).is_visible) {
    contacts_.draw(projection_, program, kHiddenMarkOpacity);
  }
  glDisable(GL_BLEND);
  glDisable(GL_CULL_FACE);
  glDepthMask(GL_TRUE);
  glDepthFunc(GL_LESS);
}

}  // namespace kerf
