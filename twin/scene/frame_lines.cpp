#include "twin/scene/frame_lines.h"

#include "twin/scene/moment_values.h"
#include "viewer/window/scene_renderer.h"
#include "viewer/window/screen_rect.h"

namespace kerf {

FrameLines::FrameLines(const DrawerStart& start, const Projection& projection)
    : projection_(projection),
      nearness_{towards_eye(projection, LineNearness::kPath_px),
                towards_eye(projection, LineNearness::kMarkers_px)},
      path_(start.track, start.shown.planned),
      shows_findings_(
          start.options.draw.looks[static_cast<std::size_t>(SceneObject::kFindings)].is_visible),
      files_(start.shown.files) {
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

void FrameLines::draw(const PlayerState& state, Picture* picture, std::vector<float>* depths) {
  if (shows_findings_ && state.findings && state.findings != shown_findings_) {
    shown_findings_ = state.findings;
    lines_.set_findings(finding_list(*state.findings, files_)->findings);
  }
  lines_.draw(projection_, nearness_, path_.past_vertices(state.place), picture, depths);
}

}  // namespace kerf
