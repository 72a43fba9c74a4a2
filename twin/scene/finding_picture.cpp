#include "twin/scene/finding_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <utility>
#include <vector>

#include "twin/machines/machine_bodies.h"
#include "twin/scene/body_watch.h"
#include "twin/scene/contact_places.h"
#include "twin/scene/drawn_machine.h"
#include "twin/scene/finding_view.h"
#include "twin/scene/patch_feeder.h"
#include "twin/scene/tool_shape.h"
#include "twin/scene/turned_look.h"
#include "viewer/gl_context.h"
#include "viewer/labels.h"
#include "viewer/orbit_camera.h"
#include "viewer/raycast/stroke_raster.h"
#include "viewer/section.h"
#include "viewer/window/scene_renderer.h"

namespace kerf {
namespace {

/// Along one edge of a pixel: the window's renderer does not smooth the edges of bodies.
constexpr int kSamples = 2;
/// By which the view is chosen.
constexpr glm::ivec2 kScout_px(240, 180);
/// A workpiece that hides the place on all sides.
constexpr float kSeenThrough = 0.35f;

constexpr float kCaption_px = 17, kLabel_px = 14, kMargin_px = 22;
constexpr float kRing_px = 24;
/// What is shown larger, in the corner: tenths of the picture.
constexpr int kInsetTenths = 3;
constexpr int kInsetMargin_px = 16;
constexpr glm::vec4 kInk{0.10f, 0.11f, 0.13f, 1.0f}, kHalo{1.0f, 1.0f, 1.0f, 0.92f};

/// The mean of kSamples x kSamples.
Picture smaller(const Picture& large) {
  Picture small;
  small.width_px = large.width_px / kSamples;
  small.height_px = large.height_px / kSamples;
  small.rgb.resize(3 * static_cast<std::size_t>(small.width_px) *
                   static_cast<std::size_t>(small.height_px));
  const auto row = 3 * static_cast<std::size_t>(large.width_px);
  std::size_t out = 0;
  for (int y = 0; y < small.height_px; ++y) {
    for (int x = 0; x < small.width_px; ++x) {
      const std::size_t at =
          static_cast<std::size_t>(kSamples * y) * row + 3 * static_cast<std::size_t>(kSamples * x);
      for (std::size_t c = 0; c < 3; ++c) {
        const int sum = large.rgb[at + c] + large.rgb[at + 3 + c] + large.rgb[at + row + c] +
                        large.rgb[at + row + 3 + c];
        small.rgb[out++] = static_cast<std::uint8_t>((sum + 2) / 4);
      }
    }
  }
  return small;
}

/// Links that do not touch are there to be seen through.
SceneMachine glass_machine(const MachineModel& model) {
  constexpr std::uint32_t kColor = 0x00ffffff, kGlass = 0x48000000;
  SceneMachine scene = scene_machine(model);
  for (MachineLink& link : scene.links) link.color = (link.color & kColor) | kGlass;
  return scene;
}

void add_text(const std::string& text, glm::vec2 at_px, glm::vec2 anchor, float height_px,
              std::vector<Stroke>* strokes) {
  add_label(text, at_px, anchor, {height_px, kInk, kHalo}, strokes);
}

/// Lines no wider than that, broken between words.
std::vector<std::string> wrapped(const std::string& text, float width_px) {
  std::vector<std::string> lines(1);
  std::size_t at = 0;
  while (at < text.size()) {
    const std::size_t end = std::min(text.find(' ', at), text.size());
    const std::string word = text.substr(at, end - at);
    const std::string longer = lines.back().empty() ? word : lines.back() + ' ' + word;
    if (lines.back().empty() || label_width_px(longer, kCaption_px) <= width_px) {
      lines.back() = longer;
    } else {
      lines.push_back(word);
    }
    at = end + 1;
  }
  return lines;
}

void add_line(glm::vec2 from_px, glm::vec2 to_px, float width_px, const glm::vec4& rgba,
              std::vector<Stroke>* strokes) {
  Stroke stroke;
  stroke.from_px = from_px;
  stroke.to_px = to_px;
  stroke.width_px = width_px;
  stroke.rgba = rgba;
  strokes->push_back(stroke);
}

void add_ring(glm::vec2 middle_px, std::vector<Stroke>* strokes) {
  constexpr int kSides = 40;
  for (const auto& [width_px, rgba] : {std::pair(6.0f, kHalo), std::pair(2.5f, kInk)}) {
    for (int i = 0; i < kSides; ++i) {
      const auto corner = [&](int k) {
        const double angle = 2 * kPi * k / kSides;
        return middle_px + kRing_px * glm::vec2(std::cos(angle), std::sin(angle));
      };
      add_line(corner(i), corner(i + 1), width_px, rgba, strokes);
    }
  }
}

/// Into the upper right corner, with an edge. Returns its upper left corner.
glm::ivec2 lay_in(const Picture& small, std::vector<Stroke>* strokes, Picture* picture) {
  const glm::ivec2 at(picture->width_px - small.width_px - kInsetMargin_px, kInsetMargin_px);
  for (int y = 0; y < small.height_px; ++y) {
    const auto row = 3 * static_cast<std::size_t>(small.width_px);
    const auto to =
        3 * (static_cast<std::size_t>(at.y + y) * static_cast<std::size_t>(picture->width_px) +
             static_cast<std::size_t>(at.x));
    const auto from = static_cast<std::size_t>(y) * row;
    std::copy_n(small.rgb.begin() + static_cast<std::ptrdiff_t>(from), row,
                picture->rgb.begin() + static_cast<std::ptrdiff_t>(to));
  }
  const glm::vec2 low(at), high(at + glm::ivec2(small.width_px, small.height_px));
  const std::array corners{low, glm::vec2(high.x, low.y), high, glm::vec2(low.x, high.y)};
  for (std::size_t i = 0; i < corners.size(); ++i)
    add_line(corners[i], corners[(i + 1) % corners.size()], 2.0f, kInk, strokes);
  return at;
}

}  // namespace

std::string finding_picture_name(std::size_t number, const Finding& finding) {
  const std::string name = fmt::format("{:02}-{}", number, to_string(finding.id));
  return finding.source.line > 0 ? fmt::format("{}-line-{}.png", name, finding.source.line)
                                 : name + ".png";
}

class FindingPictures::Impl {
 public:
  Impl(GlContext context, SceneRenderer scout, SceneRenderer renderer, CollisionWishes wishes,
       const MachineModel* machine, glm::ivec2 size_px)
      : context_(std::move(context)),
        scout_(std::move(scout)),
        renderer_(std::move(renderer)),
        links_(wishes.machine),
        watch_(std::move(wishes)),
        size_px_(size_px) {
    if (machine && !links_) links_ = bodies_of(*machine);
    if (machine) watch_.set_machine(std::make_shared<const SceneMachine>(glass_machine(*machine)));
    options_.upload_bytes_per_frame = std::numeric_limits<std::size_t>::max();
    options_.is_local = false;
    SceneUpdate update;
    update.fixtures = watch_.scene();
    update.machine = watch_.drawn_machine();
    scout_.apply(update);
    renderer_.apply(update);
  }

