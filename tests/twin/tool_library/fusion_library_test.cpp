// Libraries of Fusion; shop/fusion.json has the form of its exports.
#include <gtest/gtest.h>

#include <map>

#include "tests/twin/tool_library/library_support.h"

namespace kerf {
namespace {

/// One tool of `type` in millimetres, number 1.
std::string of_tool(const std::string& type, const std::string& geometry,
                    const std::string& more = "") {
  return text_of(ReadLibrary(
      fmt::format(R"({{"data": [{{"type": "{}", "unit": "millimeters", "geometry": {{{}}},
                      "post-process": {{"number": 1}} {}}}]}})",
                  type, geometry, more)));
}

constexpr const char* kNut =
    R"(, "holder": {"unit": "millimeters", "gaugeLength": 60, "segments": [
        {"height": 19, "lower-diameter": 34, "upper-diameter": 34},
        {"height": 41, "lower-diameter": 46, "upper-diameter": 46},
        {"height": 9, "lower-diameter": 31, "upper-diameter": 31}]})";

TEST(Fusion, KindsOfTools) {
  Diagnostics diagnostics;
  const auto library =
      read_tool_library(std::string(KERF_SHOP_FOLDER) + "/fusion.json", diagnostics);
  ASSERT_TRUE(library);
  EXPECT_EQ(library->format, "Fusion");
  std::map<int, std::string> tools;
  for (const LibraryTool& tool : library->tools) {
    if (tool.number) tools.emplace(*tool.number, text_of(tool));
  }
  const std::string holder = ":holder=34x19+34-46x11+46x30:stickout=";
  EXPECT_EQ(tools[1], "1: flat:6:flute=13:shank=5.8x7+6" + holder + "40:teeth=3");
  EXPECT_EQ(tools[2], "2: ball:6.35:flute=19.05:shank=6.35" + holder + "38.1:teeth=2")
      << "in inches, its holder in mm";
  EXPECT_EQ(tools[3], "3: bull:10:2:flute=22:shank=10" + holder + "35:teeth=4")
      << "no LB: assemblyGaugeLength 95 less the holder's gaugeLength 60";
  EXPECT_EQ(tools[4], "4: vee:12:90:1:flute=7:shank=12:teeth=2") << "TA is that of one side";
  // DC is at the tip: 12 + 2 * 24 * tan(10) = 20.46 where the flutes end.
  EXPECT_EQ(tools[5], "5: taper:12:10:2.5:flute=24:shank=20.46:teeth=4");
  EXPECT_EQ(tools[6], "6: lollipop:12:6:shank=6:teeth=5");
  EXPECT_EQ(tools[7], "7: -: its kind 'thread mill' is not known");
  EXPECT_EQ(tools[8], "8: dovetail:20:60:8.45:shank=8.45x9.997407+10:teeth=7")
      << "TA is measured from the axis: 20 - 2 * 10 * tan(30) = 8.45";
  EXPECT_EQ(tools[9], "9: tslot:20:4:6.67:shank=6.67x16+12:teeth=7");
  EXPECT_EQ(tools[10], "10: drill:5:140:flute=40:shank=5:teeth=2");
  EXPECT_EQ(tools[11], "11: bull:50:0.8:flute=12:shank=22:teeth=6");
  EXPECT_EQ(tools[12], "12: vee:12:90:1.2:flute=5.4:shank=7.2:teeth=3");
  EXPECT_EQ(tools[13],
            "13: drill:6:180:flute=18:shank=6 | a tap is taken for a plain cylinder, "
            "without its thread");
  EXPECT_EQ(tools[14], "14: flat:8:flute=25:shank=8" + holder +
                           "25:teeth=2 | flutes of 30 mm reach into the holder, 25 mm above the "
                           "tip: they are taken to end there");
  EXPECT_EQ(tools[15], "15: kerf:1.5");
  EXPECT_EQ(tools[17], "17: -: it has no DC, its diameter, above 0");
  EXPECT_EQ(tools[18], "18: -: geometry.DC: \"six\" is no length");
  EXPECT_EQ(tools[21], "21: -: it has no SC, the shape of its insert");
  EXPECT_EQ(tools[22],
            "22: tslot:10:3:6:shank=6:teeth=4 | its holder is left out: "
            "holder.segments.lower-diameter: \"wide\" is no length");
  EXPECT_EQ(library->tools.size(), 23u) << "the holder that is listed is no tool";
}

