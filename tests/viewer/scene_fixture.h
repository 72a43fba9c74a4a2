// tests/viewer/scene_fixture.h - a renderer without a window, and scenes whose pictures are known.
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "tests/viewer/test_scene.h"
#include "viewer/gl_context.h"
#include "viewer/window/scene_renderer.h"

namespace kerf {

inline constexpr glm::ivec2 kSize_px{400, 300};

struct Color {
  int r, g, b;
  auto operator<=>(const Color&) const = default;
};

Color at(const Picture& picture, glm::ivec2 px);
int differing_pixels(const Picture& a, const Picture& b);

/// The pixel, from the upper left, that shows a point.
glm::ivec2 pixel_of(const Projection& projection, const Vec3& point_mm);

SceneUpdate moment_update(const Vec3& tip_mm, std::uint64_t past_vertices);

/// Six sides, of which the triangles are seen from outside or, of a hollow, from inside.
void add_box(MeshPatch* patch, const Box& box, bool is_hollow = false);

/// A link a box, in their own frames.
std::shared_ptr<const SceneMachine> box_machine(const std::vector<Box>& boxes);

class SceneRendererTest : public testing::Test {
 protected:
  void SetUp() override;
  SceneRenderer renderer();
  SceneUpdate first_update(TestWorkpiece* workpiece);
  Projection view_of(const SceneRenderer& renderer);
  void draw(SceneRenderer* renderer, const Projection& projection, const DrawOptions& options);
  /// Graphics memory of an empty scene with first_update()'s tool.
  static std::size_t layers_and_tool_bytes();

  std::optional<GlContext> context_;
  OrbitCamera camera_;
  DrawOptions everything_;
};

}  // namespace kerf
