// Pictures through the window's renderer.
#include <chrono>
#include <limits>
#include <utility>
#include <vector>

#include "twin/scene/frame_drawer.h"
#include "twin/scene/picture_legend.h"
#include "viewer/gl_context.h"
#include "viewer/raycast/stroke_raster.h"

namespace kerf {
namespace {

class MeshDrawer final : public FrameDrawer {
 public:
  MeshDrawer(GlContext context, SceneRenderer renderer, DrawerStart start)
      : context_(std::move(context)),
        renderer_(std::move(renderer)),
        scene_(std::move(start.track), std::move(start.shown)),
        options_(start.options) {
    options_.draw.upload_bytes_per_frame = std::numeric_limits<std::size_t>::max();
    const SceneUpdate begin = scene_.start(start.state);
    renderer_.apply(begin);
    camera_.set_standing(begin.setup->standing);
    if (const auto section =
            usual_section(options_.section, begin.setup->bounds_mm, begin.setup->standing)) {
      options_.draw.section = section->plane;
      options_.draw.section_beside = section->beside;
    }
    camera_.set_perspective(options_.perspective);
    camera_.look_from(options_.view);
    camera_.fit(renderer_.fit_box(), options_.size_px);
    scene_.set_detail(camera_.detail(options_.size_px));
  }

  Result<Picture> draw(const std::shared_ptr<const PlayerState>& state) override {
    do {
      renderer_.apply(scene_.update(state, PlayerScene::Clock::time_point::max()));
    } while (scene_.behind());
    // The path that was made last moved the place along it.
    renderer_.apply(scene_.update(state, PlayerScene::Clock::time_point::max()));
    do {
      const Projection projection = camera_.projection(renderer_.depth_box(), options_.size_px);
      if (const Done done = renderer_.draw(projection, options_.draw); !done) {
        return Error{done.error()};
      }
    } while (renderer_.has_waiting());
    Picture picture = renderer_.read();
    if (!is_by_move(options_.draw.color_by)) return picture;
    std::vector<Stroke> strokes;
    add_legend(renderer_.legend(Measures(options_.units)), &strokes);
    const std::vector<float> depths(picture.rgb.size() / 3, 1.0f);
    draw_strokes(strokes, depths, &picture);
    return picture;
  }

  void color(const std::vector<float>& removed_mm3,
             std::shared_ptr<const LoadRecord> loads) override {
    if (!is_by_move(options_.draw.color_by)) return;
    if (loads) scene_.show_loads(std::move(loads));
    scene_.set_colors({options_.draw.color_by, 0, 0}, removed_mm3);
  }

 private:
  GlContext context_;  // before what lives in it
  SceneRenderer renderer_;
  PlayerScene scene_;
  FrameOptions options_;
  OrbitCamera camera_;
};

}  // namespace

Result<std::unique_ptr<FrameDrawer>> make_mesh_drawer(DrawerStart start) {
  Result<GlContext> context = GlContext::create_offscreen();
  if (!context) return Error{context.error()};
  Result<SceneRenderer> renderer = SceneRenderer::create();
  if (!renderer) return Error{renderer.error()};
  return std::unique_ptr<FrameDrawer>(std::make_unique<MeshDrawer>(
      std::move(context.value()), std::move(renderer.value()), std::move(start)));
}

}  // namespace kerf