TEST(Fusion, HoldersEndAtTheGaugeLine) {
  EXPECT_EQ(of_tool("flat end mill", R"("DC": 6, "LCF": 10, "LB": 30)", kNut),
            "1: flat:6:flute=10:holder=34x19+46x41:stickout=30\n");
  EXPECT_EQ(of_tool("flat end mill", R"("DC": 6, "LCF": 10, "assemblyGaugeLength": 85)", kNut),
            "1: flat:6:flute=10:holder=34x19+46x41:stickout=25\n");
  EXPECT_EQ(of_tool("flat end mill", R"("DC": 6, "LCF": 10)", kNut),
            "1: flat:6:flute=10 | nothing says how far it sticks out of its holder: that is left "
            "out\n");
  EXPECT_EQ(of_tool("flat end mill", R"("DC": 6, "LCF": 10, "LB": 30)",
                    R"(, "holder": {"unit": "inches", "gaugeLength": 0.5, "segments": [
                       {"height": 1, "lower-diameter": 1, "upper-diameter": 2}]})"),
            "1: flat:6:flute=10:holder=25.4-38.1x12.7:stickout=30\n")
      << "a cone is cut there";
}

TEST(Fusion, NecksAreNarrowerThanTheShank) {
  const auto parts = [](const char* geometry) {
    return of_tool("flat end mill", std::string(R"("DC": 3, "LCF": 9, "SFDM": 6, )") + geometry);
  };
  EXPECT_EQ(parts(R"("shoulder-diameter": 2.8, "shoulder-length": 15)"),
            "1: flat:3:flute=9:shank=2.8x6+6\n");
  EXPECT_EQ(parts(R"("shoulder-length": 15)"), "1: flat:3:flute=9:shank=3x6+6\n");
  EXPECT_EQ(parts(R"("shoulder-diameter": 2.8, "shoulder-length": 9)"),
            "1: flat:3:flute=9:shank=6\n");
}

TEST(Fusion, ShapesThatDoNotFit) {
  EXPECT_EQ(of_tool("bull nose end mill", R"("DC": 6, "RE": 4)"),
            "1: -: bull:6:4: corner radius R: 4 is not allowed; must be from 0 to 3 (mm)\n");
  EXPECT_EQ(of_tool("chamfer mill", R"("DC": 6, "TA": 90)"),
            "1: -: vee:6:180:0: included angle ANGLE: 180 is not allowed; must be from 1 to 179 "
            "(degrees)\n");
  EXPECT_EQ(of_tool("chamfer mill", R"("DC": 12, "TA": 45, "LCF": 2)"),
            "1: vee:12:90:flute=6 | flutes of 2 mm end below the top of its shape, 6 mm: they are "
            "taken to end there\n");
  EXPECT_EQ(of_tool("tapered mill", R"("DC": 6, "TA": 10)"),
            "1: -: nothing says how long its cone is: its flutes have no length\n");
  EXPECT_EQ(of_tool("drill", R"("DC": 6)"),
            "1: drill:6:118 | it has no SIG, the angle of its point: 118 degrees are taken\n");
  EXPECT_EQ(of_tool("ball end mill", R"("DC": 6, "LCF": 12, "SFDM": 9000)"),
            "1: ball:6 | shank and holder are left out: ball:6:flute=12:shank=9000: shank "
            "diameter: 9000 is not allowed; must be from 0.001 to 1000 (mm)\n");
}

constexpr const char* kShank =
    R"(, "holder": {"unit": "millimeters", "HAND": "R", "THSC": "l", "W": 25, "OAL": 150})";
constexpr const char* kBar =
    R"(, "holder": {"unit": "millimeters", "HAND": "R", "THSC": "boring bar l", "W": 16, "CW": 11,
        "LH": 80, "OAL": 200})";

