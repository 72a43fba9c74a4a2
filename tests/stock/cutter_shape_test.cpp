#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include "base/geometry.h"
#include "stock/cutter/holder_library.h"
#include "stock/cutter/profile_file.h"
#include "stock/cutter/shape_spec.h"

namespace kerf {
namespace {

std::string error_of(std::string_view spec) {
  const Result<Cutter> cutter = parse_shape(spec);
  return cutter ? "no error" : cutter.error();
}

std::string spec_of(std::string_view spec) {
  const Result<Cutter> cutter = parse_shape(spec);
  return cutter ? cutter->spec() : cutter.error();
}

/// A folder of its own that goes away with the test.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "kerf-shape-XXXXXX").string();
    if (mkdtemp(name.data()) != nullptr) path_ = name;
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  std::string write(const std::string& name, const std::string& text) const {
    const std::string file = path_ + "/" + name;
    std::ofstream(file) << text;
    return file;
  }
  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

const std::vector<std::pair<const char*, const char*>> kCanonical = {
    {"flat:10", "flat:10"},
    {" FLAT:10.00 ", "flat:10"},
    {"ball:+6", "ball:6"},
    {"bull:10:2", "bull:10:2"},
    {"bull:10:5", "bull:10:5"},
    {"bull:10:0", "bull:10:0"},
    {"vee:12.7:90", "vee:12.7:90"},
    {"vee:12.7:90:0", "vee:12.7:90"},
    {"vee:6:30:.2", "vee:6:30:0.2"},
    {"taper:3:5", "taper:3:5"},
    {"taper:3:5:1.5:flute=20", "taper:3:5:1.5:flute=20"},
    {"drill:8:118", "drill:8:118"},
    {"drill:8:180", "drill:8:180"},
    {"lollipop:10:4", "lollipop:10:4"},
    {"tslot:20:3:8", "tslot:20:3:8"},
    {"flat:10:shank=12:flute=22", "flat:10:flute=22:shank=12"},
    {"bull:10:2:flute=22:shank=10:holder=32x20+40x25",
     "bull:10:2:flute=22:shank=10:holder=32x20+40x25"},
    {"flat:6:stickout=30:holder=ER20", "flat:6:holder=er20:stickout=30"},
    {"ball:6:holder=30X10:Flute=9:shank=6x21.5", "ball:6:flute=9:shank=6x21.5:holder=30x10"},
};

TEST(Shape, CanonicalTextAndRoundTrip) {
  for (const auto& [text, canonical] : kCanonical) {
    EXPECT_EQ(spec_of(text), canonical);
    EXPECT_EQ(spec_of(canonical), canonical);
    const Result<Cutter> first = parse_shape(text);
    const Result<Cutter> second = parse_shape(canonical);
    ASSERT_TRUE(first && second) << text;
    for (int i = 0; i <= 100; ++i) {
      const double r = first->radius_mm() * i / 100;
      EXPECT_EQ(first->height_mm(r), second->height_mm(r)) << text;
    }
  }
}

TEST(Shape, CutAtEveryByteIsAnErrorOrAShape) {
  for (const auto& [text, canonical] : kCanonical) {
    const std::string whole = text;
    for (std::size_t size = 0; size < whole.size(); ++size) {
      const Result<Cutter> cutter = parse_shape(whole.substr(0, size));
      if (cutter) {
        EXPECT_EQ(spec_of(cutter->spec()), cutter->spec());
      } else {
        EXPECT_FALSE(cutter.error().empty());
      }
    }
  }
}

TEST(Shape, FlutesShankAndHolderStackUpward) {
  const Result<Cutter> cutter = parse_shape("bull:10:2:flute=22:shank=10x15:holder=32x20+40x25");
  ASSERT_TRUE(cutter) << cutter.error();
  EXPECT_EQ(cutter->flute_length_mm(), 22);
  EXPECT_EQ(cutter->shank_diameter_mm(), 10);
  ASSERT_EQ(cutter->holder().size(), 2U);
  EXPECT_EQ(cutter->holder()[0].diameter_mm, 32);
  EXPECT_EQ(cutter->holder()[0].from_z_mm, 37);
  EXPECT_EQ(cutter->holder()[0].to_z_mm, 57);
  EXPECT_EQ(cutter->holder()[1].diameter_mm, 40);
  EXPECT_EQ(cutter->holder()[1].from_z_mm, 57);
  EXPECT_EQ(cutter->holder()[1].to_z_mm, 82);
  const Result<Cutter> nut = parse_shape("flat:6:flute=12:holder=er20:stickout=30");
  ASSERT_TRUE(nut) << nut.error();
  ASSERT_EQ(nut->holder().size(), 1U);
  EXPECT_EQ(nut->holder()[0].diameter_mm, 34);
  EXPECT_EQ(nut->holder()[0].from_z_mm, 30);
  // Without a shank length the holder begins where the flutes end.
  EXPECT_EQ(parse_shape("flat:10:flute=22:shank=10:holder=32x20")->holder()[0].from_z_mm, 22);
}

TEST(Shape, PlainShapesHaveNoExtras) {
  const Result<Cutter> cutter = parse_shape("flat:10");
  ASSERT_TRUE(cutter) << cutter.error();
  EXPECT_FALSE(cutter->undercuts());
  EXPECT_FALSE(cutter->flute_length_mm());
  EXPECT_FALSE(cutter->shank_diameter_mm());
  EXPECT_TRUE(cutter->holder().empty());
}

TEST(Shape, NecksOfUndercuttingCutters) {
  const Result<Cutter> lollipop = parse_shape("lollipop:10:6");
  ASSERT_TRUE(lollipop) << lollipop.error();
  EXPECT_TRUE(lollipop->undercuts());
  EXPECT_EQ(lollipop->neck_radius_mm(), 3);
  EXPECT_EQ(lollipop->flute_length_mm(), 9);  // 5 + sqrt(5^2 - 3^2)
  EXPECT_EQ(lollipop->shank_diameter_mm(), 6);
  const Result<Cutter> tslot = parse_shape("tslot:20:3:8");
  ASSERT_TRUE(tslot) << tslot.error();
  EXPECT_EQ(tslot->neck_radius_mm(), 4);
  EXPECT_EQ(tslot->flute_length_mm(), 3);
  EXPECT_EQ(tslot->shank_diameter_mm(), 8);
  const Result<Cutter> dovetail = parse_shape("dovetail:20:45:8");
  ASSERT_TRUE(dovetail) << dovetail.error();
  EXPECT_EQ(dovetail->spec(), "dovetail:20:45:8");
  EXPECT_EQ(dovetail->neck_radius_mm(), 4);
  EXPECT_NEAR(*dovetail->flute_length_mm(), 6, 1e-12);
  EXPECT_EQ(dovetail->shank_diameter_mm(), 8);
  EXPECT_EQ(parse_shape("tslot:20:3:8:flute=3:shank=12")->shank_diameter_mm(), 12);
}

TEST(Shape, KerfIsItsWidth) {
  const Result<Cutter> kerf = parse_shape("KERF:1.50");
  ASSERT_TRUE(kerf) << kerf.error();
  EXPECT_EQ(kerf->spec(), "kerf:1.5");
  EXPECT_EQ(kerf->radius_mm(), 0.75);
  EXPECT_EQ(kerf->height_mm(0.7), 0);
  EXPECT_EQ(error_of("kerf"), "kerf: kerf width W is missing; the form is kerf:W");
  EXPECT_EQ(error_of("kerf:0"),
            "kerf:0: kerf width W: 0 is not allowed; must be from 0.001 to 1000 (mm)");
}

TEST(Shape, UnknownNames) {
  EXPECT_EQ(error_of("flatt:3"),
            "flatt:3: unknown shape 'flatt'; did you mean 'flat'? Shapes: flat, ball, bull, vee, "
            "taper, drill, lollipop, tslot, dovetail, kerf, profile; to turn with: turn, iso, "
            "groove, part, facegroove, thread, bore");
  EXPECT_EQ(error_of("endmill:3"),
            "endmill:3: unknown shape 'endmill'. Shapes: flat, ball, bull, vee, taper, drill, "
            "lollipop, tslot, dovetail, kerf, profile; to turn with: turn, iso, groove, part, "
            "facegroove, thread, bore");
  EXPECT_EQ(error_of("  "),
            "the shape is empty; write for example flat:6 (flat, ball, bull, vee, taper, drill, "
            "lollipop, tslot, dovetail, kerf, profile)");
  EXPECT_EQ(error_of("flat:10:flut=2"),
            "flat:10:flut=2: unknown option 'flut'; did you mean 'flute'? Options: flute=L, "
            "shank=D[xL], holder=NAME|DxL[+DxL..], stickout=L, teeth=N, live=x|z, helix=DEG, "
            "rake=DEG, chip=L, ramp=DEG, centre=yes|no");
}

TEST(Shape, MissingAndSurplusValues) {
  EXPECT_EQ(error_of("flat"), "flat: diameter D is missing; the form is flat:D");
  EXPECT_EQ(error_of("flat:"), "flat:: diameter D is missing; the form is flat:D");
  EXPECT_EQ(error_of("bull:10"), "bull:10: corner radius R is missing; the form is bull:D:R");
  EXPECT_EQ(error_of("vee:10"),
            "vee:10: included angle ANGLE is missing; the form is vee:D:ANGLE[:TIP]");
  EXPECT_EQ(error_of("drill:5"),
            "drill:5: point angle ANGLE is missing; the form is drill:D:ANGLE");
  EXPECT_EQ(error_of("tslot:20:3"),
            "tslot:20:3: shaft diameter SHAFT is missing; the form is tslot:D:T:SHAFT");
  EXPECT_EQ(error_of("ball:10:3"), "ball:10:3: 2 values are too many; the form is ball:D");
  EXPECT_EQ(error_of("profile:"), "profile:: file name FILE is missing; the form is profile:FILE");
}

TEST(Shape, ValuesThatAreNoNumbersOrOutOfRange) {
  EXPECT_EQ(error_of("flat:abc"), "flat:abc: diameter D: 'abc' is not a number");
  EXPECT_EQ(error_of("flat:10mm"), "flat:10mm: diameter D: '10mm' is not a number");
  EXPECT_EQ(error_of("flat:nan"), "flat:nan: diameter D: 'nan' is not a number");
  EXPECT_EQ(error_of("flat:inf"), "flat:inf: diameter D: 'inf' is not a number");
  EXPECT_EQ(error_of("flat:1e999"), "flat:1e999: diameter D: '1e999' is not a number");
  EXPECT_EQ(error_of("flat:0"),
            "flat:0: diameter D: 0 is not allowed; must be from 0.001 to 1000 (mm)");
  EXPECT_EQ(error_of("flat:-0"),
            "flat:-0: diameter D: 0 is not allowed; must be from 0.001 to 1000 (mm)");
  EXPECT_EQ(error_of("ball:-6"),
            "ball:-6: diameter D: -6 is not allowed; must be from 0.001 to 1000 (mm)");
  EXPECT_EQ(error_of("ball:1001"),
            "ball:1001: diameter D: 1001 is not allowed; must be from 0.001 to 1000 (mm)");
  EXPECT_EQ(error_of("bull:10:5.1"),
            "bull:10:5.1: corner radius R: 5.1 is not allowed; must be from 0 to 5 (mm)");
  EXPECT_EQ(error_of("bull:10:1e-6"),
            "bull:10:1e-6: corner radius R: 1e-06 is not allowed; must be 0 or at least 0.0001 "
            "(mm)");
  EXPECT_EQ(
      error_of("vee:10:180"),
      "vee:10:180: included angle ANGLE: 180 is not allowed; must be from 1 to 179 (degrees)");
  EXPECT_EQ(error_of("vee:10:90:10"),
            "vee:10:90:10: tip diameter TIP: 10 is not allowed; must be less than diameter D, 10 "
            "(mm)");
  EXPECT_EQ(error_of("taper:3:81"),
            "taper:3:81: half angle ANGLE: 81 is not allowed; must be from 1 to 80 (degrees)");
  EXPECT_EQ(error_of("drill:8:181"),
            "drill:8:181: point angle ANGLE: 181 is not allowed; must be from 1 to 180 (degrees)");
  EXPECT_EQ(error_of("lollipop:10:10"),
            "lollipop:10:10: shaft diameter SHAFT: 10 is not allowed; must be less than diameter "
            "D, 10 (mm)");
  EXPECT_EQ(error_of("tslot:20:0:8"),
            "tslot:20:0:8: thickness T: 0 is not allowed; must be from 0.001 to 2000 (mm)");
}

TEST(Shape, OptionsThatDoNotFit) {
  EXPECT_EQ(error_of("flat:10:flute=0"),
            "flat:10:flute=0: flute length: 0 is not allowed; must be from 0.001 to 2000 (mm)");
  EXPECT_EQ(error_of("flat:10:flute=5:flute=6"), "flat:10:flute=5:flute=6: flute= is given twice");
  EXPECT_EQ(error_of("flat:10:shank=5:shank=6"), "flat:10:shank=5:shank=6: shank= is given twice");
  EXPECT_EQ(error_of("flat:1:flute=5:holder=3x3:holder=3x3"),
            "flat:1:flute=5:holder=3x3:holder=3x3: holder= is given twice");
  EXPECT_EQ(error_of("flat:10:flute=5:holder=30"),
            "flat:10:flute=5:holder=30: holder: '30' has no length; write DxL (mm)");
  EXPECT_EQ(error_of("flat:10:flute=5:holder=30x"),
            "flat:10:flute=5:holder=30x: holder length: '' is not a number");
  EXPECT_EQ(error_of("flat:10:holder=30x5"),
            "flat:10:holder=30x5: holder= needs stickout=L, from the tip to the holder; or "
            "flute=L: the holder begins where flutes and shank end");
  EXPECT_EQ(
      error_of("flat:10:holder=er21:stickout=30"),
      "flat:10:holder=er21:stickout=30: unknown holder 'er21'; did you mean 'er11'? `kerf tools "
      "--holders` lists them; or its sections, DxL[+DxL..]");
  EXPECT_EQ(error_of("flat:10:flute=22:holder=er20:stickout=20"),
            "flat:10:flute=22:holder=er20:stickout=20: stickout=20 is shorter than the cutting "
            "part, 22 mm");
  EXPECT_EQ(error_of("flat:10:flute=9:shank=10x5:holder=er20:stickout=20"),
            "flat:10:flute=9:shank=10x5:holder=er20:stickout=20: stickout=L and shank=DxL both say "
            "where the holder begins; write shank=D");
  EXPECT_EQ(error_of("flat:10:flute=9:stickout=20"),
            "flat:10:flute=9:stickout=20: stickout= needs a holder= above it");
  EXPECT_EQ(error_of("flat:10:flute=20:shank=10x5"),
            "flat:10:flute=20:shank=10x5: shank=DxL needs a holder= above it; without one write "
            "shank=D");
  EXPECT_EQ(error_of("ball:10:flute=4"),
            "ball:10:flute=4: flute=4 is shorter than the cutting end, 5 mm");
  EXPECT_EQ(error_of("taper:3:5:1.5:flute=1"),
            "taper:3:5:1.5:flute=1: flute=1 ends below the cone, which begins 1.369 mm above the "
            "tip");
  EXPECT_EQ(error_of("taper:300:80"),
            "taper:300:80: the cone is 1.051e+04 mm wide at its top, 900 mm above the tip; at "
            "most 1000 mm");
}

TEST(CutterShape, HoldersByNameHaveTheSizesOfTheirStandards) {
  const Result<Cutter> weldon = parse_shape("flat:16:flute=30:holder=weldon16:stickout=50");
  ASSERT_TRUE(weldon) << weldon.error();
  EXPECT_EQ(weldon->holder().front().diameter_mm, 48);
  EXPECT_EQ(weldon->holder().front().from_z_mm, 50);
  EXPECT_EQ(weldon->holder().back().to_z_mm, 50 + 43.9);
  // A cone: as steps upward, the last one as wide as its upper end.
  const Result<Cutter> shrink = parse_shape("flat:6:flute=12:holder=SHRINK6:stickout=30");
  ASSERT_TRUE(shrink) << shrink.error();
  EXPECT_EQ(shrink->spec(), "flat:6:flute=12:holder=shrink6:stickout=30");
  EXPECT_GE(shrink->holder().front().diameter_mm, 21);
  EXPECT_LE(shrink->holder().front().diameter_mm, 21.5);
  EXPECT_EQ(shrink->holder().back().diameter_mm, 27);
  EXPECT_NEAR(shrink->holder().back().to_z_mm, 30 + 38.1, 1e-9);
  // Each cone of the table has the slope that its source says.
  for (const NamedHolder& holder : named_holders()) {
    const HolderSection& s = holder.section;
    if (s.lower_mm == s.upper_mm) continue;
    EXPECT_NEAR((s.upper_mm - s.lower_mm) / 2, s.length_mm * std::tan(4.5 * kPi / 180), 0.01)
        << holder.name;
  }
}

TEST(Shape, HoldersStackOfNamesSectionsAndCones) {
  const char* const spec = "flat:10:flute=9:shank=10:holder=er20+40x12+bt30:stickout=25:teeth=4";
  const Result<Cutter> cutter = parse_shape(spec);
  ASSERT_TRUE(cutter) << cutter.error();
  EXPECT_EQ(cutter->spec(), spec);
  EXPECT_EQ(cutter->teeth(), 4);
  ASSERT_EQ(cutter->holder().size(), 3u);
  EXPECT_EQ(cutter->holder()[0].diameter_mm, 34);
  EXPECT_EQ(cutter->holder()[1].from_z_mm, 25 + 19);
  EXPECT_EQ(cutter->holder()[2].from_z_mm, 25 + 19 + 12);
  EXPECT_EQ(cutter->holder()[2].diameter_mm, 46);
  EXPECT_EQ(shape_in(spec, LengthUnit::kInch),
            "flat:0.3937:flute=0.3543:shank=0.3937:holder=er20+1.5748x0.4724+bt30:stickout=0.9843:"
            "teeth=4");
  EXPECT_EQ(shape_in("flat:10:flute=9:holder=25.4-50.8x25.4+hsk-a63", LengthUnit::kInch),
            "flat:0.3937:flute=0.3543:holder=1-2x1+hsk-a63");
}

/// Of the cone between 20 and 33 mm, 13 mm high: 6.5 mm of radius.
TEST(Shape, StepsOfAConeNeverUnderstateIt) {
  for (const char* const spec : {"flat:10:flute=9:holder=20-33x13:stickout=25",
                                 "flat:10:flute=9:holder=33-20x13:stickout=25"}) {
    const Result<Cutter> cutter = parse_shape(spec);
    ASSERT_TRUE(cutter) << cutter.error();
    EXPECT_EQ(cutter->spec(), spec);
    const auto holder = cutter->holder();
    ASSERT_EQ(holder.size(), 26u);
    EXPECT_EQ(holder.front().from_z_mm, 25);
    EXPECT_EQ(holder.back().to_z_mm, 38);
    const bool widens = cutter->spec().find("20-33") != std::string::npos;
    for (const ToolSection& section : holder) {
      for (const double z : {section.from_z_mm, section.to_z_mm}) {
        const double exact_mm = widens ? 10 + (z - 25) / 2 : 16.5 - (z - 25) / 2;
        EXPECT_GE(section.diameter_mm / 2, exact_mm - 1e-9);
        EXPECT_LE(section.diameter_mm / 2, exact_mm + 0.25 + 1e-9);
      }
    }
  }
}

TEST(Shape, ShanksWithANeck) {
  const Result<Cutter> cutter = parse_shape("flat:3:flute=9:shank=2.8x6+6:holder=er11:stickout=30");
  ASSERT_TRUE(cutter) << cutter.error();
  EXPECT_EQ(cutter->spec(), "flat:3:flute=9:shank=2.8x6+6:holder=er11:stickout=30");
  ASSERT_EQ(cutter->neck().size(), 1u);
  EXPECT_EQ(cutter->neck()[0].diameter_mm, 2.8);
  EXPECT_EQ(cutter->neck()[0].from_z_mm, 9);
  EXPECT_EQ(cutter->neck()[0].to_z_mm, 15);
  EXPECT_EQ(cutter->shank_diameter_mm(), 6);
  EXPECT_EQ(cutter->holder()[0].from_z_mm, 30);
  EXPECT_TRUE(parse_shape("flat:3:flute=9:shank=6")->neck().empty());
  EXPECT_EQ(parse_shape("flat:3:flute=9:shank=2x6+6x5:holder=er11")->holder()[0].from_z_mm, 20);
  EXPECT_EQ(error_of("flat:3:shank=2x6+6"),
            "flat:3:shank=2x6+6: shank= of several sections needs flute=L: they begin where the "
            "flutes end");
  EXPECT_EQ(error_of("flat:3:flute=9:shank=2+6"),
            "flat:3:flute=9:shank=2+6: shank: '2' has no length; write DxL (mm)");
  EXPECT_EQ(error_of("flat:3:flute=9:shank=2-6"),
            "flat:3:flute=9:shank=2-6: shank: '2-6' has no length; write DxL (mm)");
  EXPECT_EQ(error_of("flat:3:flute=9:shank=2x20+6:holder=er11:stickout=20"),
            "flat:3:flute=9:shank=2x20+6:holder=er11:stickout=20: stickout=20 ends below the "
            "shank's last section, which begins 29 mm above the tip");
}

TEST(Shape, Teeth) {
  EXPECT_EQ(spec_of("flat:3:teeth=2"), "flat:3:teeth=2");
  EXPECT_FALSE(parse_shape("flat:3")->teeth());
  for (const char* bad : {"0", "100", "2.5", "x", ""}) {
    const std::string spec = std::string("flat:3:teeth=") + bad;
    EXPECT_EQ(error_of(spec),
              spec + ": teeth: '" + bad + "' is not allowed; must be a whole number from 1 to 99");
  }
}

// What counts for forces, and what the maker allows.
TEST(Shape, Edges) {
  EXPECT_EQ(parse_shape("flat:6")->edge_traits(), EdgeTraits{});
  const Cutter mill =
      parse_shape("flat:6:rake=12:teeth=3:helix=45:centre=no:ramp=3:chip=0.05").value();
  EXPECT_EQ(mill.spec(), "flat:6:teeth=3:helix=45:rake=12:chip=0.05:ramp=3:centre=no");
  EXPECT_EQ(mill.edge_traits(), (EdgeTraits{45, 12, 0.05, 3, false}));
  EXPECT_EQ(parse_shape(mill.spec())->edge_traits(), mill.edge_traits());
  EXPECT_TRUE(parse_shape("flat:6:centre=yes")->edge_traits().cuts_centre);
  EXPECT_EQ(shape_in("flat:25.4:helix=30:chip=0.0508:centre=no", LengthUnit::kInch),
            "flat:1:helix=30:chip=0.002:centre=no");
  EXPECT_EQ(error_of("flat:3:helix=71"),
            "flat:3:helix=71: helix: 71 is not allowed; must be from 0 to 70 (degrees)");
  EXPECT_EQ(error_of("flat:3:rake=x"), "flat:3:rake=x: rake: 'x' is not a number");
  EXPECT_EQ(error_of("flat:3:centre=maybe"),
            "flat:3:centre=maybe: centre: 'maybe' is not allowed; no and yes are: whether it cuts "
            "at its centre");
  for (const char* name : {"helix", "rake", "chip", "ramp"}) {
    const std::string spec = fmt::format("flat:3:{0}=1:{0}=2", name);
    EXPECT_EQ(error_of(spec), fmt::format("{}: {}= is given twice", spec, name));
  }
}

// A lathe's driven tool says along which axis it lies.
TEST(Shape, DrivenToolsLieAlongXOrZ) {
  EXPECT_FALSE(parse_shape("flat:3")->live());
  EXPECT_EQ(parse_shape("flat:3:live=x")->live(), LiveAxis::kX);
  EXPECT_EQ(parse_shape("drill:3:118:teeth=2:live=Z")->live(), LiveAxis::kZ);
  EXPECT_EQ(spec_of("flat:3:live=X:teeth=2"), "flat:3:teeth=2:live=x");
  EXPECT_EQ(shape_in("flat:25.4:flute=50.8:live=x", LengthUnit::kInch), "flat:1:flute=2:live=x");
  EXPECT_EQ(parse_shape("flat:3:live=y").error(),
            "flat:3:live=y: live: 'y' is not allowed; x and z are: the axis of a lathe along which "
            "the driven tool lies");
  EXPECT_EQ(parse_shape("flat:3:live=x:live=x").error(),
            "flat:3:live=x:live=x: live= is given twice");
  EXPECT_FALSE(parse_shape("turn:0.4:2:85:30:live=x"));
}

TEST(Shape, ToolArguments) {
  const Result<ToolShapeArgument> argument = parse_tool_argument("12=ball:6");
  ASSERT_TRUE(argument) << argument.error();
  EXPECT_EQ(argument->tool, 12);
  EXPECT_EQ(argument->cutter.spec(), "ball:6");
  for (const char* text : {"ball:6", "=ball:6", "-1=ball:6", "1.5=ball:6", "x=ball:6", ""}) {
    const Result<ToolShapeArgument> bad = parse_tool_argument(text);
    ASSERT_FALSE(bad) << text;
    EXPECT_EQ(bad.error(),
              std::string(text) + ": not N=SHAPE with a tool number N; write for example 3=ball:6");
  }
  const Result<ToolShapeArgument> bad = parse_tool_argument("3=ball");
  ASSERT_FALSE(bad);
  EXPECT_EQ(bad.error(), "tool 3: ball: diameter D is missing; the form is ball:D");
}

TEST(Shape, HelpNamesEveryShape) {
  for (const char* name : {"flat:D", "ball:D", "bull:D:R", "vee:D:ANGLE[:TIP]", "taper:D:ANGLE[:R]",
                           "drill:D:ANGLE", "lollipop:D:SHAFT", "tslot:D:T:SHAFT", "profile:FILE",
                           "flute=L", "shank=D", "holder=NAME|DxL", "stickout=L", "teeth=N"}) {
    EXPECT_NE(shape_help().find(name), std::string_view::npos) << name;
  }
}

// ---- profile:FILE ----

constexpr const char* kRounding =
    "# corner rounding, radius 3\n"
    "line 4 0\n"
    "ARC  7 3 3 cw   # hollow\n"
    "\n"
    "line 8 3\n"
    "flute 12\n"
    "shank 10x25\n"
    "holder 32x20+40x25\n";

TEST(ProfileFile, HoldersFromAnOutline) {
  const TemporaryFolder folder;
  const std::string file =
      folder.write("nut:5x6+7.txt",
                   "# nose\nline 14 0\nline 14 20\nline 15 21  # cone\nline 12 21\n"
                   "LINE 12 40\n");
  const std::string spec = "flat:6:flute=20:holder=profile:" + file + ":stickout=30:teeth=2";
  const Result<Cutter> cutter = parse_shape(spec);
  ASSERT_TRUE(cutter) << cutter.error();
  EXPECT_EQ(cutter->spec(), spec);
  EXPECT_EQ(shape_in(spec, LengthUnit::kInch),
            "flat:0.2362:flute=0.7874:holder=profile:" + file + ":stickout=1.1811:teeth=2");
  const auto holder = cutter->holder();
  ASSERT_EQ(holder.size(), 6u) << "a cylinder, four steps, a cylinder";
  EXPECT_EQ(holder[0].diameter_mm, 28);
  EXPECT_EQ(holder[0].to_z_mm, 50);
  EXPECT_EQ(holder[4].diameter_mm, 30);
  EXPECT_EQ(holder[5].diameter_mm, 24);
  EXPECT_EQ(holder[5].to_z_mm, 70);

  const auto fault = [&](const char* text) {
    const std::string path = folder.write("bad", text);
    const std::string error = error_of("flat:6:flute=20:holder=profile:" + path);
    return error.substr(std::min(error.size(), error.rfind("bad:") + 4));
  };
  EXPECT_EQ(fault("line 14 0\narc 3 4 5 cw\n"),
            "2: 'arc 3 4 5 cw' is not allowed; an outline of a holder has 'line R Z' alone");
  EXPECT_EQ(fault("line 14 5\n"), "1: the radius must be above 0");
  EXPECT_EQ(fault("line 14 0\nline 14 9\nline 14 8\n"),
            "3: Z falls from 9 to 8; the outline must run upward");
  EXPECT_EQ(fault("line -1 0\n"), "1: R: -1 is not allowed; must be from 0 to 500 (mm)");
  EXPECT_EQ(fault("line 14 0\n"),
            " no outline found; at least 'line R 0' and 'line R Z' are needed");
  EXPECT_NE(error_of("flat:6:flute=9:holder=profile:/no/file").find("/no/file: no such file"),
            std::string::npos);
  EXPECT_EQ(error_of("flat:6:flute=9:holder=profile:"),
            "flat:6:flute=9:holder=profile:: holder: file name FILE is missing after profile:");
}

TEST(ProfileFile, HeightsAndOptions) {
  const TemporaryFolder folder;
  const std::string file = folder.write("rounding:3.txt", kRounding);
  const Result<Cutter> cutter = parse_shape("profile:" + file);
  ASSERT_TRUE(cutter) << cutter.error();
  EXPECT_EQ(cutter->spec(), "profile:" + file);
  EXPECT_EQ(cutter->radius_mm(), 8);
  EXPECT_EQ(cutter->height_mm(2), 0);
  EXPECT_NEAR(cutter->height_mm(5.5), std::sqrt(9 - 1.5 * 1.5), 1e-12);
  EXPECT_EQ(cutter->flute_length_mm(), 12);
  EXPECT_EQ(cutter->shank_diameter_mm(), 10);
  ASSERT_EQ(cutter->holder().size(), 2U);
  EXPECT_EQ(cutter->holder()[0].from_z_mm, 37);
}

TEST(ProfileFile, ShapeTextOverridesTheFile) {
  const TemporaryFolder folder;
  const std::string file = folder.write("a.txt", kRounding);
  const Result<Cutter> cutter = parse_shape("profile:" + file + ":flute=15");
  ASSERT_TRUE(cutter) << cutter.error();
  EXPECT_EQ(cutter->spec(), "profile:" + file + ":flute=15");
  EXPECT_EQ(cutter->flute_length_mm(), 15);
  EXPECT_EQ(cutter->holder()[0].from_z_mm, 40);
}

TEST(ProfileFile, SameCutterAsTheBuiltInShape) {
  const TemporaryFolder folder;
  const std::string file = folder.write("ball.txt", "arc 5 5 5 ccw\n");
  const Result<Cutter> ball = parse_shape("profile:" + file);
  ASSERT_TRUE(ball) << ball.error();
  const Result<Cutter> built_in = parse_shape("ball:10");
  for (int i = 0; i <= 100; ++i) {
    EXPECT_NEAR(ball->height_mm(0.05 * i), built_in->height_mm(0.05 * i), 1e-12);
  }
}

TEST(ProfileFile, RoundedDecimalsOfAnUprightArcAreFitted) {
  // Four decimals put the end a little above the centre's level.
  const Result<ProfileFile> file = parse_profile_text("arc 3.0001 3 3 ccw\n", "a.txt");
  ASSERT_TRUE(file) << file.error();
  const ProfilePiece& arc = file->pieces[0];
  EXPECT_NEAR(arc.radius, 3, 1e-3);
  EXPECT_TRUE(Cutter::from_profile("a", file->pieces));
}

TEST(ProfileFile, HollowBottom) {
  const Result<ProfileFile> file = parse_profile_text("start 0 0.5\nline 5 0\nline 6 2\n", "a.txt");
  ASSERT_TRUE(file) << file.error();
  const Result<Cutter> cutter = Cutter::from_profile("a", file->pieces);
  ASSERT_TRUE(cutter) << cutter.error();
  EXPECT_EQ(cutter->height_mm(0), 0.5);
  EXPECT_EQ(cutter->height_mm(5), 0);
}

TEST(Shape, UpperSidesOfHeads) {
  const Result<Cutter> lollipop = parse_shape("lollipop:10:6");
  EXPECT_NEAR(lollipop->upper_height_mm(4), 5 + 3, 1e-12);
  EXPECT_NEAR(lollipop->upper_height_mm(0), 9, 1e-12);  // the foot of the neck
  EXPECT_EQ(lollipop->upper_height_mm(5.1), -std::numeric_limits<double>::infinity());
  const Result<Cutter> tslot = parse_shape("tslot:20:3:8");
  EXPECT_EQ(tslot->upper_height_mm(10), 3);
  EXPECT_EQ(tslot->upper_height_mm(5), 3);
  const Result<Cutter> dovetail = parse_shape("dovetail:20:45:8");
  EXPECT_NEAR(dovetail->upper_height_mm(7), 3, 1e-12);
  EXPECT_EQ(dovetail->height_mm(7), 0);
  EXPECT_TRUE(parse_shape("flat:6")->upper_profile().empty());
}

TEST(Shape, DovetailErrors) {
  EXPECT_EQ(parse_shape("dovetail:20:45").error(),
            "dovetail:20:45: shaft diameter SHAFT is missing; the form is dovetail:D:ANGLE:SHAFT");
  EXPECT_EQ(parse_shape("dovetail:20:90:8").error(),
            "dovetail:20:90:8: side angle ANGLE: 90 is not allowed; must be from 1 to 89 "
            "(degrees)");
  EXPECT_EQ(parse_shape("dovetail:20:45:20").error(),
            "dovetail:20:45:20: shaft diameter SHAFT: 20 is not allowed; must be less than "
            "diameter D, 20 (mm)");
}

TEST(ProfileFile, UpperSideOfAHead) {
  const TemporaryFolder folder;
  // A back-chamfer, and a lollipop written with few decimals.
  const std::string chamfer =
      folder.write("chamfer.txt", "line 4 0\nline 4 2\nupper\nline 2 4\nflute 10\n");
  const Result<Cutter> cutter = parse_shape("profile:" + chamfer);
  ASSERT_TRUE(cutter) << cutter.error();
  EXPECT_EQ(cutter->neck_radius_mm(), 2);
  EXPECT_EQ(cutter->upper_height_mm(3), 3);
  EXPECT_EQ(cutter->flute_length_mm(), 10);
  const std::string ball =
      folder.write("ball.txt", "arc 5 5 5 ccw\nupper\narc 3.333 8.727 5 ccw\n");
  const Result<Cutter> lollipop = parse_shape("profile:" + ball);
  ASSERT_TRUE(lollipop) << lollipop.error();
  EXPECT_NEAR(lollipop->upper_height_mm(4), 8, 2e-3);

  const auto error = [](const char* text) {
    const Result<ProfileFile> file = parse_profile_text(text, "a.txt");
    return file ? std::string("no error") : file.error();
  };
  EXPECT_EQ(error("upper"), "a.txt:1: upper must come after the lower side of the outline");
  EXPECT_EQ(error("line 3 0\nupper 1"), "a.txt:2: 'upper' takes no value");
  EXPECT_EQ(error("line 3 0\nupper\nupper"), "a.txt:3: 'upper' is given twice");
  EXPECT_EQ(error("line 3 0\nupper\nline 4 1"),
            "a.txt:3: the radius rises from 3 to 4; the upper side must run inward");
  const std::string wide = folder.write("wide.txt", "line 4 0\nupper\nline 4 2\n");
  EXPECT_NE(error_of("profile:" + wide)
                .find("upper profile: the neck has radius 4; must be above 0 and below the "
                      "head's, 4 (mm)"),
            std::string::npos);
  const std::string down = folder.write("down.txt", "line 4 3\nupper\nline 2 1\n");
  EXPECT_NE(error_of("profile:" + down)
                .find("upper profile piece 1: the height falls from 3 to 1 mm; the upper side "
                      "must not fall"),
            std::string::npos);
}

TEST(ProfileFile, ErrorsNameFileAndLine) {
  const auto error = [](const char* text) {
    const Result<ProfileFile> file = parse_profile_text(text, "a.txt");
    return file ? std::string("no error") : file.error();
  };
  EXPECT_EQ(error(""), "a.txt: no outline found; at least one 'line R Z' is needed");
  EXPECT_EQ(error("flute 3\n"), "a.txt: no outline found; at least one 'line R Z' is needed");
  EXPECT_EQ(error("\nlin 3 0"),
            "a.txt:2: unknown keyword 'lin'; did you mean 'line'? Allowed: line, arc, start, "
            "upper, flute, shank, holder");
  EXPECT_EQ(error("spline 3 0"),
            "a.txt:1: unknown keyword 'spline'. Allowed: line, arc, start, "
            "upper, flute, shank, holder");
  EXPECT_EQ(error("line 3"), "a.txt:1: wrong number of values; the form is 'line R Z'");
  EXPECT_EQ(error("line 3 0\narc 5 2 2"),
            "a.txt:2: wrong number of values; the form is 'arc R Z RADIUS cw|ccw'");
  EXPECT_EQ(error("line x 0"), "a.txt:1: R: 'x' is not a number");
  EXPECT_EQ(error("line -1 0"), "a.txt:1: R: -1 is not allowed; must be from 0 to 500 (mm)");
  EXPECT_EQ(error("line 1 3000"), "a.txt:1: Z: 3000 is not allowed; must be from 0 to 2000 (mm)");
  EXPECT_EQ(error("line 3 0\nline 2 1"),
            "a.txt:2: the radius falls from 3 to 2; the outline must run outward");
  EXPECT_EQ(error("line 3 0\nline 3 0"), "a.txt:2: the piece has no length");
  EXPECT_EQ(error("arc 5 5 2 ccw"),
            "a.txt:1: arc radius 2 is too small: the ends are 7.071 mm apart");
  EXPECT_EQ(error("arc 5 5 0 ccw"),
            "a.txt:1: RADIUS: 0 is not allowed; must be from 0.001 to 10000 (mm)");
  EXPECT_EQ(error("arc 5 5 5 left"), "a.txt:1: 'left' is not a sense; must be cw or ccw");
  EXPECT_EQ(error("arc 1 5 3 ccw"),
            "a.txt:1: the arc turns back inward; it must not pass its widest point");
  EXPECT_EQ(error("line 3 0\nstart 0 1"), "a.txt:2: start must come before the first line or arc");
  EXPECT_EQ(error("start 1 1"), "a.txt:1: R: 1 is not allowed; must be from 0 to 0 (mm)");
  EXPECT_EQ(error("flute 3\nflute 4"), "a.txt:2: 'flute' is given twice");
  EXPECT_EQ(error("holder 3x3 4x4"), "a.txt:1: 'holder' takes one value");
}

TEST(ProfileFile, ErrorsOfTheFileAsAWhole) {
  const TemporaryFolder folder;
  EXPECT_EQ(error_of("profile:" + folder.path() + "/none").substr(folder.path().size() + 15),
            folder.path() + "/none: no such file");
  EXPECT_NE(error_of("profile:" + folder.path()).find(": not a regular file"), std::string::npos);
  const std::string high = folder.write("high.txt", "start 0 1\nline 5 1\n");
  EXPECT_NE(error_of("profile:" + high)
                .find("high.txt: profile: the lowest point is at Z1; it must be at Z0, the tip"),
            std::string::npos);
  const std::string flute = folder.write("flute.txt", "line 5 0\nflute x\n");
  EXPECT_NE(error_of("profile:" + flute).find("flute.txt: flute length: 'x' is not a number"),
            std::string::npos);
  const std::string big = folder.write("big.txt", std::string(kMaxProfileBytes + 1, '#'));
  EXPECT_NE(error_of("profile:" + big).find("larger than 1048576 bytes"), std::string::npos);
}

TEST(ProfileFile, CutAtEveryByteNeverCrashes) {
  const std::string text = kRounding;
  int good = 0;
  for (std::size_t size = 0; size <= text.size(); ++size) {
    const Result<ProfileFile> file = parse_profile_text(text.substr(0, size), "a.txt");
    if (file && Cutter::from_profile("a", file->pieces)) ++good;
    if (!file) {
      EXPECT_EQ(file.error().substr(0, 5), "a.txt");
    }
  }
  EXPECT_GT(good, 30);  // cuts behind the outline that end no option in half
}

}  // namespace
}  // namespace kerf
