// Tools as triangles: turned outlines, and plates.
#include "viewer/window/tool_mesh.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>
#include <map>

namespace kerf {
namespace {

glm::dvec3 corner_of(const ToolMesh& mesh, const ToolMesh::Part& part, std::size_t i) {
  return glm::dvec3(mesh.vertices[mesh.indices[part.first_index + i]].position_mm);
}

double volume_mm3(const ToolMesh& mesh, ToolPiece piece) {
  const ToolMesh::Part& part = mesh.pieces[static_cast<std::size_t>(piece)];
  double sum = 0;
  for (std::size_t i = 0; i + 2 < part.index_count; i += 3) {
    const glm::dvec3 a = corner_of(mesh, part, i), b = corner_of(mesh, part, i + 1),
                     c = corner_of(mesh, part, i + 2);
    sum += glm::dot(a, glm::cross(b, c)) / 6;
  }
  return sum;
}

double area_mm2(const ToolMesh& mesh, ToolPiece piece) {
  const ToolMesh::Part& part = mesh.pieces[static_cast<std::size_t>(piece)];
  double sum = 0;
  for (std::size_t i = 0; i + 2 < part.index_count; i += 3) {
    const glm::dvec3 a = corner_of(mesh, part, i), b = corner_of(mesh, part, i + 1),
                     c = corner_of(mesh, part, i + 2);
    sum += glm::length(glm::cross(b - a, c - a)) / 2;
  }
  return sum;
}

/// 12 x 8 mm, of which the lower edge and the one at greater z cut.
ToolPlate plate() {
  ToolPlate plate;
  plate.corners = {{{0, 0}, true}, {{12, 0}, true}, {{12, 8}, false}, {{0, 8}, false}};
  plate.low_y_mm = -5;
  return plate;
}

TEST(ToolMesh, APlateIsAClosedBlock) {
  ToolShape shape;
  shape.plates = {plate()};
  const ToolMesh mesh = tool_mesh(shape);
  EXPECT_NEAR(volume_mm3(mesh, ToolPiece::kCutter), 12 * 8 * 5, 1e-3);
  EXPECT_NEAR(area_mm2(mesh, ToolPiece::kCutter), 2 * (96 + 60 + 40), 1e-3);
  EXPECT_EQ(mesh.bounds_mm.min, Vec3(0, -5, 0));
  EXPECT_NEAR(mesh.bounds_mm.max.x, 8, 1e-9);
  EXPECT_NEAR(mesh.bounds_mm.max.z, 12, 1e-9);
  for (const ToolPiece piece : {ToolPiece::kHolder, ToolPiece::kSpindle})
    EXPECT_EQ(mesh.pieces[static_cast<std::size_t>(piece)].index_count, 0u);
}

/// Half a millimetre beside the two edges that cut is left out.
TEST(ToolMesh, TheEdgesOfAPlateShowBesideItsMiddle) {
  ToolShape shape;
  shape.plates = {plate()};
  EXPECT_NEAR(area_mm2(tool_mesh(shape), ToolPiece::kShank), 11.5 * 7.5, 1e-3);
  shape.plates[0].corners = {{{0, 0}, true}, {{0.6f, 0}, true}, {{0, 0.6f}, true}};
  EXPECT_EQ(area_mm2(tool_mesh(shape), ToolPiece::kShank), 0);  // it is all edge
}

TEST(ToolMesh, NormalsOfAPlatePointOutOfIt) {
  ToolShape shape;
  shape.plates = {plate()};
  const ToolMesh mesh = tool_mesh(shape);
  const glm::vec3 middle(4, -2.5f, 6);
  for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    const MeshVertex &a = mesh.vertices[mesh.indices[i]], &b = mesh.vertices[mesh.indices[i + 1]],
                     &c = mesh.vertices[mesh.indices[i + 2]];
    const glm::vec3 normal =
        glm::normalize(glm::cross(b.position_mm - a.position_mm, c.position_mm - a.position_mm));
    EXPECT_GT(glm::dot(normal, a.position_mm - middle), 0);
    for (const MeshVertex* vertex : {&a, &b, &c})
      EXPECT_GT(glm::dot(normal, unpack_normal(vertex->normal)), 0.99f);
  }
}

TEST(ToolMesh, WhatHoldsAPlateIsOfTheHolder) {
  ToolShape shape;
  shape.plates = {plate()};
  shape.plates[0].is_holder = true;
  const ToolMesh mesh = tool_mesh(shape);
  EXPECT_NEAR(volume_mm3(mesh, ToolPiece::kHolder), 480, 1e-3);
  EXPECT_EQ(mesh.pieces[static_cast<std::size_t>(ToolPiece::kCutter)].index_count, 0u);
  EXPECT_EQ(mesh.pieces[static_cast<std::size_t>(ToolPiece::kShank)].index_count, 0u);
}

}  // namespace
}  // namespace kerf
