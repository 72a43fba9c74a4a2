#include "viewer/csg/csg_renderer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <glm/geometric.hpp>
#include <optional>
#include <random>

#include "tests/viewer/csg/cylinder_blank.h"
#include "tests/viewer/csg/depth_values.h"
#include "tests/viewer/csg/ray_oracle.h"
#include "tests/viewer/csg/test_outlines.h"
#include "viewer/gl_context.h"
#include "viewer/png_image.h"

namespace kerf {
namespace {

constexpr glm::ivec2 kSize_px{160, 120};
const Box kBox{Vec3(0, 0, -20), Vec3(60, 45, 0)};
/// Of the prisms that stand for cutters.
constexpr double kTolerance_mm = 0.004;
/// Between picture and oracle: prism, outline of the ball in steps, 24 bits of depth; along the
/// normal, doubled for faces seen aslant. Steeper ones are held to the neighbourhood instead.
constexpr double kAgrees_mm = 0.03;

enum Cutter : std::uint32_t { kFlat, kBall, kBull, kVee };

const Outline& outline_of(std::uint32_t tool) {
  static const Outline outlines[] = {flat_outline(5, 60), bull_outline(4, 4, 60, 1.5),
                                     bull_outline(6, 2, 60), vee_outline(5, 35, 60)};
  return outlines[tool];
}

std::vector<CsgTool> test_tools() {
  constexpr std::uint32_t kColors[] = {0xffd09060, 0xff60a0e0, 0xff70c070, 0xffb070c0};
  std::vector<CsgTool> tools;
  for (std::uint32_t tool = kFlat; tool <= kVee; ++tool) {
    CsgTool made;
    made.shape.cutter = outline_of(tool);
    made.color = kColors[tool];
    tools.push_back(std::move(made));
  }
  return tools;
}

Span meet_move(const Ray& ray, const SweptMove& move) {
  switch (move.tool) {
    case kFlat:
      return meet_flat_sweep(ray, move.from_mm, move.to_mm, 5.0);
    case kBall:
      return meet_ball_sweep(ray, move.from_mm, move.to_mm, 4.0);
    default:
      return meet_outline_sweep(ray, move.from_mm, move.to_mm, outline_of(move.tool));
  }
}

/// What the blank is, for rays.
struct TestBlank {
  CsgBlank drawn;
  std::function<Span(const Ray&)> meet;
  std::optional<Box> hollow;  // is missing from it
};

TestBlank box() {
  return {box_blank(kBox), [](const Ray& ray) { return meet_box(ray, kBox); }, {}};
}

TestBlank cylinder() {
  const Vec3 base(30, 22, -20);
  return {cylinder_blank(base, 'Z', 22, 20, kTolerance_mm),
          [base](const Ray& ray) { return meet_cylinder(ray, base, 22, 20); },
          {}};
}

/// A box with a groove along y in its floor: a ray enters it twice at most.
TestBlank bridge() {
  const Box groove{Vec3(20, -1, -30), Vec3(40, 50, -8)};
  const auto x = [](int i) { return static_cast<float>(std::array{0, 20, 40, 60}[i % 4]); };
  const std::array<glm::vec2, 8> outline = {
      glm::vec2(x(0), -20), {x(1), -20}, {x(1), -8}, {x(2), -8},
      {x(2), -20},          {x(3), -20}, {x(3), 0},  {x(0), 0}};
  CsgBlank blank;
  blank.convexity = 2;
  for (std::uint32_t i = 0; i < 8; ++i) {
    for (const float y : {0.0f, 45.0f}) {
      blank.mesh.positions_mm.emplace_back(outline[i].x, y, outline[i].y);
    }
    const std::uint32_t a = 2 * i, b = 2 * ((i + 1) % 8);
    blank.mesh.triangles.insert(blank.mesh.triangles.end(), {{a, b + 1, b}, {a, a + 1, b + 1}});
  }
  // The ends, counter-clockwise seen from -y.
  const std::array<std::array<std::uint32_t, 3>, 6> end = {
      {{0, 1, 2}, {0, 2, 7}, {2, 3, 7}, {3, 6, 7}, {3, 4, 5}, {3, 5, 6}}};
  for (const auto& [a, b, c] : end) {
    blank.mesh.triangles.push_back({2 * a, 2 * b, 2 * c});
    blank.mesh.triangles.push_back({2 * a + 1, 2 * c + 1, 2 * b + 1});
  }
  return {blank, [](const Ray& ray) { return meet_box(ray, kBox); }, groove};
}

class Programs {
 public:
  explicit Programs(unsigned seed) : random_(seed) {}
  double between(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }
  Vec3 place() { return {between(-5, 65), between(-5, 50), between(-15, 1)}; }

