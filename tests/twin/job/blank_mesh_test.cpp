#include "twin/job/blank_mesh.h"

#include <gtest/gtest.h>

#include <cstring>
#include <fstream>

#include "base/mesh_file.h"
#include "mesh/mesh_body.h"
#include "tests/base/temporary_folder.h"
#include "tests/mesh/sample_meshes.h"

namespace kerf {
namespace {

class BlankMeshFile : public testing::Test {
 protected:
  std::string write(const TriangleMesh& mesh) {
    const std::string path = folder_ / "part.stl";
    EXPECT_TRUE(write_stl(path, mesh));
    return path;
  }
  /// As the specification has it; an empty mesh where it is refused.
  Blank read(const std::string& spec) {
    said_.clear();
    Result<Blank> blank = parse_blank(spec);
    EXPECT_TRUE(blank) << blank.error();
    is_read_ = read_blank_mesh(*blank, said_);
    return std::move(blank.value());
  }
  std::string told() const {
    std::string all;
    for (const Diagnostic& d : said_) all += to_string(d) + "\n";
    return all;
  }

  TemporaryFolder folder_;
  Diagnostics said_;
  bool is_read_ = false;
};

TEST_F(BlankMeshFile, IsPlacedAndGrows) {
  const std::string path = write(test::box_of({0, 0, 0}, {60, 40, 20}));
  EXPECT_EQ(read(path).bounds_mm(), (Box{{0, 0, 0}, {60, 40, 20}}));
  EXPECT_TRUE(is_read_);
  EXPECT_EQ(told(), "");
  EXPECT_EQ(read(path + ":flip=x:at=5,0,0").bounds_mm(), (Box{{5, -40, -20}, {65, 0, 0}}));
  EXPECT_EQ(read(path + ":rotate=90,0,0").bounds_mm(), (Box{{0, -20, 0}, {60, 0, 40}}));
  const Box grown = read(path + "+2:at=10,0,0").bounds_mm();
  EXPECT_NEAR(grown.min.x, 8, 1e-5);
  EXPECT_NEAR(grown.max.z, 22, 1e-5);
  const Blank inch = read(path + ":inch");
  EXPECT_NEAR(inch.bounds_mm().max.x, 60 * 25.4, 1e-3);
  EXPECT_NEAR(inch.mesh->body->volume_mm3, 48000 * 25.4 * 25.4 * 25.4, 1e3);
}

TEST_F(BlankMeshFile, DoubtsItsUnit) {
  std::string path = write(test::box_of({0, 0, 0}, {4, 3, 1}));
  read(path);
  EXPECT_NE(told().find("is 4 x 3 x 1 mm large; in inches?"), std::string::npos) << told();
  read(path + ":mm");
  EXPECT_EQ(told(), "");
  read(path + ":inch");
  EXPECT_EQ(told(), "");
  path = write(test::box_of({0, 0, 0}, {6000, 3, 1}));
  read(path);
  EXPECT_NE(told().find("are its numbers of another unit?"), std::string::npos) << told();
  EXPECT_TRUE(is_read_);
}

TEST_F(BlankMeshFile, FaultsAreToldOnce) {
  TriangleMesh open = test::box_of({0, 0, 0}, {60, 40, 20});
  open.triangles.erase(open.triangles.begin());
  read(write(open));
  EXPECT_FALSE(is_read_);
  EXPECT_EQ(said_.size(), 1u);
  EXPECT_NE(told().find("part.stl: is not closed: 3 of 18 edges belong to one triangle only, at X"),
            std::string::npos)
      << told();
  read(folder_ / "none.stl");
  EXPECT_FALSE(is_read_);
  EXPECT_NE(told().find("none.stl: No such file"), std::string::npos) << told();
  std::ofstream(folder_ / "empty.stl") << "solid a\nendsolid a\n";
  read(folder_ / "empty.stl");
  EXPECT_FALSE(is_read_);
  EXPECT_EQ(said_.size(), 1u) << told();
  TriangleMesh odd = test::box_of({0, 0, 0}, {60, 40, 20});
  odd.positions_mm[3].y = std::numeric_limits<float>::quiet_NaN();
  read(write(odd));
  EXPECT_FALSE(is_read_);
  EXPECT_NE(told().find("a corner is no number"), std::string::npos) << told();
  TriangleMesh turned = test::box_of({0, 0, 0}, {60, 40, 20});
  for (auto& t : turned.triangles) std::swap(t[0], t[1]);
  read(write(turned));
  EXPECT_TRUE(is_read_);
  EXPECT_NE(told().find("is inside out (all normals point inwards); it is turned"),
            std::string::npos)
      << told();
}

TEST_F(BlankMeshFile, IsABodyForCollisionsAndHasAShadow) {
  TriangleMesh angle = test::box_of({0, 0, 0}, {60, 20, 20});
  test::add_box(angle, {0, 0, 0}, {20, 60, 20});
  const Blank blank = read(write(angle));
  const SolidPointer solid = solid_of(blank);
  ASSERT_TRUE(solid);
  EXPECT_EQ(solid->box_mm(), (Box{{0, 0, 0}, {60, 60, 20}}));
  const BlankShadow shadow(*blank.mesh->body, 0.25);
  EXPECT_TRUE(shadow.covers(50, 10));
  EXPECT_TRUE(shadow.covers(10, 50));
  EXPECT_FALSE(shadow.covers(40, 40));
  EXPECT_FALSE(shadow.covers(-1, 10));
  EXPECT_FALSE(shadow.covers(10, 61));
  EXPECT_EQ(need_of_mesh(blank), "");
  EXPECT_EQ(solid_of(*parse_blank("state:a")), nullptr);
}

}  // namespace
}  // namespace kerf
