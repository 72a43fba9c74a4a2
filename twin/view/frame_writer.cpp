#include "twin/view/frame_writer.h"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <limits>
#include <optional>
#include <system_error>
#include <utility>

#include "viewer/gl_context.h"
#include "viewer/png_image.h"

namespace kerf {
namespace {

/// Cutting a program to its end at once may take this long.
constexpr std::chrono::milliseconds kPatience{200};

}  // namespace

struct FrameRenderer::Impl {
  Impl(GlContext made_context, SceneRenderer made_renderer, PlayerScene made_scene,
       FrameOptions made_options)
      : context(std::move(made_context)),
        renderer(std::move(made_renderer)),
        scene(std::move(made_scene)),
        options(std::move(made_options)) {}
  GlContext context;  // before what lives in it
  SceneRenderer renderer;
  PlayerScene scene;
  FrameOptions options;
  OrbitCamera camera;
};

FrameRenderer::FrameRenderer(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
FrameRenderer::FrameRenderer(FrameRenderer&&) noexcept = default;
FrameRenderer& FrameRenderer::operator=(FrameRenderer&&) noexcept = default;
FrameRenderer::~FrameRenderer() = default;

Result<FrameRenderer> FrameRenderer::create(const FrameOptions& options, const PlayerState& state,
                                            std::shared_ptr<const ProgramTrack> track,
                                            ViewedProgram shown) {
  Result<GlContext> context = GlContext::create_offscreen();
  if (!context) return Error{context.error()};
  Result<SceneRenderer> renderer = SceneRenderer::create();
  if (!renderer) return Error{renderer.error()};
  auto impl = std::make_unique<Impl>(std::move(context.value()), std::move(renderer.value()),
                                     PlayerScene(std::move(track), std::move(shown)), options);
  impl->options.draw.upload_bytes_per_frame = std::numeric_limits<std::size_t>::max();
  impl->renderer.apply(impl->scene.start(state));
  impl->camera.set_perspective(options.perspective);
  impl->camera.look_from(options.view);
  impl->camera.fit(impl->renderer.fit_box(), options.size_px);
  impl->scene.set_detail(impl->camera.pixel_mm(options.size_px));
  return FrameRenderer(std::move(impl));
}

Result<Picture> FrameRenderer::draw(const std::shared_ptr<const PlayerState>& state) {
  do {
    impl_->renderer.apply(impl_->scene.update(state, PlayerScene::Clock::time_point::max()));
  } while (impl_->scene.behind());
  // The path that was made last moved the place along it.
  impl_->renderer.apply(impl_->scene.update(state, PlayerScene::Clock::time_point::max()));
  do {
    const Projection projection =
        impl_->camera.projection(impl_->renderer.depth_box(), impl_->options.size_px);
    if (const Done done = impl_->renderer.draw(projection, impl_->options.draw); !done) {
      return Error{done.error()};
    }
  } while (impl_->renderer.has_waiting());
  return impl_->renderer.read();
}

Result<std::size_t> write_film(Player& player, FrameRenderer& renderer, const FilmOptions& options,
                               std::stop_token stop, const std::function<void(double)>& on_frame) {
  std::error_code error;
  std::filesystem::create_directories(options.folder, error);
  if (error) return Error{fmt::format("{}: {}", options.folder, error.message())};
  const double begin_s = player.state()->elapsed_s;
  const double end_s = player.track().duration_s();
  const double step_s = options.speed / options.fps;
  const auto frames = static_cast<std::size_t>(std::ceil((end_s - begin_s) / step_s)) + 1;
  std::size_t written = 0;
  for (; written < frames && !stop.stop_requested(); ++written) {
    const double time_s = begin_s + static_cast<double>(written) * step_s;
    const Player::Ticket ticket =
        written + 1 == frames ? player.seek_end() : player.seek_time(time_s);
    while (!player.wait(ticket, kPatience) && !stop.stop_requested()) {
    }
    if (stop.stop_requested()) break;
    const Result<Picture> picture = renderer.draw(player.state());
    if (!picture) return Error{picture.error()};
    const std::string path =
        (std::filesystem::path(options.folder) / fmt::format("frame_{:06}.png", written)).string();
    if (const Done done = write_png(path, *picture); !done) return Error{done.error()};
    if (on_frame) on_frame(static_cast<double>(written + 1) / static_cast<double>(frames));
  }
  return written;
}

}  // namespace kerf
