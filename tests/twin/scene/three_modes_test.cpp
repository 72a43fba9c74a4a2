// The three draw modes to a picture, against each other: the mesh of the Z-map by OpenGL, rays at
// its heights, and the blank minus the moves, which knows nothing of cells.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <iostream>
#include <random>

#include "stock/zmap/zmap.h"
#include "tests/twin/playback/tracks.h"
#include "tests/viewer/csg/depth_values.h"
#include "twin/scene/frame_moves.h"
#include "twin/scene/frame_writer.h"
#include "viewer/csg/csg_renderer.h"
#include "viewer/gl_context.h"
#include "viewer/raycast/ray_caster.h"
#include "viewer/window/scene_renderer.h"

namespace kerf {
namespace {

constexpr glm::ivec2 kSize_px{240, 180};
constexpr double kCell_mm = 0.05;
const Box kBlock{Vec3(0, 0, -8), Vec3(20, 20, 0)};

// Mesh and rays show one surface: rounding of positions to 32 bits and 24 bits of depth.
constexpr double kSameSurface_mm = 1e-3;
/// Pixels whose centre passes an edge so closely that rounding decides.
constexpr double kMostSilhouette = 0.01;
// The Z-map puts walls on the course of cells, and slopes half a cell aside of walls.
constexpr double kOneAndAHalfCells_mm = 1.5 * kCell_mm;
/// Of pixels that differ by more along the view: edges that lie part of a cell apart, and walls
/// seen so flatly that part of a cell aside is more than that along the view. At most 3.6 % (front,
/// a slot nearly along the view); shrinks with the cell, not with the tolerance of the prisms.
constexpr double kMostEdgeOn = 0.04;
/// Of those, pixels that do not lie between the depths beside them, either: slivers of walls and
/// ridges that one draw mode shows and the other does not. At most 0.05 %.
constexpr double kMostSliver = 0.001;

/// Of the pixels of lines: ends of those that a surface hides, which lies part of a cell elsewhere.
constexpr double kMostLinesAlone = 0.03;

ToolSources four_tools() {
  ToolSources sources;
  for (const char* text : {"1=flat:3", "2=ball:4", "3=bull:5:1.2", "4=vee:6:60"}) {
    sources.arguments.push_back(std::move(parse_tool_argument(text).value()));
  }
  return sources;
}

/// Level runs, ramps, plunges, level arcs and circles, helices; traverses above the block and,
/// seldom, into it; every tool.
std::vector<Motion> random_program(unsigned seed, int moves) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> place(-2, 22), depth(-6, 0.3), radius(0.3, 4);
  std::uniform_real_distribution<double> turn(-2 * kPi, 2 * kPi);
  MotionList program;
  Vec3 at{-4, 10, 5};
  program.at(at).tool(1 + static_cast<int>(seed % 4)).spindle(true);
  for (int i = 0; i < moves; ++i) {
    const unsigned kind = i == 0 ? 0 : random() % 12;
    if (kind < 2) {  // elsewhere, from above
      program.traverse({at.x, at.y, 5});
      if (random() % 2 == 0) program.tool(1 + static_cast<int>(random() % 4));
      at = {place(random), place(random), depth(random)};
      program.traverse({at.x, at.y, 5}).feed(at);
    } else if (kind < 5) {
      at = {place(random), place(random), at.z};
      program.feed(at);
    } else if (kind < 8) {
      at = {place(random), place(random), depth(random)};
      program.feed(at);
    } else if (kind == 8) {
      at.z = depth(random);
      program.feed(at);
    } else if (kind == 9) {
      at = {place(random), place(random), depth(random)};
      program.traverse(at);
    } else {
      const Vec3 center = at + Vec3{radius(random), 0, 0};
      const double angle = kind == 10 ? 2 * kPi : turn(random);
      const Vec3 arm = at - center;
      const Vec3 end = center + Vec3{arm.x * std::cos(angle), arm.x * std::sin(angle), 0};
      at = kind == 10 ? at : end;
      if (random() % 4 == 0) at.z = depth(random);
      program.arc(at, center, {0, 0, 1}, angle);
    }
  }
  program.traverse({at.x, at.y, 20});
  return program.list();
}

std::unique_ptr<ZMap> block() {
  ZMapOptions options;
  options.blank = parse_blank("box:0,0,-8:20,20,0").value();
  options.cell_mm = kCell_mm;
  return std::move(ZMap::create(options).value());
}

std::unique_ptr<ZMap> cut_by(std::span<const Motion> program) {
  std::unique_ptr<ZMap> stock = block();
  ToolResolver resolver(four_tools(), ZMap::can_cut);
  FindingLog log;
  CutStage stage(*stock, resolver, log, TimelineOptions{});
  stage.take(program);
  stage.finish();
  return stock;
}

struct NamedProjection {
  const char* name;
  Projection projection;
};

std::vector<NamedProjection> views(const Box& depth_box) {
  OrbitCamera camera;
  camera.fit(kBlock, kSize_px);
  std::vector<NamedProjection> views;
  views.push_back({"iso, perspective", camera.projection(depth_box, kSize_px)});
  camera.orbit({23, -11}, kSize_px);
  camera.fit(kBlock, kSize_px);
  views.push_back({"aslant, perspective", camera.projection(depth_box, kSize_px)});
  camera.set_perspective(false);
  camera.look_from(StandardView::kTop);
  camera.fit(kBlock, kSize_px);
  views.push_back({"top, orthographic", camera.projection(depth_box, kSize_px)});
  camera.look_from(StandardView::kFront);
  camera.fit(kBlock, kSize_px);
  // Fitted exactly, the top of the block lies in the rays of one row of pixels: hit or missed.
  camera.pan({0.31f, 0.37f}, kSize_px);
  views.push_back({"front, orthographic", camera.projection(depth_box, kSize_px)});
  return views;
}

/// Distances along the view, rows from the top; kNoDepth_mm on the background.
using Distances = std::vector<float>;

Distances distances(std::span<const float> depths, const Projection& projection) {
  return view_distances_mm({kSize_px.x, kSize_px.y, {depths.begin(), depths.end()}}, projection);
}

class Modes {
 public:
  Modes(const std::vector<Motion>& program, const ZMap& stock, SceneRenderer mesh, CsgRenderer csg)
      : mesh_(std::move(mesh)), csg_(std::move(csg)) {
    SceneUpdate update;
    update.clears = true;
    for (std::uint32_t tile = 0; tile < stock.tile_count(); ++tile) {
      update.patches.push_back(std::make_shared<const MeshPatch>(stock.patch(tile, 0)));
    }
    mesh_.apply(update);
    caster_.set_workpiece(stock.height_grid());
    const auto track = test::track_of(program);
    const FrameMoves moves(track, std::make_shared<const CutQuery>(track, four_tools()), kBlock);
    EXPECT_TRUE(csg_.set_blank(box_blank(kBlock)));
    EXPECT_TRUE(csg_.set_tools(moves.tools()));
    csg_.append(moves.between({}, track->place_before(track->size())));
  }

