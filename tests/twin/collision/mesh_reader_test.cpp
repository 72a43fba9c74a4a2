#include "mesh/mesh_reader.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>
#include <utility>

#include "tests/base/temporary_folder.h"
#include "tests/base/zip_writer.h"
#include "tests/twin/machines/mesh_support.h"
#include "twin/collision/solid.h"

namespace kerf {
namespace {

constexpr std::size_t kMost = 1000;

/// A box of 10 x 20 x 30 with quads, as CAD programs write them.
constexpr const char* kObj =
    "# a box\nmtllib a.mtl\no box\n"
    "v 0 0 0\nv 10 0 0\nv 10 20 0\nv 0 20 0\nv 0 0 30\nv 10 0 30\nv 10 20 30\nv 0 20 30 1.0\n"
    "vt 0 0\nvn 0 0 1\nusemtl steel\ns off\n"
    "f 4 3 2 1\nf 5/1/1 6/1/1 7/1/1 8/1/1\nf 1//1 2//1 6//1 5//1\n"
    "f -7 -6 -2 \\\n -3\nf 3 4 8 7\nf 4 1 5 8\n";

const std::string kCorners =
    "<vertices><vertex x='0' y='0' z='0'/><vertex x='1' y='0' z='0'/><vertex x='0' y='1' z='0'/>"
    "<vertex x='0' y='0' z='1'/></vertices>";
const std::string kTetrahedron =
    "<mesh>" + kCorners +
    "<triangles><triangle v1='0' v2='2' v3='1'/><triangle v1='0' v2='1' v3='3'/>"
    "<triangle v1='0' v2='3' v3='2'/><triangle v1='1' v2='2' v3='3'/></triangles></mesh>";

std::string model(const std::string& head, const std::string& resources, const std::string& build) {
  return "<?xml version='1.0'?><model xmlns='http://schemas.microsoft.com/3dmanufacturing/core/"
         "2015/02' " +
         head + "><resources>" + resources + "</resources><build>" + build + "</build></model>";
}

std::string threemf(const std::string& text) {
  return zipped({{"[Content_Types].xml", "<Types/>"}, {"3D/3dmodel.model", text}});
}

std::string said_of(const std::string& bytes, MeshFormat format) {
  const Result<MeshFromFile> read = parse_mesh(bytes, "a", format, 1, kMost);
  return read ? fmt::format("{}", read->mesh.triangles.size()) : read.error();
}
std::string said_of_obj(const std::string& text) { return said_of(text, MeshFormat::kObj); }
std::string said_of_3mf(const std::string& text) {
  return said_of(threemf(text), MeshFormat::k3mf);
}

TEST(MeshReader, ObjWithQuadsIsAClosedBox) {
  const auto read = parse_mesh(kObj, "a.obj", MeshFormat::kObj, 25.4, kMost);
  ASSERT_TRUE(read) << read.error();
  EXPECT_EQ(read->mesh.triangles.size(), 12U);
  EXPECT_EQ(open_edges(read->mesh), 0U);
  EXPECT_NEAR(volume_mm3(read->mesh), 6000 * 25.4 * 25.4 * 25.4, 100);
}

TEST(MeshReader, FaultsOfObjSayWhatAndWhere) {
  const std::string corners = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
  EXPECT_EQ(said_of_obj(""), "a: has no triangles");
  EXPECT_EQ(said_of_obj(corners + "f 1 2 4\n"),
            "a:4: corner 4 is not there; 3 corners are before it");
  EXPECT_EQ(said_of_obj(corners + "f 1 2 0\n"),
            "a:4: corner 0 is not there; 3 corners are before it");
  EXPECT_EQ(said_of_obj(corners + "f 1 2\n"), "a:4: a face has three corners or more");
  EXPECT_EQ(said_of_obj("v 0 0\n"), "a:1: '' found where a number is due");
  EXPECT_EQ(said_of_obj("v 0 0 nan\n"), "a:1: 'nan' found where a number is due");
  EXPECT_EQ(said_of_obj(corners + "f 1 x 3\n"), "a:4: 'x' found where a number is due");
  EXPECT_EQ(said_of_obj(corners + "surf 0 1 0 1 1 2 3\n"),
            "a:4: 'surf': curved surfaces are not read; triangles are understood");
  // A fan of it would fill its notch.
  EXPECT_EQ(said_of_obj("v 0 0 0\nv 4 0 0\nv 1 1 0\nv 0 4 0\nf 1 2 3 4\n"),
            "a:5: a face that is not convex; triangles are understood");
  EXPECT_EQ(said_of_obj("v 0 0 0\nv 4 0 0\nv 4 4 0\nv 0 4 0\nf 1 2 3 4\n"), "2");
  EXPECT_EQ(said_of_obj("v 0 0 0\nv 1e9 0 0\nv 0 1 0\nf 1 2 3\n"),
            "a: triangle 1: a corner is no number, or farther away than 100 m");
}

TEST(MeshReader, ThreemfInItsUnitPlacedAndInParts) {
  const std::string object = "<object id='1' type='model'>" + kTetrahedron + "</object>";
  const auto read = [](const std::string& bytes) {
    Result<MeshFromFile> mesh = parse_mesh(bytes, "a", MeshFormat::k3mf, 1, kMost);
    EXPECT_TRUE(mesh) << (mesh ? "" : mesh.error());
    return mesh ? mesh->mesh : TriangleMesh{};
  };
  // An inch, 4 / 6 of a cubic one after it was made 4 times as high.
  const TriangleMesh inch = read(threemf(
      model("unit='inch'", object, "<item objectid='1' transform='1 0 0 0 1 0 0 0 4 10 0 0'/>")));
  EXPECT_NEAR(volume_mm3(inch), 4.0 / 6 * 25.4 * 25.4 * 25.4, 0.01);
  const auto first =
      std::ranges::min(inch.positions_mm, {}, [](const glm::vec3& p) { return p.x; });
  EXPECT_NEAR(first.x, 254, 1e-4);
  // Components, one of them in a part of its own.
  const std::string assembled =
      "<object id='2'><components><component objectid='1'/><component objectid='7' "
      "p:path='/3D/Objects/b.model' transform='0 1 0 -1 0 0 0 0 1 0 0 5'/></components></object>";
  const std::string other = model("", "<object id='7'>" + kTetrahedron + "</object>", "");
  const std::string head =
      "requiredextensions='p' xmlns:p='http://schemas.microsoft.com/3dmanufacturing/production/"
      "2015/06'";
  const TriangleMesh both =
      read(zipped({{"3D/3dmodel.model", model(head, object + assembled, "<item objectid='2'/>")},
                   {"3D/Objects/b.model", other}}));
  EXPECT_EQ(both.triangles.size(), 8U);
  EXPECT_NEAR(volume_mm3(both), 2.0 / 6, 1e-6);
  const auto highest =
      std::ranges::max(both.positions_mm, {}, [](const glm::vec3& p) { return p.z; });
  EXPECT_EQ(highest.z, 6);
}

TEST(MeshReader, FaultsOf3mfSayWhatAndWhere) {
  const std::string object = "<object id='1'>" + kTetrahedron + "</object>";
  const std::string item = "<item objectid='1'/>";
  EXPECT_EQ(said_of_3mf(model("", object, item)), "4");
  EXPECT_EQ(said_of("PK", MeshFormat::k3mf), "a: is no whole zip file");
  EXPECT_EQ(said_of(zipped({{"b.txt", ""}}), MeshFormat::k3mf),
            "a: is a zip file without a .model in it");
  EXPECT_EQ(said_of_3mf(model("", object, "")), "a: has no triangles");
  EXPECT_EQ(said_of_3mf("<a/>"), "a: 3D/3dmodel.model:1: is no 3MF model");
  EXPECT_EQ(said_of_3mf("<model>"), "a: 3D/3dmodel.model:1: no element found");
  EXPECT_EQ(said_of_3mf(model("unit='ell'", object, item)),
            "a: 3D/3dmodel.model:1: unknown unit 'ell'");
  EXPECT_EQ(said_of_3mf(model("", object, "<item objectid='3'/>")),
            "a: object '3' is placed, but not there");
  EXPECT_EQ(said_of_3mf(model("", object, "<item objectid='1' transform='1 0'/>")),
            "a: 3D/3dmodel.model:1: transform '1 0' is not twelve numbers");
  EXPECT_EQ(said_of_3mf(model("", object, "<item objectid='1' path='/b.model'/>")),
            "a: has no part 'b.model'");
  EXPECT_EQ(said_of_3mf(model("requiredextensions='b' xmlns:b='http://x/beamlattice/2017/02'",
                              object, item)),
            "a: 3D/3dmodel.model:1: needs the extension http://x/beamlattice/2017/02, which is not "
            "read");
  std::string far = model("", object, item);
  far.replace(far.find("v2='2'"), 6, "v2='9'");
  EXPECT_EQ(said_of_3mf(far), "a: 3D/3dmodel.model:1: triangle with corner 9; 4 corners are there");
  far = model("", object, item);
  far.replace(far.find("x='1'"), 5, "x='nan'");
  EXPECT_EQ(said_of_3mf(far), "a: 3D/3dmodel.model:1: 'nan' found where a number is due");
  EXPECT_EQ(said_of_3mf("<!DOCTYPE a [<!ENTITY b 'c'>]>" + model("", object, item).substr(21)),
            "a: 3D/3dmodel.model:1: a document type is not allowed in 3MF");
}

TEST(MeshReader, ObjectsWithinThemselvesEnd) {
  const std::string circle =
      "<object id='1'><components><component objectid='1'/></components></object>";
  EXPECT_EQ(said_of_3mf(model("", circle, "<item objectid='1'/>")),
            "a: has objects within objects without end");
  std::string doubled = "<object id='0'/>";
  for (int i = 1; i < 30; ++i) {
    doubled += fmt::format(
        "<object id='{0}'><components><component objectid='{1}'/><component objectid='{1}'/>"
        "</components></object>",
        i, i - 1);
  }
  EXPECT_EQ(said_of_3mf(model("", doubled, "<item objectid='29'/>")),
            "a: has objects within objects without end");
}

TEST(MeshReader, MoreThanItsMostIsRefusedBeforeItIsRead) {
  const TemporaryFolder folder;
  const std::string path = folder / "large.stl";
  // 500 MB that are not there: only the head is.
  std::string head(84, ' ');
  const std::uint32_t count = 10'000'000;
  std::memcpy(head.data() + 80, &count, 4);
  std::ofstream(path, std::ios::binary) << head;
  std::filesystem::resize_file(path, 84 + std::size_t{50} * count);
  const auto read = read_mesh(path, MeshFormat::kStl, 1, 2'000'000);
  ASSERT_FALSE(read);
  EXPECT_EQ(read.error(), path + ": has 10000000 triangles or more; must be from 1 to 2000000");
  EXPECT_EQ(parse_mesh(kObj, "a", MeshFormat::kObj, 1, 11).error(),
            "a: has 12 triangles or more; must be from 1 to 11");
  const std::string four =
      model("", "<object id='1'>" + kTetrahedron + "</object>", "<item objectid='1'/>");
  EXPECT_EQ(parse_mesh(threemf(four), "a", MeshFormat::k3mf, 1, 3).error(),
            "a: 3D/3dmodel.model:1: has 4 triangles or more; must be from 1 to 3");
}

TEST(MeshReader, FlatTrianglesAreCountedAndLeftOut) {
  const auto read = parse_mesh("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 1 0\nf 1 2 3\nf 2 3 4\n", "a",
                               MeshFormat::kObj, 1, kMost);
  ASSERT_TRUE(read);
  EXPECT_EQ(read->mesh.triangles.size(), 1U);
  EXPECT_EQ(read->flat, 1U);
}

TEST(MeshReader, InsideOutIsTheSameBody) {
  TriangleMesh mesh = parse_mesh(kObj, "a", MeshFormat::kObj, 1, kMost)->mesh;
  for (auto& triangle : mesh.triangles) std::swap(triangle[0], triangle[1]);
  const SolidPointer solid = Solid::of_mesh(mesh);
  EXPECT_TRUE(solid->is_closed());
  EXPECT_TRUE(solid->encloses({5, 5, 5}));
  EXPECT_FALSE(solid->encloses({5, 5, 35}));
}

TEST(MeshReader, CutAnywhereIsAnErrorOrAMesh) {
  const std::string text = kObj;
  for (std::size_t size = 0; size < text.size(); ++size)
    EXPECT_FALSE(said_of_obj(text.substr(0, size)).empty()) << size;
  const std::string whole =
      threemf(model("", "<object id='1'>" + kTetrahedron + "</object>", "<item objectid='1'/>"));
  for (std::size_t size = 0; size < whole.size(); ++size) {
    EXPECT_FALSE(parse_mesh(whole.substr(0, size), "a", MeshFormat::k3mf, 1, kMost)) << size;
  }
}

}  // namespace
}  // namespace kerf
