#include "base/mesh_file.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <glm/geometric.hpp>
#include <sstream>
#include <string>

#include "tests/base/temporary_folder.h"

namespace kerf {
namespace {

TriangleMesh tetrahedron() {
  return {{{0, 0, 0}, {10, 0, 0}, {0, 20, 0}, {0, 0, 30}},
          {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}};
}

/// A strip of `count` triangles with corners that differ in all bytes.
TriangleMesh strip(std::uint32_t count) {
  TriangleMesh mesh;
  for (std::uint32_t i = 0; i < count + 2; ++i) {
    mesh.positions_mm.emplace_back(float(i) * 0.37f, float(i % 2), std::sin(float(i)));
  }
  for (std::uint32_t i = 0; i < count; ++i) mesh.triangles.push_back({i, i + 1, i + 2});
  return mesh;
}

/// Reads little endian byte by byte, so that it works on any host.
class Reader {
 public:
  explicit Reader(const std::string& bytes) : bytes_(bytes) {}
  unsigned byte() { return static_cast<unsigned char>(bytes_.at(at_++)); }
  std::uint32_t u32() {
    std::uint32_t value = 0;
    for (int i = 0; i < 4; ++i) value |= std::uint32_t(byte()) << (8 * i);
    return value;
  }
  float real() {
    const std::uint32_t bits = u32();
    float value;
    std::memcpy(&value, &bits, sizeof value);
    return value;
  }
  glm::vec3 vec3() {
    const float x = real();
    const float y = real();
    return {x, y, real()};
  }
  void skip(std::size_t bytes) { at_ += bytes; }
  bool at_end() const { return at_ == bytes_.size(); }