  Box depth_box() const { return mesh_.depth_box(); }

  Distances by_mesh(const Projection& projection) {
    DrawOptions options;
    options.upload_bytes_per_frame = std::size_t{1} << 30;
    EXPECT_TRUE(mesh_.draw(projection, options));
    EXPECT_FALSE(mesh_.has_waiting());
    const glm::dmat4 view(projection.view_from_world);
    Distances found;
    for (int y = 0; y < kSize_px.y; ++y) {
      for (int x = 0; x < kSize_px.x; ++x) {
        const std::optional<Vec3> point = mesh_.pick({x, y});
        found.push_back(point ? static_cast<float>(-(view * glm::dvec4(*point, 1)).z)
                              : kNoDepth_mm);
      }
    }
    return found;
  }
  Distances by_rays(const Projection& projection) {
    caster_.draw(projection);
    return distances(caster_.depths(), projection);
  }
  Distances by_csg(const Projection& projection) {
    EXPECT_TRUE(csg_.draw(projection));
    return distances(csg_.read_depth().depths, projection);
  }

 private:
  SceneRenderer mesh_;
  RayCaster caster_;
  CsgRenderer csg_;
};

/// Of the pixels that show the workpiece in one of the two draw modes, those that differ by more.
double share_off(const Distances& a, const Distances& b, double tolerance_mm) {
  std::size_t seen = 0, off = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const bool in_a = a[i] != kNoDepth_mm, in_b = b[i] != kNoDepth_mm;
    if (!in_a && !in_b) continue;
    ++seen;
    if (in_a != in_b || std::abs(static_cast<double>(a[i] - b[i])) > tolerance_mm) ++off;
  }
  EXPECT_GT(seen, a.size() / 10);
  return static_cast<double>(off) / static_cast<double>(std::max<std::size_t>(1, seen));
}

