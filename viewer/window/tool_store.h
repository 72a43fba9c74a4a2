// viewer/window/tool_store.h - the tool on the graphics card. For the sources of viewer/ only.
#pragma once

#include <glm/mat4x4.hpp>
#include <optional>

#include "viewer/gl_objects.h"
#include "viewer/scene.h"
#include "viewer/window/body_mark.h"
#include "viewer/window/mesh_buffers.h"
#include "viewer/window/screen_rect.h"
#include "viewer/window/tool_mesh.h"

namespace kerf {

struct ToolLook {
  bool shows_cutter = true;
  bool shows_holder = true;  ///< and shank, and spindle
  float cutter_opacity = 1.0f;
  float holder_opacity = 1.0f;
  bool operator==(const ToolLook&) const = default;
};

class ToolStore {
 public:
  void set_shape(const ToolShape& shape);
  void set_pose(const std::optional<ToolPose>& pose);
  void set_marks(const ToolMarks& marks);

  /// Shape, pose or marks are other ones than at the last call.
  bool take_changed();
  /// Empty if there is nothing to see.
  ScreenRect rect(const Projection& projection, const ToolLook& look) const;
  /// In the workpiece frame; empty if there is no tool.
  Box bounds_mm() const;
  /// The parts that are opaque, or those that are not, with viewer/shaders/scene, in use, of which
  /// it sets matrices and colour.
  void draw(const Projection& projection, const GlProgram& program, const ToolLook& look,
            bool opaque_parts) const;
  /// The pieces that are marked, as they shine through what hides them.
  void draw_marked(const Projection& projection, const GlProgram& program,
                   const ToolLook& look) const;
  std::size_t gpu_bytes() const { return buffers_.gpu_bytes(); }

 private:
  glm::mat4 world_from_tool() const;
  /// `draw`: called with each piece that is shown, and its opacity.
  template <typename Draw>
  void each_piece(const ToolLook& look, const Draw& draw) const;
  void draw_piece(ToolPiece piece, const GlProgram& program, float opacity) const;
  BodyMark mark_of(ToolPiece piece) const { return marks_[static_cast<std::size_t>(piece)]; }

  ToolMesh mesh_;
  MeshBuffers buffers_;
  std::optional<ToolPose> pose_;
  ToolMarks marks_{};
  bool has_changed_ = false;
};

}  // namespace kerf
