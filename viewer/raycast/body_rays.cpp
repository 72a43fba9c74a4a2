#include "viewer/raycast/body_rays.h"

#include <algorithm>
#include <functional>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <limits>
#include <optional>
#include <utility>

#include "viewer/raycast/parallel.h"
#include "viewer/raycast/ray_frame.h"
#include "viewer/raycast/scene_light.h"
#include "viewer/shaded_mesh.h"
#include "viewer/sight_lines.h"

namespace kerf {
namespace {

constexpr std::size_t kLeastRowsForTwo = 16;

/// Where a ray meets a body.
struct BodyHit {
  double t = 0.0;
  glm::vec3 color{0.0f};
  float opacity = 0.0f;
};

/// A place on the line that lies before the box: rays without perspective begin nowhere.
double before(const Box& box, const Vec3& origin, const Vec3& way) {
  const Vec3 middle = 0.5 * (box.min + box.max);
  const double length = glm::length(way);
  return glm::dot(middle - origin, way) / (length * length) - glm::length(box.size()) / length;
}

void blend(const BodyHit& hit, std::uint8_t* rgb) {
  for (int k = 0; k < 3; ++k) {
    const float below = static_cast<float>(rgb[k]) / 255.0f;
    const float color = glm::mix(below, std::clamp(hit.color[k], 0.0f, 1.0f), hit.opacity);
    rgb[k] = static_cast<std::uint8_t>(color * 255.0f + 0.5f);
  }
}

}  // namespace

void BodyRays::set_bodies(const SceneMachine& bodies) {
  bodies_.clear();
  for (const MachineLink& link : bodies.links) {
    Body body;
    const std::uint32_t c = link.color;
    body.rgba = glm::vec4(c & 0xffu, c >> 8 & 0xffu, c >> 16 & 0xffu, c >> 24) / 255.0f;
    auto mesh = std::make_shared<TriangleMesh>();
    const ShadedMesh shaded = link.mesh ? shade_mesh(*link.mesh, {}) : ShadedMesh{};
    for (const MeshVertex& vertex : shaded.vertices) {
      mesh->positions_mm.push_back(vertex.position_mm);
      body.normals.push_back(unpack_normal(vertex.normal));
      body.box_mm.extend(Vec3(vertex.position_mm));
    }
    for (std::size_t i = 0; i + 2 < shaded.indices.size(); i += 3)
      mesh->triangles.push_back({shaded.indices[i], shaded.indices[i + 1], shaded.indices[i + 2]});
    body.mesh = mesh;
    body.rays = MeshRays(std::move(mesh));
    bodies_.push_back(std::move(body));
  }
}

std::vector<BodyRays::Placed> BodyRays::placed(const Projection& projection,
                                               std::span<const glm::mat4> poses,
                                               const Box& part_mm) const {
  double reach_mm = glm::length(part_mm.size());
  for (const Body& body : bodies_) reach_mm += glm::length(body.box_mm.size());
  const std::vector<SightLine> lines = sight_lines(part_mm, projection, reach_mm);
  std::vector<Placed> all;
  for (std::size_t i = 0; i < std::min(bodies_.size(), poses.size()); ++i) {
    const Body& body = bodies_[i];
    if (poses[i] == kNotDrawn || body.mesh->triangles.empty()) continue;
    Placed one{&body, glm::inverse(glm::dmat4(poses[i])),
               glm::mat3(projection.view_from_world) * glm::mat3(poses[i]), body.rgba};
    one.rgba.a = std::min(one.rgba.a, most_opacity(body.rays, poses[i], lines));
    all.push_back(one);
  }
  return all;
}

void BodyRays::draw(const Projection& projection, std::span<const glm::mat4> poses,
                    const Box& part_mm, std::span<const float> depths, int threads,
                    Picture* picture) const {
  const std::vector<Placed> all = placed(projection, poses, part_mm);
  if (all.empty()) return;
  const RayFrame frame(projection.clip_from_world, projection.size_px);
  const glm::vec3 up = up_view(projection);
  const auto meet = [&](const Placed& one, const Ray& ray) -> std::optional<BodyHit> {
    const Vec3 origin(one.body_from_world * glm::dvec4(ray.origin_mm, 1.0));
    const Vec3 way(one.body_from_world * glm::dvec4(ray.direction_mm, 0.0));
    const double begin_t = std::max(ray.t_min, before(one.body->box_mm, origin, way));
    const auto hit = one.body->rays.first_front(origin + begin_t * way, way,
                                                std::numeric_limits<double>::infinity());
    if (!hit) return std::nullopt;
    const auto& corners = one.body->mesh->triangles[hit->triangle];
    const auto u = static_cast<float>(hit->u), v = static_cast<float>(hit->v);
    const glm::vec3 normal = (1.0f - u - v) * one.body->normals[corners[0]] +
                             u * one.body->normals[corners[1]] + v * one.body->normals[corners[2]];
    const glm::vec3 seen = glm::normalize(one.view_from_body * normal);
    return BodyHit{begin_t + hit->t, scene_light::lit(glm::vec3(one.rgba), seen, up), one.rgba.a};
  };
  const auto rows = static_cast<std::size_t>(projection.size_px.y);
  const auto columns = static_cast<std::size_t>(projection.size_px.x);
  for_each_piece(rows, threads, kLeastRowsForTwo, [&](std::size_t y) {
    std::vector<BodyHit> hits;
    for (std::size_t x = 0; x < columns; ++x) {
      const Ray ray = frame.ray(static_cast<double>(x) + 0.5, static_cast<double>(y) + 0.5);
      const std::size_t pixel = y * columns + x;
      hits.clear();
      for (const Placed& one : all) {
        const auto hit = meet(one, ray);
        if (hit && frame.depth(ray, hit->t) < depths[pixel]) hits.push_back(*hit);
      }
      std::ranges::sort(hits, std::greater{}, &BodyHit::t);
      for (const BodyHit& hit : hits) blend(hit, &picture->rgb[3 * pixel]);
    }
  });
}

}  // namespace kerf
