// viewer/window/machine_store.h - the machine's links, or fixtures, on the graphics card. For the
// sources of viewer/ only.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/mat4x4.hpp>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "viewer/gl_objects.h"
#include "viewer/mesh_rays.h"
#include "viewer/scene.h"
#include "viewer/sight_lines.h"
#include "viewer/window/body_mark.h"
#include "viewer/window/mesh_buffers.h"
#include "viewer/window/screen_rect.h"

namespace kerf {

/// Links are drawn from when they are uploaded and their pose is known. One that hides more of the
/// workpiece than kMayHide, or that has the eye inside, fades: what is worked on is seen through
/// it.
class MachineStore {
 public:
  void set_machine(std::shared_ptr<const SceneMachine> machine);
  /// One a link; links beyond have none, nor have those that are kNotDrawn.
  void set_poses(std::span<const glm::mat4> link_poses);
  /// One a link; links beyond have none. Those that are marked do not fade.
  void set_marks(std::vector<BodyMark> marks);

  /// Uploads links until `budget_bytes` are used up, but at least one: shading a mesh takes about
  /// 0.5 us a triangle. Returns the bytes.
  std::size_t upload(std::size_t budget_bytes);
  bool has_waiting() const { return uploaded_ < links_.size(); }

  /// Where the links that moved or faded since the last call were and are. A new projection moves
  /// all. `part_mm`: what is to be seen; may be empty. A link whose place is another one, or all
  /// of them with another eye, costs some ten microseconds.
  ScreenRect take_changed(const Projection& projection, const Box& part_mm);
  /// With viewer/shaders/scene, in use, of which it sets matrices and colour. Only the links that
  /// touch `rect`: those that are opaque, or those that are seen through (by `opacity` or by their
  /// own colour), from back to front.
  void draw(const Projection& projection, const GlProgram& program, float opacity,
            bool opaque_parts, const ScreenRect& rect) const;
  /// Those that are marked, as they shine through what hides them.
  void draw_marked(const Projection& projection, const GlProgram& program,
                   const ScreenRect& rect) const;

  /// Of all links that have a pose, in the workpiece frame.
  Box bounds_mm() const;
  std::size_t gpu_bytes() const;

 private:
  struct Link {
    std::shared_ptr<const TriangleMesh> mesh;
    glm::vec4 rgba{1.0f};
    Box box_mm;  // in its own frame
    std::optional<glm::mat4> pose;
    MeshBuffers buffers;
    MeshRays rays;
    BodyMark mark = BodyMark::kNone;
    float most_opacity = 1.0f;  // less where it hides the workpiece
    ScreenRect rect;            // at the last take_changed()
    bool has_changed = false;
  };

  static float opacity_of(const Link& link, float opacity);
  void draw_link(const Link& link, const Projection& projection, const GlProgram& program,
                 float opacity) const;

  std::vector<Link> links_;
  std::vector<glm::mat4> poses_;
  std::vector<BodyMark> marks_;
  std::size_t uploaded_ = 0;  // the first of the links
  ScreenRect dropped_rect_;   // of links that are no more
  Projection projection_;     // of the last take_changed()
  Box part_mm_;
  std::vector<SightLine> lines_;  // for those two
};

}  // namespace kerf
