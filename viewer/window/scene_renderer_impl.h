// viewer/window/scene_renderer_impl.h - what scene_renderer.cpp, scene_frame.cpp (what has changed)
// and scene_passes.cpp (how it is drawn) share. For the sources of viewer/ only.
#pragma once

#include <cstddef>
#include <glm/common.hpp>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "viewer/gl_objects.h"
#include "viewer/window/gpu_timer.h"
#include "viewer/window/layer.h"
#include "viewer/window/marker_store.h"
#include "viewer/window/moving_bodies.h"
#include "viewer/window/patch_store.h"
#include "viewer/window/path_store.h"
#include "viewer/window/scene_pace.h"
#include "viewer/window/scene_programs.h"
#include "viewer/window/scene_renderer.h"
#include "viewer/window/surface_colors.h"
#include "viewer/window/workpiece_renderer.h"

namespace kerf {

/// The processor draws: llvmpipe, softpipe.
bool is_software_gl();

/// Half the size of a scene without anything in it.
inline constexpr double kSmallestScene_mm = 10.0;

class SceneRenderer::Impl {
 public:
  Impl(ScenePrograms programs, PathStore path, MarkerStore markers, WorkpieceRenderer draw_modes)
      : programs_(std::move(programs)),
        path_(std::move(path)),
        markers_(std::move(markers)),
        draw_modes_(std::move(draw_modes)) {
    glGetIntegerv(GL_MAX_TEXTURE_SIZE, &max_size_px_);
  }

  void apply(const SceneUpdate& update);
  Done draw(const Projection& projection, const DrawOptions& options);
  void keep_pace() { pace_.emplace(); }
  bool has_waiting() const {
    return (pace_ && pace_->has_waiting()) || patches_.waiting_bytes() > 0 || path_.has_waiting() ||
           bodies_.has_waiting() || draw_modes_.has_waiting();
  }
  bool is_full() const { return divisor_ == 1 && draw_modes_.is_full(); }
  ScreenRect take_changed() {
    return std::exchange(changed_, {}).times(divisor_).common(ScreenRect::whole(full_px_));
  }
  void show_in(GLuint framebuffer, glm::ivec2 corner_px, const ScreenRect& rect) const;
  Picture read() const { return read_framebuffer(shown_.framebuffer(), size_px_); }
  std::optional<Vec3> pick(glm::ivec2 px) const;
  Box fit_box() const;
  const Box& depth_box() const { return depth_box_; }
  std::vector<ColorLegendEntry> legend(const Measures& measures) const {
    if (draw_mode_ != DrawMode::kMesh && !paints_path()) return {};
    return colors_.legend(shown_by_, scale_, measures);
  }
  DrawMode drawn_mode() const { return draw_mode_; }
  const Projection& projection() const { return full_projection_; }

  DrawCounters counters;

 private:
  void grow_depth_box(const Box& box);
  Done resize(glm::ivec2 size_px);
  Done take_options(const Projection& projection, const DrawOptions& options);
  void set_divisor(int divisor);
  std::size_t upload(std::size_t budget_bytes);
  ScreenRect changed_rect(std::span<const Box> changed_mm) const;
  std::size_t draw_kept(const ScreenRect& rect);
  std::size_t draw_workpiece(const ScreenRect& rect);
  std::vector<glm::dvec4> kept_sides() const;
  std::size_t draw_patches(const ScreenRect& rect, const std::optional<glm::dvec4>& section);
  void draw_section_faces(std::span<const glm::dvec4> kept);
  void draw_lines(const ScreenRect& rect) const;
  void draw_shown(ScreenRect rect);
  void draw_moving_beside_glass(const ScreenRect& rect, bool is_behind) const;
  void draw_seen_through(const ScreenRect& rect);
  void draw_glass();
  std::size_t gpu_bytes() const;
  bool paints_path() const {
    return options_.color_on != ColorTarget::kSurface && colors_.has_path(shown_by_);
  }
  /// What the workpiece is coloured by.
  ColorBy surface_by() const {
    return options_.color_on == ColorTarget::kPath && is_by_move(shown_by_) ? ColorBy::kPlain
                                                                            : shown_by_;
  }
  const ObjectLook& look(SceneObject object) const {
    return options_.looks[static_cast<std::size_t>(object)];
  }
  /// Drawn into a layer of its own, since the tool has to be seen through it.
  bool is_glass() const {
    const ObjectLook& workpiece = look(SceneObject::kWorkpiece);
    return workpiece.is_visible && workpiece.opacity < 1.0f;
  }

  ScenePrograms programs_;
  GlVertexArray no_vertices_;
  PatchStore patches_;
  SurfaceColors colors_;
  PathStore path_;
  MarkerStore markers_;
  MovingBodies bodies_;
  WorkpieceRenderer draw_modes_;
  DrawMode draw_mode_ = DrawMode::kMesh;  // drawn last
  Layer kept_;
  Layer glass_;
  Layer shown_;
  GpuTimer timer_{is_software_gl()};
  bool is_full_timed_ = false;  // what is timed is a whole picture

  std::shared_ptr<const SceneSetup> setup_;
  Box path_box_;
  Box depth_box_{Vec3(-kSmallestScene_mm), Vec3(kSmallestScene_mm)};
  bool has_content_ = false;
  std::optional<ScenePace> pace_;
  int divisor_ = 1;             // of the picture last drawn
  glm::ivec2 full_px_{1};       // its size as asked for
  Projection full_projection_;  // for that size
  Projection projection_;       // for its own
  DrawOptions options_;
  ColorBy shown_by_ = ColorBy::kPlain;
  ColorScale scale_;
  GLint max_size_px_ = 1;
  glm::ivec2 size_px_{0};
  bool is_kept_old_ = true;  // all of it
  std::vector<Box> changed_mm_;
  ScreenRect changed_;  // of shown_, since take_changed()
};

}  // namespace kerf
