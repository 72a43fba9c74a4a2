// tests/stock/octree/dual_contour/sampled_field.h - fields for the tests: of random signs, and of
// bodies.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <glm/geometric.hpp>
#include <random>
#include <vector>

#include "base/geometry.h"
#include "base/mesh_patch.h"
#include "stock/octree/dual_contour.h"
#include "stock/octree/dual_contour_mesh.h"

namespace kerf {

/// A signed distance (negative inside), or any function of the same sign that is smooth between
/// edges of the part, and the unit normal where it is zero.
struct Body {
  std::function<double(const Vec3&)> distance;
  std::function<Vec3(const Vec3&)> normal;
  std::function<std::uint32_t(const Vec3&)> cut_by = [](const Vec3&) { return MeshPatch::kNotCut; };
};

/// All nodes of a field, from (0, 0, 0) up to `nodes`; beyond them nothing is solid.
class SampledField {
 public:
  SampledField(const std::array<int, 3>& nodes, const Vec3& origin_mm, const Vec3& cell_mm)
      : nodes_(nodes), origin_mm_(origin_mm), cell_mm_(cell_mm) {
    const std::size_t count = size(0) * size(1) * size(2);
    solid_.assign(count, 0);
    for (auto& crossings : crossings_) crossings.resize(count);
  }

  /// A node is solid with probability `share`, its crossings are anywhere and face anywhere within
  /// a right angle of the edge.
  static SampledField random(std::minstd_rand* random, const std::array<int, 3>& nodes,
                             double share) {
    SampledField field(nodes, Vec3(3, -5, 7), Vec3(1.0, 1.25, 0.75));
    std::uniform_real_distribution<float> unit(0.0f, 1.0f);
    for (std::size_t n = 0; n < field.solid_.size(); ++n) {
      if (!field.is_rim(n)) field.solid_[n] = unit(*random) < float(share) ? 1 : 0;
    }
    for (std::size_t axis = 0; axis < 3; ++axis) {
      for (std::size_t n = 0; n < field.solid_.size(); ++n) {
        glm::vec3 normal(unit(*random) - 0.5f, unit(*random) - 0.5f, unit(*random) - 0.5f);
        normal[int(axis)] = (field.solid_[n] != 0 ? 0.6f : -0.6f);
        field.crossings_[axis][n] = {unit(*random), glm::normalize(normal), std::uint32_t(n % 7)};
      }
    }
    return field;
  }

  /// Nodes with a negative distance are solid.
  static SampledField of(const Body& body, const std::array<int, 3>& nodes, const Vec3& origin_mm,
                         const Vec3& cell_mm) {
    SampledField field(nodes, origin_mm, cell_mm);
    for (std::size_t n = 0; n < field.solid_.size(); ++n) {
      field.solid_[n] = body.distance(field.place(n)) < 0.0 ? 1 : 0;
    }
    for (std::size_t axis = 0; axis < 3; ++axis) {
      for (std::size_t n = 0; n < field.solid_.size(); ++n) field.cross(body, axis, n);
    }
    return field;
  }
  static SampledField of(const Body& body, const Box& box, double cell_mm) {
    std::array<int, 3> nodes;
    for (int axis = 0; axis < 3; ++axis)
      nodes[std::size_t(axis)] = int(std::ceil(box.size()[axis] / cell_mm)) + 1;
    return of(body, nodes, box.min, Vec3(cell_mm));
  }

  /// Refers to this.
  DualField field() const {
    return {origin_mm_, cell_mm_,
            [this](const std::array<int, 3>& first, const std::array<int, 3>& nodes,
                   HermiteGrid* grid) { gather(first, nodes, grid); }};
  }
  /// All tiles of the field.
  std::vector<std::array<int, 3>> tiles(int cells_per_side) const {
    std::vector<std::array<int, 3>> out;
    for (int k = 0; k * cells_per_side < nodes_[2]; ++k) {
      for (int j = 0; j * cells_per_side < nodes_[1]; ++j) {
        for (int i = 0; i * cells_per_side < nodes_[0]; ++i) out.push_back({i, j, k});
      }
    }
    return out;
  }
  TriangleMesh mesh(int cells_per_side, double tolerance_mm = 0.0, int threads = 1) const {
    const auto all = tiles(cells_per_side);
    return mesh_dual_field(field(), {cells_per_side, all}, tolerance_mm, threads);
  }
  bool solid(int i, int j, int k) const { return solid_[number(i, j, k)] != 0; }
  void set_solid(int i, int j, int k) { solid_[number(i, j, k)] = 1; }
  const std::array<int, 3>& nodes() const { return nodes_; }
  double node_volume() const { return cell_mm_.x * cell_mm_.y * cell_mm_.z; }

