#include "tests/viewer/test_scene.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace kerf {
namespace {

constexpr double kBlankDepth_mm = 40.0;

}  // namespace

TestWorkpiece::TestWorkpiece(int cells_x, int cells_y)
    : cells_x_(cells_x),
      cells_y_(cells_y),
      tiles_x_((cells_x + kTileCells - 1) / kTileCells),
      tiles_y_((cells_y + kTileCells - 1) / kTileCells),
      heights_mm_(static_cast<std::size_t>(cells_x + 1) * static_cast<std::size_t>(cells_y + 1)),
      dirty_(static_cast<std::size_t>(tiles_x_ * tiles_y_), true) {}

float& TestWorkpiece::height(int x, int y) {
  const int kept_x = std::clamp(x, 0, cells_x_);
  const int kept_y = std::clamp(y, 0, cells_y_);
  return heights_mm_[static_cast<std::size_t>(kept_y) * static_cast<std::size_t>(cells_x_ + 1) +
                     static_cast<std::size_t>(kept_x)];
}

void TestWorkpiece::dent(double x_mm, double y_mm, double radius_mm, double depth_mm) {
  const auto reach = static_cast<int>(std::ceil(radius_mm));
  const auto middle_x = static_cast<int>(x_mm);
  const auto middle_y = static_cast<int>(y_mm);
  for (int y = std::max(0, middle_y - reach); y <= std::min(cells_y_, middle_y + reach); ++y) {
    for (int x = std::max(0, middle_x - reach); x <= std::min(cells_x_, middle_x + reach); ++x) {
      const double r2 = (x - x_mm) * (x - x_mm) + (y - y_mm) * (y - y_mm);
      if (r2 >= radius_mm * radius_mm) continue;
      const double z = radius_mm - depth_mm - std::sqrt(radius_mm * radius_mm - r2);
      if (z >= static_cast<double>(height(x, y))) continue;
      height(x, y) = static_cast<float>(z);
      // A corner changes the normals of its neighbours, which may be another tile's.
      for (int ty = std::max(0, y - 2) / kTileCells; ty <= std::min(cells_y_, y + 2) / kTileCells;
           ++ty) {
        for (int tx = std::max(0, x - 2) / kTileCells; tx <= std::min(cells_x_, x + 2) / kTileCells;
             ++tx) {
          if (tx < tiles_x_ && ty < tiles_y_) {
            dirty_[static_cast<std::size_t>(ty * tiles_x_ + tx)] = true;
          }
        }
      }
    }
  }
}

std::shared_ptr<const MeshPatch> TestWorkpiece::patch(int tile_x, int tile_y) {
  auto made = std::make_shared<MeshPatch>();
  made->tile = static_cast<std::uint32_t>(tile_y * tiles_x_ + tile_x);
  made->version = version_;
  const int x0 = tile_x * kTileCells, x1 = std::min(x0 + kTileCells, cells_x_);
  const int y0 = tile_y * kTileCells, y1 = std::min(y0 + kTileCells, cells_y_);
  for (int y = y0; y <= y1; ++y) {
    for (int x = x0; x <= x1; ++x) {
      const glm::vec3 normal(height(x - 1, y) - height(x + 1, y),
                             height(x, y - 1) - height(x, y + 1), 2.0f);
      made->vertices.push_back({{static_cast<float>(x), static_cast<float>(y), height(x, y)},
                                pack_normal(glm::normalize(normal))});
    }
  }
  const auto row = static_cast<std::uint32_t>(x1 - x0 + 1);
  for (std::uint32_t j = 0; j < static_cast<std::uint32_t>(y1 - y0); ++j) {
    for (std::uint32_t i = 0; i + 1 < row; ++i) {
      const std::uint32_t a = j * row + i;
      for (const std::uint32_t v : {a, a + 1, a + row + 1, a, a + row + 1, a + row}) {
        made->indices.push_back(v);
      }
    }
  }
  made->skirt_begin = static_cast<std::uint32_t>(made->indices.size());
  return made;
}

std::vector<std::shared_ptr<const MeshPatch>> TestWorkpiece::take_patches() {
  ++version_;
  std::vector<std::shared_ptr<const MeshPatch>> patches;
  for (int y = 0; y < tiles_y_; ++y) {
    for (int x = 0; x < tiles_x_; ++x) {
      const auto tile = static_cast<std::size_t>(y * tiles_x_ + x);
      if (!dirty_[tile]) continue;
      dirty_[tile] = false;
      patches.push_back(patch(x, y));
    }
  }
  return patches;
}

std::shared_ptr<const SceneSetup> TestWorkpiece::setup() const {
  SceneSetup setup;
  setup.title = "test.ngc";
  setup.bounds_mm = {Vec3(0.0, 0.0, -kBlankDepth_mm), Vec3(cells_x_, cells_y_, 0.0)};
  setup.blank_outline = box_outline(setup.bounds_mm);
  setup.frames = {{.name = "G54"}};
  return std::make_shared<const SceneSetup>(std::move(setup));
}

std::shared_ptr<const ToolShape> test_tool(float radius_mm) {
  constexpr int kSteps = 12;
  ToolShape shape;
  for (int i = 0; i <= kSteps; ++i) {
    const float angle =
        0.5f * static_cast<float>(kPi) * static_cast<float>(i) / static_cast<float>(kSteps);
    shape.cutter.push_back({radius_mm * std::sin(angle), radius_mm * (1 - std::cos(angle))});
  }
  const float r = radius_mm;
  shape.cutter.push_back({r, 5 * r});
  shape.shank = {{r, 5 * r}, {r, 10 * r}};
  shape.holder = {{2 * r, 10 * r}, {4 * r, 12 * r}, {4 * r, 16 * r}};
  return std::make_shared<const ToolShape>(std::move(shape));
}

std::vector<PathVertex> test_path(int cells_x, int cells_y) {
  std::vector<PathVertex> path{PathVertex{{0.0f, 0.0f, 30.0f}, PathKind::kTraverse},
                               PathVertex{{20.0f, 20.0f, 30.0f}, PathKind::kTraverse}};
  float low = 20.0f;
  const auto high_x = static_cast<float>(cells_x), high_y = static_cast<float>(cells_y);
  while (2 * low < std::min(high_x, high_y)) {
    for (const glm::vec3& p : {glm::vec3(low, low, -3), glm::vec3(high_x - low, low, -3),
                               glm::vec3(high_x - low, high_y - low, -3),
                               glm::vec3(low, high_y - low, -3), glm::vec3(low, low + 12, -3)}) {
      path.push_back(PathVertex{p, PathKind::kFeed});
    }
    low += 12.0f;
  }
  return path;
}

std::vector<std::shared_ptr<const PathChunk>> path_chunks(const std::vector<PathVertex>& vertices) {
  std::vector<std::shared_ptr<const PathChunk>> chunks;
  for (std::size_t first = 0; first + 1 < vertices.size(); first += kPathChunkSegments) {
    const std::size_t count = std::min(kPathChunkSegments + 1, vertices.size() - first);
    const auto begin = vertices.begin() + static_cast<std::ptrdiff_t>(first);
    chunks.push_back(std::make_shared<const PathChunk>(
        PathChunk{static_cast<std::uint32_t>(chunks.size()),
                  {begin, begin + static_cast<std::ptrdiff_t>(count)}}));
  }
  return chunks;
}

}  // namespace kerf