  /// Lines, ramps, plunges and arcs, one after the other.
  std::vector<SweptMove> moves(std::size_t count) {
    std::vector<SweptMove> moves;
    Vec3 at = place();
    while (moves.size() < count) {
      const auto tool = static_cast<std::uint32_t>(between(0, 4));
      const int kind = static_cast<int>(between(0, 4));
      Vec3 to = place();
      if (kind == 0) to = {at.x, at.y, to.z};
      if (kind == 1) to.z = at.z;
      if (kind == 3) {
        const Vec3 center = at + Vec3{between(-12, 12), between(-12, 12), 0.0};
        const Vec3 arm = at - center;
        const double angle = between(0.3, 6.0);
        to = center + Vec3(arm.x * std::cos(angle) - arm.y * std::sin(angle),
                           arm.x * std::sin(angle) + arm.y * std::cos(angle), between(-3, 3));
        for (const SweptMove& chord : chords({at, to, center, {0, 0, 1}, 0, tool}, 0.4)) {
          moves.push_back(chord);
        }
      } else {
        moves.push_back({at, to, tool});
      }
      at = to;
      at.z = std::clamp(at.z, -15.0, 1.0);
    }
    moves.resize(count);
    return moves;
  }

 private:
  std::mt19937 random_;
};

/// Distance along the rays of a view, by the oracle.
class RayPicture {
 public:
  RayPicture(const TestBlank& blank, std::vector<SweptMove> moves, const Projection& projection)
      : blank_(blank), moves_(std::move(moves)), projection_(projection) {}

  Ray ray(Vec2 px) const {
    // Rays of neighbouring pixels differ linearly at both clip planes.
    const PixelRay at = pixel_ray({0, 0}, projection_);
    const PixelRay right = pixel_ray({1, 0}, projection_), below = pixel_ray({0, 1}, projection_);
    const Vec3 from =
        at.near_mm + px.x * (right.near_mm - at.near_mm) + px.y * (below.near_mm - at.near_mm);
    const Vec3 to =
        at.far_mm + px.x * (right.far_mm - at.far_mm) + px.y * (below.far_mm - at.far_mm);
    return {from, glm::normalize(to - from)};
  }

  double distance_mm(Vec2 px) const {
    const Ray through = ray(px);
    const Span blank = blank_.meet(through);
    if (blank.empty()) return std::numeric_limits<double>::infinity();
    std::vector<Span> removed;
    if (blank_.hollow) removed.push_back(meet_box(through, *blank_.hollow));
    for (const SweptMove& move : moves_) {
      const Span span = meet_move(through, move);
      if (!span.empty()) removed.push_back(span);
    }
    return nearest_left(blank, removed);
  }

  /// Whether the distance lies between the least and the greatest around the pixel: it does at the
  /// rim of a face, where the true edge runs through the pixel, and where a face is seen edge on.
  bool is_near(Vec2 px, double distance_mm) const {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const double reach : {0.05, 0.25, 0.75}) {
      for (int i = 0; i < 8; ++i) {
        const Vec2 offset(std::cos(i * kPi / 4), std::sin(i * kPi / 4));
        const double d = this->distance_mm(px + reach * offset);
        low = std::min(low, d);
        high = std::max(high, d);
      }
    }
    return distance_mm >= low - kAgrees_mm && distance_mm <= high + kAgrees_mm;
  }

