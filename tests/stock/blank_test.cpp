#include "stock/blank.h"

#include <gtest/gtest.h>

#include <string>

namespace kerf {
namespace {

std::string error_of(std::string_view spec) {
  const Result<Blank> blank = parse_blank(spec);
  return blank ? "no error" : blank.error();
}

std::string described(std::string_view spec) {
  const Result<Blank> blank = parse_blank(spec);
  return blank ? describe(*blank) : blank.error();
}

TEST(Blank, Box) {
  const Result<Blank> blank = parse_blank("box:-50,-50,-50:50,50,0");
  ASSERT_TRUE(blank) << blank.error();
  ASSERT_EQ(blank->bodies.size(), 1U);
  EXPECT_EQ(blank->bodies[0].kind, BlankBody::Kind::kBox);
  EXPECT_EQ(blank->bounds_mm(), (Box{{-50, -50, -50}, {50, 50, 0}}));
}

TEST(Blank, CylinderAlongEachAxis) {
  const Result<Blank> z = parse_blank("cylinder:10,20,-30:0:50");
  ASSERT_TRUE(z) << z.error();
  EXPECT_EQ(z->bodies[0].axis, 'z');
  EXPECT_EQ(z->bodies[0].diameter_mm, 50);
  EXPECT_EQ(z->bodies[0].center_mm, Vec3(10, 20, -30));
  EXPECT_EQ(z->bounds_mm(), (Box{{-15, -5, -30}, {35, 45, 0}}));
  EXPECT_EQ(parse_blank("cylinder:10,20,-30:60:4:x")->bounds_mm(),
            (Box{{10, 18, -32}, {60, 22, -28}}));
  EXPECT_EQ(parse_blank("cylinder:10,20,-30:60:4:Y")->bounds_mm(),
            (Box{{8, 20, -32}, {12, 60, -28}}));
}

TEST(Blank, Tube) {
  const Result<Blank> blank = parse_blank("tube:0,0,-10:0:40:30");
  ASSERT_TRUE(blank) << blank.error();
  EXPECT_EQ(blank->bodies[0].kind, BlankBody::Kind::kTube);
  EXPECT_EQ(blank->bodies[0].inner_diameter_mm, 30);
  EXPECT_EQ(blank->bounds_mm(), (Box{{-20, -20, -10}, {20, 20, 0}}));
}

TEST(Blank, BodiesAddUp) {
  // The plus signs of numbers are no separators.
  const Result<Blank> blank =
      parse_blank("box:0,0,-1e+1:+10,10,0 + cylinder:20,5,-5:+0:6+box:30,0,-2:31,1,0");
  ASSERT_TRUE(blank) << blank.error();
  EXPECT_EQ(blank->bodies.size(), 3U);
  EXPECT_EQ(blank->bounds_mm(), (Box{{0, 0, -10}, {31, 10, 0}}));
}

TEST(Blank, StateFileMayHoldAnyCharacter) {
  const Result<Blank> blank = parse_blank("state:a+box:1.kerf");
  ASSERT_TRUE(blank) << blank.error();
  EXPECT_EQ(blank->state_file, "a+box:1.kerf");
  EXPECT_TRUE(blank->bodies.empty());
  EXPECT_TRUE(blank->bounds_mm().empty());
}

TEST(Blank, Described) {
  EXPECT_EQ(described("box:0,0,-20:100,60,0"), "box 100 x 60 x 20 mm, X0..100 Y0..60 Z-20..0");
  EXPECT_EQ(described("cylinder:0,5,-30:0:50"),
            "cylinder diameter 50 x 30 mm along Z, X0 Y5 Z-30..0");
  EXPECT_EQ(described("tube:0,0,1:81:40:30:x"),
            "tube diameter 40 / 30 x 81 mm along X, Y0 Z1 X0..81");
  EXPECT_EQ(described("box:0,0,0:0.1,0.3,1+box:0,0,0:1,1,1"),
            "box 0.1 x 0.3 x 1 mm, X0..0.1 Y0..0.3 Z0..1 + box 1 x 1 x 1 mm, X0..1 Y0..1 Z0..1");
  EXPECT_EQ(described("state:part.kerf"), "workpiece saved in part.kerf");
}

constexpr const char* kForms =
    "box:x0,y0,z0:x1,y1,z1, cylinder:x,y,z0:z1:d[:axis], tube:x,y,z0:z1:d:inner[:axis], "
    "hex:x,y,z0:z1:ACROSS_FLATS, square:x,y,z0:z1:ACROSS_FLATS, state:FILE, stl:FILE, obj:FILE, "
    "3mf:FILE, step:FILE, profile:FILE.dxf, "
    "profile:FILE.svg, sheet:x0,y0:x1,y1:THICKNESS, sheet:FILE.dxf:THICKNESS, "
    "sheet:FILE.svg:THICKNESS";

TEST(Blank, UnknownAndUnsupportedKinds) {
  EXPECT_EQ(error_of(""), std::string("no stock is given; forms: ") + kForms);
  EXPECT_EQ(error_of("bax:0"),
            std::string("bax:0: unknown stock 'bax'; did you mean 'box'? Forms: ") + kForms);
  EXPECT_EQ(error_of("box:0,0,0:1,1,1+state:x"),
            "state:x: state:FILE stands alone; it cannot be added to other bodies");
  EXPECT_EQ(error_of("state:"), "state:: the file name is missing; the form is state:FILE");
}

TEST(Blank, BarsOfFlats) {
  const Result<Blank> hex = parse_blank("hex:0,0,-40:0:27");
  ASSERT_TRUE(hex) << hex.error();
  EXPECT_EQ(hex->bodies[0].kind, BlankBody::Kind::kBar);
  EXPECT_EQ(hex->bodies[0].flats, 6);
  EXPECT_EQ(hex->bodies[0].diameter_mm, 27);
  EXPECT_NEAR(hex->bounds_mm().max.y, 13.5 / std::cos(kPi / 6), 1e-12);
  EXPECT_EQ(hex->bounds_mm().max.x, 13.5);
  EXPECT_EQ(hex->bounds_mm().min.z, -40);
  EXPECT_EQ(described("hex:0,0,-40:0:27"), "hexagonal bar 27 x 40 mm along Z, X0 Y0 Z-40..0");
  EXPECT_EQ(described("square:1,0,-40:0:27"), "square bar 27 x 40 mm along Z, X1 Y0 Z-40..0");
  EXPECT_EQ(parse_blank("square:1,0,-40:0:20")->bounds_mm(), (Box{{-9, -10, -40}, {11, 10, 0}}));
  EXPECT_EQ(need_to_turn(*hex), "the blank is a hexagonal bar");
  EXPECT_EQ(need_to_turn(*parse_blank("cylinder:0,0,-5:0:9+square:0,0,0:9:8")),
            "the blank is a square bar");
  EXPECT_EQ(need_to_turn(*parse_blank("cylinder:0,0,-5:0:9")), "");
  EXPECT_EQ(error_of("hex:0,0,-40:0"), "hex:0,0,-40:0: the form is hex:x,y,z0:z1:ACROSS_FLATS");
  EXPECT_EQ(error_of("square:0,0,-40:0:5:z"),
            "square:0,0,-40:0:5:z: the form is square:x,y,z0:z1:ACROSS_FLATS");
  EXPECT_EQ(error_of("hex:0,0,-40:0:0"),
            "hex:0,0,-40:0:0: across flats: 0 is not allowed; must be from 0.001 to 100000 (mm)");
  EXPECT_EQ(
      error_of("hex:0,0,4:0:3"),
      "hex:0,0,4:0:3: Z runs from 4 to 0; the second must be at least 0.001 mm above the first");
  EXPECT_EQ(parse_blank("hex:0,0,-1:0:1", LengthUnit::kInch)->bodies[0].diameter_mm, 25.4);
}

TEST(Blank, ASavedPartLiesElsewhere) {
  const Result<Blank> plain = parse_blank("state:a:b.state");
  ASSERT_TRUE(plain) << plain.error();
  EXPECT_EQ(plain->state_file, "a:b.state");
  EXPECT_TRUE(plain->saved_place.is_as_saved());
  const Result<Blank> about = parse_blank("state:a:b.state:flip=x:at=0,0,-2.5");
  ASSERT_TRUE(about) << about.error();
  EXPECT_EQ(about->state_file, "a:b.state");
  EXPECT_EQ(about->saved_place, (BlankPlace{'x', Vec3(0), Vec3(0, 0, -2.5)}));
  EXPECT_EQ(describe(*about),
            "workpiece saved in a:b.state, flipped about X, its zero at X0 Y0 Z-2.5");
  EXPECT_EQ(described("state:a:at=0,0,4"), "workpiece saved in a, its zero at X0 Y0 Z4");
  EXPECT_EQ(described("state:a:rotate=0,90,-30.5:flip=y"),
            "workpiece saved in a, flipped about Y, turned by 0, 90, -30.5 degrees about X, Y, Z");
  EXPECT_EQ(error_of("state:a:flip=z"), "'flip=z' is not allowed; must be flip=x or flip=y");
  EXPECT_EQ(error_of("state:a:rotate=1,2"), "rotate: '1,2' has 2 values; must be A,B,C");
  EXPECT_EQ(error_of("state:a:rotate=1,2,400"),
            "rotate C: 400 is not allowed; must be from -360 to 360 (degrees)");
  EXPECT_EQ(error_of("state:a:at=4"), "at: '4' has 1 value; must be x,y,z");
  EXPECT_EQ(error_of("state:a:flip=x:flip=x"), "'flip=x': flip= is given twice");
  EXPECT_EQ(error_of("state:flip=x"), "no error") << "that is a name";
  EXPECT_EQ(error_of("state::flip=x"), "state:: the file name is missing; the form is state:FILE");
}

TEST(Blank, PlacesTurnAboutTheZeroOfTheFile) {
  const Vec3 p(1, 2, 3);
  EXPECT_EQ((BlankPlace{'x', Vec3(0), Vec3(0)}.placement().placed(p)), Vec3(1, -2, -3));
  EXPECT_EQ((BlankPlace{'y', Vec3(0), Vec3(10, 0, 0)}.placement().placed(p)), Vec3(9, 2, -3));
  EXPECT_EQ((BlankPlace{0, Vec3(90, 0, 0), Vec3(0)}.placement().placed(p)), Vec3(1, -3, 2));
  // About X, then Y, then Z: (1, -3, 2) -> (2, -3, -1) -> (3, 2, -1).
  EXPECT_EQ((BlankPlace{0, Vec3(90, 90, 90), Vec3(0)}.placement().placed(p)), Vec3(3, 2, -1));
}

TEST(Blank, Mesh) {
  const Result<Blank> blank = parse_blank("stl:a:b+c.STL+2.5:inch:flip=y:at=1,2,3");
  ASSERT_TRUE(blank) << blank.error();
  ASSERT_TRUE(blank->mesh);
  EXPECT_EQ(blank->mesh->file, "a:b+c.STL");
  EXPECT_EQ(blank->mesh->allowance_mm, 2.5);
  EXPECT_EQ(blank->mesh->unit, LengthUnit::kInch);
  EXPECT_EQ(blank->mesh->place, (BlankPlace{'y', Vec3(0), Vec3(1, 2, 3)}));
  EXPECT_TRUE(blank->bounds_mm().empty()) << "nobody has read it";
  EXPECT_EQ(describe(*blank),
            "mesh from a:b+c.STL, grown by 2.5 mm, flipped about Y, its zero at X1 Y2 Z3");
  EXPECT_EQ(described("part.obj:rotate=0,0,45"),
            "mesh from part.obj, turned by 0, 0, 45 degrees about X, Y, Z");
  EXPECT_EQ(parse_blank("dir/part.3mf + 1")->mesh->allowance_mm, 1);
  EXPECT_EQ(parse_blank("part.stl+1", LengthUnit::kInch)->mesh->allowance_mm, 25.4);
  EXPECT_EQ(parse_blank("a+2.stl")->mesh->allowance_mm, 0);
  EXPECT_EQ(error_of("stl:a.stl+0"),
            "stl:a.stl+0: allowance: 0 is not allowed; must be from 0.001 to 100 (mm)");
  EXPECT_EQ(error_of("stl:a.obj"),
            "stl:a.obj: 'a.obj' is not a name of that kind; the form is stl:FILE.stl[+ALLOWANCE]");
  EXPECT_EQ(error_of("3mf:a.3mf:inch"), "3mf:a.3mf:inch: a 3MF file says its unit itself");
  EXPECT_EQ(error_of("stl:"), "stl:: the file name is missing; the form is stl:FILE[+ALLOWANCE]");
  EXPECT_EQ(error_of("stl:a.stl:at=1"), "stl:a.stl:at=1: at: '1' has 1 value; must be x,y,z");
  EXPECT_EQ(error_of("box:0,0,0:1,1,1+stl:a.stl"),
            "stl:a.stl: stl:FILE stands alone; it cannot be added to other bodies");
}

TEST(Blank, Profile) {
  const Result<Blank> drawn = parse_blank("Profile: a+b:c.DXF");
  ASSERT_TRUE(drawn) << drawn.error();
  EXPECT_EQ(drawn->profile_file, "a+b:c.DXF");
  EXPECT_TRUE(drawn->bounds_mm().empty());
  EXPECT_EQ(describe(*drawn), "profile from a+b:c.DXF");
  EXPECT_EQ(need_to_turn(*drawn), "the blank is a profile that turns");
  EXPECT_EQ(error_of("profile:part.step"),
            "profile:part.step: 'part.step' is not a drawing; the form is profile:FILE.dxf or "
            "profile:FILE.svg");
  EXPECT_EQ(error_of("cylinder:0,0,-5:0:9+profile:a.dxf"),
            "profile:a.dxf: profile:FILE stands alone; it cannot be added to other bodies");
}

TEST(Blank, Sheet) {
  const Result<Blank> blank = parse_blank(" Sheet: -10,0 : 90,50 :3");
  ASSERT_TRUE(blank) << blank.error();
  ASSERT_TRUE(blank->sheet);
  EXPECT_EQ(blank->sheet->low_mm, Vec2(-10, 0));
  EXPECT_EQ(blank->sheet->high_mm, Vec2(90, 50));
  EXPECT_EQ(blank->sheet->thickness_mm, 3);
  EXPECT_EQ(blank->bounds_mm(), (Box{{-10, 0, -3}, {90, 50, 0}})) << "its top is at Z0";
  EXPECT_EQ(describe(*blank), "sheet 100 x 50 x 3 mm, X-10..90 Y0..50 Z-3..0");
  const Result<Blank> drawn = parse_blank("sheet:a+b:c.DXF:1.5");
  ASSERT_TRUE(drawn) << drawn.error();
  EXPECT_EQ(drawn->sheet->file, "a+b:c.DXF");
  EXPECT_TRUE(drawn->bounds_mm().empty());
  EXPECT_EQ(describe(*drawn), "sheet 1.5 mm thick, outline from a+b:c.DXF, Z-1.5..0");
  EXPECT_EQ(parse_blank("sheet:rest.svg:2")->sheet->file, "rest.svg");
}

TEST(Blank, SheetErrors) {
  const std::string form =
      "the form is sheet:x0,y0:x1,y1:THICKNESS, sheet:FILE.dxf:THICKNESS or "
      "sheet:FILE.svg:THICKNESS";
  EXPECT_EQ(error_of("sheet:"), "sheet:: " + form);
  EXPECT_EQ(error_of("sheet:part.dxf"), "sheet:part.dxf: " + form);
  EXPECT_EQ(error_of("sheet:0,0:1,1"), "sheet:0,0:1,1: " + form);
  EXPECT_EQ(error_of("sheet:0,0,0:1,1:2"),
            "sheet:0,0,0:1,1:2: first corner: '0,0,0' has 3 values; must be x,y");
  EXPECT_EQ(error_of("sheet:0,0:1,0:2"),
            "sheet:0,0:1,0:2: Y runs from 0 to 0; the second must be at least 0.001 mm above the "
            "first");
  EXPECT_EQ(error_of("sheet:0,0:1,1:0"),
            "sheet:0,0:1,1:0: thickness: 0 is not allowed; must be from 0.001 to 1000 (mm)");
  EXPECT_EQ(error_of("sheet:a.svg:thick"), "sheet:a.svg:thick: thickness: 'thick' is not a number");
  EXPECT_EQ(error_of("sheet:0,0:1,1:2+box:0,0,0:1,1,1"),
            "sheet:0,0:1,1:2+box:0,0,0:1,1,1: a sheet stands alone; it cannot be added to other "
            "bodies");
  EXPECT_EQ(error_of("box:0,0,0:1,1,1+sheet:0,0:1,1:2"),
            "sheet:0,0:1,1:2: a sheet stands alone; it cannot be added to other bodies");
}

TEST(Blank, BoxErrors) {
  EXPECT_EQ(error_of("box:0,0,0"), "box:0,0,0: the form is box:x0,y0,z0:x1,y1,z1");
  EXPECT_EQ(error_of("box:0,0:1,1,1"),
            "box:0,0:1,1,1: first corner: '0,0' has 2 values; must be x,y,z");
  EXPECT_EQ(error_of("box:0,0,0:5"), "box:0,0,0:5: second corner: '5' has 1 value; must be x,y,z");
  EXPECT_EQ(error_of("box:0,0,0:1,b,1"), "box:0,0,0:1,b,1: second corner Y: 'b' is not a number");
  EXPECT_EQ(error_of("box:0,0,nan:1,1,1"),
            "box:0,0,nan:1,1,1: first corner Z: 'nan' is not a number");
  EXPECT_EQ(error_of("box:0,0,0:1e6,1,1"),
            "box:0,0,0:1e6,1,1: second corner X: 1000000 is not allowed; must be from -100000 to "
            "100000 (mm)");
  EXPECT_EQ(error_of("box:0,0,0:1,0,1"),
            "box:0,0,0:1,0,1: Y runs from 0 to 0; the second must be at least 0.001 mm above the "
            "first");
  EXPECT_EQ(error_of("box:0,0,0:1,1,-1"),
            "box:0,0,0:1,1,-1: Z runs from 0 to -1; the second must be at least 0.001 mm above the "
            "first");
}

TEST(Blank, RoundErrors) {
  EXPECT_EQ(error_of("cylinder:0,0,0:1"),
            "cylinder:0,0,0:1: the form is cylinder:x,y,z0:z1:d[:axis]");
  EXPECT_EQ(error_of("tube:0,0,0:1:5"),
            "tube:0,0,0:1:5: the form is tube:x,y,z0:z1:d:inner[:axis]");
  EXPECT_EQ(error_of("cylinder:0,0,0:1:5:a"),
            "cylinder:0,0,0:1:5:a: axis: 'a' is not an axis; must be x, y or z");
  EXPECT_EQ(error_of("cylinder:0,0,0:-1:5"),
            "cylinder:0,0,0:-1:5: Z runs from 0 to -1; the second must be at least 0.001 mm above "
            "the first");
  EXPECT_EQ(error_of("cylinder:0,0,0:1:0"),
            "cylinder:0,0,0:1:0: diameter: 0 is not allowed; must be from 0.001 to 100000 (mm)");
  EXPECT_EQ(error_of("tube:0,0,0:1:5:5"),
            "tube:0,0,0:1:5:5: inner diameter: 5 is not allowed; must be less than the diameter, 5 "
            "(mm)");
  EXPECT_EQ(error_of("tube:0,0,0:1:5:-1"),
            "tube:0,0,0:1:5:-1: inner diameter: -1 is not allowed; must be from 0.001 to 100000 "
            "(mm)");
}

TEST(Blank, CutAtEveryByteIsAnErrorOrABlank) {
  const std::string text = "box:0,0,-20:100,60,0 + tube:0,0,-10:0:40:30:z+cylinder:1,2,3:4:5:x";
  for (std::size_t size = 0; size < text.size(); ++size) {
    const Result<Blank> blank = parse_blank(text.substr(0, size));
    if (blank) {
      EXPECT_FALSE(blank->bounds_mm().empty());
    } else {
      EXPECT_FALSE(blank.error().empty());
    }
  }
}

}  // namespace
}  // namespace kerf
