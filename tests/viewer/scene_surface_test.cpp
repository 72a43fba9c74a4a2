// What the workpiece's surface shows: sections, colours, what is seen through it.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <optional>
#include <random>
#include <set>

#include "tests/viewer/scene_fixture.h"

namespace kerf {
namespace {

constexpr Box kBlock{Vec3(0, 0, -20), Vec3(40, 40, 0)};
constexpr Box kHollow{Vec3(10, 10, -15), Vec3(30, 30, -5)};

bool inside(const Box& box, const Vec3& p, double margin_mm) {
  for (int axis = 0; axis < 3; ++axis) {
    if (p[axis] < box.min[axis] - margin_mm || p[axis] > box.max[axis] + margin_mm) return false;
  }
  return true;
}

SceneUpdate update_of(MeshPatch patch, const Box& bounds) {
  SceneSetup setup;
  setup.bounds_mm = bounds;
  SceneUpdate update;
  update.setup = std::make_shared<const SceneSetup>(std::move(setup));
  update.patches = {std::make_shared<const MeshPatch>(std::move(patch))};
  return update;
}

/// A block with a hollow inside, cut open.
class Section : public SceneRendererTest, public testing::WithParamInterface<bool> {};

TEST_P(Section, ShowsItsFaceWhereThePlaneGoesThroughMaterial) {
  camera_.set_perspective(GetParam());
  MeshPatch patch;
  add_box(&patch, kBlock);
  add_box(&patch, kHollow, true);
  SceneRenderer scene = renderer();
  scene.apply(update_of(patch, kBlock));
  const Projection projection = view_of(scene);
  DrawOptions options = everything_;
  // Away goes what lies before 2 y + x = 60, an askew plane; the normal need not be of unit length.
  options.section = SectionPlane{Vec3(-1, -2, 0), -60.0};
  draw(&scene, projection, options);
  std::mt19937 random(5);
  std::uniform_real_distribution<double> x_mm(-5, 45), z_mm(-25, 5);
  int on_face = 0, in_hollow = 0, beside = 0;
  for (int i = 0; i < 400; ++i) {
    Vec3 p{x_mm(random), 0.0, z_mm(random)};
    p.y = (60.0 - p.x) / 2.0;
    const bool is_material = inside(kBlock, p, -0.6) && !inside(kHollow, p, 0.6);
    const bool is_air = !inside(kBlock, p, 0.6) || inside(kHollow, p, -0.6);
    if (!is_material && !is_air) continue;  // within pixels of an edge
    const std::optional<Vec3> found = scene.pick(pixel_of(projection, p));
    SCOPED_TRACE(testing::Message() << p.x << " " << p.y << " " << p.z);
    if (is_material) {
      ASSERT_TRUE(found);
      // Pixels are a quarter of a millimetre; the plane itself is met much more closely.
      EXPECT_NEAR(found->x + 2.0 * found->y, 60.0, 2e-3);
      EXPECT_NEAR(found->x, p.x, 0.4);
      EXPECT_NEAR(found->z, p.z, 0.4);
      ++on_face;
    } else if (inside(kHollow, p, 0.0)) {
      ASSERT_TRUE(found);
      // Floor or sides of the hollow, behind the plane.
      EXPECT_GT(found->x + 2.0 * found->y, 60.0 + 0.1);
      EXPECT_TRUE(inside(kHollow, *found, 0.01));
      ++in_hollow;
    } else {
      // Past the block, or onto its top behind the plane: never onto the face.
      EXPECT_TRUE(!found || found->x + 2.0 * found->y > 60.0 + 0.1);
      ++beside;
    }
  }
  EXPECT_GT(on_face, 40);
  EXPECT_GT(in_hollow, 10);
  EXPECT_GT(beside, 40);
}

TEST_P(Section, FromItsFarSideOnlyTheCutAwayPartIsMissing) {
  camera_.set_perspective(GetParam());
  MeshPatch patch;
  add_box(&patch, kBlock);
  SceneRenderer scene = renderer();
  scene.apply(update_of(patch, kBlock));
  const Projection projection = view_of(scene);
  DrawOptions options = everything_;
  draw(&scene, projection, options);
  const Picture whole = scene.read();
  options.section = SectionPlane{Vec3(0, 1, 0), 20.0};  // the half behind goes
  draw(&scene, projection, options);
  const Picture half = scene.read();
  const Vec3 kept(20, 5, 0), gone(20, 35, 0);
  EXPECT_EQ(at(whole, pixel_of(projection, kept)), at(half, pixel_of(projection, kept)));
  EXPECT_NE(at(whole, pixel_of(projection, gone)), at(half, pixel_of(projection, gone)));
  EXPECT_FALSE(scene.pick(pixel_of(projection, gone)));
  options.section->normal = Vec3(0.0);  // no direction: no section
  draw(&scene, projection, options);
  EXPECT_EQ(differing_pixels(scene.read(), whole), 0);
}

/// Away goes what lies before y 20 and to the right of x 20; both faces show, and no more of the
/// block is away than that.
TEST_P(Section, OfAQuarterShowsBothFaces) {
  camera_.set_perspective(GetParam());
  MeshPatch patch;
  add_box(&patch, kBlock);
  SceneRenderer scene = renderer();
  scene.apply(update_of(patch, kBlock));
  camera_.look_from(-0.7, 0.3);  // of the eye: from the front, the right and above
  const Projection projection = view_of(scene);
  DrawOptions options = everything_;
  options.section = SectionPlane{Vec3(0, -1, 0), -20.0};
  options.section_beside = SectionPlane{Vec3(2, 0, 0), 40.0};
  draw(&scene, projection, options);
  std::mt19937 random(7);
  std::uniform_real_distribution<double> along(20.6, 39.4), down(-19.4, -0.6);
  const auto expect_at = [&](const Vec3& p) {
    const std::optional<Vec3> found = scene.pick(pixel_of(projection, p));
    ASSERT_TRUE(found);
    EXPECT_LT(glm::distance(*found, p), 0.6) << p.x << ' ' << p.y << ' ' << p.z;
  };
  for (int i = 0; i < 100; ++i) {
    const double a = along(random), z = down(random);
    expect_at({a, 20, z});                   // of the first plane
    expect_at({20, 40 - a, z});              // of the second one
    expect_at({40 - a, 0, z});               // what is left of the front
    expect_at({a, 40 - 0.5 * (a - 20), 0});  // and of the top
  }
}

/// From behind, the quarter that is away is not seen at all.
TEST_P(Section, OfAQuarterIsNotSeenFromBehind) {
  camera_.set_perspective(GetParam());
  MeshPatch patch;
  add_box(&patch, kBlock);
  SceneRenderer scene = renderer();
  scene.apply(update_of(patch, kBlock));
  camera_.look_from(2.3, -0.3);
  const Projection projection = view_of(scene);
  draw(&scene, projection, everything_);
  const Picture whole = scene.read();
  DrawOptions options = everything_;
  options.section = SectionPlane{Vec3(0, -1, 0), -20.0};
  options.section_beside = SectionPlane{Vec3(1, 0, 0), 20.0};
  draw(&scene, projection, options);
  for (const Vec3& p : {Vec3(10, 40, -10), Vec3(0, 30, -10), Vec3(10, 30, -20)})
    EXPECT_EQ(at(whole, pixel_of(projection, p)), at(scene.read(), pixel_of(projection, p)));
}

INSTANTIATE_TEST_SUITE_P(Views, Section, testing::Bool());

TEST(UsualSection, GoesThroughTheMiddle) {
  const auto half = usual_section(SectionKind::kHalf, kBlock, Standing::kOnTable);
  ASSERT_TRUE(half);
  EXPECT_EQ(half->plane, (SectionPlane{Vec3(0, -1, 0), -20.0}));
  EXPECT_FALSE(half->beside);
  const Box bar{Vec3(-20, -20, -60), Vec3(20, 20, 0)};
  const auto quarter = usual_section(SectionKind::kQuarter, bar, Standing::kInLathe);
  ASSERT_TRUE(quarter && quarter->beside);
  EXPECT_EQ(quarter->plane, (SectionPlane{Vec3(0, 1, 0), 0.0}));
  EXPECT_EQ(*quarter->beside, (SectionPlane{Vec3(1, 0, 0), 0.0}));
  EXPECT_FALSE(usual_section(SectionKind::kNone, bar, Standing::kInLathe));
  EXPECT_FALSE(usual_section(SectionKind::kHalf, Box{}, Standing::kInLathe));
}

TEST_F(SceneRendererTest, ASectionCutsNeitherPathNorTool) {
  MeshPatch patch;
  add_box(&patch, kBlock);
  SceneRenderer scene = renderer();
  SceneUpdate update = update_of(patch, kBlock);
  update.tool_shape = test_tool(3.0f);
  update.path = path_chunks(
      {PathVertex{{0, 5, 3}, PathKind::kFeed}, PathVertex{{40, 5, 3}, PathKind::kFeed}});
  Moment moment;
  moment.tool_pose = ToolPose{Vec3(20, 5, 3)};
  update.moment = std::make_shared<const Moment>(moment);
  scene.apply(update);
  const Projection projection = view_of(scene);
  DrawOptions options = everything_;
  options.section = SectionPlane{Vec3(0, -1, 0), -20.0};
  options.looks[static_cast<std::size_t>(SceneObject::kFeeds)].is_visible = false;
  options.looks[static_cast<std::size_t>(SceneObject::kCutter)].is_visible = false;
  draw(&scene, projection, options);
  const Picture without = scene.read();
  options.looks[static_cast<std::size_t>(SceneObject::kFeeds)].is_visible = true;
  draw(&scene, projection, options);
  const Picture with_path = scene.read();
  EXPECT_GT(differing_pixels(without, with_path), 60);
  options.looks[static_cast<std::size_t>(SceneObject::kCutter)].is_visible = true;
  draw(&scene, projection, options);
  EXPECT_GT(differing_pixels(with_path, scene.read()), 300);
}

/// Squares of 10 mm side by side, four corners each: square k by moves[k], in the plane z = 0.
MeshPatch squares(const std::vector<std::uint32_t>& moves) {
  MeshPatch patch;
  for (std::size_t k = 0; k < moves.size(); ++k) {
    const auto x = 10.0f * static_cast<float>(k);
    const auto first = static_cast<std::uint32_t>(patch.vertices.size());
    for (const glm::vec3& p : {glm::vec3(x, 0, 0), glm::vec3(x + 10, 0, 0),
                               glm::vec3(x + 10, 10, 0), glm::vec3(x, 10, 0)}) {
      patch.vertices.push_back({p, pack_normal({0, 0, 1})});
      patch.cut_by.push_back(moves[k]);
    }
    for (const std::uint32_t corner : {0u, 1u, 2u, 0u, 2u, 3u}) {
      patch.indices.push_back(first + corner);
    }
  }
  patch.skirt_begin = static_cast<std::uint32_t>(patch.indices.size());
  return patch;
}

SceneUpdate colors_update(ColorBy mode, std::vector<std::uint32_t> of_move,
                          bool is_of_path = false) {
  CutColors colors;
  colors.is_of_path = is_of_path;
  colors.mode = mode;
  colors.of_move = std::move(of_move);
  colors.other = 0xff00ffff;    // yellow
  colors.not_cut = 0xffffffff;  // white
  colors.legend = {{0xff0000ff, "T1 flat 10"}};
  SceneUpdate update;
  update.colors = std::make_shared<const CutColors>(std::move(colors));
  return update;
}

enum class Tone { kRed, kGreen, kBlue, kYellow, kGrey };

Tone tone_of(const Color& c) {
  const int strong = std::max({c.r, c.g, c.b}) - 40;
  if (c.r > strong && c.g > strong && c.b > strong) return Tone::kGrey;
  if (c.r > strong && c.g > strong) return Tone::kYellow;
  return c.r > strong ? Tone::kRed : c.g > strong ? Tone::kGreen : Tone::kBlue;
}

class SurfaceColorsTest : public SceneRendererTest {
 protected:
  Projection top_view(const SceneRenderer& scene) {
    camera_.set_perspective(false);
    camera_.look_from(StandardView::kTop);
    return view_of(scene);
  }
};

TEST_F(SurfaceColorsTest, AreThoseOfTheMoves) {
  const MeshPatch patch = squares({0, 1, 2, 70000, MeshPatch::kNotCut, 1'000'000});
  SceneRenderer scene = renderer();
  scene.apply(update_of(patch, {Vec3(0, 0, -5), Vec3(60, 10, 0)}));
  std::vector<std::uint32_t> of_move(70001, 0xffff0000);
  of_move[0] = 0xff0000ff;
  of_move[1] = 0xff00ff00;
  of_move[70000] = 0xff00ff00;
  scene.apply(colors_update(ColorBy::kTool, of_move));
  const Projection projection = top_view(scene);
  DrawOptions options = everything_;
  options.color_by = ColorBy::kTool;
  draw(&scene, projection, options);
  const Picture picture = scene.read();
  const std::vector<Tone> expected{Tone::kRed,   Tone::kGreen, Tone::kBlue,
                                   Tone::kGreen, Tone::kGrey,  Tone::kYellow};
  for (std::size_t k = 0; k < expected.size(); ++k) {
    for (const double x : {0.5, 5.0, 9.5}) {
      const Vec3 p(10.0 * static_cast<double>(k) + x, 5, 0);
      EXPECT_EQ(tone_of(at(picture, pixel_of(projection, p))), expected[k]) << k << " " << x;
    }
  }
  ASSERT_EQ(scene.legend().size(), 1u);
  EXPECT_EQ(scene.legend()[0].text, "T1 flat 10");
}

/// Two feeds of moves 0 and 1 above six squares that move 0 has cut, and a traverse.
TEST_F(SurfaceColorsTest, AreThoseOfThePathWhereThatIsWanted) {
  const std::vector<PathVertex> path{
      PathVertex{{0, 5, 1}, PathKind::kTraverse, 0}, PathVertex{{30, 5, 1}, PathKind::kFeed, 0},
      PathVertex{{60, 5, 1}, PathKind::kFeed, 1}, PathVertex{{60, 25, 1}, PathKind::kTraverse, 1}};
  SceneRenderer scene = renderer();
  SceneUpdate update = update_of(squares({2, 2, 2, 2, 2, 2}), {Vec3(0, 0, -5), Vec3(60, 30, 1)});
  update.path = path_chunks(path);
  scene.apply(update);
  scene.apply(moment_update(Vec3(500, 500, 500), path.size()));
  Projection projection = top_view(scene);
  DrawOptions options = everything_;
  options.color_by = ColorBy::kTool;
  draw(&scene, projection, options);
  const Picture plain = scene.read();
  const auto tones_near = [&](const Picture& picture, const Vec3& point) {
    std::set<Tone> tones;
    const glm::ivec2 middle = pixel_of(projection, point);
    for (int y = -2; y <= 2; ++y) tones.insert(tone_of(at(picture, {middle.x, middle.y + y})));
    return tones;
  };
  const Vec3 first(15, 5, 1), second(45, 5, 1), beside(15, 9, 0);
  // Colours of whoever has no numbers for the path are for the surface alone.
  options.color_on = ColorTarget::kPath;
  scene.apply(colors_update(ColorBy::kTool, {0xff0000ff, 0xff00ff00, 0xffff0000}));
  draw(&scene, projection, options);
  EXPECT_FALSE(tones_near(scene.read(), first).contains(Tone::kRed));
  for (const float line_px : {1.0f, 3.0f}) {  // OpenGL's own lines, and wide ones
    projection.line_px = line_px;
    scene.apply(colors_update(ColorBy::kTool, {0xff0000ff, 0xff00ff00, 0xffff0000}, true));
    for (const ColorTarget target :
         {ColorTarget::kSurface, ColorTarget::kBoth, ColorTarget::kPath}) {
      options.color_on = target;
      draw(&scene, projection, options);
      const Picture picture = scene.read();
      const bool has_path = target != ColorTarget::kSurface;
      const Tone surface = target == ColorTarget::kPath ? Tone::kGrey : Tone::kBlue;
      EXPECT_EQ(tones_near(picture, first).contains(Tone::kRed), has_path) << line_px;
      EXPECT_EQ(tones_near(picture, second).contains(Tone::kGreen), has_path) << line_px;
      EXPECT_EQ(tone_of(at(picture, pixel_of(projection, beside))), surface) << line_px;
      EXPECT_EQ(scene.legend().size(), 1u);
    }
  }
  // What is still to come is paler; the tail of the path is coloured as well.
  projection.line_px = 1.0f;
  scene.apply(moment_update(Vec3(500, 500, 500), 0));
  draw(&scene, projection, options);
  EXPECT_FALSE(tones_near(scene.read(), first).contains(Tone::kBlue));
  EXPECT_GT(differing_pixels(plain, scene.read()), 20);
  scene.apply(moment_update(Vec3(500, 500, 500), path.size()));
  options.path_tail = 3;
  draw(&scene, projection, options);
  EXPECT_TRUE(tones_near(scene.read(), second).contains(Tone::kGreen));
}

/// A straight path of many moves would be drawn as one line.
TEST_F(SurfaceColorsTest, OfAStraightPathNoMoveIsLeftOut) {
  std::vector<PathVertex> path{PathVertex{{0, 5, 1}, PathKind::kTraverse, 0}};
  for (std::uint32_t i = 1; i <= 2 * kPathChunkSegments; ++i) {
    const float x = 60.0f * static_cast<float>(i) / (2 * kPathChunkSegments);
    path.push_back(PathVertex{{x, 5, 1}, PathKind::kFeed, i / 512 % 2});
  }
  SceneRenderer scene = renderer();
  SceneUpdate update = update_of(squares({2, 2, 2, 2, 2, 2}), {Vec3(0, 0, -5), Vec3(60, 30, 1)});
  update.path = path_chunks(path);
  scene.apply(update);
  scene.apply(moment_update(Vec3(500, 500, 500), path.size()));
  scene.apply(colors_update(ColorBy::kTool, {0xff0000ff, 0xff00ff00, 0xffff0000}, true));
  const Projection projection = top_view(scene);
  DrawOptions options = everything_;
  options.color_by = ColorBy::kTool;
  options.color_on = ColorTarget::kPath;
  draw(&scene, projection, options);
  const Picture picture = scene.read();
  int changes = 0;
  std::optional<Tone> before;
  for (double x = 1; x < 59; x += 0.1) {
    const glm::ivec2 middle = pixel_of(projection, Vec3(x, 5, 1));
    for (int y = -1; y <= 1; ++y) {
      const Tone tone = tone_of(at(picture, {middle.x, middle.y + y}));
      if (tone != Tone::kRed && tone != Tone::kGreen) continue;
      changes += before && *before != tone ? 1 : 0;
      before = tone;
      break;
    }
  }
  EXPECT_EQ(changes, 15) << "each 512 of 8192 moves another colour";
}

TEST_F(SurfaceColorsTest, ATriangleHasOneColorEvenBetweenMoves) {
  // A strip whose corners were cut by different moves: no mixture may appear.
  MeshPatch patch = squares({0, 0, 0});
  for (std::size_t v = 0; v < patch.cut_by.size(); ++v) patch.cut_by[v] = v % 2 == 0 ? 0 : 1;
  SceneRenderer scene = renderer();
  scene.apply(update_of(patch, {Vec3(0, 0, -5), Vec3(30, 10, 0)}));
  scene.apply(colors_update(ColorBy::kTool, {0xff0000ff, 0xff00ff00}));
  const Projection projection = top_view(scene);
  DrawOptions options = everything_;
  options.color_by = ColorBy::kTool;
  draw(&scene, projection, options);
  std::set<Color> found;
  const Picture picture = scene.read();
  for (double x = 0.5; x < 30.0; x += 0.25) {
    for (double y = 0.5; y < 10.0; y += 0.25) {
      found.insert(at(picture, pixel_of(projection, Vec3(x, y, 0))));
    }
  }
  EXPECT_LE(found.size(), 2u);
}

TEST_F(SurfaceColorsTest, AWallHasTheColorOfWhatLiesBelow) {
  // Seen from the front: a wall from a top that nobody cut down to a floor of move 1.
  MeshPatch patch;
  for (const glm::vec3& p :
       {glm::vec3(0, 0, 0), glm::vec3(0, 0, -10), glm::vec3(20, 0, -10), glm::vec3(20, 0, 0)}) {
    patch.vertices.push_back({p, pack_normal({0, -1, 0})});
    patch.cut_by.push_back(p.z < 0 ? 1 : MeshPatch::kNotCut);
  }
  for (int turn = 0; turn < 3; ++turn) {
    patch.indices.clear();
    for (const std::uint32_t corner : {0u, 1u, 2u}) {
      patch.indices.push_back((corner + static_cast<std::uint32_t>(turn)) % 3);
    }
    const std::uint32_t second[] = {0, 2, 3};
    for (int corner = 0; corner < 3; ++corner) patch.indices.push_back(second[(corner + turn) % 3]);
    patch.skirt_begin = 6;
    SceneRenderer scene = renderer();
    scene.apply(update_of(patch, {Vec3(0, 0, -10), Vec3(20, 1, 0)}));
    scene.apply(colors_update(ColorBy::kTool, {0xff0000ff, 0xff00ff00}));
    camera_.set_perspective(false);
    camera_.look_from(StandardView::kFront);
    const Projection projection = view_of(scene);
    DrawOptions options = everything_;
    options.color_by = ColorBy::kTool;
    draw(&scene, projection, options);
    for (const Vec3& p : {Vec3(1, 0, -1), Vec3(19, 0, -1), Vec3(10, 0, -9), Vec3(1, 0, -9)}) {
      EXPECT_EQ(tone_of(at(scene.read(), pixel_of(projection, p))), Tone::kGreen) << turn;
    }
  }
}

TEST_F(SurfaceColorsTest, ChangingThemRedrawsOnceAndUploadsNoPatch) {
  TestWorkpiece workpiece(200, 170);
  SceneRenderer scene = renderer();
  scene.apply(first_update(&workpiece));
  scene.apply(update_of(squares({0, 1}), {Vec3(0, 0, -5), Vec3(200, 170, 0)}));
  const Projection projection = view_of(scene);
  DrawOptions options = everything_;
  draw(&scene, projection, options);
  const Picture plain = scene.read();
  const std::uint64_t uploaded = scene.counters().uploaded_bytes;
  scene.apply(colors_update(ColorBy::kRemovalRate, {0xff0000ff, 0xff00ff00}));
  draw(&scene, projection, options);
  EXPECT_EQ(scene.counters().full.frames, 1u) << "colours that are not shown";
  options.color_by = ColorBy::kRemovalRate;
  draw(&scene, projection, options);
  const Picture colored = scene.read();
  EXPECT_GT(differing_pixels(plain, colored), 10);
  scene.apply(colors_update(ColorBy::kRemovalRate, {0xffff0000, 0xff00ff00}));
  draw(&scene, projection, options);
  EXPECT_GT(differing_pixels(scene.read(), colored), 10);
  draw(&scene, projection, options);
  EXPECT_EQ(scene.counters().full.frames, 3u);
  EXPECT_EQ(scene.counters().uploaded_bytes, uploaded);
  options.color_by = ColorBy::kTool;  // of which nothing is known
  draw(&scene, projection, options);
  EXPECT_EQ(differing_pixels(scene.read(), plain), 0);
  EXPECT_TRUE(scene.legend().empty());
}

TEST_F(SurfaceColorsTest, PatchesWithoutMovesArePlainAndTakeNoMemory) {
  MeshPatch with = squares({0, 1}), without = with;
  without.cut_by.clear();
  const Box bounds{Vec3(0, 0, -5), Vec3(20, 10, 0)};
  SceneRenderer a = renderer(), b = renderer();
  a.apply(update_of(with, bounds));
  b.apply(update_of(without, bounds));
  for (SceneRenderer* scene : {&a, &b}) {
    scene->apply(colors_update(ColorBy::kTool, {0xff0000ff, 0xff00ff00}));
  }
  const Projection projection = top_view(a);
  draw(&a, projection, everything_);
  DrawOptions options = everything_;
  options.color_by = ColorBy::kTool;
  draw(&b, projection, options);
  EXPECT_EQ(differing_pixels(a.read(), b.read()), 0);
  EXPECT_EQ(a.counters().gpu_bytes, b.counters().gpu_bytes + 8 * sizeof(std::uint32_t));
  // Of the same version, but now with moves: that is news.
  b.apply(update_of(with, bounds));
  draw(&b, projection, options);
  EXPECT_GT(differing_pixels(a.read(), b.read()), 1000);
}

TEST_F(SurfaceColorsTest, PlainlyWhatIsLeftOfTheBlankIsDarker) {
  SceneRenderer scene = renderer();
  scene.apply(update_of(squares({7, MeshPatch::kNotCut}), {Vec3(0, 0, -5), Vec3(20, 10, 0)}));
  const Projection projection = top_view(scene);
  draw(&scene, projection, everything_);
  const Picture picture = scene.read();
  const Color cut = at(picture, pixel_of(projection, Vec3(5, 5, 0)));
  const Color blank = at(picture, pixel_of(projection, Vec3(15, 5, 0)));
  EXPECT_GT(cut.g, blank.g + 15);
  EXPECT_EQ(tone_of(blank), Tone::kGrey);
}

TEST_F(SurfaceColorsTest, DeviationsAreRedWhereTooMuchIsGone) {
  MeshPatch patch = squares({0, 0, 0, 0, 0});
  patch.cut_by.clear();
  const float deviations[] = {-0.3f, -0.011f, 0.009f, 0.011f, 0.3f};
  for (const float deviation : deviations)
    patch.deviation_mm.insert(patch.deviation_mm.end(), 4, deviation);
  SceneRenderer scene = renderer();
  scene.apply(update_of(patch, {Vec3(0, 0, -5), Vec3(50, 10, 0)}));
  const Projection projection = top_view(scene);
  DrawOptions options = everything_;
  options.color_by = ColorBy::kDeviation;
  options.tolerance_mm = 0.01;
  draw(&scene, projection, options);
  const Picture picture = scene.read();
  const auto square = [&](double k) {
    return at(picture, pixel_of(projection, Vec3(10 * k + 5, 5, 0)));
  };
  EXPECT_EQ(tone_of(square(0)), Tone::kRed);
  EXPECT_GT(square(1).r, square(1).b + 40);
  EXPECT_EQ(tone_of(square(2)), Tone::kGreen);
  EXPECT_GT(square(3).b, square(3).r + 40);
  EXPECT_EQ(tone_of(square(4)), Tone::kBlue);
  const std::vector<ColorLegendEntry> legend = scene.legend();
  ASSERT_EQ(legend.size(), 5u);
  EXPECT_EQ(legend[0].text, "< -0.020 mm");
  EXPECT_EQ(legend[1].text, "-0.010 mm");
  EXPECT_EQ(legend[2].text, "0 mm");
  EXPECT_EQ(legend[3].text, "+0.010 mm");
  EXPECT_EQ(legend[4].text, "> +0.020 mm");
}

TEST_F(SurfaceColorsTest, HeightsGoFromDarkToBright) {
  TestWorkpiece workpiece(100, 100);
  workpiece.dent(50, 50, 38, 37);
  SceneRenderer scene = renderer();
  scene.apply(first_update(&workpiece));
  const Projection projection = top_view(scene);
  DrawOptions options = everything_;
  options.color_by = ColorBy::kHeight;
  options.looks[static_cast<std::size_t>(SceneObject::kFeeds)].is_visible = false;
  draw(&scene, projection, options);
  const Picture picture = scene.read();
  const Color top = at(picture, pixel_of(projection, Vec3(90, 50, 0)));
  const Color bottom = at(picture, pixel_of(projection, Vec3(50, 50, -37)));
  EXPECT_GT(top.r + top.g, bottom.r + bottom.g + 150);
  EXPECT_GT(bottom.b, bottom.r + 30);
  const std::vector<ColorLegendEntry> legend = scene.legend();
  ASSERT_EQ(legend.size(), 5u);
  EXPECT_EQ(legend.front().text, "-40 mm");
  EXPECT_EQ(legend.back().text, "0 mm");
}

TEST_F(SceneRendererTest, ATransparentWorkpieceShowsWhatIsInIt) {
  MeshPatch patch;
  add_box(&patch, kBlock);
  SceneRenderer scene = renderer();
  SceneUpdate update = update_of(patch, kBlock);
  update.tool_shape = test_tool(4.0f);
  Moment moment;
  moment.tool_pose = ToolPose{Vec3(20, 20, -10)};
  update.moment = std::make_shared<const Moment>(moment);
  scene.apply(update);
  camera_.set_perspective(false);
  camera_.look_from(StandardView::kFront);
  const Projection projection = view_of(scene);
  const glm::ivec2 in_block = pixel_of(projection, Vec3(20, 0, -6));
  const glm::ivec2 above = pixel_of(projection, Vec3(20, 0, 2));
  const auto seen = [&](float workpiece, float cutter) {
    DrawOptions options = everything_;
    options.looks[static_cast<std::size_t>(SceneObject::kWorkpiece)] = {workpiece > 0.0f,
                                                                        workpiece};
    options.looks[static_cast<std::size_t>(SceneObject::kCutter)] = {cutter > 0.0f, cutter};
    draw(&scene, view_of(scene), options);  // the depth range follows the tool
    return scene.read();
  };
  const Picture solid = seen(1.0f, 1.0f), glass = seen(0.25f, 1.0f), tool = seen(0.0f, 1.0f);
  EXPECT_EQ(at(solid, above), at(glass, above));
  const auto mixed = [](const Color& a, const Color& b, double share_of_a) {
    const auto mix = [&](int x, int y) {
      return static_cast<int>(std::lround(share_of_a * x + (1.0 - share_of_a) * y));
    };
    return Color{mix(a.r, b.r), mix(a.g, b.g), mix(a.b, b.b)};
  };
  const auto near = [](const Color& a, const Color& b) {
    return std::abs(a.r - b.r) <= 1 && std::abs(a.g - b.g) <= 1 && std::abs(a.b - b.b) <= 1;
  };
  // One surface lies over it, not the back of the block as well.
  EXPECT_TRUE(near(at(glass, in_block), mixed(at(solid, in_block), at(tool, in_block), 0.25)));
  // A cutter that is transparent too, behind the surface and before it (moved out of the block).
  const Picture both = seen(0.25f, 0.5f), faint = seen(0.0f, 0.5f);
  EXPECT_TRUE(near(at(both, in_block), mixed(at(solid, in_block), at(faint, in_block), 0.25)));
  scene.apply(moment_update(Vec3(20, -20, -10), 0));
  const Picture before = seen(0.25f, 0.5f), opaque_tool = seen(0.0f, 1.0f),
                block = seen(0.25f, 0.0f);
  EXPECT_TRUE(
      near(at(before, in_block), mixed(at(opaque_tool, in_block), at(block, in_block), 0.5)));
  // What is pointed at is the surface, transparent or not.
  seen(0.25f, 0.0f);
  const std::optional<Vec3> found = scene.pick(in_block);
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->y, 0.0, 1e-3);
}

TEST_F(SceneRendererTest, LocalAndFullAgreeWithSectionAndColors) {
  std::mt19937 random(11);
  const auto share = [&random] { return std::uniform_real_distribution<double>(0, 1)(random); };
  TestWorkpiece workpiece(200, 170);
  SceneRenderer local = renderer(), full = renderer();
  const SceneUpdate first = first_update(&workpiece);
  for (SceneRenderer* scene : {&local, &full}) {
    scene->apply(first);
    SceneUpdate machine;
    machine.machine = box_machine({{{-20, -20, 0}, {20, 20, 60}}, {{0, 0, -60}, {200, 170, -45}}});
    scene->apply(machine);
  }
  DrawOptions options = everything_;
  options.color_by = ColorBy::kHeight;
  options.section = SectionPlane{Vec3(-1, -2, 0.3), -150.0};
  options.looks[static_cast<std::size_t>(SceneObject::kMachine)].opacity = 0.4f;
  const Projection projection = view_of(local);
  for (int step = 0; step < 12; ++step) {
    const Vec3 tip(200 * share(), 170 * share(), -1.0 - 3.0 * share());
    workpiece.dent(tip.x, tip.y, 4 + 6 * share(), 1 + 4 * share());
    Moment moment;
    moment.tool_pose = ToolPose{tip};
    glm::mat4 head(1.0f);
    head[3] = glm::vec4(glm::vec3(tip) + glm::vec3(0, 0, 70), 1.0f);
    moment.link_poses = {head, glm::mat4(1.0f)};
    SceneUpdate update;
    update.moment = std::make_shared<const Moment>(moment);
    update.patches = workpiece.take_patches();
    if (step == 6) options.looks[0].opacity = 0.5f;
    DrawOptions full_options = options;
    full_options.is_local = false;
    local.apply(update);
    full.apply(update);
    draw(&local, projection, options);
    draw(&full, projection, full_options);
    ASSERT_EQ(differing_pixels(local.read(), full.read()), 0) << "step " << step;
  }
  EXPECT_EQ(local.counters().full.frames, 2u);
}

}  // namespace
}  // namespace kerf