 private:
  const TestBlank& blank_;
  std::vector<SweptMove> moves_;
  Projection projection_;
};

struct Comparison {
  int rim_pixels = 0;    // agree with a neighbouring ray only
  int wrong_pixels = 0;  // agree with none
  int pixels = 0;        // on the workpiece, by the oracle
};

/// From the near plane to the point at this depth, which is affine in clip space.
double along_ray_mm(const PixelRay& ends, double depth, const Projection& projection) {
  const glm::dmat4 clip_from_world(projection.clip_from_world);
  const double near_w = (clip_from_world * glm::dvec4(ends.near_mm, 1.0)).w;
  const double far_w = (clip_from_world * glm::dvec4(ends.far_mm, 1.0)).w;
  const double share = depth * near_w / (depth * near_w + (1.0 - depth) * far_w);
  return share * glm::distance(ends.near_mm, ends.far_mm);
}

Comparison compare(const DepthPicture& picture, const RayPicture& rays,
                   const Projection& projection) {
  constexpr double kNothing = std::numeric_limits<double>::infinity();
  Comparison result;
  for (int y = 0; y < picture.height_px; ++y) {
    for (int x = 0; x < picture.width_px; ++x) {
      const PixelRay ends = pixel_ray({x, y}, projection);
      const auto depth =
          static_cast<double>(picture.depths[static_cast<std::size_t>(y * picture.width_px + x)]);
      double drawn = kNothing;
      if (depth < 1.0) {
        drawn = along_ray_mm(ends, depth, projection);
      }
      const double expected = rays.distance_mm(Vec2(x, y));
      result.pixels += expected < kNothing ? 1 : 0;
      if (drawn == expected || std::abs(drawn - expected) <= kAgrees_mm) continue;
      ++(rays.is_near(Vec2(x, y), drawn) ? result.rim_pixels : result.wrong_pixels);
    }
  }
  return result;
}

class CsgRendererTest : public testing::Test {
 protected:
  void SetUp() override {
    unsetenv("DISPLAY");
    Result<GlContext> context = GlContext::create_offscreen();
    ASSERT_TRUE(context) << context.error();
    context_.emplace(std::move(*context));
  }

  CsgRenderer renderer(const CsgBlank& blank, bool is_local = true,
                       double tolerance_mm = kTolerance_mm) {
    Result<CsgRenderer> made = CsgRenderer::create({tolerance_mm, is_local});
    EXPECT_TRUE(made) << made.error();
    EXPECT_TRUE(made->set_tools(test_tools()));
    const Done done = made->set_blank(blank);
    EXPECT_TRUE(done) << done.error();
    return std::move(*made);
  }

  static void draw(CsgRenderer* renderer, const Projection& projection) {
    const Done done = renderer->draw(projection);
    ASSERT_TRUE(done) << done.error();
  }

  static Projection view_from(StandardView view, bool is_perspective, glm::vec2 drag_px = {0, 0}) {
    OrbitCamera camera;
    camera.look_from(view);
    camera.orbit(drag_px, kSize_px);
    camera.set_perspective(is_perspective);
    camera.fit(kBox, kSize_px);
    return camera.projection(kBox, kSize_px);
  }

  /// Where KERF_PICTURES names a folder, for looking at.
  static void keep_picture(const CsgRenderer& renderer, const std::string& name) {
    const char* folder = std::getenv("KERF_PICTURES");
    if (folder == nullptr) return;
    const Done done = write_png(std::string(folder) + "/" + name + ".png", renderer.read());
    EXPECT_TRUE(done) << done.error();
  }

