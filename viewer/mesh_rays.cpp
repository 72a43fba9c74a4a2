#include "viewer/mesh_rays.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <numeric>
#include <utility>

namespace kerf {
namespace {

constexpr std::size_t kLeafTriangles = 4;
/// Halving what has 2^32 triangles is over before.
constexpr std::size_t kDeepest = 64;

/// The way from 0 to `end` has a part in the box.
bool passes(const glm::vec3& min, const glm::vec3& max, const Vec3& from, const Vec3& way,
            double end) {
  double begin = 0.0;
  for (int axis = 0; axis < 3; ++axis) {
    const auto low = static_cast<double>(min[axis]), high = static_cast<double>(max[axis]);
    if (way[axis] == 0.0) {
      if (from[axis] < low || from[axis] > high) return false;
      continue;
    }
    const double a = (low - from[axis]) / way[axis], b = (high - from[axis]) / way[axis];
    begin = std::max(begin, std::min(a, b));
    end = std::min(end, std::max(a, b));
  }
  return begin <= end;
}

}  // namespace

MeshRays::MeshRays(std::shared_ptr<const TriangleMesh> mesh) : mesh_(std::move(mesh)) {
  if (!mesh_ || mesh_->triangles.empty()) return;
  std::vector<glm::vec3> middles;
  middles.reserve(mesh_->triangles.size());
  for (const auto& corners : mesh_->triangles) {
    glm::vec3 sum(0.0f);
    for (const std::uint32_t corner : corners) sum += mesh_->positions_mm[corner];
    middles.push_back(sum / 3.0f);
  }
  order_.resize(middles.size());
  std::iota(order_.begin(), order_.end(), 0u);
  build(0, order_.size(), middles);
}

void MeshRays::build(std::size_t first, std::size_t count, const std::vector<glm::vec3>& middles) {
  constexpr float kFar = std::numeric_limits<float>::max();
  Node node{glm::vec3(kFar), glm::vec3(-kFar), 0, 0};
  glm::vec3 low(kFar), high(-kFar);
  for (std::size_t i = first; i < first + count; ++i) {
    for (const std::uint32_t corner : mesh_->triangles[order_[i]]) {
      node.min = glm::min(node.min, mesh_->positions_mm[corner]);
      node.max = glm::max(node.max, mesh_->positions_mm[corner]);
    }
    low = glm::min(low, middles[order_[i]]);
    high = glm::max(high, middles[order_[i]]);
  }
  const std::size_t at = nodes_.size();
  nodes_.push_back(node);
  if (count <= kLeafTriangles) {
    nodes_[at].first = static_cast<std::uint32_t>(first);
    nodes_[at].count = static_cast<std::uint32_t>(count);
    return;
  }
  const glm::vec3 size = high - low;
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  const std::size_t half = count / 2;
  const auto begin = order_.begin() + static_cast<std::ptrdiff_t>(first);
  std::nth_element(begin, begin + static_cast<std::ptrdiff_t>(half),
                   begin + static_cast<std::ptrdiff_t>(count),
                   [&](std::uint32_t a, std::uint32_t b) {
                     return std::pair(middles[a][axis], a) < std::pair(middles[b][axis], b);
                   });
  build(first, half, middles);
  nodes_[at].first = static_cast<std::uint32_t>(nodes_.size());
  build(first + half, count - half, middles);
}

std::optional<MeshRays::Met> MeshRays::meet(std::size_t which, const Vec3& from_mm,
                                            const Vec3& way_mm) const {
  const auto& corners = mesh_->triangles[order_[which]];
  const Vec3 a(mesh_->positions_mm[corners[0]]);
  const Vec3 ab = Vec3(mesh_->positions_mm[corners[1]]) - a;
  const Vec3 ac = Vec3(mesh_->positions_mm[corners[2]]) - a;
  const Vec3 across = glm::cross(way_mm, ac);
  const double volume = glm::dot(ab, across);
  if (volume == 0.0) return std::nullopt;  // seen edge on
  const Vec3 from_a = from_mm - a;
  const double u = glm::dot(from_a, across) / volume;
  if (u < 0.0 || u > 1.0) return std::nullopt;
  const Vec3 other = glm::cross(from_a, ab);
  const double v = glm::dot(way_mm, other) / volume;
  if (v < 0.0 || u + v > 1.0) return std::nullopt;
  const double along = glm::dot(ac, other) / volume;
  if (along < 0.0) return std::nullopt;
  return Met{{along, order_[which], u, v}, volume > 0.0};
}

template <class End, class Leaf>
bool MeshRays::walk(const Vec3& from_mm, const Vec3& way_mm, const End& end,
                    const Leaf& leaf) const {
  if (nodes_.empty()) return false;
  std::uint32_t waiting[kDeepest];
  std::size_t count = 0;
  for (std::uint32_t at = 0;;) {
    const Node& node = nodes_[at];
    bool goes_on = passes(node.min, node.max, from_mm, way_mm, end());
    if (goes_on && node.count > 0) {
      for (std::uint32_t i = 0; i < node.count; ++i)
        if (leaf(node.first + i)) return true;
      goes_on = false;
    }
    if (goes_on) {
      waiting[count++] = node.first;
      ++at;
    } else if (count > 0) {
      at = waiting[--count];
    } else {
      return false;
    }
  }
}

bool MeshRays::hits(const Vec3& from_mm, const Vec3& to_mm) const {
  const Vec3 way = to_mm - from_mm;
  return walk(
      from_mm, way, [] { return 1.0; },
      [&](std::size_t which) {
        const std::optional<Met> met = meet(which, from_mm, way);
        return met && met->hit.t <= 1.0;
      });
}

std::optional<MeshRays::Hit> MeshRays::first_front(const Vec3& from_mm, const Vec3& way_mm,
                                                   double before_t) const {
  Hit first;
  first.t = before_t;
  bool is_met = false;
  walk(
      from_mm, way_mm, [&] { return first.t; },
      [&](std::size_t which) {
        const std::optional<Met> met = meet(which, from_mm, way_mm);
        if (met && met->is_front && met->hit.t < first.t) {
          first = met->hit;
          is_met = true;
        }
        return false;
      });
  return is_met ? std::optional(first) : std::nullopt;
}

}  // namespace kerf