TEST(Fusion, InsertsAreThoseOfIso1832) {
  const auto general = [](const std::string& geometry, const char* holder = kShank) {
    return of_tool("turning general", geometry, holder);
  };
  // By the cutting edge, 12.9 mm, and by the circle, in inches.
  EXPECT_EQ(general(R"("SC": "C", "INSD": 12.9, "SIZE_SPECIFICATION_MODE": "CE", "RE": 0.8,
                       "S": 4.76, "RA": 0, "TC": "M", "SCTY": "G")"),
            "1: iso:CNMG120408:R:95:holder=25x150\n");
  EXPECT_EQ(general(R"("SC": "D", "INSD": "0.375 in", "SIZE_SPECIFICATION_MODE": "IC",
                       "RE": "0.0157 in", "S": 3.97, "RA": 7, "TC": "M", "SCTY": "T")"),
            "1: iso:DCMT11T304:R:95:holder=25x150\n");
  EXPECT_EQ(general(R"("SC": "R", "INSD": 10, "RE": 5, "S": 3.97, "RA": 7, "TC": "M",
                       "SCTY": "T")"),
            "1: iso:RCMT10T3M0:R:holder=25x150\n");
  // Left, with an angle that no lettered style has.
  EXPECT_EQ(
      general(R"("SC": "V", "INSD": 16.6, "RE": 0.4, "S": 4.76, "RA": 5, "TC": "M",
                       "SCTY": "T")",
              R"(, "holder": {"HAND": "L", "THSC": "custom"})"),
      "1: iso:VBMT160404:L | the angle of its holder's style 'custom' is not known: the usual "
      "one is taken\n");
  // No such size: 180 - 93 = 87 in front, 55 less behind.
  EXPECT_EQ(
      general(R"("SC": "D", "INSD": 100, "RE": 0.8)", R"(, "holder": {"HAND": "R", "THSC": "j"})"),
      "1: turn:0.8:2:87:32 | there is no such size in ISO 1832: only its corner is taken\n");
  EXPECT_EQ(general(R"("SC": "Q", "INSD": 9)"),
            "1: -: the shape SC of its insert, 'q', is not known\n");
  EXPECT_EQ(general(R"("SC": "C")"), "1: -: it has no INSD, the size of its insert, above 0\n");
}

TEST(Fusion, BoringBarsStandInBores) {
  EXPECT_EQ(of_tool("turning boring", R"("SC": "C", "INSD": 9.67, "SIZE_SPECIFICATION_MODE": "CE",
                       "RE": 0.4, "S": 3.97, "RA": 7, "TC": "M", "SCTY": "T")",
                    kBar),
            "1: iso:CCMT09T304:R:95:bar=16x80:f=11\n");
  EXPECT_EQ(of_tool("turning boring", R"("SC": "C", "INSD": 9.67, "RE": 0.4, "S": 3.97)"),
            "1: -: its holder has no W, the thickness of its bar, or no length LH | its holder has "
            "no HAND: a right-hand one is taken | its holder has no style THSC: the usual angle of "
            "its edge is taken\n");
}

TEST(Fusion, BladesAndThreads) {
  const std::string where =
      " | nothing says whether it cuts outside, in a bore or in a face: outside is taken\n";
  EXPECT_EQ(of_tool("turning grooving", R"("SC": "groove square", "tool_grooveWidth": 3,
                       "tool_insertWidth": 2.7, "RE": 0.2, "LH": 14)"),
            "1: groove:3:0.2:edge=14" + where);
  EXPECT_EQ(of_tool("turning grooving", R"("SC": "groove round", "tool_insertWidth": 4)"),
            "1: groove:4:2" + where);
  EXPECT_EQ(of_tool("turning grooving", R"("SC": "groove square", "RE": 0.2)"),
            "1: -: it has no tool_grooveWidth, the width of its blade, above 0\n");
  EXPECT_EQ(of_tool("turning threading", R"("SC": "thread iso triple", "TPN": 1.5, "TPX": 1.5,
                       "thread-profile-angle": 60, "tool_internalThread": false)"),
            "1: thread:60:1.5\n");
  EXPECT_EQ(of_tool("turning threading", R"("SC": "thread iso double", "TPN": 0.5, "TPX": 3,
                       "thread-profile-angle": 55, "tool_internalThread": true)"),
            "1: thread:55:orient=8 | it is for more than one pitch, or says none: its tip is taken "
            "to be sharp\n");
}

}  // namespace
}  // namespace kerf
