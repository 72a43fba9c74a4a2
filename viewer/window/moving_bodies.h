// viewer/window/moving_bodies.h - what moves over the kept scene: tool, machine, fixtures, marks of
// contacts. For the sources of viewer/ only.
#pragma once

#include <array>
#include <cstddef>

#include "viewer/gl_objects.h"
#include "viewer/scene.h"
#include "viewer/window/contact_store.h"
#include "viewer/window/machine_store.h"
#include "viewer/window/scene_renderer.h"
#include "viewer/window/screen_rect.h"
#include "viewer/window/tool_store.h"

namespace kerf {

/// Bodies that touch each other are red, and shine through the workpiece.
class MovingBodies {
 public:
  using Looks = std::array<ObjectLook, kSceneObjectCount>;

  void apply(const SceneUpdate& update);
  /// Of all that is shown and has a place, in the workpiece frame.
  Box bounds_mm() const;
  std::size_t upload(std::size_t budget_bytes);
  bool has_waiting() const { return machine_.has_waiting() || fixtures_.has_waiting(); }
  std::size_t gpu_bytes() const;

  /// Where something has changed since the last call; what is drawn from now on is seen so.
  /// `part_mm`: MachineStore::take_changed().
  ScreenRect take_changed(const Projection& projection, const Looks& looks, const Box& part_mm);
  /// With a variant of viewer/shaders/scene that lights both sides: what is opaque, or what is not,
  /// which wants blending.
  void draw(const ScreenRect& rect, const GlProgram& program, bool opaque_parts) const;
  /// What of the marked bodies lies behind what has been drawn.
  void draw_hidden_marks(const ScreenRect& rect, const GlProgram& program) const;

 private:
  const ObjectLook& look(SceneObject object) const {
    return looks_[static_cast<std::size_t>(object)];
  }
  ToolLook tool_look() const;

  ToolStore tool_;
  MachineStore machine_;
  MachineStore fixtures_;
  ContactStore contacts_;
  Projection projection_;  // of the last take_changed()
  Looks looks_{};
  ScreenRect tool_rect_;  // as it was drawn last
  ScreenRect contacts_rect_;
};

}  // namespace kerf