 private:
  std::size_t size(std::size_t axis) const { return std::size_t(nodes_[axis]); }
  std::size_t number(int i, int j, int k) const {
    return (std::size_t(k) * size(1) + std::size_t(j)) * size(0) + std::size_t(i);
  }
  std::array<int, 3> indices(std::size_t n) const {
    return {int(n % size(0)), int(n / size(0) % size(1)), int(n / size(0) / size(1))};
  }
  bool is_rim(std::size_t n) const {
    const std::array<int, 3> node = indices(n);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (node[axis] == 0 || node[axis] == nodes_[axis] - 1) return true;
    }
    return false;
  }
  Vec3 place(std::size_t n) const {
    const std::array<int, 3> node = indices(n);
    return origin_mm_ + cell_mm_ * Vec3(node[0], node[1], node[2]);
  }
  std::size_t stride(std::size_t axis) const {
    return axis == 0 ? 1 : axis == 1 ? size(0) : size(0) * size(1);
  }
  void cross(const Body& body, std::size_t axis, std::size_t n) {
    if (indices(n)[axis] + 1 == nodes_[axis] || solid_[n] == solid_[n + stride(axis)]) return;
    double low = 0.0, high = 1.0;
    Vec3 way(0);
    way[int(axis)] = cell_mm_[int(axis)];
    const bool low_is_solid = solid_[n] != 0;
    for (int step = 0; step < 48; ++step) {
      const double middle = 0.5 * (low + high);
      ((body.distance(place(n) + middle * way) < 0.0) == low_is_solid ? low : high) = middle;
    }
    const Vec3 at = place(n) + 0.5 * (low + high) * way;
    crossings_[axis][n] = {float(0.5 * (low + high)), glm::vec3(body.normal(at)), body.cut_by(at)};
  }

  void gather(const std::array<int, 3>& first, const std::array<int, 3>& nodes,
              HermiteGrid* grid) const {
    grid->nodes = nodes;
    grid->origin_mm = origin_mm_ + cell_mm_ * Vec3(first[0], first[1], first[2]);
    grid->cell_mm = cell_mm_;
    const std::size_t count = std::size_t(nodes[0]) * std::size_t(nodes[1]) * std::size_t(nodes[2]);
    grid->solid.assign(count, 0);
    grid->crossings.clear();
    for (auto& edges : grid->edges) edges.assign(count, -1);
    std::size_t out = 0;
    for (int k = 0; k < nodes[2]; ++k) {
      for (int j = 0; j < nodes[1]; ++j) {
        for (int i = 0; i < nodes[0]; ++i, ++out) {
          const std::array<int, 3> node{first[0] + i, first[1] + j, first[2] + k};
          if (!is_inside(node)) continue;
          const std::size_t n = number(node[0], node[1], node[2]);
          grid->solid[out] = solid_[n];
          for (std::size_t axis = 0; axis < 3; ++axis) {
            if (node[axis] + 1 == nodes_[axis] || solid_[n] == solid_[n + stride(axis)]) continue;
            if (std::array<int, 3>{i, j, k}[axis] + 1 == nodes[axis]) continue;
            grid->edges[axis][out] = std::int32_t(grid->crossings.size());
            grid->crossings.push_back(crossings_[axis][n]);
          }
        }
      }
    }
  }
  bool is_inside(const std::array<int, 3>& node) const {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (node[axis] < 0 || node[axis] >= nodes_[axis]) return false;
    }
    return true;
  }

  std::array<int, 3> nodes_;
  Vec3 origin_mm_, cell_mm_;
  std::vector<std::uint8_t> solid_;
  std::array<std::vector<HermiteCrossing>, 3> crossings_;
};

}  // namespace kerf
