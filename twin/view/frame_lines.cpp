#include "twin/view/frame_lines.h"

#include "twin/view/moment_values.h"
#include "viewer/window/scene_renderer.h"
#include "viewer/window/screen_rect.h"

namespace kerf {

FrameLines::FrameLines(const RoadStart& start, const Projection& projection)
    : projection_(projection),
      nearness_{towards_eye(projection, LineNearness::kPath_px),
                towards_eye(projection, LineNearness::kMarkers_px)},
      path_(start.track, start.shown.planned) {
  SceneSetup setup;
  if (start.state.stock) setup.bounds_mm = start.state.stock->bounds_mm();
  const auto is_shown = [&](SceneObject object) {
    return start.options.draw.looks[static_cast<std::size_t>(object)].is_visible;
  };
  if (is_shown(SceneObject::kBlank)) setup.blank_outline = start.shown.blank_outline;
  if (is_shown(SceneObject::kFrames)) {
    setup.frames = scene_frames(start.track->frame(), start.shown.work_offset);
  }
  lines_.set_setup(setup);
  lines_.show_path({is_shown(SceneObject::kTraverses), is_shown(SceneObject::kFeeds),
                    is_shown(SceneObject::kPlanned)});
  for (auto chunks = path_.next_chunks(); !chunks.empty(); chunks = path_.next_chunks()) {
    for (auto& chunk : chunks) lines_.add(std::move(chunk));
  }
}

void FrameLines::draw(const TrackPlace& place, Picture* picture, std::vector<float>* depths) const {
  lines_.draw(projection_, nearness_, path_.past_vertices(place), picture, depths);
}

}  // namespace kerf
