#include "tests/viewer/scene_fixture.h"

#include <array>
#include <cmath>
#include <cstdlib>
#include <glm/vec4.hpp>
#include <utility>

#include "viewer/window/tool_mesh.h"

namespace kerf {

Color at(const Picture& picture, glm::ivec2 px) {
  const auto i = static_cast<std::size_t>(3 * (px.y * picture.width_px + px.x));
  return {picture.rgb[i], picture.rgb[i + 1], picture.rgb[i + 2]};
}

int differing_pixels(const Picture& a, const Picture& b) {
  int count = 0;
  for (std::size_t i = 0; i + 2 < a.rgb.size(); i += 3) {
    const bool same =
        a.rgb[i] == b.rgb[i] && a.rgb[i + 1] == b.rgb[i + 1] && a.rgb[i + 2] == b.rgb[i + 2];
    count += same ? 0 : 1;
  }
  return count;
}

glm::ivec2 pixel_of(const Projection& projection, const Vec3& point_mm) {
  const glm::dvec4 clip = glm::dmat4(projection.clip_from_world) * glm::dvec4(point_mm, 1.0);
  const glm::dvec2 size(projection.size_px);
  return {static_cast<int>(std::floor((clip.x / clip.w * 0.5 + 0.5) * size.x)),
          static_cast<int>(std::floor((0.5 - clip.y / clip.w * 0.5) * size.y))};
}

SceneUpdate moment_update(const Vec3& tip_mm, std::uint64_t past_vertices) {
  Moment moment;
  moment.tool_pose = ToolPose{tip_mm};
  moment.past_vertices = past_vertices;
  SceneUpdate update;
  update.moment = std::make_shared<const Moment>(std::move(moment));
  return update;
}

void add_box(MeshPatch* patch, const Box& box, bool is_hollow) {
  for (int axis = 0; axis < 3; ++axis) {
    for (const bool is_high : {false, true}) {
      const int u = (axis + 1) % 3, v = (axis + 2) % 3;
      glm::vec3 normal(0.0f);
      normal[axis] = is_high != is_hollow ? 1.0f : -1.0f;
      const auto first = static_cast<std::uint32_t>(patch->vertices.size());
      for (const auto& [at_u, at_v] : {std::pair{0, 0}, {1, 0}, {1, 1}, {0, 1}}) {
        Vec3 p;
        p[axis] = is_high ? box.max[axis] : box.min[axis];
        p[u] = at_u == 1 ? box.max[u] : box.min[u];
        p[v] = at_v == 1 ? box.max[v] : box.min[v];
        patch->vertices.push_back({glm::vec3(p), pack_normal(normal)});
      }
      const auto turned = is_high != is_hollow ? std::array{0u, 1u, 2u, 0u, 2u, 3u}
                                               : std::array{0u, 2u, 1u, 0u, 3u, 2u};
      for (const std::uint32_t corner : turned) patch->indices.push_back(first + corner);
    }
  }
  patch->skirt_begin = static_cast<std::uint32_t>(patch->indices.size());
}

std::shared_ptr<const SceneMachine> box_machine(const std::vector<Box>& boxes) {
  auto machine = std::make_shared<SceneMachine>();
  machine->name = "boxes";
  for (const Box& box : boxes) {
    MeshPatch patch;
    add_box(&patch, box);
    auto mesh = std::make_shared<TriangleMesh>();
    for (const MeshVertex& vertex : patch.vertices) {
      mesh->positions_mm.push_back(vertex.position_mm);
    }
    for (std::size_t i = 0; i + 2 < patch.indices.size(); i += 3) {
      mesh->triangles.push_back({patch.indices[i], patch.indices[i + 1], patch.indices[i + 2]});
    }
    machine->links.push_back({"link", std::move(mesh), 0xff60a0d0});
  }
  return machine;
}

void SceneRendererTest::SetUp() {
  unsetenv("DISPLAY");
  Result<GlContext> context = GlContext::create_offscreen();
  ASSERT_TRUE(context) << context.error();
  context_.emplace(std::move(*context));
  everything_.upload_bytes_per_frame = std::size_t{1} << 30;
}

SceneRenderer SceneRendererTest::renderer() {
  Result<SceneRenderer> made = SceneRenderer::create();
  EXPECT_TRUE(made) << made.error();
  return std::move(*made);
}

SceneUpdate SceneRendererTest::first_update(TestWorkpiece* workpiece) {
  SceneUpdate update;
  update.setup = workpiece->setup();
  update.patches = workpiece->take_patches();
  update.path = path_chunks(test_path(workpiece->cells_x(), workpiece->cells_y()));
  update.tool_shape = test_tool();
  return update;
}

Projection SceneRendererTest::view_of(const SceneRenderer& renderer) {
  camera_.fit(renderer.fit_box(), kSize_px);
  return camera_.projection(renderer.depth_box(), kSize_px);
}

void SceneRendererTest::draw(SceneRenderer* renderer, const Projection& projection,
                             const DrawOptions& options) {
  const Done done = renderer->draw(projection, options);
  ASSERT_TRUE(done) << done.error();
}

std::size_t SceneRendererTest::layers_and_tool_bytes() {
  const ToolMesh tool = tool_mesh(*test_tool());
  const std::size_t layers = 2 * 8 * std::size_t{kSize_px.x} * std::size_t{kSize_px.y};
  return layers + tool.vertices.size() * sizeof(MeshVertex) + tool.indices.size() * 4;
}

}  // namespace kerf
