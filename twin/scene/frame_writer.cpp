#include "twin/scene/frame_writer.h"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <system_error>
#include <utility>

#include "twin/scene/frame_drawer.h"
#include "viewer/png_image.h"

namespace kerf {
namespace {

/// Cutting a program to its end at once may take this long.
constexpr std::chrono::milliseconds kPatience{200};

}  // namespace

FrameRenderer::FrameRenderer(std::unique_ptr<FrameDrawer> draw_mode)
    : draw_mode_(std::move(draw_mode)) {}
FrameRenderer::FrameRenderer(FrameRenderer&&) noexcept = default;
FrameRenderer& FrameRenderer::operator=(FrameRenderer&&) noexcept = default;
FrameRenderer::~FrameRenderer() = default;

Result<FrameRenderer> FrameRenderer::create(const FrameOptions& options, const PlayerState& state,
                                            std::shared_ptr<const ProgramTrack> track,
                                            ViewedProgram shown) {
  DrawerStart start{options, state, std::move(track), std::move(shown)};
  auto draw_mode = options.draw_mode == DrawMode::kMesh      ? make_mesh_drawer(std::move(start))
                   : options.draw_mode == DrawMode::kRaycast ? make_raycast_drawer(std::move(start))
                                                             : make_csg_drawer(std::move(start));
  if (!draw_mode) return Error{draw_mode.error()};
  return FrameRenderer(std::move(draw_mode.value()));
}

Done FrameRenderer::can_reach(const TrackPosition& place) { return draw_mode_->can_reach(place); }

Result<Picture> FrameRenderer::draw(const std::shared_ptr<const PlayerState>& state) {
  return draw_mode_->draw(state);
}

void FrameRenderer::color(const Player& player) {
  draw_mode_->color(player.removed_mm3(), player.loads());
}

Result<std::size_t> write_film(Player& player, FrameRenderer& renderer, const FilmOptions& options,
                               std::stop_token stop, const std::function<void(double)>& on_frame) {
  const ProgramTrack& track = player.track();
  if (const Done can = renderer.can_reach(track.place_before(track.size())); !can) {
    return Error{can.error()};
  }
  std::error_code error;
  std::filesystem::create_directories(options.folder, error);
  if (error) return Error{fmt::format("{}: {}", options.folder, error.message())};
  const double begin_s = player.state()->elapsed_s;
  const double end_s = track.duration_s();
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
    renderer.color(player);
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