  Result<Picture> draw(const FindingShot& shot);

 private:
  SceneUpdate scene_of(const FindingShot& shot, const FindingView& view);
  Result<OrbitCamera> chosen_camera(const FindingView& view, bool* is_hidden);
  Result<Picture> drawn(const OrbitCamera& camera, glm::ivec2 size_px, bool is_hidden);
  static Done draw_whole(SceneRenderer& renderer, const Projection& projection,
                         const DrawOptions& options);
  void name_bodies(const FindingView& view, const OrbitCamera& camera,
                   std::vector<Stroke>* strokes) const;
  void add_caption(const FindingShot& shot, std::vector<Stroke>* strokes) const;

  GlContext context_;  // before what lives in it
  SceneRenderer scout_;
  SceneRenderer renderer_;
  MachineBodiesPointer links_;  ///< null: not known
  BodyWatch watch_;
  glm::ivec2 size_px_;
  DrawOptions options_;
  PatchFeeder scout_feeder_;
  PatchFeeder feeder_;
};

SceneUpdate FindingPictures::Impl::scene_of(const FindingShot& shot, const FindingView& view) {
  SceneUpdate update;
  auto setup = std::make_shared<SceneSetup>();
  setup->bounds_mm = shot.stock->bounds_mm();
  setup->standing = view.standing;
  setup->blank_outline = blank_outline_of(*shot.stock);
  update.setup = std::move(setup);
  update.tool_shape = view.tool_shape;
  auto moment = std::make_shared<Moment>();
  moment->tool_pose = shot.tool;
  moment->fixture_poses = watch_.poses();
  if (view.contact && !view.contact->links.empty()) moment->link_poses = shot.link_poses;
  if (view.contact) moment->contacts.push_back(*view.contact);
  update.moment = std::move(moment);
  return update;
}

Done FindingPictures::Impl::draw_whole(SceneRenderer& renderer, const Projection& projection,
                                       const DrawOptions& options) {
  do {
    if (Done done = renderer.draw(projection, options); !done) return done;
  } while (renderer.has_waiting());
  return std::monostate{};
}

/// The best of the candidates: what shows more of the places that are to be seen counts first.
Result<OrbitCamera> FindingPictures::Impl::chosen_camera(const FindingView& view, bool* is_hidden) {
  OrbitCamera best;
  best.set_standing(view.standing);
  if (view.is_flat) {
    best.set_perspective(false);
    best.look_from(StandardView::kFront);
    best.fit(view.frame_mm, size_px_);
    return best;
  }
  double best_score = -std::numeric_limits<double>::infinity();
  for (const ViewAngles& angles : candidate_views()) {
    OrbitCamera camera;
    camera.set_standing(view.standing);
    camera.look_from(angles.yaw_rad, angles.pitch_rad);
    camera.fit(view.frame_mm, kScout_px);
    const Projection projection = camera.projection(scout_.depth_box(), kScout_px);
    if (Done done = draw_whole(scout_, projection, options_); !done) return Error{done.error()};
    // A pixel of slope, and a place that lies on the surface.
    const double near_mm = 3 * camera.pixel_mm(kScout_px);
    const Vec3 to_eye = direction_of(angles, view.standing);
    const auto is_seen = [&](const Vec3& place) {
      const auto px = picture_px(place, projection);
      if (!px) return false;
      const auto hit = scout_.pick(glm::ivec2(glm::floor(*px)));
      return !hit || glm::dot(*hit - place, to_eye) < near_mm;
    };
    const bool shows_place = is_seen(view.place_mm) && !tool_hides_place(view, angles);
    const double score = score_of(view, angles, shows_place, is_seen(view.tool_mm),
                                  !view.other_mm || is_seen(*view.other_mm));
    if (score <= best_score) continue;
    best_score = score;
    best = camera;
    *is_hidden = !shows_place;
  }
  best.fit(view.frame_mm, size_px_);
  return best;
}

Result<Picture> FindingPictures::Impl::drawn(const OrbitCamera& camera, glm::ivec2 size_px,
                                             bool is_hidden) {
  DrawOptions options = options_;
  if (is_hidden)
    options.looks[static_cast<std::size_t>(SceneObject::kWorkpiece)].opacity = kSeenThrough;
  Projection projection = camera.projection(renderer_.depth_box(), kSamples * size_px);
  projection.line_px = kSamples;
  if (Done done = draw_whole(renderer_, projection, options); !done) return Error{done.error()};
  return smaller(renderer_.read());
}

/// The part of the tool on its left, the fixture on itself or, if that is where they touch, on the
/// right of the ring.
void FindingPictures::Impl::name_bodies(const FindingView& view, const OrbitCamera& camera,
                                        std::vector<Stroke>* strokes) const {
  const Projection projection = camera.projection(renderer_.depth_box(), size_px_);
  const auto place = picture_px(view.place_mm, projection);
  if (!place) return;
  constexpr float kBeside_px = 12;
  add_ring(*place, strokes);
  if (!view.contact) return;
  if (const auto tool = picture_px(view.tool_mm, projection)) {
    const auto radius_px =
        static_cast<float>(view.tool_radius_mm / camera.pixel_mm(size_px_)) + kBeside_px;
    add_text(view.tool_name, {tool->x - radius_px, tool->y}, {1, 0.5f}, kLabel_px, strokes);
  }
  const auto other = view.other_mm ? picture_px(*view.other_mm, projection) : std::nullopt;
  if (!other) return;
  const bool is_apart = glm::distance(*other, *place) > 2.5f * kRing_px;
  const glm::vec2 right_of_ring = *place + glm::vec2(kRing_px + kBeside_px, kRing_px);
  add_text(view.other_name, is_apart ? *other : right_of_ring, {is_apart ? 0.5f : 0.0f, 0.5f},
           kLabel_px, strokes);
}

void FindingPictures::Impl::add_caption(const FindingShot& shot,
                                        std::vector<Stroke>* strokes) const {
  const float width = static_cast<float>(size_px_.x) - 2 * kMargin_px;
  std::vector<std::string> lines = wrapped(shot.message, width);
  const std::string where = shot.place.empty() ? "" : shot.place + "  ";
  lines.insert(lines.begin(), where + to_string(shot.finding.id));
  float y = static_cast<float>(size_px_.y) - kMargin_px;
  for (auto line = lines.rbegin(); line != lines.rend(); ++line) {
    add_text(*line, {kMargin_px, y}, {0, 0}, kCaption_px, strokes);
    y -= 1.8f * kCaption_px;
  }
}

Result<Picture> FindingPictures::Impl::draw(const FindingShot& shot) {
  const FindingView view = finding_view(shot, watch_, links_.get());
  const SceneUpdate scene = scene_of(shot, view);
  const auto feed = [&](SceneRenderer& renderer, PatchFeeder& feeder, const ViewDetail& detail) {
    renderer.apply(scene);
    feeder.follow(shot.stock);
    feeder.set_detail(detail);
    do {
      SceneUpdate update;
      update.patches = feeder.make_until(PatchFeeder::Clock::time_point::max());
      renderer.apply(update);
    } while (feeder.behind());
  };
  if (!view.is_flat) {
    OrbitCamera whole;
    whole.fit(view.frame_mm, kScout_px);
    feed(scout_, scout_feeder_, whole.detail(kScout_px));
  }
  options_.section.reset();
  if (view.is_inside) {
    const Box middle{Vec3(-1), Vec3(1)};  // of the axis
    options_.section = usual_section(SectionKind::kHalf, middle, view.standing)->plane;
  }
  bool is_hidden = false;
  const Result<OrbitCamera> camera = chosen_camera(view, &is_hidden);
  if (!camera) return Error{camera.error()};
  feed(renderer_, feeder_, camera->detail(kSamples * size_px_));
  Result<Picture> picture = drawn(*camera, size_px_, is_hidden);
  if (!picture) return picture;
  std::vector<Stroke> strokes;
  name_bodies(view, *camera, &strokes);
  if (!view.close_mm.empty()) {
    OrbitCamera close = *camera;
    const glm::ivec2 inset_px = kInsetTenths * size_px_ / 10;
    close.fit(view.close_mm, inset_px);
    const Result<Picture> inset = drawn(close, inset_px, is_hidden);
    if (!inset) return inset;
    const glm::vec2 corner_px(lay_in(*inset, &strokes, &*picture));
    const auto place = picture_px(view.place_mm, close.projection(renderer_.depth_box(), inset_px));
    if (place) add_ring(corner_px + *place, &strokes);
  }
  add_caption(shot, &strokes);
  // Nothing of the part is before the lettering.
  const std::vector<float> depths(picture->rgb.size() / 3, 1.0f);
  draw_strokes(strokes, depths, &*picture);
  return picture;
}

Result<FindingPictures> FindingPictures::create(CollisionWishes wishes,
                                                std::shared_ptr<const MachineModel> machine,
                                                glm::ivec2 size_px) {
  Result<GlContext> context = GlContext::create_offscreen();
  if (!context) return Error{context.error()};
  Result<SceneRenderer> scout = SceneRenderer::create();
  if (!scout) return Error{scout.error()};
  Result<SceneRenderer> renderer = SceneRenderer::create();
  if (!renderer) return Error{renderer.error()};
  return FindingPictures(std::make_unique<Impl>(std::move(context.value()), std::move(*scout),
                                                std::move(*renderer), std::move(wishes),
                                                machine.get(), size_px));
}

FindingPictures::FindingPictures(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
FindingPictures::FindingPictures(FindingPictures&&) noexcept = default;
FindingPictures& FindingPictures::operator=(FindingPictures&&) noexcept = default;
FindingPictures::~FindingPictures() = default;
Result<Picture> FindingPictures::draw(const FindingShot& shot) { return impl_->draw(shot); }

}  // namespace kerf
