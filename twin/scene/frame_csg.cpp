// Pictures by image-space CSG: blank minus moves, without a stock model.
#include <fmt/format.h>

#include <tuple>
#include <utility>
#include <vector>

#include "base/translate.h"
#include "twin/scene/frame_bodies.h"
#include "twin/scene/frame_drawer.h"
#include "twin/scene/frame_lines.h"
#include "twin/scene/frame_moves.h"
#include "twin/scene/frame_tool.h"
#include "viewer/csg/csg_renderer.h"
#include "viewer/gl_context.h"
#include "viewer/raycast/ray_caster.h"

namespace kerf {
namespace {

/// A new view of so many moves takes tens of seconds, and they take 100 MB.
constexpr std::size_t kMostMoves = 20'000;
/// Films cut motions into a part a frame; when the parts are this many, whole motions replace them.
constexpr std::size_t kMostParts = 2 * kMostMoves;
/// Round cutters lose no more than the chords of arcs do.
constexpr double kTolerance_mm = FrameMoves::kChordTolerance_mm;

/// The tool over what lies behind it; depths of both are of one projection.
void lay_over(const RayCaster& tool, Picture* picture, std::vector<float>* depths) {
  for (std::size_t pixel = 0; pixel < depths->size(); ++pixel) {
    if (tool.depths()[pixel] >= (*depths)[pixel]) continue;
    (*depths)[pixel] = tool.depths()[pixel];
    for (std::size_t k = 3 * pixel; k < 3 * pixel + 3; ++k) {
      picture->rgb[k] = tool.picture().rgb[k];
    }
  }
}

class CsgDrawer final : public FrameDrawer {
 public:
  CsgDrawer(GlContext context, CsgRenderer renderer, FrameMoves moves, const DrawerStart& start)
      : context_(std::move(context)),
        renderer_(std::move(renderer)),
        moves_(std::move(moves)),
        projection_(frame_projection(start)),
        lines_(start, projection_),
        bodies_(start, projection_) {}

  Done can_reach(const TrackPosition& place) override {
    if (std::tie(place.motion, place.fraction) <= std::tie(reach_.motion, reach_.fraction)) {
      return std::monostate{};
    }
    const std::size_t count = moves_.count_until(place);
    if (count > kMostMoves) {
      return Error{trf(
          "--draw csg: {} moves reach the blank up to there (arcs count a move a chord); it draws "
          "at most {}; --draw mesh draws any number",
          count, kMostMoves)};
    }
    reach_ = place;
    return std::monostate{};
  }

  Result<Picture> draw(const std::shared_ptr<const PlayerState>& state) override {
    if (const Done can = can_reach(state->place); !can) return Error{can.error()};
    go_to(state->place);
    if (const Done done = renderer_.draw(projection_); !done) return Error{done.error()};
    Picture picture = renderer_.read();
    tool_.show(*state, caster_);
    caster_.draw(projection_);
    std::vector<float> depths = renderer_.read_depth().depths;
    lay_over(caster_, &picture, &depths);
    lines_.draw(*state, &picture, &depths);
    bodies_.draw(*state, depths, &picture);
    return picture;
  }

 private:
  void go_to(const TrackPosition& place) {
    const bool is_back =
        std::tie(place.motion, place.fraction) < std::tie(place_.motion, place_.fraction);
    if (is_back || renderer_.move_count() > kMostParts) {
      renderer_.clear_moves();
      place_ = {};
    }
    renderer_.append(moves_.between(place_, place));
    place_ = place;
  }

  GlContext context_;  // before what lives in it
  CsgRenderer renderer_;
  FrameMoves moves_;
  Projection projection_;
  FrameLines lines_;
  FrameBodies bodies_;
  RayCaster caster_{ray_threads()};  // of the tool alone
  FrameTool tool_;
  TrackPosition place_;  ///< the moves up to here are subtracted
  TrackPosition reach_;  ///< up to here they are known to be few enough
};

}  // namespace

Result<std::unique_ptr<FrameDrawer>> make_csg_drawer(DrawerStart start) {
  const std::shared_ptr<const HeightGrid> blank =
      start.state.stock ? start.state.stock->height_grid() : nullptr;
  const std::size_t low = blank ? low_cells(*blank) : 0;
  if (!blank || low > 0) {
    const std::string found =
        blank ? trf("{} of {} cells are lower than its top", low, start.state.stock->cell_count())
              : tr("it has no heights");
    return Error{
        trf("--draw csg: begins with a box, and this blank is none ({}); --draw mesh draws any",
            found)};
  }
  Result<GlContext> context = GlContext::create_offscreen();
  if (!context) return Error{context.error()};
  CsgOptions options;
  options.tolerance_mm = kTolerance_mm;
  Result<CsgRenderer> renderer = CsgRenderer::create(options);
  if (!renderer) return Error{renderer.error()};
  FrameMoves moves(start.track, start.shown.cuts, blank->bounds_mm());
  if (const Done done = renderer->set_blank(box_blank(blank->bounds_mm())); !done) {
    return Error{done.error()};
  }
  if (const Done done = renderer->set_tools(moves.tools()); !done) {
    return Error{tr("--draw csg: ") + done.error()};
  }
  return std::unique_ptr<FrameDrawer>(std::make_unique<CsgDrawer>(
      std::move(context.value()), std::move(renderer.value()), std::move(moves), start));
}

}  // namespace kerf
