#include "mesh/stl_mesh.h"

#include <gtest/gtest.h>

#include <cstring>

#include "base/mesh_file.h"
#include "tests/base/temporary_folder.h"
#include "tests/twin/machines/mesh_support.h"
#include "twin/machines/mesh_builder.h"

namespace kerf {
namespace {

constexpr const char* kTetrahedron =
    "solid a part\n"
    " facet normal 0 0 -1\n  outer loop\n   vertex 0 0 0\n   vertex 0 1 0\n   vertex 1 0 0\n"
    "  endloop\n endfacet\n"
    " facet normal nan nan nan\n  outer loop\n   vertex 0 0 0\n   vertex 1 0 0\n   vertex 0 0 1\n"
    "  endloop\n endfacet\n"
    " facet normal -1 0 0\n  outer loop\n   vertex 0 0 0\n   vertex 0 0 1\n   vertex 0 1 0\n"
    "  endloop\n endfacet\n"
    "endsolid a part\nsolid b\n"
    " facet normal 1 1 1\n  outer loop\n   vertex 1 0 0\n   vertex 0 1 0\n   vertex 0 0 1.0e0\n"
    "  endloop\n endfacet\n"
    "endsolid b\n";

std::string said_of(std::string_view bytes) {
  const Result<TriangleMesh> mesh = parse_stl(bytes, "a.stl", 1);
  return mesh ? std::to_string(mesh->triangles.size()) : mesh.error();
}

std::string binary_cube() {
  MeshBuilder cube;
  cube.box({0, 0, 0}, {10, 20, 30});
  const TemporaryFolder folder;
  const std::string path = folder / "cube.stl";
  EXPECT_TRUE(write_stl(path, cube.mesh()));
  const Result<TriangleMesh> read = read_stl(path, 25.4);
  EXPECT_TRUE(read);
  EXPECT_NEAR(volume_mm3(*read), 6000 * 25.4 * 25.4 * 25.4, 100);
  std::FILE* const file = std::fopen(path.c_str(), "rb");
  std::string bytes(4096, '\0');
  bytes.resize(std::fread(bytes.data(), 1, bytes.size(), file));
  std::fclose(file);
  return bytes;
}

TEST(StlMesh, TextIsReadWithItsCornersJoined) {
  const Result<TriangleMesh> mesh = parse_stl(kTetrahedron, "a.stl", 2);
  ASSERT_TRUE(mesh) << mesh.error();
  EXPECT_EQ(mesh->positions_mm.size(), 4U);
  EXPECT_EQ(open_edges(*mesh), 0U);
  EXPECT_NEAR(volume_mm3(*mesh), 8.0 / 6, 1e-6);
}

TEST(StlMesh, BinaryIsReadAlsoIfItSaysSolid) {
  std::string bytes = binary_cube();
  EXPECT_EQ(said_of(bytes), "12");
  std::memcpy(bytes.data(), "solid cube", 10);
  EXPECT_EQ(said_of(bytes), "12");
  EXPECT_EQ(open_edges(*parse_stl(bytes, "", 1)), 0U);
}

TEST(StlMesh, FaultsSayWhatAndWhere) {
  const std::string cube = binary_cube();
  EXPECT_EQ(said_of(""), "a.stl: is empty");
  EXPECT_EQ(said_of("<html>"), "a.stl: no STL: 6 bytes, and the first word is not 'solid'");
  EXPECT_EQ(
      said_of(cube.substr(0, 400)),
      "a.stl: cut off, or no STL: 12 triangles announced, which take 684 bytes, but 400 bytes "
      "found");
  std::string far = cube;
  const float infinite = INFINITY;
  std::memcpy(far.data() + 84 + 50 + 12, &infinite, 4);
  EXPECT_EQ(said_of(far), "a.stl: triangle 2: a corner is no number, or farther away than 100 m");
  std::string typo = kTetrahedron;
  typo.replace(typo.find("vertex 0 1 0"), 6, "vertx ");
  EXPECT_EQ(said_of(typo), "a.stl:5: 'vertx' found where 'vertex' is due");
  typo = kTetrahedron;
  typo.replace(typo.find("1.0e0"), 5, "1,0e0");
  EXPECT_EQ(said_of(typo), "a.stl:29: '1,0e0' found where 'a number' is due");
  EXPECT_EQ(said_of("solid x\nendsolid x\n"), "a.stl: has no triangles");
  EXPECT_EQ(read_stl("/nonexistent/a.stl", 1).error(),
            "cannot read /nonexistent/a.stl: No such file or directory");
}

TEST(StlMesh, CutAtEveryByteIsAnErrorOrAMesh) {
  const std::string text = kTetrahedron;
  for (std::size_t size = 0; size < text.size(); ++size) {
    const Result<TriangleMesh> mesh = parse_stl(std::string_view(text).substr(0, size), "a", 1);
    // Whole solids only: the first one, or both but for the rest of the last line.
    if (mesh) {
      EXPECT_TRUE(mesh->triangles.size() == 3 || mesh->triangles.size() == 4) << size;
    }
  }
  const std::string cube = binary_cube();
  for (std::size_t size = 0; size < cube.size(); ++size) {
    EXPECT_FALSE(parse_stl(std::string_view(cube).substr(0, size), "a", 1)) << size;
  }
}

}  // namespace
}  // namespace kerf
