// viewer/window/contact_store.h - marks where bodies touch, on the graphics card. For the sources
// of viewer/ only.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "viewer/gl_objects.h"
#include "viewer/scene.h"
#include "viewer/window/mesh_buffers.h"
#include "viewer/window/screen_rect.h"

namespace kerf {

/// A ball at each contact whose place is known.
class ContactStore {
 public:
  void set_contacts(std::span<const SceneContact> contacts);
  /// They are other ones than at the last call.
  bool take_changed();
  /// Empty if there is nothing to see.
  ScreenRect rect(const Projection& projection) const;
  Box bounds_mm() const;
  /// With viewer/shaders/scene, in use, of which it sets matrices and colour.
  void draw(const Projection& projection, const GlProgram& program, float opacity) const;
  std::size_t gpu_bytes() const { return ball_.gpu_bytes(); }

 private:
  std::vector<SceneContact> contacts_;  // those with a place
  MeshBuffers ball_;                    // of radius 1; empty until it is needed
  bool has_changed_ = false;
};

}  // namespace kerf