  std::optional<GlContext> context_;
};

struct Look {
  StandardView view;
  bool is_perspective;
  glm::vec2 drag_px;
};

constexpr Look kLooks[] = {
    {StandardView::kTop, false, {0, 0}},           {StandardView::kIsometric, true, {0, 0}},
    {StandardView::kIsometric, false, {170, -20}}, {StandardView::kFront, false, {0, 0}},
    {StandardView::kFront, true, {55, 6}},         {StandardView::kBottom, true, {0, 0}},
    {StandardView::kIsometric, true, {30, -70}}};

class RandomPrograms : public CsgRendererTest, public testing::WithParamInterface<int> {};

TEST_P(RandomPrograms, DepthsAreThoseOfTheRays) {
  const int seed = GetParam();
  SCOPED_TRACE("seed " + std::to_string(seed));
  Programs programs(static_cast<unsigned>(seed));
  const std::size_t counts[] = {1, 2, 5, 12, 25, 60};
  const std::vector<SweptMove> moves = programs.moves(counts[seed % 6]);
  const TestBlank blank = seed % 3 == 0 ? box() : seed % 3 == 1 ? cylinder() : bridge();
  CsgRenderer renderer = this->renderer(blank.drawn);
  renderer.append(moves);
  for (std::size_t i = 0; i < std::size(kLooks); ++i) {
    SCOPED_TRACE("view " + std::to_string(i));
    const Projection projection =
        view_from(kLooks[i].view, kLooks[i].is_perspective, kLooks[i].drag_px);
    draw(&renderer, projection);
    keep_picture(renderer, "random" + std::to_string(seed) + "_" + std::to_string(i));
    const Comparison found =
        compare(renderer.read_depth(), RayPicture(blank, moves, projection), projection);
    EXPECT_GT(found.pixels, 1000);
    // One or none: where two surfaces cross at a hair.
    EXPECT_LE(found.wrong_pixels, found.pixels / 5000) << "of " << found.pixels;
    EXPECT_LT(found.rim_pixels, found.pixels / 20);
    RecordProperty("rim_share_" + std::to_string(i),
                   std::to_string(static_cast<double>(found.rim_pixels) / found.pixels));
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, RandomPrograms, testing::Range(0, 12));

/// Depths only grow to the least point that no solid holds, so the order of moves and the steps in
/// which they come change nothing, not even in the last bit.
TEST_F(CsgRendererTest, OrderAndStepsOfMovesChangeNoDepth) {
  for (unsigned seed = 100; seed < 106; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Programs programs(seed);
    std::vector<SweptMove> moves = programs.moves(40);
    const TestBlank blank = seed % 2 == 0 ? box() : bridge();
    const Projection projection = view_from(StandardView::kIsometric, seed % 3 == 0);
    constexpr double kCoarse_mm = 0.1;
    CsgRenderer at_once = renderer(blank.drawn, true, kCoarse_mm),
                by_one = renderer(blank.drawn, true, kCoarse_mm),
                backwards = renderer(blank.drawn, true, kCoarse_mm),
                always_full = renderer(blank.drawn, false, kCoarse_mm);
    at_once.append(moves);
    draw(&at_once, projection);
    EXPECT_TRUE(at_once.counters().was_full);
    for (std::size_t i = 0; i < moves.size(); ++i) {
      by_one.append(std::span(moves).subspan(i, 1));
      always_full.append(std::span(moves).subspan(i, 1));
      draw(&by_one, projection);
      EXPECT_EQ(by_one.counters().was_full, i == 0);
      if (i % 8 != 7) continue;
      draw(&always_full, projection);
      EXPECT_TRUE(always_full.counters().was_full);
      EXPECT_EQ(by_one.read_depth().depths, always_full.read_depth().depths) << i;
    }
    std::reverse(moves.begin(), moves.end());
    backwards.append(moves);
    draw(&backwards, projection);
    EXPECT_EQ(by_one.read_depth().depths, at_once.read_depth().depths);
    EXPECT_EQ(backwards.read_depth().depths, at_once.read_depth().depths);
    EXPECT_EQ(by_one.move_count(), 40u);
  }
}

TEST_F(CsgRendererTest, AddingAMoveTouchesItsNeighboursOnly) {
  CsgRenderer renderer = this->renderer(box_blank(kBox));
  std::vector<SweptMove> rows;
  for (int i = 0; i < 20; ++i) {
    rows.push_back({Vec3(2, 2.0 * i + 3, -1), Vec3(58, 2.0 * i + 3, -1), kBall});
  }
  const Projection projection = view_from(StandardView::kTop, false);
  renderer.append(rows);
  draw(&renderer, projection);
  const std::size_t all = renderer.counters().subtractions;
  EXPECT_GE(all, 20u);
  const SweptMove plunge{Vec3(30, 41, 1), Vec3(30, 41, -6), kFlat};
  renderer.append(std::span(&plunge, 1));
  draw(&renderer, projection);
  EXPECT_FALSE(renderer.counters().was_full);
  EXPECT_GE(renderer.counters().subtractions, 2u);
  EXPECT_LE(renderer.counters().subtractions, 16u);
  draw(&renderer, projection);  // nothing new
  EXPECT_EQ(renderer.counters().subtractions, 0u);
}

/// Group by group, the newest first: until the end there is too much material, never too little.
TEST_F(CsgRendererTest, WithATimeLimitTheEndIsTheSame) {
  const std::vector<SweptMove> moves = Programs(11).moves(120);
  const Projection view = view_from(StandardView::kIsometric, true);
  constexpr double kCoarse_mm = 0.1;
  for (const TestBlank& blank : {box(), bridge()}) {
    // Of a blank with a hollow, points at the wall of that may be taken for air.
    const bool is_convex = !blank.hollow;
    CsgRenderer at_once = renderer(blank.drawn, true, kCoarse_mm);
    at_once.append(moves);
    draw(&at_once, view);
    EXPECT_FALSE(at_once.has_waiting());
    const std::vector<float> end = at_once.read_depth().depths;
    CsgRenderer in_parts = renderer(blank.drawn, true, kCoarse_mm);
    in_parts.append(moves);
    std::vector<float> before;
    int draws = 0;
    do {
      ASSERT_TRUE(in_parts.draw(view, 1e-3));
      const std::vector<float> now = in_parts.read_depth().depths;
      for (std::size_t i = 0; is_convex && i < now.size(); ++i) {
        ASSERT_LE(now[i], end[i]);
        ASSERT_GE(now[i], before.empty() ? 0.0f : before[i]);
      }
      before = now;
      ++draws;
    } while (in_parts.has_waiting());
    EXPECT_GT(draws, 3);
    EXPECT_EQ(before, end);
  }
}

TEST_F(CsgRendererTest, WhatIsNotFinishedMayBeKeptBack) {
  const std::vector<SweptMove> moves = Programs(12).moves(60);
  const Projection view = view_from(StandardView::kIsometric, true);
  constexpr double kCoarse_mm = 0.1;
  CsgRenderer renderer = this->renderer(box_blank(kBox), true, kCoarse_mm);
  renderer.append(moves);
  draw(&renderer, view);
  const std::vector<float> all = renderer.read_depth().depths;
  renderer.clear_moves();
  renderer.append(std::span(moves).first(40));
  ASSERT_TRUE(renderer.draw(view, 1e-3, false));
  ASSERT_TRUE(renderer.has_waiting());
  EXPECT_TRUE(renderer.changed().empty());
  EXPECT_EQ(renderer.read_depth().depths, all) << "the picture before";
  while (renderer.has_waiting()) ASSERT_TRUE(renderer.draw(view, 1e-3, false));
  EXPECT_EQ(renderer.read_depth().depths, all);
  draw(&renderer, view);
  EXPECT_FALSE(renderer.changed().empty());
  CsgRenderer fewer = this->renderer(box_blank(kBox), true, kCoarse_mm);
  fewer.append(std::span(moves).first(40));
  draw(&fewer, view);
  EXPECT_EQ(renderer.read_depth().depths, fewer.read_depth().depths);
}

/// What is told as not shown is all that changes, also where all is subtracted anew.
TEST_F(CsgRendererTest, OnlyWhatIsToldAsNotShownChanges) {
  CsgRenderer renderer = this->renderer(box_blank(kBox));
  const Projection view = view_from(StandardView::kTop, false);
  draw(&renderer, view);
  EXPECT_TRUE(renderer.unshown().empty());
  const SweptMove places[] = {{Vec3(10, 10, -5), Vec3(20, 10, -5), kFlat},
                              {Vec3(40, 30, -5), Vec3(45, 30, -5), kBull}};
  for (const SweptMove& place : places) {
    const DepthPicture before = renderer.read_depth();
    renderer.clear_moves();
    renderer.append(std::span(&place, 1));
    ASSERT_TRUE(renderer.draw(view, 0.0, false));
    EXPECT_TRUE(renderer.has_waiting()) << "no time, no work";
    EXPECT_EQ(renderer.counters().subtractions, 0u);
    while (renderer.has_waiting()) ASSERT_TRUE(renderer.draw(view, 1e-3, false));
    const PixelRect told = renderer.unshown();
    EXPECT_LT(told.pixels(), kSize_px.x * kSize_px.y / 2);
    ASSERT_TRUE(renderer.draw(view, 0.0));
    EXPECT_TRUE(renderer.unshown().empty());
    const DepthPicture after = renderer.read_depth();
    CsgRenderer fresh = this->renderer(box_blank(kBox));
    fresh.append(std::span(&place, 1));
    draw(&fresh, view);
    EXPECT_EQ(after.depths, fresh.read_depth().depths);
    int changed = 0;
    for (int y = 0; y < kSize_px.y; ++y) {
      for (int x = 0; x < kSize_px.x; ++x) {
        const auto i = static_cast<std::size_t>((kSize_px.y - 1 - y) * kSize_px.x + x);
        if (before.depths[i] == after.depths[i]) continue;
        ++changed;
        EXPECT_TRUE(x >= told.min.x && x < told.max.x && y >= told.min.y && y < told.max.y);
      }
    }
    EXPECT_GT(changed, 100);
  }
}

TEST_F(CsgRendererTest, ACutThroughTheFloorOpensIt) {
  CsgRenderer renderer = this->renderer(box_blank(kBox));
  const SweptMove slot{Vec3(20, 22, -20), Vec3(40, 22, -20),
                       kFlat};  // exactly as deep as the blank
  renderer.append(std::span(&slot, 1));
  for (const StandardView view : {StandardView::kTop, StandardView::kBottom}) {
    for (const bool is_perspective : {false, true}) {
      draw(&renderer, view_from(view, is_perspective));
      const DepthPicture depth = renderer.read_depth();
      EXPECT_EQ(depth.depths[static_cast<std::size_t>(60 * 160 + 80)], 1.0f);
      EXPECT_LT(depth.depths[static_cast<std::size_t>(60 * 160 + 20)], 1.0f);
    }
  }
}

TEST_F(CsgRendererTest, HeightsAndDistancesAreInMillimetres) {
  CsgRenderer renderer = this->renderer(box_blank(kBox));
  const SweptMove slot{Vec3(10, 22, -7.5), Vec3(50, 22, -7.5), kFlat};
  renderer.append(std::span(&slot, 1));
  const std::size_t middle = 60 * 160 + 80, beside = 40 * 160 + 80, outside = 0;
  for (const bool is_perspective : {false, true}) {
    const Projection projection = view_from(StandardView::kTop, is_perspective);
    draw(&renderer, projection);
    const DepthPicture depth = renderer.read_depth();
    const std::vector<float> heights = world_heights_mm(depth, projection);
    const std::vector<float> distances = view_distances_mm(depth, projection);
    EXPECT_NEAR(heights[middle], -7.5, 1e-3);
    EXPECT_NEAR(heights[beside], 0.0, 1e-3);
    EXPECT_EQ(heights[outside], kNoDepth_mm);
    EXPECT_NEAR(distances[middle] - distances[beside], 7.5, 1e-3);
    EXPECT_EQ(distances[outside], kNoDepth_mm);
  }
}

TEST_F(CsgRendererTest, SurfacesHaveTheColorOfTheCutterThatLeftThem) {
  CsgRenderer renderer = this->renderer(box_blank(kBox));
  const SweptMove moves[] = {{Vec3(15, 22, -5), Vec3(15, 22, -5), kFlat},
                             {Vec3(45, 22, -5), Vec3(45, 22, -5), kBull}};
  renderer.append(moves);
  draw(&renderer, view_from(StandardView::kTop, false));
  const Picture picture = renderer.read();
  const auto tint = [&picture](int x) {  // blue less red
    const auto i = static_cast<std::size_t>(3 * (60 * 160 + x));
    return static_cast<int>(picture.rgb[i + 2]) - static_cast<int>(picture.rgb[i]);
  };
  EXPECT_GT(tint(45), 20);             // bluish: 0xd09060 is blue, green, red
  EXPECT_LT(std::abs(tint(115)), 10);  // green
  EXPECT_LT(std::abs(tint(80)), 25);   // the blank
}

TEST_F(CsgRendererTest, TheEyeMayStandInACut) {
  const TestBlank blank = box();
  CsgRenderer renderer = this->renderer(blank.drawn);
  const std::vector<SweptMove> moves{{Vec3(30, -10, -12), Vec3(30, 60, -12), kBull}};
  renderer.append(moves);
  // From within the slot, along it, a little down.
  const Vec3 eye(30, 8, -5);
  const Vec3 back = glm::normalize(Vec3(0, -1, 0.3));
  const Vec3 right(1, 0, 0);
  const Vec3 up = glm::cross(back, right);
  glm::dmat4 view(1.0), clip(0.0);
  for (int k = 0; k < 3; ++k) {
    view[k][0] = right[k];
    view[k][1] = up[k];
    view[k][2] = back[k];
  }
  view[3] = glm::dvec4(-glm::dot(right, eye), -glm::dot(up, eye), -glm::dot(back, eye), 1.0);
  const double near_mm = 0.5, far_mm = 120.0;
  clip[0][0] = 1.5;
  clip[1][1] = 2.0;
  clip[2][2] = -(far_mm + near_mm) / (far_mm - near_mm);
  clip[2][3] = -1.0;
  clip[3][2] = -2.0 * far_mm * near_mm / (far_mm - near_mm);
  const Projection projection{glm::mat4(clip * view), glm::mat4(view), kSize_px};
  draw(&renderer, projection);
  keep_picture(renderer, "inside");
  const Comparison found =
      compare(renderer.read_depth(), RayPicture(blank, moves, projection), projection);
  EXPECT_GT(found.pixels, 10000);
  EXPECT_EQ(found.wrong_pixels, 0) << "of " << found.pixels;
  EXPECT_LT(found.rim_pixels, found.pixels / 20);
}

TEST_F(CsgRendererTest, DrawsWithoutBlankWithoutMovesAndOnOnePixel) {
  Result<CsgRenderer> empty = CsgRenderer::create({});
  ASSERT_TRUE(empty) << empty.error();
  const Projection projection = view_from(StandardView::kIsometric, true);
  draw(&*empty, projection);
  const DepthPicture nothing = empty->read_depth();
  EXPECT_EQ(std::count(nothing.depths.begin(), nothing.depths.end(), 1.0f), 160 * 120);

  CsgRenderer renderer = this->renderer(box_blank(kBox));
  draw(&renderer, projection);
  const DepthPicture before = renderer.read_depth();
  EXPECT_LT(std::count(before.depths.begin(), before.depths.end(), 1.0f), 160 * 90);
  const SweptMove slot{Vec3(10, 22, -7.5), Vec3(50, 22, -7.5), kFlat};
  renderer.append(std::span(&slot, 1));
  draw(&renderer, projection);
  EXPECT_NE(renderer.read_depth().depths, before.depths);
  renderer.clear_moves();
  draw(&renderer, projection);
  EXPECT_EQ(renderer.read_depth().depths, before.depths);
  Projection one = projection;
  one.size_px = {1, 1};
  draw(&renderer, one);
  EXPECT_EQ(renderer.read().rgb.size(), 3u);
  one.size_px = {1 << 20, 4};
  const Done too_large = renderer.draw(one);
  ASSERT_FALSE(too_large);
  EXPECT_NE(too_large.error().find("the picture has 1048576 x 4"), std::string::npos);
}

TEST_F(CsgRendererTest, FaultsAreNamedAndChangeNothing) {
  EXPECT_EQ(CsgRenderer::create({0.0}).error(),
            "a tolerance of 0 mm is not allowed for the CSG view; must be above 0");
  CsgRenderer renderer = this->renderer(box_blank(kBox));
  CsgBlank open = box_blank(kBox);
  open.mesh.triangles.pop_back();
  EXPECT_FALSE(renderer.set_blank(open));
  std::vector<CsgTool> tools = test_tools();
  tools[2].shape.cutter = {{0, 0}};
  EXPECT_EQ(renderer.set_tools(tools).error(),
            "tool 2: the outline of the cutter has 1 points; it needs at least two");
  draw(&renderer, view_from(StandardView::kTop, false));
  EXPECT_LT(renderer.read_depth().depths[60 * 160 + 80], 1.0f);
}

}  // namespace
}  // namespace kerf
