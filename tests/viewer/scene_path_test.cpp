#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <utility>

#include "tests/viewer/scene_fixture.h"

namespace kerf {
namespace {

/// Waves in rows, with a traverse between rows: `count` vertices, rows of a thousand.
std::vector<PathVertex> waves(std::size_t count) {
  constexpr std::size_t kRow = 1000;
  std::vector<PathVertex> path;
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t row = i / kRow;
    const double along = 100.0 * static_cast<double>(i % kRow) / kRow;
    const double x = row % 2 == 0 ? along : 100.0 - along;
    const double y = 4.0 * static_cast<double>(row) + std::sin(x / 3.0);
    const bool is_first = i % kRow == 0;
    path.push_back(PathVertex{glm::vec3(x, y, std::cos(x / 5.0)),
                              is_first ? PathKind::kTraverse : PathKind::kFeed});
  }
  return path;
}

/// In chunks that are never full, of which all vertices are drawn.
std::vector<std::shared_ptr<const PathChunk>> growing_chunks(const std::vector<PathVertex>& path) {
  std::vector<std::shared_ptr<const PathChunk>> chunks;
  for (std::size_t first = 0; first + 1 < path.size(); first += kPathChunkSegments - 1) {
    const std::size_t end = std::min(first + kPathChunkSegments, path.size());
    auto chunk = std::make_shared<PathChunk>();
    chunk->index = static_cast<std::uint32_t>(chunks.size());
    chunk->vertices.assign(path.begin() + static_cast<std::ptrdiff_t>(first),
                           path.begin() + static_cast<std::ptrdiff_t>(end));
    chunks.push_back(std::move(chunk));
  }
  return chunks;
}

SceneUpdate path_update(std::vector<std::shared_ptr<const PathChunk>> chunks) {
  SceneUpdate update;
  SceneSetup setup;
  setup.bounds_mm = {Vec3(0, 0, -10), Vec3(100, 100, 0)};
  update.setup = std::make_shared<const SceneSetup>(setup);
  update.path = std::move(chunks);
  return update;
}

SceneUpdate past_update(std::uint64_t vertices) {
  Moment moment;
  moment.past_vertices = vertices;
  SceneUpdate update;
  update.moment = std::make_shared<const Moment>(moment);
  return update;
}

/// A line that is moved by half a pixel, and rounded to whole ones in both pictures.
constexpr int kMoved_px = 2;

/// Pixels of `a` that no pixel of `b` has, at their place or near it.
int pixels_elsewhere(const Picture& a, const Picture& b) {
  int count = 0;
  for (int y = kMoved_px; y + kMoved_px < kSize_px.y; ++y) {
    for (int x = kMoved_px; x + kMoved_px < kSize_px.x; ++x) {
      bool is_found = false;
      for (int to_y = y - kMoved_px; to_y <= y + kMoved_px && !is_found; ++to_y) {
        for (int to_x = x - kMoved_px; to_x <= x + kMoved_px && !is_found; ++to_x) {
          is_found = at(a, {x, y}) == at(b, {to_x, to_y});
        }
      }
      count += is_found ? 0 : 1;
    }
  }
  return count;
}

TEST_F(SceneRendererTest, AThinnedPathIsWhereTheWholeOneIs) {
  const std::vector<PathVertex> path = waves(25'000);
  DrawOptions options = everything_;
  options.looks[0].opacity = 0.5f;  // lines beside what is seen through have no faint rims
  for (const bool is_perspective : {true, false}) {
    camera_.set_perspective(is_perspective);
    SceneRenderer thinned = renderer(), whole = renderer();
    thinned.apply(path_update(path_chunks(path)));
    whole.apply(path_update(growing_chunks(path)));
    const Projection projection = view_of(thinned);
    draw(&thinned, projection, options);
    draw(&whole, projection, options);
    const Picture found = thinned.read(), expected = whole.read();
    // The thinned one is another one: a pixel here and there is.
    EXPECT_GT(differing_pixels(found, expected), 0);
    EXPECT_LT(differing_pixels(found, expected), kSize_px.x * kSize_px.y / 50);
    EXPECT_EQ(pixels_elsewhere(found, expected), 0);
    EXPECT_EQ(pixels_elsewhere(expected, found), 0);
  }
}

TEST_F(SceneRendererTest, OfAThinnedPathThePastEndsAtTheVertex) {
  std::vector<PathVertex> path;
  for (std::size_t i = 0; i <= 3 * kPathChunkSegments; ++i) {
    path.push_back(
        PathVertex{{100.0f * static_cast<float>(i) / (3 * kPathChunkSegments), 50.0f, 0.0f}});
  }
  SceneRenderer scene = renderer();
  scene.apply(path_update(path_chunks(path)));
  camera_.look_from(StandardView::kTop);
  camera_.set_perspective(false);
  const Projection projection = view_of(scene);
  const auto color_at = [&](double x) {
    const glm::ivec2 px = pixel_of(projection, Vec3(x, 50, 0));
    Color darkest{255, 255, 255};
    for (int y = px.y - 1; y <= px.y + 1; ++y) {
      darkest = std::min(darkest, at(scene.read(), {px.x, y}));
    }
    return darkest;
  };
  draw(&scene, projection, everything_);
  const Color future = color_at(50);
  scene.apply(past_update(path.size()));
  draw(&scene, projection, everything_);
  const Color past = color_at(50);
  ASSERT_GT(future.r - past.r, 30);
  // Where two chords meet, a line is a little paler than elsewhere.
  const auto is_past = [&](double x) { return color_at(x).r < (past.r + future.r) / 2; };
  for (const std::size_t vertices : {700u, 2000u, 4096u, 4097u, 4098u, 9000u, 12000u, 300u}) {
    scene.apply(past_update(vertices));
    draw(&scene, projection, everything_);
    const double border_mm = static_cast<double>(path[vertices - 1].position_mm.x);
    const double pixel_mm = camera_.pixel_mm(kSize_px);
    EXPECT_TRUE(is_past(border_mm - 1.5 * pixel_mm)) << vertices;
    EXPECT_FALSE(is_past(border_mm + 1.5 * pixel_mm)) << vertices;
  }
}

TEST_F(SceneRendererTest, OfATailTheOlderSegmentsArePalerAndTheRestIsNotThere) {
  std::vector<PathVertex> path;
  for (std::size_t i = 0; i <= 3 * kPathChunkSegments; ++i) {
    path.push_back(
        PathVertex{{100.0f * static_cast<float>(i) / (3 * kPathChunkSegments), 50.0f, 0.0f}});
  }
  SceneRenderer scene = renderer();
  scene.apply(path_update(path_chunks(path)));
  camera_.look_from(StandardView::kTop);
  camera_.set_perspective(false);
  const Projection projection = view_of(scene);
  DrawOptions options = everything_;
  options.path_tail = 4000;
  const auto red_at = [&](std::size_t vertex) {
    const Vec3 place(path[vertex].position_mm);
    const glm::ivec2 px = pixel_of(projection, place);
    int least = 255;
    for (int y = px.y - 1; y <= px.y + 1; ++y)
      least = std::min(least, at(scene.read(), {px.x, y}).r);
    return least;
  };
  draw(&scene, projection, options);
  const int ground = red_at(6000);
  // Across the border of two chunks.
  scene.apply(past_update(9000));
  draw(&scene, projection, options);
  EXPECT_LT(red_at(8800), red_at(7500) - 20);
  EXPECT_LT(red_at(7500), red_at(5600) - 20);
  EXPECT_LT(red_at(5600), ground);
  EXPECT_NEAR(red_at(4700), ground, 2);
  EXPECT_NEAR(red_at(9200), ground, 2);
}

/// Pixels that two pictures have not in common, weighed by how much darker the second one is: for
/// lines on plain ground, what they cover.
double covered_px(const Picture& ground, const Picture& picture, int full) {
  double sum = 0.0;
  for (std::size_t i = 0; i < ground.rgb.size(); i += 3) sum += ground.rgb[i] - picture.rgb[i];
  return sum / full;
}

/// On fine displays lines are wider, with faint rims or without, of the path and of all else.
TEST_F(SceneRendererTest, LinesAreAsWideAsTheDisplayAsks) {
  std::vector<PathVertex> path;
  for (int i = 0; i <= 50; ++i) {
    path.push_back(PathVertex{{2.0f * static_cast<float>(i), 50.0f, 0.0f}, PathKind::kFeed});
  }
  camera_.look_from(StandardView::kTop);
  camera_.set_perspective(false);
  SceneRenderer empty = renderer(), scene = renderer(), outlined = renderer();
  empty.apply(path_update({}));
  scene.apply(path_update(path_chunks(path)));
  scene.apply(past_update(path.size()));
  SceneSetup setup;
  setup.bounds_mm = {Vec3(0, 0, -10), Vec3(100, 100, 0)};
  setup.blank_outline = {{glm::vec3(0, 50, 0), glm::vec3(100, 50, 0)}};
  SceneUpdate with_outline;
  with_outline.setup = std::make_shared<const SceneSetup>(setup);
  outlined.apply(with_outline);
  Projection projection = view_of(empty);
  const double length_px =
      pixel_of(projection, {100, 50, 0}).x - pixel_of(projection, {0, 50, 0}).x;
  ASSERT_GT(length_px, 100.0);
  for (const float opacity : {1.0f, 0.5f}) {  // of the workpiece: seen through, lines have no rims
    DrawOptions options = everything_;
    options.looks[0].opacity = opacity;
    options.looks[static_cast<std::size_t>(SceneObject::kFrames)].is_visible = false;
    for (SceneRenderer* lines : {&scene, &outlined}) {
      double of_one_px = 0.0;
      for (const float line_px : {1.0f, 1.5f, 2.0f, 3.0f, 4.0f}) {
        projection.line_px = line_px;
        draw(&empty, projection, options);
        draw(lines, projection, options);
        const Picture ground = empty.read(), picture = lines->read();
        const int full = lines == &scene ? at(ground, {200, 150}).r - 26 : 100;
        const double covered = covered_px(ground, picture, full) / length_px;
        if (line_px == 1.0f) of_one_px = covered;
        ASSERT_GT(of_one_px, 0.0);
        // Without rims a line has whole rows.
        const double slack = opacity == 1.0f ? 0.15 : 0.55;
        EXPECT_NEAR(covered / of_one_px, line_px, slack * line_px) << line_px << ' ' << opacity;
      }
    }
  }
}

/// With lines through the eye, and behind it.
TEST_F(SceneRendererTest, WideLinesEndBeforeTheEye) {
  std::vector<PathVertex> path{PathVertex{{50, -4000, 0}, PathKind::kFeed},
                               PathVertex{{50, 4000, 0}, PathKind::kFeed}};
  SceneRenderer scene = renderer(), empty = renderer();
  empty.apply(path_update({}));
  scene.apply(path_update(path_chunks(path)));
  scene.apply(past_update(path.size()));
  camera_.set_perspective(true);
  camera_.look_from(StandardView::kFront);
  camera_.orbit({0.0f, 20.0f}, kSize_px);
  Projection projection = view_of(empty);
  const auto covered = [&](float line_px) {
    projection.line_px = line_px;
    draw(&empty, projection, everything_);
    draw(&scene, projection, everything_);
    return covered_px(empty.read(), scene.read(), 200);
  };
  const double fine = covered(1.0f), wide = covered(2.0f);
  EXPECT_GT(fine, 30.0);
  EXPECT_NEAR(wide / fine, 2.0, 0.4);
}

TEST_F(SceneRendererTest, OfATailThatPassesTheSamePixelsAsAnew) {
  std::mt19937 random(7);
  SceneRenderer local = renderer(), full = renderer();
  const std::vector<PathVertex> path = waves(25'000);
  local.apply(path_update(path_chunks(path)));
  full.apply(path_update(path_chunks(path)));
  DrawOptions options = everything_, anew = everything_;
  options.path_tail = anew.path_tail = 200;
  anew.is_local = false;
  camera_.fit({Vec3(0, 0, -10), Vec3(100, 100, 0)}, kSize_px);
  Projection projection = camera_.projection(local.depth_box(), kSize_px);
  std::uint64_t past = 4000;
  for (int step = 0; step < 20; ++step) {
    projection.line_px = step < 10 ? 1.0f : 3.0f;
    past = step % 5 == 4 ? random() % path.size() : past + random() % 90;
    local.apply(past_update(past));
    full.apply(past_update(past));
    draw(&local, projection, options);
    draw(&full, projection, anew);
    ASSERT_EQ(differing_pixels(local.read(), full.read()), 0) << past;
  }
  EXPECT_GE(local.counters().local.frames, 15u);
}

TEST_F(SceneRendererTest, OfAThinnedPathThatPassesTheSamePixelsAsAnew) {
  std::mt19937 random(7);
  SceneRenderer local = renderer(), full = renderer();
  const std::vector<PathVertex> path = waves(25'000);
  local.apply(path_update(path_chunks(path)));
  full.apply(path_update(path_chunks(path)));
  DrawOptions anew = everything_;
  anew.is_local = false;
  // Whole, and so near that most of it is outside the picture and some behind the eye.
  for (const auto& [zoom, line_px] :
       {std::pair(1.0, 1.0f), {30.0, 1.0f}, {1.0, 2.0f}, {30.0, 2.0f}}) {
    camera_.fit({Vec3(0, 0, -10), Vec3(100, 100, 0)}, kSize_px);
    camera_.zoom(zoom, glm::vec2(kSize_px) * 0.4f, kSize_px);
    Projection projection = camera_.projection(local.depth_box(), kSize_px);
    projection.line_px = line_px;
    draw(&local, projection, everything_);
    local.reset_counters();
    std::uint64_t past = 3000;
    for (int step = 0; step < 30; ++step) {
      past = step % 5 == 4 ? random() % path.size() : past + random() % 200;
      local.apply(past_update(past));
      full.apply(past_update(past));
      draw(&local, projection, everything_);
      draw(&full, projection, anew);
      ASSERT_EQ(differing_pixels(local.read(), full.read()), 0)
          << "zoom " << zoom << " past " << past;
    }
    EXPECT_EQ(local.counters().full.frames, 0u);
    EXPECT_GE(local.counters().local.frames, zoom > 1.0 ? 1u : 20u);
  }
}

TEST_F(SceneRendererTest, OfALongPathThatPassesPartByPartTheSamePixelsAsAnew) {
  TestWorkpiece workpiece(200, 170);
  SceneRenderer scene = renderer();
  SceneUpdate first = first_update(&workpiece);
  std::vector<PathVertex> path;
  for (int i = 0; i < 6000; ++i) {
    const auto along = static_cast<float>(i % 100), row = static_cast<float>(i / 100);
    path.push_back(
        PathVertex{{i / 100 % 2 == 0 ? along : 99 - along, 1.2f * row, 5}, PathKind::kFeed});
  }
  first.path = path_chunks(path);
  scene.apply(first);
  const Projection projection = view_of(scene);
  draw(&scene, projection, everything_);
  DrawOptions anew = everything_;
  anew.is_local = false;
  for (const std::uint64_t past : {30u, 70u, 1000u, 4090u, 4100u, 5990u, 500u}) {
    Moment moment;
    moment.past_vertices = past;
    SceneUpdate update;
    update.moment = std::make_shared<const Moment>(moment);
    scene.apply(update);
    draw(&scene, projection, everything_);
    const Picture kept = scene.read();
    draw(&scene, projection, anew);
    EXPECT_EQ(differing_pixels(kept, scene.read()), 0) << past;
    draw(&scene, projection, everything_);
  }
  EXPECT_GE(scene.counters().local.frames, 7u);
}

TEST_F(SceneRendererTest, OfAPathThatGrowsAndIsReplacedTheSamePixelsAsAnew) {
  SceneRenderer scene = renderer();
  SceneUpdate first;
  SceneSetup setup;
  setup.bounds_mm = {Vec3(0, 0, -10), Vec3(100, 100, 0)};
  first.setup = std::make_shared<const SceneSetup>(setup);
  scene.apply(first);
  const Projection projection = view_of(scene);
  DrawOptions anew = everything_;
  anew.is_local = false;
  const auto path_of = [](std::size_t vertices, float height_mm) {
    std::vector<PathVertex> path;
    for (std::size_t i = 0; i < vertices; ++i) {
      const auto row = static_cast<float>(i / 100), along = static_cast<float>(i % 100);
      path.push_back(PathVertex{{along, row, height_mm}, PathKind::kFeed});
    }
    return path_chunks(path);
  };
  Picture last;
  const auto expect_equal = [&](const SceneUpdate& update, const char* when) {
    scene.apply(update);
    draw(&scene, projection, everything_);
    const Picture kept = scene.read();
    EXPECT_TRUE(last.rgb.empty() || differing_pixels(kept, last) > 0) << when;
    draw(&scene, projection, anew);
    EXPECT_EQ(differing_pixels(kept, scene.read()), 0) << when;
    draw(&scene, projection, everything_);
    last = kept;
  };
  SceneUpdate update;
  for (const std::size_t vertices : {2000u, 4050u, 4097u, 6000u}) {
    update.path = path_of(vertices, 0.0f);
    expect_equal(update, "it grows");
  }
  const std::size_t full_bytes = scene.counters().gpu_bytes;
  update.path.clear();
  update.path_chunk_count = 1;
  expect_equal(update, "its end is dropped");
  EXPECT_EQ(full_bytes - scene.counters().gpu_bytes, (6000u - 4096u) * sizeof(PathVertex));
  update.path_chunk_count.reset();
  update.path = path_of(4097, -8.0f);
  expect_equal(update, "a full chunk comes again, with other values");
}

TEST_F(SceneRendererTest, TenMillionPathVerticesAreThinnedOut) {
  constexpr std::size_t kVertices = 10'000'000;
  SceneRenderer scene = renderer();
  SceneUpdate update;
  SceneSetup setup;
  setup.bounds_mm = {Vec3(0, 0, -10), Vec3(100, 100, 0)};
  update.setup = std::make_shared<const SceneSetup>(setup);
  std::vector<PathVertex> path(kVertices);
  for (std::size_t i = 0; i < kVertices; ++i) {
    path[i] = PathVertex{{static_cast<float>(i % 1000) * 0.1f, static_cast<float>(i) * 1e-5f, 0.0f},
                         PathKind::kFeed};
  }
  update.path = path_chunks(path);
  path.clear();
  scene.apply(update);
  draw(&scene, view_of(scene), everything_);
  EXPECT_FALSE(scene.has_waiting());
  EXPECT_GE(scene.counters().gpu_bytes, kVertices * sizeof(PathVertex));
  // Blue where the path is.
  const Color middle = at(scene.read(), kSize_px / 2);
  EXPECT_GT(middle.b, middle.r + 20);
}

}  // namespace
}  // namespace kerf
