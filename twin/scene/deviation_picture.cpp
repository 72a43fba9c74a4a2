#include "twin/scene/deviation_picture.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "base/translate.h"
#include "twin/scene/finding_view.h"
#include "twin/scene/patch_feeder.h"
#include "twin/scene/picture_legend.h"
#include "twin/scene/turned_look.h"
#include "viewer/gl_context.h"
#include "viewer/labels.h"
#include "viewer/orbit_camera.h"
#include "viewer/raycast/stroke_raster.h"
#include "viewer/window/scene_renderer.h"

namespace kerf {
namespace {

constexpr float kWords_px = kLegendWords_px, kEdge_px = kLegendEdge_px;
constexpr glm::vec4 kWordsInk{0.10f, 0.11f, 0.13f, 1.0f}, kWordsHalo{1.0f, 1.0f, 1.0f, 0.92f};

Done draw_all(SceneRenderer& renderer, const Projection& projection, const DrawOptions& options) {
  do {
    if (Done done = renderer.draw(projection, options); !done) return done;
  } while (renderer.has_waiting());
  return std::monostate{};
}

void add_words(const std::string& text, glm::vec2 at_px, std::vector<Stroke>* strokes) {
  add_label(text, at_px, {0, 0}, {kWords_px, kWordsInk, kWordsHalo}, strokes);
}

void add_mark(const Vec3& place, const std::string& text, const Projection& projection,
              std::vector<Stroke>* strokes) {
  const auto at = picture_px(place, projection);
  if (!at) return;
  constexpr int kSides = 40;
  constexpr float kRadius_px = 16;
  for (const auto& [width_px, rgba] : {std::pair(6.0f, kWordsHalo), std::pair(2.5f, kWordsInk)}) {
    for (int i = 0; i < kSides; ++i) {
      const auto corner = [&](int k) {
        const double angle = 2 * kPi * k / kSides;
        return *at + kRadius_px * glm::vec2(std::cos(angle), std::sin(angle));
      };
      Stroke stroke;
      stroke.from_px = corner(i);
      stroke.to_px = corner(i + 1);
      stroke.width_px = width_px;
      stroke.rgba = rgba;
      strokes->push_back(stroke);
    }
  }
  add_words(text, *at + glm::vec2(kRadius_px + 6, kWords_px / 2), strokes);
}

}  // namespace

Result<Picture> deviation_picture(const StockModel& stock,
                                  const std::shared_ptr<const DesignPart>& design,
                                  const Comparison& comparison, const std::string& name,
                                  glm::ivec2 size_px) {
  const Result<GlContext> context = GlContext::create_offscreen();
  if (!context) return Error{context.error()};
  Result<SceneRenderer> renderer = SceneRenderer::create();
  if (!renderer) return Error{renderer.error()};
  DrawOptions options;
  options.upload_bytes_per_frame = std::numeric_limits<std::size_t>::max();
  options.is_local = false;
  options.color_by = ColorBy::kDeviation;
  options.tolerance_mm = comparison.tolerance_mm;
  SceneUpdate update;
  auto setup = std::make_shared<SceneSetup>();
  setup->bounds_mm = stock.bounds_mm();
  setup->blank_outline = blank_outline_of(stock);
  setup->tolerance_mm = comparison.tolerance_mm;
  if (stock.turned() != nullptr) setup->standing = Standing::kInLathe;
  const Standing standing = setup->standing;
  update.setup = std::move(setup);
  renderer->apply(update);
  PatchFeeder feeder;
  feeder.compare_with(design, comparison.tolerance_mm);
  feeder.follow(stock.snapshot());
  do {
    SceneUpdate patches;
    patches.patches = feeder.make_until(PatchFeeder::Clock::time_point::max());
    renderer->apply(patches);
  } while (feeder.behind());

  const DeviationPlace& worst = comparison.gouge.mm > 0 ? comparison.gouge : comparison.excess;
  constexpr std::array kViews{StandardView::kIsometric, StandardView::kTop,  StandardView::kFront,
                              StandardView::kBack,      StandardView::kLeft, StandardView::kRight,
                              StandardView::kBottom};
  OrbitCamera camera;
  camera.set_standing(standing);
  std::optional<Projection> projection;
  for (const StandardView view : kViews) {
    OrbitCamera tried = camera;
    tried.look_from(view);
    tried.fit(renderer->fit_box(), size_px);
    const Projection seen = tried.projection(renderer->depth_box(), size_px);
    if (Done done = draw_all(*renderer, seen, options); !done) return Error{done.error()};
    if (!projection) projection = seen;
    if (worst.mm == 0) break;
    const auto px = picture_px(worst.at_mm, seen);
    const auto hit = px ? renderer->pick(glm::ivec2(glm::floor(*px))) : std::nullopt;
    if (!hit || glm::distance(*hit, worst.at_mm) > 4 * tried.pixel_mm(size_px) + worst.mm) continue;
    projection = seen;
    break;
  }
  if (Done done = draw_all(*renderer, *projection, options); !done) return Error{done.error()};
  Picture picture = renderer->read();
  std::vector<Stroke> strokes;
  add_legend(renderer->legend(), &strokes);
  if (comparison.gouge.mm > 0)
    add_mark(comparison.gouge.at_mm, trf("gouge {:.3f} mm", comparison.gouge.mm), *projection,
             &strokes);
  if (comparison.excess.mm > 0)
    add_mark(comparison.excess.at_mm, trf("excess {:.3f} mm", comparison.excess.mm), *projection,
             &strokes);
  add_words(trf("{}: {}; {:.2f} % within {:g} mm", name, tr(to_string(comparison.verdict)),
                comparison.within_percent(), comparison.tolerance_mm),
            {kEdge_px, static_cast<float>(size_px.y) - kEdge_px}, &strokes);
  const std::vector<float> depths(picture.rgb.size() / 3, 1.0f);
  draw_strokes(strokes, depths, &picture);
  return picture;
}

}  // namespace kerf