/// Of the pixels of `b`, those that lie before or behind all of the 3 x 3 pixels of `a` around.
double share_apart(const Distances& a, const Distances& b, double tolerance_mm) {
  std::size_t seen = 0, apart = 0;
  for (int y = 1; y + 1 < kSize_px.y; ++y) {
    for (int x = 1; x + 1 < kSize_px.x; ++x) {
      const int middle = y * kSize_px.x + x;
      const float here = b[static_cast<std::size_t>(middle)];
      float least = kNoDepth_mm, most = 0;
      for (const int step : {-kSize_px.x - 1, -kSize_px.x, -kSize_px.x + 1, -1, 0, 1,
                             kSize_px.x - 1, kSize_px.x, kSize_px.x + 1}) {
        const float beside = a[static_cast<std::size_t>(middle + step)];
        least = std::min(least, beside);
        most = std::max(most, beside);
      }
      if (here == kNoDepth_mm && least == kNoDepth_mm) continue;
      ++seen;
      const auto slack = static_cast<float>(tolerance_mm);
      if (here < least - slack || here > most + slack) ++apart;
    }
  }
  return static_cast<double>(apart) / static_cast<double>(std::max<std::size_t>(1, seen));
}

class ThreeModes : public testing::TestWithParam<unsigned> {};

