// viewer/window/tool_store.h - the tool on the graphics card. For the sources of viewer/ only.
#pragma once

#include <glm/mat4x4.hpp>
#include <optional>

#include "viewer/gl_objects.h"
#include "viewer/scene.h"
#include "viewer/window/mesh_buffers.h"
#include "viewer/window/screen_rect.h"
#include "viewer/window/tool_mesh.h"

namespace kerf {

struct ToolLook {
  bool shows_cutter = true;
  bool shows_holder = true;  ///< and shank
  float cutter_opacity = 1.0f;
  float holder_opacity = 1.0f;
  bool operator==(const ToolLook&) const = default;
};

class ToolStore {
 public:
  void set_shape(const ToolShape& shape);
  void set_pose(const std::optional<ToolPose>& pose);

  /// Shape or pose is another one than at the last call.
  bool take_changed();
  /// Empty if there is nothing to see.
  ScreenRect rect(const Projection& projection, const ToolLook& look) const;
  /// In the workpiece frame; empty if there is no tool.
  Box bounds_mm() const;
  /// The parts that are opaque, or those that are not, with viewer/shaders/scene, in use, of which
  /// it sets matrices and colour.
  void draw(const Projection& projection, const GlProgram& program, const ToolLook& look,
            bool opaque_parts) const;
  std::size_t gpu_bytes() const { return buffers_.gpu_bytes(); }

 private:
  glm::mat4 world_from_tool() const;

  ToolMesh mesh_;
  MeshBuffers buffers_;
  std::optional<ToolPose> pose_;
  bool has_changed_ = false;
};

}  // namespace kerf
