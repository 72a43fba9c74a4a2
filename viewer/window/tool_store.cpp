#include "viewer/window/tool_store.h"

#include <cmath>
#include <cstddef>
#include <glm/geometric.hpp>
#include <glm/vec4.hpp>
#include <utility>

namespace kerf {
namespace {

constexpr glm::vec3 kCutterColor{0.86f, 0.66f, 0.20f};
constexpr glm::vec3 kShankColor{0.62f, 0.64f, 0.68f};
constexpr glm::vec3 kHolderColor{0.36f, 0.38f, 0.43f};

}  // namespace

void ToolStore::set_shape(const ToolShape& shape) {
  mesh_ = revolve(shape);
  buffers_.load(mesh_.vertices.data(), mesh_.vertices.size() * sizeof(MeshVertex), mesh_.indices);
  has_changed_ = true;
}

void ToolStore::set_pose(const std::optional<ToolPose>& pose) {
  if (pose == pose_) return;
  pose_ = pose;
  has_changed_ = true;
}

bool ToolStore::take_changed() { return std::exchange(has_changed_, false); }

glm::mat4 ToolStore::world_from_tool() const {
  const Vec3 z = glm::normalize(pose_->axis);
  // Any direction across the axis will do: the tool is round.
  const Vec3 across = std::abs(z.x) < 0.9 ? Vec3(1, 0, 0) : Vec3(0, 1, 0);
  const Vec3 y = glm::normalize(glm::cross(z, across));
  const Vec3 x = glm::cross(y, z);
  return glm::mat4(glm::dmat4(glm::dvec4(x, 0.0), glm::dvec4(y, 0.0), glm::dvec4(z, 0.0),
                              glm::dvec4(pose_->tip_mm, 1.0)));
}

ScreenRect ToolStore::rect(const Projection& projection, const ToolLook& look) const {
  if (!pose_ || mesh_.bounds_mm.empty() || (!look.shows_cutter && !look.shows_holder)) return {};
  const glm::mat4 clip_from_tool = projection.clip_from_world * world_from_tool();
  return covered_rect(mesh_.bounds_mm,
                      {clip_from_tool, projection.view_from_world, projection.size_px});
}

Box ToolStore::bounds_mm() const {
  return pose_ ? placed(mesh_.bounds_mm, world_from_tool()) : Box{};
}

void ToolStore::draw(const Projection& projection, const GlProgram& program, const ToolLook& look,
                     bool opaque_parts) const {
  if (!pose_) return;
  const glm::mat4 world = world_from_tool();
  program.set("clip_from_model", projection.clip_from_world * world);
  program.set("view_from_model", projection.view_from_world * world);
  const auto draw_part = [&](const ToolMesh::Part& part, const glm::vec3& color, float opacity) {
    if ((opacity >= 1.0f) != opaque_parts) return;
    program.set("rgba", glm::vec4(color, opacity));
    buffers_.draw(part.first_index, part.index_count);
  };
  if (look.shows_cutter) draw_part(mesh_.cutter, kCutterColor, look.cutter_opacity);
  if (look.shows_holder) {
    draw_part(mesh_.shank, kShankColor, look.holder_opacity);
    draw_part(mesh_.holder, kHolderColor, look.holder_opacity);
  }
}

}  // namespace kerf
