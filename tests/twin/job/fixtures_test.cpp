#include "twin/job/fixtures.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "tests/base/temporary_folder.h"

namespace kerf {
namespace {

std::string error_of(std::string_view text) {
  const Result<FixtureSpec> spec = parse_fixture(text);
  return spec ? "" : spec.error();
}

TEST(Fixtures, AreReadFromTheirText) {
  const FixtureSpec vise = parse_fixture("my vise=vise:125:60:40:at=50,30,-45:turn=90").value();
  EXPECT_EQ(vise.name, "my vise");
  EXPECT_EQ(vise.at_mm, Vec3(50, 30, -45));
  EXPECT_EQ(vise.turn_deg, 90);
  ASSERT_EQ(vise.bodies.size(), 3U);
  EXPECT_EQ(vise.bodies[0].bounds_mm.min, Vec3(-62.5, 30, 0));
  EXPECT_EQ(vise.bodies[0].bounds_mm.max, Vec3(62.5, 61.25, 40));
  const FixtureSpec screw = parse_fixture("screw:4:12").value();
  EXPECT_TRUE(screw.in_blank);
  EXPECT_EQ(screw.bodies[0].bounds_mm.min.z, -12);
  EXPECT_EQ(screw.bodies[1].diameter_mm, 8);
  EXPECT_EQ(screw.bodies[1].bounds_mm.max.z, 4);
  const FixtureSpec mesh = parse_fixture("stl:a b/c:d.stl:inch:at=1,2,3").value();
  EXPECT_EQ(mesh.mesh_path, "a b/c:d.stl");
  EXPECT_EQ(mesh.mm_per_unit, 25.4);
  const FixtureSpec obj = parse_fixture("obj:a.obj:inch").value();
  EXPECT_EQ(obj.mesh_path, "a.obj");
  EXPECT_EQ(obj.mesh_format, MeshFormat::kObj);
  EXPECT_EQ(obj.mm_per_unit, 25.4);
  EXPECT_EQ(parse_fixture("3mf:a.3mf").value().mesh_format, MeshFormat::k3mf);
  EXPECT_EQ(parse_fixture("box:0,0,0:1,1,1", LengthUnit::kInch)->bodies[0].bounds_mm.max.x, 25.4);
  EXPECT_EQ(parse_fixture("box:0,0,0:1,1,1+cylinder:0,0,0:5:3")->bodies.size(), 2U);
  const FixtureSpec on_link = parse_fixture("stl:a.stl:inch:on=rotary table:at=1,2,3").value();
  EXPECT_EQ(on_link.on, "rotary table");
  EXPECT_EQ(on_link.mesh_path, "a.stl");
}

TEST(Fixtures, ThoseOnALinkAreNotHeldAgainstTheBlank) {
  Diagnostics diagnostics;
  const std::vector<FixtureSpec> specs{
      parse_fixture("box:0,0,-20:10,10,0:on=table").value(),
  };
  const FixtureList list = load_fixtures(specs, diagnostics);
  ASSERT_TRUE(list);
  EXPECT_EQ((*list)[0].on, "table");
  const Blank blank = parse_blank("box:0,0,-40:40,30,0").value();
  EXPECT_TRUE(check_fixtures_beside(*list, blank, diagnostics));
}

TEST(Fixtures, FaultsAreSaidWithWhatIsAllowed) {
  EXPECT_NE(error_of("vice:125:60:40").find("did you mean 'vise'"), std::string::npos);
  EXPECT_NE(error_of("vise:125:60").find("vise:JAW_WIDTH:OPENING:HEIGHT"), std::string::npos);
  EXPECT_NE(error_of("vise:125:0:40").find("OPENING: 0 is not allowed"), std::string::npos);
  EXPECT_NE(error_of("vise:125:nan:40").find("'nan'"), std::string::npos);
  EXPECT_NE(error_of("box:0,0,0:1,1,1:at=1,2").find("must be three numbers"), std::string::npos);
  EXPECT_NE(error_of("box:0,0,0:1,1,1:tilt=4").find("unknown option 'tilt'"), std::string::npos);
  EXPECT_NE(error_of("box:0,0,0:1,1,1:on=").find("name of a link"), std::string::npos);
  EXPECT_NE(error_of("clamp:30:20:12:inch").find("stl"), std::string::npos);
  EXPECT_NE(error_of("3mf:a.3mf:inch").find("says its unit itself"), std::string::npos);
  EXPECT_NE(error_of("obj").find("obj:FILE[:inch]"), std::string::npos);
  EXPECT_NE(error_of("screw:4:12:turn=400").find("-360"), std::string::npos);
  for (const char* const text :
       {"", "=box:0,0,0:1,1,1", "stl:", "stl", "state:a", "box", ":::", "="})
    EXPECT_FALSE(parse_fixture(text)) << text;
}

TEST(Fixtures, HaveNamesAndPlaces) {
  Diagnostics diagnostics;
  const std::vector<FixtureSpec> specs{parse_fixture("box:0,0,0:1,1,1").value(),
                                       parse_fixture("box:0,0,0:2,2,2").value(),
                                       parse_fixture("clamp:30:20:12:at=10,0,5:turn=90").value()};
  const FixtureList list = load_fixtures(specs, diagnostics);
  ASSERT_TRUE(list);
  EXPECT_EQ((*list)[0].name, "box");
  EXPECT_EQ((*list)[1].name, "box 2");
  const Vec3 nose = (*list)[2].workpiece_from_fixture.point({30, 0, 12});
  EXPECT_NEAR(nose.x, 10, 1e-12);
  EXPECT_NEAR(nose.y, 30, 1e-12);
  EXPECT_NEAR(nose.z, 17, 1e-12);
  const std::vector<FixtureSpec> twice{parse_fixture("a=box:0,0,0:1,1,1").value(),
                                       parse_fixture("a=box:0,0,0:1,1,1").value()};
  EXPECT_FALSE(load_fixtures(twice, diagnostics));
  ASSERT_EQ(diagnostics.size(), 1U);
  EXPECT_EQ(diagnostics[0].message, "there are two fixtures 'a'");
}

TEST(Fixtures, MeshesThatAreMissingOrBrokenAreErrors) {
  const TemporaryFolder folder;
  const std::string path = folder.path() + "/clamp.stl";
  Diagnostics diagnostics;
  const std::vector<FixtureSpec> spec{parse_fixture("stl:" + path).value()};
  EXPECT_FALSE(load_fixtures(spec, diagnostics));
  ASSERT_EQ(diagnostics.size(), 1U);
  diagnostics.clear();
  std::ofstream(path) << "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 20 0 0\n"
                         "vertex 0 20 0\nendloop\nendfacet\nendsolid a\n";
  EXPECT_TRUE(load_fixtures(spec, diagnostics));
  ASSERT_EQ(diagnostics.size(), 1U);
  EXPECT_EQ(diagnostics[0].severity, Severity::kNote);
  EXPECT_NE(diagnostics[0].message.find("has holes"), std::string::npos);
  diagnostics.clear();
  std::ofstream(path) << "solid a\nendsolid a\n";
  EXPECT_FALSE(load_fixtures(spec, diagnostics));
}

TEST(Fixtures, MeshesWithDoubtsAreNoted) {
  const TemporaryFolder folder;
  const std::string path = folder.path() + "/clamp.obj";
  const auto notes_of = [&](const std::string& text, const std::string& option = "") {
    std::ofstream(path) << text;
    Diagnostics diagnostics;
    const std::vector<FixtureSpec> spec{parse_fixture("obj:" + path + option).value()};
    EXPECT_TRUE(load_fixtures(spec, diagnostics));
    std::string out;
    for (const Diagnostic& diagnostic : diagnostics) {
      EXPECT_EQ(diagnostic.severity, Severity::kNote);
      out += diagnostic.message.substr(diagnostic.message.find(':') + 2) + "\n";
    }
    return out;
  };
  const std::string faces = "f 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";
  const std::string sound = "v 0 0 0\nv 20 0 0\nv 0 20 0\nv 0 0 20\n" + faces;
  EXPECT_EQ(notes_of(sound), "");
  EXPECT_EQ(notes_of(sound + "f 1 1 2\n"),
            path + " has triangles without area; they are left out: 1\n");
  EXPECT_EQ(notes_of("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n" + faces),
            path + " is 1.0 mm large; in inches?\n");
  EXPECT_EQ(notes_of("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n" + faces, ":inch"), "");
  EXPECT_EQ(notes_of("v 0 0 0\nv 2001 0 0\nv 0 1 0\nv 0 0 1\n" + faces),
            path + " is 2001 mm large; is it drawn in other units?\n");
}

TEST(Fixtures, MustNotStandInTheBlank) {
  const Blank blank = parse_blank("box:0,0,-20:100,40,0").value();
  const auto check = [&](std::string_view text) {
    Diagnostics diagnostics;
    const std::vector<FixtureSpec> specs{parse_fixture(text).value()};
    check_fixtures_beside(*load_fixtures(specs, diagnostics), blank, diagnostics);
    return diagnostics.empty() ? "" : diagnostics[0].message;
  };
  EXPECT_EQ(check("jaw=box:0,40,-20:100,60,5"), "");
  EXPECT_EQ(check("jaw=box:0,37.5,-20:100,60,5"),
            "fixture 'jaw' stands in the blank, 2.50 mm deep");
  EXPECT_EQ(check("jaw=box:0,37.5,-20:100,60,5:in-blank"), "");
  EXPECT_EQ(check("screw:4:12:at=50,20,-8"), "");
  Diagnostics of_sheet;
  const std::vector<FixtureSpec> box{parse_fixture("box:0,0,0:1,1,1").value()};
  EXPECT_FALSE(check_fixtures_beside(*load_fixtures(box, of_sheet),
                                     parse_blank("sheet:0,0:60,40:3").value(), of_sheet));
  EXPECT_EQ(of_sheet.size(), 1U);
  EXPECT_EQ(check("table=box:-100,-100,-30:200,200,-20"), "");
}

}  // namespace
}  // namespace kerf