 private:
  const std::string& bytes_;
  std::size_t at_ = 0;
};

void expect_stl_holds(const std::string& bytes, const TriangleMesh& mesh) {
  ASSERT_EQ(bytes.size(), 84 + 50 * mesh.triangles.size());
  EXPECT_EQ(bytes.substr(0, 5), "kerf:");
  Reader reader(bytes);
  reader.skip(80);
  ASSERT_EQ(reader.u32(), mesh.triangles.size());
  for (const auto& t : mesh.triangles) {
    const glm::vec3 normal = reader.vec3();
    const glm::dvec3 a = mesh.positions_mm[t[0]];
    const glm::dvec3 b = mesh.positions_mm[t[1]];
    const glm::dvec3 c = mesh.positions_mm[t[2]];
    const glm::dvec3 expected = glm::normalize(glm::cross(b - a, c - a));
    ASSERT_LT(glm::length(glm::dvec3(normal) - expected), 1e-6);
    for (const std::uint32_t corner : t) ASSERT_EQ(reader.vec3(), mesh.positions_mm[corner]);
    ASSERT_EQ(reader.byte() + reader.byte(), 0u);
  }
  EXPECT_TRUE(reader.at_end());
}

TEST(WriteStl, holds_every_triangle) {
  const TemporaryFolder folder;
  for (const TriangleMesh& mesh : {tetrahedron(), strip(50000), TriangleMesh{}}) {
    ASSERT_TRUE(write_stl(folder / "part.stl", mesh));
    expect_stl_holds(read_file(folder / "part.stl"), mesh);
  }
  EXPECT_EQ(folder.names(), std::vector<std::string>{"part.stl"});
}

TEST(WriteStl, bytes_of_one_triangle) {
  const TemporaryFolder folder;
  const TriangleMesh mesh{{{0, 0, 1}, {2, 0, 1}, {0, 2, 1}}, {{0, 1, 2}}};
  ASSERT_TRUE(write_stl(folder / "one.stl", mesh));
  std::string expected = "kerf: binary STL, unit mm";
  expected.resize(80, '\0');
  const std::string zero(4, '\0'), one("\0\0\x80\x3f", 4), two("\0\0\0\x40", 4);
  expected += std::string("\1\0\0\0", 4);
  expected += zero + zero + one;  // normal
  expected += zero + zero + one + two + zero + one + zero + two + one;
  expected += std::string(2, '\0');
  EXPECT_EQ(read_file(folder / "one.stl"), expected);
}

TEST(WriteStl, normals_of_tiny_and_of_empty_triangles) {
  const TemporaryFolder folder;
  const float s = 1e-15f;  // the area squared is below the least float
  const TriangleMesh mesh{{{0, 0, 0}, {s, 0, 0}, {0, s, 0}, {2 * s, 0, 0}}, {{0, 2, 1}, {0, 1, 3}}};
  ASSERT_TRUE(write_stl(folder / "tiny.stl", mesh));
  const std::string bytes = read_file(folder / "tiny.stl");
  Reader reader(bytes);
  reader.skip(84);
  EXPECT_EQ(reader.vec3(), glm::vec3(0, 0, -1));
  reader.skip(38);
  EXPECT_EQ(reader.vec3(), glm::vec3(0, 0, 0));
}

TEST(WritePly, marks_of_vertices_come_behind_their_places) {
  const TemporaryFolder folder;
  const TriangleMesh mesh = tetrahedron();
  VertexMarks marks;
  marks.name = "deviation_mm";
  for (std::size_t n = 0; n < mesh.positions_mm.size(); ++n) {
    marks.rgb.push_back({static_cast<std::uint8_t>(n), 200, 255});
    marks.values.push_back(0.5f - static_cast<float>(n));
  }
  ASSERT_TRUE(write_ply(folder / "part.ply", mesh, marks));
  const std::string bytes = read_file(folder / "part.ply");
  const std::string end =
      "property uchar red\nproperty uchar green\nproperty uchar blue\n"
      "property float deviation_mm\nelement face ";
  ASSERT_NE(bytes.find(end), std::string::npos);
  const std::size_t begin = bytes.find("end_header\n") + 11;
  ASSERT_EQ(bytes.size(), begin + mesh.positions_mm.size() * 19 + mesh.triangles.size() * 13);
  for (std::size_t n = 0; n < mesh.positions_mm.size(); ++n) {
    Reader reader(bytes);
    reader.skip(begin + 19 * n);
    EXPECT_EQ(reader.vec3(), mesh.positions_mm[n]);
    const std::size_t at = begin + 19 * n + 12;
    EXPECT_EQ(bytes.substr(at, 3), (std::string{static_cast<char>(n), '\xc8', '\xff'}));
    float value = 0;
    std::memcpy(&value, bytes.data() + at + 3, 4);
    EXPECT_EQ(value, marks.values[n]);
  }
}

TEST(WritePly, holds_shared_vertices_and_faces) {
  const TemporaryFolder folder;
  for (const TriangleMesh& mesh : {tetrahedron(), strip(90000), TriangleMesh{}}) {
    ASSERT_TRUE(write_ply(folder / "part.ply", mesh));
    const std::string bytes = read_file(folder / "part.ply");
    std::ostringstream head;
    head << "ply\nformat binary_little_endian 1.0\ncomment kerf, unit mm\nelement vertex "
         << mesh.positions_mm.size()
         << "\nproperty float x\nproperty float y\nproperty float z\nelement face "
         << mesh.triangles.size() << "\nproperty list uchar int vertex_indices\nend_header\n";
    ASSERT_EQ(bytes.substr(0, head.str().size()), head.str());
    Reader reader(bytes);
    reader.skip(head.str().size());
    for (const glm::vec3& p : mesh.positions_mm) ASSERT_EQ(reader.vec3(), p);
    for (const auto& t : mesh.triangles) {
      ASSERT_EQ(reader.byte(), 3u);
      for (const std::uint32_t corner : t) ASSERT_EQ(reader.u32(), corner);
    }
    EXPECT_TRUE(reader.at_end());
  }
}

TEST(WriteMesh, failures_name_the_file_and_the_reason) {
  const TemporaryFolder folder;
  const std::string missing = folder / "none/part";
  const std::string no_folder = "writing " + missing + ": No such file or directory";
  const std::string full = "writing /dev/full: No space left on device";
  const Done stl = write_stl(missing, tetrahedron());
  const Done ply = write_ply(missing, tetrahedron());
  const Done full_stl = write_stl("/dev/full", strip(100000));
  const Done full_ply = write_ply("/dev/full", strip(100000));
  ASSERT_FALSE(stl || ply || full_stl || full_ply);
  EXPECT_EQ(stl.error(), no_folder);
  EXPECT_EQ(ply.error(), no_folder);
  EXPECT_EQ(full_stl.error(), full);
  EXPECT_EQ(full_ply.error(), full);
  EXPECT_TRUE(folder.names().empty());
}

}  // namespace
}  // namespace kerf
