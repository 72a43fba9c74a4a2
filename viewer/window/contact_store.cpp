#include "viewer/window/contact_store.h"

#include <cmath>
#include <cstdint>
#include <glm/gtc/matrix_transform.hpp>
#include <utility>

#include "base/mesh_patch.h"
#include "viewer/window/body_mark.h"

namespace kerf {
namespace {

constexpr std::uint32_t kAround = 24, kUpward = 12;

/// A mesh of radius 1 about the origin.
void load_ball(MeshBuffers* ball) {
  std::vector<MeshVertex> vertices;
  std::vector<std::uint32_t> indices;
  for (std::uint32_t ring = 0; ring <= kUpward; ++ring) {
    const double up = kPi * ring / kUpward;
    for (std::uint32_t k = 0; k <= kAround; ++k) {
      const double angle = 2 * kPi * k / kAround;
      const glm::vec3 p(std::sin(up) * std::cos(angle), std::sin(up) * std::sin(angle),
                        -std::cos(up));
      vertices.push_back({p, pack_normal(p)});
    }
  }
  for (std::uint32_t ring = 0; ring < kUpward; ++ring) {
    for (std::uint32_t k = 0; k < kAround; ++k) {
      const std::uint32_t low = ring * (kAround + 1) + k, high = low + kAround + 1;
      const std::uint32_t quad[] = {low, low + 1, high + 1, low, high + 1, high};
      indices.insert(indices.end(), std::begin(quad), std::end(quad));
    }
  }
  ball->load(vertices.data(), vertices.size() * sizeof(MeshVertex), indices);
}

}  // namespace

void ContactStore::set_contacts(std::span<const SceneContact> contacts) {
  std::vector<SceneContact> placed;
  for (const SceneContact& contact : contacts) {
    if (contact.point_mm) placed.push_back(contact);
  }
  if (placed == contacts_) return;
  contacts_ = std::move(placed);
  if (ball_.gpu_bytes() == 0) load_ball(&ball_);
  has_changed_ = true;
}

bool ContactStore::take_changed() { return std::exchange(has_changed_, false); }

Box ContactStore::bounds_mm() const {
  Box box;
  for (const SceneContact& contact : contacts_) {
    box.extend(*contact.point_mm - Vec3(contact.mark_mm));
    box.extend(*contact.point_mm + Vec3(contact.mark_mm));
  }
  return box;
}

ScreenRect ContactStore::rect(const Projection& projection) const {
  const Box box = bounds_mm();
  return box.empty() ? ScreenRect{} : covered_rect(box, projection);
}

void ContactStore::draw(const Projection& projection, const GlProgram& program,
                        float opacity) const {
  for (const SceneContact& contact : contacts_) {
    const glm::mat4 world =
        glm::scale(glm::translate(glm::mat4(1.0f), glm::vec3(*contact.point_mm)),
                   glm::vec3(static_cast<float>(contact.mark_mm)));
    program.set("clip_from_model", projection.clip_from_world * world);
    program.set("view_from_model", projection.view_from_world * world);
    program.set("rgba", glm::vec4(color_of(mark_of(contact), glm::vec3(1.0f)), opacity));
    ball_.draw_all();
  }
}

}  // namespace kerf
