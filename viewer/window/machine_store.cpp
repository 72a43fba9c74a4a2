#include "viewer/window/machine_store.h"

#include <algorithm>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <numeric>
#include <utility>

#include "viewer/shaded_mesh.h"

namespace kerf {
namespace {

glm::vec4 rgba_of(std::uint32_t color) {
  return glm::vec4(color & 0xffu, color >> 8 & 0xffu, color >> 16 & 0xffu, color >> 24) / 255.0f;
}

}  // namespace

void MachineStore::set_machine(std::shared_ptr<const SceneMachine> machine) {
  for (const Link& link : links_) dropped_rect_.extend(link.rect);
  links_.clear();
  uploaded_ = 0;
  for (const MachineLink& given : machine->links) {
    Link link;
    link.mesh = given.mesh;
    link.rgba = rgba_of(given.color);
    if (given.mesh) {
      for (const glm::vec3& p : given.mesh->positions_mm) link.box_mm.extend(Vec3(p));
    }
    links_.push_back(std::move(link));
  }
  set_poses(std::exchange(poses_, {}));
  set_marks(std::exchange(marks_, {}));
}

void MachineStore::set_poses(std::span<const glm::mat4> link_poses) {
  poses_.assign(link_poses.begin(), link_poses.end());
  for (std::size_t i = 0; i < links_.size(); ++i) {
    const bool is_known = i < poses_.size() && poses_[i] != kNotDrawn;
    const std::optional<glm::mat4> pose = is_known ? std::optional(poses_[i]) : std::nullopt;
    if (pose == links_[i].pose) continue;
    links_[i].pose = pose;
    links_[i].has_changed = true;
  }
}

void MachineStore::set_marks(std::vector<BodyMark> marks) {
  marks_ = std::move(marks);
  for (std::size_t i = 0; i < links_.size(); ++i) {
    const BodyMark mark = i < marks_.size() ? marks_[i] : BodyMark::kNone;
    if (mark == links_[i].mark) continue;
    links_[i].mark = mark;
    links_[i].has_changed = true;
  }
}

std::size_t MachineStore::upload(std::size_t budget_bytes) {
  std::size_t bytes = 0;
  for (; has_waiting() && (bytes == 0 || bytes < budget_bytes); ++uploaded_) {
    Link& link = links_[uploaded_];
    if (!link.mesh) continue;
    const ShadedMesh shaded = shade_mesh(*link.mesh, {});
    link.buffers.load(shaded.vertices.data(), shaded.vertices.size() * sizeof(MeshVertex),
                      shaded.indices);
    link.rays = MeshRays(link.mesh);
    link.has_changed = true;
    bytes += link.buffers.gpu_bytes();
  }
  return bytes;
}

ScreenRect MachineStore::take_changed(const Projection& projection, const Box& part_mm) {
  ScreenRect changed = std::exchange(dropped_rect_, {});
  const bool is_other_eye = projection != projection_ || !(part_mm == part_mm_);
  if (is_other_eye) {
    const double reach_mm = glm::length(bounds_mm().size()) + glm::length(part_mm.size());
    lines_ = sight_lines(part_mm, projection, reach_mm);
  }
  for (std::size_t i = 0; i < uploaded_; ++i) {
    Link& link = links_[i];
    if (!std::exchange(link.has_changed, false) && !is_other_eye) continue;
    changed.extend(link.rect);
    link.rect = {};
    link.most_opacity = link.pose ? most_opacity(link.rays, *link.pose, lines_) : 1.0f;
    if (link.pose && !link.box_mm.empty()) {
      link.rect = covered_rect(link.box_mm, {projection.clip_from_world * *link.pose,
                                             projection.view_from_world, projection.size_px});
    }
    changed.extend(link.rect);
  }
  projection_ = projection;
  part_mm_ = part_mm;
  return changed;
}

float MachineStore::opacity_of(const Link& link, float opacity) {
  if (link.mark != BodyMark::kNone) return std::max(link.rgba.a, kLeastMarkedOpacity) * opacity;
  return std::min(link.rgba.a * opacity, link.most_opacity);
}

void MachineStore::draw_link(const Link& link, const Projection& projection,
                             const GlProgram& program, float opacity) const {
  program.set("clip_from_model", projection.clip_from_world * *link.pose);
  program.set("view_from_model", projection.view_from_world * *link.pose);
  program.set("rgba", glm::vec4(color_of(link.mark, glm::vec3(link.rgba)), opacity));
  link.buffers.draw_all();
}

void MachineStore::draw_marked(const Projection& projection, const GlProgram& program,
                               const ScreenRect& rect) const {
  for (std::size_t i = 0; i < uploaded_; ++i) {
    const Link& link = links_[i];
    if (link.mark == BodyMark::kNone || !link.pose || !link.rect.intersects(rect)) continue;
    draw_link(link, projection, program, kHiddenMarkOpacity);
  }
}

void MachineStore::draw(const Projection& projection, const GlProgram& program, float opacity,
                        bool opaque_parts, const ScreenRect& rect) const {
  std::vector<std::pair<double, std::size_t>> order;  // by height above the plane of the eye
  for (std::size_t i = 0; i < uploaded_; ++i) {
    const Link& link = links_[i];
    if (!link.pose || !link.rect.intersects(rect)) continue;
    if ((opacity_of(link, opacity) >= 1.0f) != opaque_parts) continue;
    const Vec3 middle = 0.5 * (link.box_mm.min + link.box_mm.max);
    const glm::vec4 seen = projection.view_from_world * *link.pose * glm::vec4(middle, 1.0f);
    order.emplace_back(static_cast<double>(seen.z), i);
  }
  std::sort(order.begin(), order.end());
  for (const auto& [height, i] : order) {
    draw_link(links_[i], projection, program, opacity_of(links_[i], opacity));
  }
}

Box MachineStore::bounds_mm() const {
  Box box;
  for (const Link& link : links_) {
    if (link.pose) box.extend(placed(link.box_mm, *link.pose));
  }
  return box;
}

std::size_t MachineStore::gpu_bytes() const {
  return std::accumulate(
      links_.begin(), links_.end(), std::size_t{0},
      [](std::size_t sum, const Link& l) { return sum + l.buffers.gpu_bytes(); });
}

}  // namespace kerf