TEST_P(ThreeModes, DrawTheSameScene) {
  Result<GlContext> context = GlContext::create_offscreen();
  ASSERT_TRUE(context) << context.error();
  Result<SceneRenderer> mesh = SceneRenderer::create();
  ASSERT_TRUE(mesh) << mesh.error();
  CsgOptions csg_options;
  csg_options.tolerance_mm = FrameMoves::kChordTolerance_mm;
  Result<CsgRenderer> csg = CsgRenderer::create(csg_options);
  ASSERT_TRUE(csg) << csg.error();
  const unsigned seed = GetParam();
  const int moves = 1 + static_cast<int>(seed * 13 % 40);
  const std::vector<Motion> program = random_program(seed, moves);
  const std::unique_ptr<ZMap> stock = cut_by(program);
  EXPECT_LT(stock->remaining_mm3(), stock->blank_mm3());
  Modes draw_modes(program, *stock, std::move(mesh.value()), std::move(csg.value()));
  for (const auto& [name, projection] : views(draw_modes.depth_box())) {
    const Distances by_mesh = draw_modes.by_mesh(projection);
    const Distances by_rays = draw_modes.by_rays(projection);
    const Distances by_csg = draw_modes.by_csg(projection);
    const double rays_off = share_off(by_mesh, by_rays, kSameSurface_mm);
    const double csg_off = share_off(by_mesh, by_csg, kOneAndAHalfCells_mm);
    const double csg_apart = share_apart(by_mesh, by_csg, kOneAndAHalfCells_mm);
    std::cout << "seed " << seed << ", " << moves << " moves, " << name << ": off by rays "
              << 100 * rays_off << " %, by csg " << 100 * csg_off << " % (apart " << 100 * csg_apart
              << " %)\n";
    EXPECT_LT(rays_off, kMostSilhouette) << name;
    EXPECT_LT(csg_off, kMostEdgeOn) << name;
    EXPECT_LT(csg_apart, kMostSliver) << name;
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, ThreeModes, testing::Range(1u, 9u));

/// Pictures of states on the way, as FrameRenderer makes them.
class FrameModes : public testing::Test {
 protected:
  void open(const std::vector<Motion>& program, std::unique_ptr<StockModel> blank = block()) {
    PlayerProgram played;
    track_ = played.track = test::track_of(program);
    played.blank = std::move(blank);
    played.tools = four_tools();
    shown_.cuts = std::make_shared<const CutQuery>(track_, four_tools());
    PlayerOptions options;
    options.check_ahead = false;
    player_ = std::make_unique<Player>(std::move(played), options);
    start_ = player_->state();
  }
  Result<FrameRenderer> renderer(DrawMode draw_mode) const {
    FrameOptions options;
    options.size_px = kSize_px;
    options.draw_mode = draw_mode;
    return FrameRenderer::create(options, *start_, track_, shown_);
  }
  /// With path, outline and frames, or workpiece and tool alone.
  Picture draw(DrawMode draw_mode, bool with_lines,
               const std::shared_ptr<const PlayerState>& state) {
    FrameOptions options;
    options.size_px = kSize_px;
    options.draw_mode = draw_mode;
    for (const SceneObject line :
         {SceneObject::kTraverses, SceneObject::kFeeds, SceneObject::kPlanned, SceneObject::kBlank,
          SceneObject::kFrames}) {
      options.draw.looks[static_cast<std::size_t>(line)].is_visible = with_lines;
    }
    Result<FrameRenderer> frames = FrameRenderer::create(options, *start_, track_, shown_);
    EXPECT_TRUE(frames) << frames.error();
    return frames->draw(state).value();
  }
  std::shared_ptr<const PlayerState> at_time(double time_s) {
    const Player::Ticket ticket = player_->seek_time(time_s);
    while (!player_->wait(ticket, std::chrono::milliseconds(100))) {
    }
    return player_->state();
  }

  std::shared_ptr<const ProgramTrack> track_;
  ViewedProgram shown_;
  std::unique_ptr<Player> player_;
  std::shared_ptr<const PlayerState> start_;
};

/// Pixels that differ by more than light at a slightly different normal makes.
double share_different(const Picture& a, const Picture& b) {
  constexpr int kLight = 24;
  std::size_t different = 0;
  for (std::size_t i = 0; i < a.rgb.size(); i += 3) {
    bool same = true;
    for (std::size_t k = i; k < i + 3; ++k) same = same && std::abs(a.rgb[k] - b.rgb[k]) <= kLight;
    if (!same) ++different;
  }
  return 3.0 * static_cast<double>(different) / static_cast<double>(a.rgb.size());
}

TEST_F(FrameModes, CsgForwardInPartsAndBackDrawsWhatItDrawsAtOnce) {
  open(random_program(5, 12));
  const double end_s = track_->duration_s();
  const auto middle = at_time(0.47 * end_s);
  ASSERT_GT(middle->place.fraction, 0) << "within a motion";
  std::vector<std::shared_ptr<const PlayerState>> way;
  for (int i = 0; i <= 20; ++i) way.push_back(at_time(end_s * i / 20));
  Picture in_parts, back, first;
  {
    Result<FrameRenderer> frames = renderer(DrawMode::kCsg);
    ASSERT_TRUE(frames) << frames.error();
    first = frames->draw(way.front()).value();
    for (const auto& state : way) in_parts = frames->draw(state).value();
    back = frames->draw(middle).value();
  }
  const auto at_once = [&](const std::shared_ptr<const PlayerState>& state) {
    return renderer(DrawMode::kCsg).value().draw(state).value();
  };
  EXPECT_EQ(back.rgb, at_once(middle).rgb);
  EXPECT_LT(share_different(in_parts, at_once(way.back())), 0.002);
  EXPECT_GT(share_different(in_parts, first), 0.05);
  EXPECT_GT(share_different(in_parts, back), 0.005);
}

TEST_F(FrameModes, RaycastDrawsTheMeshsWorkpieceToolAndLines) {
  open(random_program(3, 12));
  const auto state = at_time(0.6 * track_->duration_s());
  for (const bool with_lines : {false, true}) {
    const Picture by_rays = draw(DrawMode::kRaycast, with_lines, state);
    // Patches are made for what a pixel of this size can show, rays go by every cell.
    EXPECT_LT(share_different(draw(DrawMode::kMesh, with_lines, state), by_rays), 0.04);
  }
}

/// Where a picture has lines: 1, rows from the top.
std::vector<char> line_mask(const Picture& with_lines, const Picture& without) {
  constexpr int kLeast = 30;
  std::vector<char> mask(with_lines.rgb.size() / 3, 0);
  for (std::size_t i = 0; i < with_lines.rgb.size(); ++i) {
    if (std::abs(with_lines.rgb[i] - without.rgb[i]) > kLeast) mask[i / 3] = 1;
  }
  return mask;
}

/// Of the pixels of `a`, those that have none of `b` in the 3 x 3 around.
double share_alone(const std::vector<char>& a, const std::vector<char>& b) {
  std::size_t all = 0, alone = 0;
  for (int y = 1; y + 1 < kSize_px.y; ++y) {
    for (int x = 1; x + 1 < kSize_px.x; ++x) {
      if (a[static_cast<std::size_t>(y * kSize_px.x + x)] == 0) continue;
      ++all;
      bool has_near = false;
      for (int near_y = y - 1; near_y <= y + 1; ++near_y) {
        for (int near_x = x - 1; near_x <= x + 1; ++near_x) {
          has_near = has_near || b[static_cast<std::size_t>(near_y * kSize_px.x + near_x)] != 0;
        }
      }
      if (!has_near) ++alone;
    }
  }
  EXPECT_GT(all, 500u);
  return static_cast<double>(alone) / static_cast<double>(std::max<std::size_t>(1, all));
}

TEST_F(FrameModes, LinesAreInTheSamePlaces) {
  open(random_program(6, 8));
  shown_.blank_outline = box_outline(kBlock);
  shown_.work_offset = "G54";
  for (const double share : {0.55, 1.0}) {
    const auto state = at_time(share * track_->duration_s());
    const auto lines_of = [&](DrawMode draw_mode) {
      return line_mask(draw(draw_mode, true, state), draw(draw_mode, false, state));
    };
    const std::vector<char> by_mesh = lines_of(DrawMode::kMesh);
    for (const DrawMode draw_mode : {DrawMode::kRaycast, DrawMode::kCsg}) {
      const std::vector<char> lines = lines_of(draw_mode);
      const double missing = share_alone(by_mesh, lines), more = share_alone(lines, by_mesh);
      std::cout << "at " << share << ", draw mode " << static_cast<int>(draw_mode) << ": missing "
                << 100 * missing << " %, more " << 100 * more << " %\n";
      EXPECT_LT(missing, kMostLinesAlone);
      EXPECT_LT(more, kMostLinesAlone);
    }
  }
}

TEST_F(FrameModes, FindingsAreInTheSamePlaces) {
  open(random_program(6, 8));
  auto state = std::make_shared<PlayerState>(*at_time(0.5 * track_->duration_s()));
  const auto plain = std::make_shared<const PlayerState>(*state);
  std::vector<Finding> findings(9);
  for (std::size_t i = 0; i < findings.size(); ++i) {
    const auto at = static_cast<double>(i);
    findings[i].severity = static_cast<Severity>(i % 3);
    findings[i].position_mm = Vec3(2 + 2 * at, 18 - 1.5 * at, -0.8 * at);
  }
  state->findings = std::make_shared<const std::vector<Finding>>(std::move(findings));
  const auto marks_of = [&](DrawMode draw_mode) {
    return line_mask(draw(draw_mode, false, state), draw(draw_mode, false, plain));
  };
  const std::vector<char> by_mesh = marks_of(DrawMode::kMesh);
  for (const DrawMode draw_mode : {DrawMode::kRaycast, DrawMode::kCsg}) {
    const std::vector<char> marks = marks_of(draw_mode);
    EXPECT_LT(share_alone(by_mesh, marks), kMostLinesAlone);
    EXPECT_LT(share_alone(marks, by_mesh), kMostLinesAlone);
  }
}

TEST_F(FrameModes, CsgRefusesBlanksThatAreNoBox) {
  auto blank = cut_by(random_program(1, 10));
  open({}, std::move(blank));
  const Result<FrameRenderer> frames = renderer(DrawMode::kCsg);
  ASSERT_FALSE(frames);
  EXPECT_NE(frames.error().find("this blank is none"), std::string::npos) << frames.error();
  EXPECT_NE(frames.error().find("of 160000 cells are lower than its top"), std::string::npos);
}

TEST_F(FrameModes, CsgRefusesMoreMovesThanItCanDraw) {
  MotionList program;
  program.at({1, 1, -1}).tool(1).spindle(true);
  for (int i = 0; i < 10'000; ++i) program.feed({2, 1, -1}).feed({1, 1, -1});
  program.feed({3, 3, -1});
  open(program.list());
  Result<FrameRenderer> frames = renderer(DrawMode::kCsg);
  ASSERT_TRUE(frames) << frames.error();
  EXPECT_TRUE(frames->can_reach(track_->place_before(20'001)));
  const Done can = frames->can_reach(track_->place_before(track_->size()));
  ASSERT_FALSE(can);
  EXPECT_NE(can.error().find("20001 moves reach the blank"), std::string::npos) << can.error();
  EXPECT_NE(can.error().find("at most 20000; --draw mesh"), std::string::npos) << can.error();
}

TEST(FrameMoves, LeavesOutWhatCutsNothing) {
  MotionList program;
  program.at({-5, 5, 5}).tool(9).spindle(true);
  program.feed({5, 5, -1});                     // of a tool that is not known
  program.traverse({5, 5, 5}).tool(1);          // above
  program.feed({5, 5, -1}).probe({9, 5, -1});   // cuts; does not
  program.traverse({9, 9, -1});                 // cuts
  program.feed({40, 9, -1}).feed({50, 9, -1});  // cuts; beside
  program.traverse({50, 9, 5});
  const auto track = test::track_of(program.list());
  const FrameMoves moves(track, std::make_shared<const CutQuery>(track, four_tools()), kBlock);
  const TrackPosition end = track->place_before(track->size());
  EXPECT_EQ(moves.tools().size(), 1u);
  const std::vector<SweptMove> all = moves.between({}, end);
  ASSERT_EQ(all.size(), 3u);
  EXPECT_EQ(all[0].to_mm, Vec3(5, 5, -1));
  EXPECT_EQ(all[1].to_mm, Vec3(9, 9, -1));
  EXPECT_EQ(all[2].to_mm, Vec3(40, 9, -1));
  EXPECT_EQ(moves.count_until(end), 3u);
}

TEST(FrameMoves, ChordsStayBesideTheirArcAndPartsJoin) {
  MotionList program;
  program.at({14, 10, -1}).tool(2).spindle(true);
  program.arc({14, 10, -4}, {10, 10, -1}, {0, 0, -1}, -4 * kPi);  // a helix of two turns
  const auto track = test::track_of(program.list());
  const FrameMoves moves(track, std::make_shared<const CutQuery>(track, four_tools()), kBlock);
  const std::size_t arc = track->size() - 1;
  const TrackPosition begin{arc, 0, 0}, middle{arc, 0.37, 0}, end = track->place_before(arc + 1);
  std::vector<SweptMove> parts = moves.between(begin, middle);
  const std::vector<SweptMove> rest = moves.between(middle, end);
  parts.insert(parts.end(), rest.begin(), rest.end());
  const std::vector<SweptMove> whole = moves.between(begin, end);
  EXPECT_EQ(moves.count_until(end), whole.size());
  for (const auto& chords : {whole, parts}) {
    EXPECT_EQ(chords.front().from_mm, Vec3(14, 10, -1));
    EXPECT_EQ(chords.back().to_mm, Vec3(14, 10, -4));
    for (std::size_t i = 0; i < chords.size(); ++i) {
      if (i > 0) {
        EXPECT_EQ(chords[i].from_mm, chords[i - 1].to_mm);
      }
      const Vec3 halfway = 0.5 * (chords[i].from_mm + chords[i].to_mm);
      const double radius = glm::length(Vec2(halfway) - Vec2(10, 10));
      EXPECT_LT(radius, 4);
      EXPECT_GE(radius, 4 - FrameMoves::kChordTolerance_mm - 1e-9);
    }
  }
}

}  // namespace
}  // namespace kerf
