// FreeCAD's tool bits and libraries; the files in shop/ have the form of those that it ships.
#include <gtest/gtest.h>

#include <map>

#include "tests/twin/tool_library/library_support.h"

namespace kerf {
namespace {

std::string of_bit(const std::string& shape, const std::string& parameters) {
  return text_of(ReadLibrary(fmt::format(
      R"({{"version": 2, "name": "x", "shape": "{}", "parameter": {{{}}}, "attribute": {{}}}})",
      shape, parameters)));
}

TEST(FreeCad, TheLibraryWithItsBitsBesideIt) {
  Diagnostics diagnostics;
  const auto library =
      read_tool_library(std::string(KERF_SHOP_FOLDER) + "/Library/shop.fctl", diagnostics);
  ASSERT_TRUE(library);
  EXPECT_TRUE(diagnostics.empty());
  EXPECT_EQ(library->format, "FreeCAD");
  std::map<int, std::string> tools;
  for (const LibraryTool& tool : library->tools) tools[tool.number.value_or(0)] = text_of(tool);
  EXPECT_EQ(tools[1], "1: flat:6:flute=16:shank=6:teeth=3");
  EXPECT_EQ(tools[2], "2: ball:6.35:flute=25.4:shank=6.35") << "inches, and a decimal comma";
  EXPECT_EQ(tools[3], "3: bull:8:1:flute=20");
  EXPECT_EQ(tools[4], "4: bull:8:1.5") << "FlatRadius of older ones";
  EXPECT_EQ(tools[5], "5: vee:10:60:0.1:shank=6") << "CuttingEdgeHeight is that of the rim";
  EXPECT_EQ(tools[6], "6: drill:5:118");
  EXPECT_EQ(tools[7], "7: dovetail:20:60:9.6:shank=9.6x5+12");
  EXPECT_EQ(tools[8],
            "8: tslot:63:2:16:shank=16 | its cap is left out: the underside of its blade "
            "is the tip");
  EXPECT_EQ(tools[9], "9: taper:2:5:1:flute=20:shank=6") << "TaperAngle is that of both sides";
  EXPECT_EQ(tools[10], "10: -: its kind 'thread-mill.fcstd' is not known");
  EXPECT_EQ(tools[11], "11: vee:12:90:2") << "a drawing of one's own, of a known type";
  EXPECT_EQ(tools[12], "12: -: its Diameter is not above 0");
  EXPECT_EQ(tools[13], "13: -: parameter.Diameter: \"5 parsec\" is no length");
  EXPECT_EQ(tools[14],
            "14: drill:8:180:shank=8 | a tap is taken for a plain cylinder, without its "
            "thread");
  EXPECT_EQ(tools[15],
            "15: -: its tool bit missing.fctb is neither in ../Bit nor in Bit nor "
            "beside the library");
  EXPECT_EQ(tools[16], "16: -: it is no tool bit of FreeCAD: it has no parameter")
      << "a library that lists itself";
}

TEST(FreeCad, OneBitHasTheNumberThatItIsGiven) {
  const std::string bit = std::string(KERF_SHOP_FOLDER) + "/Bit/bull.fctb";
  Diagnostics diagnostics;
  auto libraries = read_tool_libraries({bit, "7=" + bit}, diagnostics);
  EXPECT_TRUE(diagnostics.empty());
  ASSERT_EQ(libraries.size(), 2u);
  EXPECT_EQ(text_of(libraries[0].tools.at(0)), "-: bull:8:1:flute=20");
  EXPECT_EQ(text_of(libraries[1].tools.at(0)), "7: bull:8:1:flute=20");
  read_tool_libraries({"0=" + bit}, diagnostics);
  ASSERT_EQ(diagnostics.size(), 1u);
  EXPECT_NE(diagnostics[0].message.find("0 is not allowed; tool numbers are 1 to 99999"),
            std::string::npos);
  diagnostics.clear();
  read_tool_libraries({"3=" + std::string(KERF_SHOP_FOLDER) + "/fusion.json"}, diagnostics);
  ASSERT_EQ(diagnostics.size(), 1u);
  EXPECT_EQ(diagnostics[0].message, "holds 23 tools; N=FILE is for a file with a single one");
}

TEST(FreeCad, WhatIsMissingIsNamed) {
  EXPECT_EQ(of_bit("endmill.fcstd", ""), "-: -: it has no Diameter\n");
  EXPECT_EQ(of_bit("bullnose.fcstd", R"("Diameter": "6 mm")"), "-: -: it has no CornerRadius\n");
  EXPECT_EQ(of_bit("v-bit.fcstd", R"("Diameter": "6 mm")"), "-: -: it has no CuttingEdgeAngle\n");
  EXPECT_EQ(of_bit("drill.fcstd", R"("Diameter": "6 mm")"), "-: -: it has no TipAngle\n");
  EXPECT_EQ(of_bit("taperedballnose.fcstd", R"("Diameter": "6 mm", "TaperAngle": "8 deg")"),
            "-: -: nothing says how long its cone is: its flutes have no length\n");
  EXPECT_EQ(of_bit("endmill.fcstd", R"("Diameter": "5000 mm")"),
            "-: -: flat:5000: diameter D: 5000 is not allowed; must be from 0.001 to 1000 (mm)\n");
  EXPECT_EQ(of_bit("endmill.fcstd", R"("Diameter": [6])"),
            "-: -: parameter.Diameter: [6] is no length\n");
}

TEST(FreeCad, AnglesAndHeightsOfADovetailThatDisagree) {
  EXPECT_EQ(of_bit("dovetail.fcstd",
                   R"("Diameter": "20 mm", "CuttingEdgeAngle": "45 deg", "NeckDiameter": "10 mm",
                      "CuttingEdgeHeight": "9 mm")"),
            "-: dovetail:20:45:10 | its CuttingEdgeHeight is 9 mm, its diameters and its angle "
            "make 5 mm: the angle counts\n");
}

TEST(FreeCad, NumbersOfALibrary) {
  const auto of_number = [](const char* number) {
    return text_of(
        ReadLibrary(fmt::format(R"({{"tools": [{{"nr": {}, "path": "Bit/bull.fctb"}}]}})", number),
                    std::string(KERF_SHOP_FOLDER) + "/x.fctl"));
  };
  EXPECT_EQ(of_number("12"), "12: bull:8:1:flute=20\n");
  EXPECT_EQ(of_number("\"12\""), "12: bull:8:1:flute=20\n");
  EXPECT_EQ(of_number("0"), "-: bull:8:1:flute=20\n");
  EXPECT_EQ(of_number("null"), "-: bull:8:1:flute=20\n");
  for (const char* bad : {"-1", "1.5", "100000", "1e300", "[]"}) {
    const std::string said = of_number(bad);
    EXPECT_NE(said.find("is not allowed; must be a whole number from 1 to 99999"),
              std::string::npos)
        << said;
  }
}

}  // namespace
}  // namespace kerf
