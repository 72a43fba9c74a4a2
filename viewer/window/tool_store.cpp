#include "viewer/window/tool_store.h"

#include <algorithm>
#include <array>
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
constexpr glm::vec3 kSpindleColor{0.42f, 0.45f, 0.50f};
constexpr std::array kColors{kCutterColor, kShankColor, kHolderColor, kSpindleColor};
static_assert(kColors.size() == kToolPieceCount);
/// What they are about is to be seen.
constexpr float kHolderOpacity = 0.6f, kSpindleOpacity = 0.35f;

}  // namespace

void ToolStore::set_shape(const ToolShape& shape) {
  mesh_ = tool_mesh(shape);
  buffers_.load(mesh_.vertices.data(), mesh_.vertices.size() * sizeof(MeshVertex), mesh_.indices);
  has_changed_ = true;
}

void ToolStore::set_pose(const std::optional<ToolPose>& pose) {
  if (pose == pose_) return;
  pose_ = pose;
  has_changed_ = true;
}

void ToolStore::set_marks(const ToolMarks& marks) {
  if (marks == marks_) return;
  marks_ = marks;
  has_changed_ = true;
}

bool ToolStore::take_changed() { return std::exchange(has_changed_, false); }

glm::mat4 ToolStore::world_from_tool() const {
  const Vec3 z = glm::normalize(pose_->axis);
  // Any direction across the axis will do where the tool is round. What is not stands upright: its
  // x is that of the workpiece.
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

template <typename Draw>
void ToolStore::each_piece(const ToolLook& look, const Draw& draw) const {
  const auto show = [&](ToolPiece piece, float opacity) {
    const bool is_marked = mark_of(piece) != BodyMark::kNone;
    draw(piece, is_marked ? std::max(opacity, kLeastMarkedOpacity) : opacity);
  };
  if (look.shows_cutter) show(ToolPiece::kCutter, look.cutter_opacity);
  if (!look.shows_holder) return;
  show(ToolPiece::kShank, look.holder_opacity);
  show(ToolPiece::kHolder, kHolderOpacity * look.holder_opacity);
  show(ToolPiece::kSpindle, kSpindleOpacity * look.holder_opacity);
}

void ToolStore::draw_piece(ToolPiece piece, const GlProgram& program, float opacity) const {
  const ToolMesh::Part& part = mesh_.pieces[static_cast<std::size_t>(piece)];
  const glm::vec3& color = kColors[static_cast<std::size_t>(piece)];
  program.set("rgba", glm::vec4(color_of(mark_of(piece), color), opacity));
  buffers_.draw(part.first_index, part.index_count);
}

void ToolStore::draw(const Projection& projection, const GlProgram& program, const ToolLook& look,
                     bool opaque_parts) const {
  if (!pose_) return;
  const glm::mat4 world = world_from_tool();
  program.set("clip_from_model", projection.clip_from_world * world);
  program.set("view_from_model", projection.view_from_world * world);
  each_piece(look, [&](ToolPiece piece, float opacity) {
    if ((opacity >= 1.0f) == opaque_parts) draw_piece(piece, program, opacity);
  });
}

void ToolStore::draw_marked(const Projection& projection, const GlProgram& program,
                            const ToolLook& look) const {
  if (!pose_) return;
  const glm::mat4 world = world_from_tool();
  program.set("clip_from_model", projection.clip_from_world * world);
  program.set("view_from_model", projection.view_from_world * world);
  each_piece(look, [&](ToolPiece piece, float) {
    if (mark_of(piece) != BodyMark::kNone) draw_piece(piece, program, kHiddenMarkOpacity);
  });
}

}  // namespace kerf
