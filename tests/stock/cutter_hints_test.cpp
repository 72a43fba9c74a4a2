#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "stock/blank.h"
#include "stock/cutter/shape_spec.h"
#include "stock/cutter/tool_hints.h"
#include "tests/stock/program_comments.h"

namespace kerf {
namespace {

/// "dialect T1 shape [guessed]" of each hint, joined by "; ".
std::string hints_in(const std::vector<CommentText>& comments) {
  std::string text;
  for (const ToolHint& hint : find_tool_hints(comments)) {
    EXPECT_TRUE(parse_shape(hint.shape)) << hint.shape;
    text += (text.empty() ? "" : "; ") + hint.dialect + " T" + std::to_string(hint.tool) + " " +
            hint.shape + (hint.shape_guessed ? " guessed" : "");
  }
  return text;
}

std::string mm(const char* text) { return hints_in({{1, text, false}}); }
std::string inch(const char* text) { return hints_in({{1, text, true}}); }

CommentText in_block(const char* text, int tool) {
  CommentText comment{1, text, false};
  comment.block_tool = tool;
  return comment;
}

TEST(ToolHints, Fusion) {
  EXPECT_EQ(mm("T1 D=6. CR=0. - ZMIN=-29.5 - flat end mill"), "fusion T1 flat:6");
  EXPECT_EQ(mm("T12  D=6. CR=3. - ZMIN=-2 - BALL END MILL"), "fusion T12 ball:6");
  EXPECT_EQ(mm("T2 D=10 CR=1.5 - ZMIN=0 - bullnose end mill"), "fusion T2 bull:10:1.5");
  EXPECT_EQ(mm("T3 D=6 CR=0 TAPER=45deg - ZMIN=-1 - chamfer mill"), "fusion T3 vee:6:90");
  EXPECT_EQ(mm("T3 D=6 CR=0 TAPER=30deg TD=0.5 - chamfer mill"), "fusion T3 vee:6:60:0.5");
  EXPECT_EQ(mm("T4 D=5. CR=0. TAPER=118deg - ZMIN=-14. - drill"), "fusion T4 drill:5:118");
  EXPECT_EQ(mm("T4 D=5. CR=0. TAPER=118deg - ZMIN=-14. - taladrar"), "fusion T4 drill:5:118");
  EXPECT_EQ(mm("T4 D=8 CR=0 TAPER=90deg - ZMIN=-1 - spot drill"), "fusion T4 drill:8:90");
  EXPECT_EQ(mm("T5 D=1 CR=0.5 TAPER=5deg - ZMIN=-9 - tapered mill"), "fusion T5 taper:1:5:0.5");
  EXPECT_EQ(mm("T6 D=50. CR=0. - ZMIN=0. - face mill"), "fusion T6 flat:50");
  EXPECT_EQ(mm("T7 D=6 CR=0 - ZMIN=-10 - right hand tap"), "fusion T7 flat:6");
  EXPECT_EQ(mm("T8 D=12 CR=0 - ZMIN=-3 - lollipop mill"), "fusion T8 lollipop:12:6 guessed");
  EXPECT_EQ(mm("T9 6mm carbide ball D=6. CR=0. - ZMIN=-3. - flat end mill"), "fusion T9 flat:6");
  EXPECT_EQ(inch("T1 D=0.1875 CR=0. - ZMIN=-0.8268 - FLAT END MILL"), "fusion T1 flat:4.7625");
  EXPECT_EQ(inch("T1 D=0.5 CR=0.25 - ZMIN=-0.6275 - BALL END MILL"), "fusion T1 ball:12.7");
  EXPECT_EQ(mm("T1 D=0. CR=0. - ZMIN=0 - flat end mill"), "");
  EXPECT_EQ(mm("T1 D=6 - probe"), "");
}

TEST(ToolHints, CamBam) {
  EXPECT_EQ(mm(" T1 : 3.175 "), "cambam T1 flat:3.175 guessed");
  EXPECT_EQ(inch("T0 : 0.125"), "cambam T0 flat:3.175 guessed");
  EXPECT_EQ(mm("T0 : 0.0"), "");
  EXPECT_EQ(inch("T0 : 0.001"), "") << "a placeholder";
  EXPECT_EQ(mm("T1 : 0.05"), "cambam T1 flat:0.05 guessed");
}

TEST(ToolHints, Pcb2Gcode) {
  EXPECT_EQ(mm("MSG, Change tool bit to mill diameter 0.20000mm"),
            "pcb2gcode T-1 flat:0.2 guessed");
  EXPECT_EQ(mm("MSG, Change tool bit to mill diameter 0.10000in"),
            "pcb2gcode T-1 flat:2.54 guessed");
  EXPECT_EQ(mm("MSG, Change tool bit to drill size 0.8mm"), "pcb2gcode T-1 drill:0.8:118");
  EXPECT_EQ(mm("MSG, Change tool bit to mill diameter 0.00000in"), "");
}

TEST(ToolHints, FlatCam) {
  EXPECT_EQ(mm("TOOL DIAMETER: 0.1 mm"), "flatcam T-1 flat:0.1 guessed");
  EXPECT_EQ(inch("TOOL DIAMETER: 0.1"), "flatcam T-1 flat:2.54 guessed");
  EXPECT_EQ(mm("MSG, Change to Tool Dia = 0.8000 ||| Total drills for tool T1 = 10"),
            "flatcam T-1 drill:0.8:118");
  EXPECT_EQ(mm("Compensated Tool Path. Diameter: 3.0"), "");
}

TEST(ToolHints, ViaConstructor) {
  EXPECT_EQ(mm("Tool-Diameter: 2.5mm"), "viaconstructor T-1 flat:2.5 guessed");
  EXPECT_EQ(inch("Tool-Diameter: 0.125"), "viaconstructor T-1 flat:3.175 guessed");
  EXPECT_EQ(mm("Tool-Offset: 1.25mm none"), "");
  EXPECT_EQ(mm("Tool-Mode: mill"), "");
}

TEST(ToolHints, CutViewer) {
  EXPECT_EQ(mm("TOOL/MILL,6.3500,0,1.0000,0.0"), "cutviewer T-1 flat:6.35");
  // Half of the diameter within the decimals written.
  EXPECT_EQ(mm("TOOL/MILL,0.7937,0.39687,1.000,0.0"), "cutviewer T-1 ball:0.7937");
  EXPECT_EQ(mm("TOOL/MILL, 10, 2, 30, 0"), "cutviewer T-1 bull:10:2");
  EXPECT_EQ(inch("tool/mill,.125,0,1,15"), "cutviewer T-1 taper:3.175:15:flute=25.4");
  // Carbide Create's V-bit of 90 degrees.
  EXPECT_EQ(mm("TOOL/MILL,0.03, 0.00, 10.00, 45.00"), "cutviewer T-1 taper:0.03:45:flute=10");
  EXPECT_EQ(mm("TOOL/DRILL, 5, 135, 40"), "cutviewer T-1 drill:5:135");
  EXPECT_EQ(mm("TOOL/CHAMFER, 12, 60, 10"), "cutviewer T-1 vee:12:60");
  EXPECT_EQ(mm("TOOL/MILL,x,0,1,0"), "");
  EXPECT_EQ(mm("TOOL/MILL"), "");
}

TEST(ToolHints, Fabex) {
  EXPECT_EQ(mm("Tool: D = 3.0 mm  type END flutes 2"), "fabex T-1 flat:3");
  EXPECT_EQ(mm("Tool: D = 6.0 mm  type BALLNOSE flutes 2"), "fabex T-1 ball:6");
  EXPECT_EQ(mm("Tool: D = 3.0 mm  type VCARVE flutes 1"), "fabex T-1 vee:3:90 guessed");
  EXPECT_EQ(mm("Tool: D = 1.0 mm  type BALLCONE flutes 2"), "fabex T-1 ball:1 guessed");
}

TEST(ToolHints, ToolLists) {
  EXPECT_EQ(inch("T01 = 1/2\"  END MILL   03-0086"), "list T1 flat:12.7");
  EXPECT_EQ(inch("T1 .5 ENDMILL 03-0086"), "list T1 flat:12.7");
  EXPECT_EQ(inch("T04 = .201\" #7 DRILL   03-0290, 135 Point Angle"), "list T4 drill:5.1054:135");
  EXPECT_EQ(inch("T7 .3125 DRILL 03-0018"), "list T7 drill:7.9375:118");
  EXPECT_EQ(inch("T9 = .25 CHAMFER MILL 03-0612"), "list T9 vee:6.35:90 guessed");
  EXPECT_EQ(inch("T10 2\" FACE MILL 01-0001"), "list T10 flat:50.8");
  EXPECT_EQ(inch("T16 = 1/4\"  REAMER      03-0650"), "list T16 flat:6.35 guessed");
  EXPECT_EQ(mm("T212 |    3. FLAT ENDMILL | H0"), "list T212 flat:3");
  EXPECT_EQ(mm("T01 | 0.813mm 0.0320in | 0.0000in |       0"), "list T1 flat:0.813 guessed");
  EXPECT_EQ(mm("TOOL: T1 = 10.0 dia. ENDMILLM1000:REG"), "list T1 flat:10");
  EXPECT_EQ(mm("Tool 3: 6mm ball nose, 2 flutes"), "list T3 ball:6");
  EXPECT_EQ(mm("T5 - 1-1/4\" face mill"), "list T5 flat:31.75");
  EXPECT_EQ(mm("T6 = 10mm bull nose R2"), "list T6 bull:10:2");
  EXPECT_EQ(mm("T6 = 10mm bull nose"), "list T6 flat:10 guessed");
  EXPECT_EQ(mm("T7 = 1/4\" 60 deg v-bit"), "list T7 vee:6.35:60");
  EXPECT_EQ(mm("T8 = 6 mm 45 deg chamfer mill"), "list T8 vee:6:90");
}

TEST(ToolHints, ListsThatDescribeNoMillingCutter) {
  EXPECT_EQ(inch("T02 = 35* Finish Turning Tool, Tool Nose Radius: .0157, Tool Tip: 3"), "");
  EXPECT_EQ(inch("T03 = 60* Threading Tool, Insert: 02-0475, Tool Holder: 01-0118"), "");
  EXPECT_EQ(inch("T12 = Cutoff Tool, Insert: 02-0494"), "");
  EXPECT_EQ(mm("t1 is for facing and left turning, t9 parting"), "");
  EXPECT_EQ(mm("T1 M6"), "");
  EXPECT_EQ(mm("T1 is a 1/16th end mill"), "");
}

TEST(ToolHints, Turret) {
  EXPECT_EQ(mm("Turret No. :   0   Diameter :6.350     MM   BALLNOSE  "), "turret T0 ball:6.35");
}

TEST(ToolHints, SheetCam) {
  EXPECT_EQ(mm("o=0, ph=3.0, pd=0.1, ch=1.0, fr=3000, kw=1.5"), "sheetcam T-1 flat:1.5");
  EXPECT_EQ(inch("o=0, ph=0.1, fr=100, kw=0.040"), "sheetcam T-1 flat:1.016");
  EXPECT_EQ(mm("o=0, pd=0.5"), "");
  EXPECT_EQ(mm("Operation: Outside Offset, 17_, T4: Plasma, 1.5 mm kerf"), "sheetcam T4 flat:1.5");
  EXPECT_EQ(mm("Operation: Pocket, 1, T2: End Mill, 3.175 mm Diameter"), "sheetcam T2 flat:3.175");
}

TEST(ToolHints, PyCam) {
  const auto block = [](const char* shape) {
    return std::vector<CommentText>{{1, "[Tool]", false},
                                    {2, "torus_radius = 0.25", false},
                                    {3, std::string("shape = ") + shape, false},
                                    {4, "tool_radius = 1.5", false},
                                    {5, "", false},
                                    {6, "[Process]", false}};
  };
  EXPECT_EQ(hints_in(block("CylindricalCutter")), "pycam T-1 flat:3");
  EXPECT_EQ(hints_in(block("ToroidalCutter")), "pycam T-1 bull:3:0.25");
  EXPECT_EQ(hints_in(block("SphericalCutter")), "pycam T-1 ball:3");
  // A block that ends with the program counts, and keeps the line where it began.
  std::vector<CommentText> open = block("SphericalCutter");
  open.resize(4);
  const std::vector<ToolHint> hints = find_tool_hints(open);
  ASSERT_EQ(hints.size(), 1U);
  EXPECT_EQ(hints[0].line, 1U);
}

TEST(ToolHints, FreeCad) {
  EXPECT_EQ(hints_in({{1, "Begin operation: 3mm Endmill001", false},
                      {2, "Path: 3mm Endmill001", false},
                      {3, "TC: 3mm Ballend", false},
                      {4, "Begin toolchange", false},
                      {5, " M6 T2 ", false}}),
            "freecad T2 ball:3");
  EXPECT_EQ(hints_in({{1, "Begin toolchange", false}}), "");
  EXPECT_EQ(hints_in({{1, "MillFace", false}, {2, "begin toolchange", false}}), "");
}

TEST(ToolHints, LinesThatNameATool) {
  EXPECT_EQ(inch("TOOL: V-BIT {90 DEG 0.5\"}"), "tool-line T-1 vee:12.7:90");
  EXPECT_EQ(mm("Tool: 1/4 in Carbide End Mill"), "tool-line T-1 flat:6.35");
  EXPECT_EQ(mm("MSG, INSERT BALLNOSE  ,1/4\" ballnose"), "message T-1 ball:6.35");
  EXPECT_EQ(mm("MSG, optional stop"), "");
}

TEST(ToolHints, ALineThatBeginsWithTheToolsNumber) {
  EXPECT_EQ(mm("Tool: 5 HSS drill"), "");
  EXPECT_EQ(inch("Tool: 5 HSS drill"), "");
  EXPECT_EQ(inch("Tool: 23 YG-1 .375 CoHSS stub drill"), "tool-line T23 drill:9.525:118");
  EXPECT_EQ(inch("Tool: 24 YG-1 1/2-13 LH P-HSS spiral tap"), "tool-line T24 flat:12.7");
  EXPECT_EQ(inch("Tool: 21  M4 #3 (.250) Center drill"), "tool-line T21 drill:6.35:118");
  EXPECT_EQ(mm("Tool: 7 6mm end mill"), "tool-line T7 flat:6");
  EXPECT_EQ(mm("Tool: 7 1/4 end mill"), "tool-line T7 flat:6.35");
  EXPECT_EQ(mm("Tool: 3 V-bit 60 deg 12 mm"), "tool-line T3 vee:12:60");
  EXPECT_EQ(mm("Tool: 5 drill of box 12"), "") << "12 may be anything";
  EXPECT_EQ(mm("Tool: 1 1/4 end mill"), "") << "31.75 mm, or 6.35 of tool 1";
  // What a unit, a fraction or its name makes a size is no number of a tool.
  EXPECT_EQ(mm("Tool: 6 mm end mill"), "tool-line T-1 flat:6");
  EXPECT_EQ(mm("Tool: 2 flute 3 mm end mill"), "tool-line T-1 flat:3");
  EXPECT_EQ(mm("Tool: 6 dia end mill"), "tool-line T-1 flat:6");
  EXPECT_EQ(mm("Tool: 60 v-bit 1/2\""), "tool-line T-1 vee:12.7:60");
  EXPECT_EQ(hints_in({in_block("Tool: 5 HSS .25 drill", 5)}), "tool-line T5 drill:0.25:118");
  EXPECT_EQ(hints_in({in_block("Tool: 5 HSS .25 drill", 4)}), "");
}

TEST(ToolHints, Prose) {
  EXPECT_EQ(inch(" and Cutter is assumed to be a 10mm ball nose "), "prose T-1 ball:10");
  EXPECT_EQ(mm("Ball cutter D=10.00"), "prose T-1 ball:10");
  EXPECT_EQ(mm(" 10. END_MILL_SPHER DIA. 10. "), "prose T-1 ball:10");
  for (const char* text :
       {"drill three bolt holes on a 5\" diameter", "allow use of 0.125 cutter diameter",
        "Cutter does not descend more than 0.94\" below top", "use a 5mm diam",
        "same 1/2 end mill oversize roughing", "Diamond boundary", "Rough Drill 5 mm holes",
        "Block-name: 3mm Endmill001", "Begin operation: 3mm Endmill", "Feed 300mm/min end mill"}) {
    EXPECT_EQ(mm(text), "") << text;
  }
}

TEST(ToolHints, Mastercam) {
  // H17 and D17 are offsets.
  EXPECT_EQ(inch("T17|STANDARD DRILL - 0.16|H17|D17|TOOL DIA. - .16"), "list T17 drill:4.064:118");
  EXPECT_EQ(inch("T15|3'' FACE MILL / SHELL MILL|H15|D15|TOOL DIA. - 3.25"), "list T15 flat:82.55");
  EXPECT_EQ(inch("1/8 FLAT ENDMILL TOOL - 14 DIA. OFF. - 14 LEN. - 14 TOOL DIA. - .125"),
            "mastercam T14 flat:3.175");
}

TEST(ToolHints, Vectric) {
  EXPECT_EQ(inch("5 = End Mill {0.2500 inch} UpDown"), "vectric T5 flat:6.35");
  EXPECT_EQ(mm("T2 = End Mill {0.5 inches}"), "list T2 flat:12.7");
  EXPECT_EQ(mm("V-Bit {60 deg 12.7 mm}"), "vectric T-1 vee:12.7:60");
  EXPECT_EQ(mm("2 = V-Bit {60 deg}"), "vectric T2 vee:12.7:60 guessed");
  EXPECT_EQ(mm("T1 - V-Bit 60 degree"), "list T1 vee:12.7:60 guessed");
  EXPECT_EQ(mm("Profile {1}"), "");
}

TEST(ToolHints, FEngrave) {
  const auto settings = [](const char* cut, const char* shape, const char* units) {
    return hints_in({{1, std::string("fengrave_set units   ") + units},
                     {2, std::string("fengrave_set cut_type ") + cut},
                     {3, std::string("fengrave_set bit_shape ") + shape},
                     {4, "fengrave_set v_bit_angle 60"},
                     {5, "fengrave_set v_bit_dia 0.5"},
                     {6, "part"}});
  };
  EXPECT_EQ(settings("v-carve", "VBIT", "in"), "fengrave T-1 vee:12.7:60");
  EXPECT_EQ(settings("v-carve", "VBIT", "mm"), "fengrave T-1 vee:0.5:60");
  EXPECT_EQ(settings("v-carve", "BALL", "in"), "fengrave T-1 ball:12.7");
  EXPECT_EQ(settings("v-carve", "FLAT", "in"), "fengrave T-1 flat:12.7");
  EXPECT_EQ(settings("engrave", "VBIT", "in"), "") << "engraving says nothing of its bit";
  EXPECT_EQ(mm("30.0 deg. conical"), "prose T-1 vee:12.7:30 guessed");
  EXPECT_EQ(mm("60deg. 1/2\" V bit"), "prose T-1 vee:12.7:60");
}

TEST(ToolHints, KiriMoto) {
  EXPECT_EQ(mm("tool#=2 flute=3.175 len=20 unit=metric"), "kirimoto T2 flat:3.175 guessed");
  EXPECT_EQ(mm("tool#=5 flute=0.25 len=1 unit=imperial"), "kirimoto T5 flat:6.35 guessed");
  EXPECT_EQ(mm("tool#=-5 flute=0.25"), "");
}

TEST(ToolHints, LengthsAreNoDiameters) {
  EXPECT_EQ(inch("Tools: T05 1/8\" Endmill, Square, 3 Flute, 1\" LOC, 1\" Offset H#"),
            "list T5 flat:3.175");
  EXPECT_EQ(inch("Tools: T02 2\" Facemill, 4 Flute, 1.5\" LOC, 2\" Offset H#"),
            "list T2 flat:50.8");
  EXPECT_EQ(mm("T3 = 50 mm long 6 mm end mill, shank 8 mm"), "list T3 flat:6");
}

TEST(ToolHints, OfABlockBelongToItsTool) {
  EXPECT_EQ(hints_in({in_block("2\" Facemill", 2)}), "block T2 flat:50.8");
  EXPECT_EQ(hints_in({in_block("5 mm drill", 3)}), "block T3 drill:5:118");
  EXPECT_EQ(hints_in({in_block("3. FLAT ENDMILL", 3)}), "block T3 flat:3");
  EXPECT_EQ(hints_in({in_block("TOOL/MILL,6.0,0,25.0,0", 3)}), "cutviewer T3 flat:6");
  // What names another tool is about that one.
  EXPECT_EQ(hints_in({in_block("T5 = 3 mm end mill", 2)}), "list T5 flat:3");
  EXPECT_EQ(hints_in({in_block("then T5: 3 mm end mill", 2)}), "");
  EXPECT_EQ(hints_in({in_block("next: 3 mm end mill", 2)}), "");
  EXPECT_EQ(hints_in({in_block("Reset tool", 2)}), "");
}

TEST(ToolHints, ADiameterAloneOfABlock) {
  EXPECT_EQ(hints_in({in_block("D26", 1)}), "block T1 flat:26 guessed");
  EXPECT_EQ(hints_in({in_block("D6.5mm", 1)}), "block T1 flat:6.5 guessed");
  EXPECT_EQ(hints_in({in_block("\xc3\x98"
                               "8",
                               1)}),
            "block T1 flat:8 guessed");
  EXPECT_EQ(hints_in({in_block("D12", 12)}), "") << "the number of an offset";
  EXPECT_EQ(hints_in({in_block("D26 H1", 1)}), "");
  EXPECT_EQ(hints_in({in_block("DN26", 1)}), "");
  EXPECT_EQ(hints_in({in_block("D", 1)}), "");
  EXPECT_EQ(mm("D26"), "") << "of no tool";
}

TEST(ToolHints, NearAreThoseThatNameNoToolAndAreNotAtAChange) {
  const auto near = [](const char* text, bool at_change) {
    CommentText comment{1, text, false};
    comment.at_change = at_change;
    const std::vector<ToolHint> hints = find_tool_hints(std::vector<CommentText>{comment});
    EXPECT_EQ(hints.size(), 1U) << text;
    return !hints.empty() && hints[0].near;
  };
  EXPECT_FALSE(near("TOOL/MILL,6.0,0,25.0,0", true));
  EXPECT_TRUE(near("TOOL/MILL,6.0,0,25.0,0", false));
  EXPECT_FALSE(near("T1 = 6 mm end mill", false));
  EXPECT_TRUE(near("the cutter is a 10mm ball nose", true));
  EXPECT_FALSE(near("the cutter of T4 is a 10mm ball nose", false));
  EXPECT_EQ(mm("the cutter of T4, as that of T5, is a 10mm ball nose"), "");
}

TEST(ToolHints, RepeatedListEntriesCountOnce) {
  EXPECT_EQ(hints_in({{1, "T1 : 3", false}, {9, "T1 : 3", false}, {12, "T1 : 4", false}}),
            "cambam T1 flat:3 guessed; cambam T1 flat:4 guessed");
}

TEST(ToolHints, KeepTheLine) {
  const std::vector<ToolHint> hints = find_tool_hints(
      comments_of("%\n(part)\nG20\n(T3 D=.5 CR=0. - ZMIN=0 - flat end mill)\nT3 M6\n"));
  ASSERT_EQ(hints.size(), 1U);
  EXPECT_EQ(hints[0].line, 4U);
  EXPECT_EQ(hints[0].shape, "flat:12.7");
}

TEST(ToolHints, OverlongCommentsArePassedOver) {
  EXPECT_EQ(hints_in({{1, "T1 : 3 " + std::string(1 << 20, '(') + " ball", false}}), "");
  EXPECT_EQ(hints_in({{1, std::string(400, '9') + " mm ball cutter", false}}), "");
}

TEST(ToolHints, CutAtEveryByteNeverCrashes) {
  const char* const texts[] = {
      "T3 6mm D=6 CR=0.5 TAPER=45deg TD=.1 - ZMIN=-1 - chamfer mill",
      "T04 = 1-1/4\" #7 DRILL   03-0290, 135 Point Angle",
      "TOOL/MILL,0.7937,0.39687,1.000,0.0",
      "Turret No. :   0   Diameter :6.350     MM   BALLNOSE",
      "Operation: Outside Offset, 17_, T4: Plasma, 1.5 mm kerf",
      "MSG, Change tool bit to mill diameter 0.20000mm",
      "TOOL: V-BIT {90 DEG 0.5\"}",
      "Tool-Diameter: 2.5mm",
      "Tool: 24 YG-1 1/2-13 LH P-HSS spiral tap",
      "MSG, Change to Tool Dia = 0.8000 ||| Total drills for tool T1 = 10"};
  std::size_t hints = 0;
  for (const std::string text : texts) {
    for (std::size_t size = 0; size <= text.size(); ++size) {
      for (const ToolHint& hint : find_tool_hints(std::vector<CommentText>{
               {1, text.substr(0, size), false}, {2, text.substr(size), true}})) {
        EXPECT_TRUE(parse_shape(hint.shape)) << hint.shape;
        ++hints;
      }
    }
  }
  EXPECT_GT(hints, 100U);
}

// ---- remarks ----

std::string remark(double diameter_mm, const char* text) {
  const std::optional<ToolHint> hint = shape_from_remark(5, diameter_mm, text);
  if (!hint) return "";
  EXPECT_EQ(hint->tool, 5);
  EXPECT_TRUE(parse_shape(hint->shape)) << hint->shape;
  return hint->shape + (hint->shape_guessed ? " guessed" : "");
}

TEST(ToolRemark, NamesTheKindTableGivesTheDiameter) {
  EXPECT_EQ(remark(1.5875, "1/16 end mill"), "flat:1.5875");
  EXPECT_EQ(remark(6.35, "45/60 v-bit "), "vee:6.35:60");
  EXPECT_EQ(remark(6, "6 mm straight ball end "), "ball:6");
  EXPECT_EQ(remark(1, "1 mm tapered ball end "), "ball:1 guessed");
  EXPECT_EQ(remark(1, "1 mm tapered ball end 5 deg"), "taper:1:5:0.5");
  EXPECT_EQ(remark(5.1054, "#7 tap drill"), "drill:5.1054:118");
  EXPECT_EQ(remark(5, "5mm drill 118deg"), "drill:5:118");
  EXPECT_EQ(remark(9.525, "90 deg 3/8 mill-drill"), "drill:9.525:90");
  EXPECT_EQ(remark(16, "16 mm schaftfr\xc3\xa4ser"), "flat:16");
  EXPECT_EQ(remark(25, "25'er fr\xe4ser"), "flat:25");
  EXPECT_EQ(remark(101.6, "4\" Face Mill "), "flat:101.6");
  EXPECT_EQ(remark(10, "bull nose R1.5"), "bull:10:1.5");
  EXPECT_EQ(remark(6.35, "60 degree V bit"), "vee:6.35:60");
  EXPECT_EQ(remark(6.35, "1/4-20 pulley tap"), "flat:6.35");
}

TEST(ToolRemark, NoKindNoShape) {
  for (const char* text : {"", "generated", "tool 6", "3/4 roughing", "3/8 4fl carbide", "big",
                           "No Tool", "Wear Offset 9", "probe", "turning insert"}) {
    EXPECT_EQ(remark(6, text), "") << text;
  }
}

TEST(ToolRemark, TextGivesTheDiameterWhereTheTableHasNone) {
  EXPECT_EQ(remark(0, "6 mm ball end"), "ball:6");
  EXPECT_EQ(remark(0, "1/4 end mill"), "flat:6.35");
  EXPECT_EQ(remark(0, "end mill"), "");
  EXPECT_EQ(remark(-1, "ball"), "");
}

// ---- blanks ----

std::string blank_in(const std::vector<CommentText>& comments) {
  const std::optional<BlankHint> hint = find_blank_hint(comments);
  if (!hint) return "";
  EXPECT_TRUE(parse_blank(hint->spec)) << hint->spec;
  return hint->dialect + " " + hint->spec;
}

TEST(BlankHints, WorkpieceBodies) {
  EXPECT_EQ(blank_in({{1, "WORKPIECE,BOX,XMIN=0,YMIN=-5,ZMIN=-20,XMAX=100,YMAX=60,ZMAX=0", false}}),
            "workpiece box:0,-5,-20:100,60,0");
  EXPECT_EQ(
      blank_in({{1, " workpiece, box, zmax = 0, xmin=0,ymin=0,zmin=-1,xmax=4,ymax=2 ", true}}),
      "workpiece box:0,0,-25.4:101.6,50.8,0");
  EXPECT_EQ(blank_in({{1, "WORKPIECE,CYLINDER,AXIS=Z,X=1,Y=2,ZMIN=-30,ZMAX=0,DIAMETER=50", false}}),
            "workpiece cylinder:1,2,-30:0:50");
  EXPECT_EQ(blank_in({{1, "WORKPIECE,CYLINDER,AXIS=X,XMIN=0,XMAX=80,Y=2,Z=-3,DIAMETER=50", false}}),
            "workpiece cylinder:0,2,-3:80:50:x");
  EXPECT_EQ(
      blank_in({{1, "WORKPIECE,TUBE,X=0,Y=0,ZMIN=-9,ZMAX=0,DIAMETER=50,INNER_DIAMETER=30", false}}),
      "workpiece tube:0,0,-9:0:50:30");
}

TEST(BlankHints, WorkpiecesAddUpAndBeatCutViewer) {
  EXPECT_EQ(blank_in({{1, "STOCK/BLOCK,100,50,20,0,0,20", false},
                      {4, "WORKPIECE,BOX,XMIN=0,YMIN=0,ZMIN=-2,XMAX=1,YMAX=1,ZMAX=0", false},
                      {5, "WORKPIECE,CYLINDER,AXIS=Z,X=5,Y=5,ZMIN=-3,ZMAX=0,DIAMETER=2", false}}),
            "workpiece box:0,0,-2:1,1,0 + cylinder:5,5,-3:0:2");
}

TEST(BlankHints, CutViewerBlockFromItsOrigin) {
  EXPECT_EQ(blank_in({{1, "STOCK/BLOCK,100,50,20,50,25,20", false}}),
            "cutviewer box:-50,-25,-20:50,25,0");
  EXPECT_EQ(blank_in({{1, "stock/block, 4, 2, .5, 0, 0, .5", true}}),
            "cutviewer box:0,0,-12.7:101.6,50.8,0");
  EXPECT_EQ(blank_in({{1, "STOCK/BLOCK,100,50,0,50,25,20", false}}), "");
  EXPECT_EQ(blank_in({{1, "STOCK/BLOCK,100,50", false}}), "");
}

TEST(BlankHints, AnIncompleteWorkpieceIsNone) {
  EXPECT_EQ(blank_in({{1, "WORKPIECE,BOX,XMIN=0,YMIN=0,ZMIN=-2,XMAX=1,YMAX=1,ZMAX=0", false},
                      {2, "WORKPIECE,BOX,XMIN=0,YMIN=0,ZMIN=-2,XMAX=1,YMAX=1", false}}),
            "");
  EXPECT_EQ(blank_in({{1, "WORKPIECE,CONE,XMIN=0", false}}), "");
  EXPECT_EQ(blank_in({{1, "WORKPIECE,CYLINDER,AXIS=W,X=1,Y=2,ZMIN=0,ZMAX=1,DIAMETER=5", false}}),
            "");
  EXPECT_EQ(blank_in({{1, "WORKPIECE,BOX,XMIN=0,YMIN=0,ZMIN=5,XMAX=1,YMAX=1,ZMAX=0", false}}), "");
  EXPECT_EQ(blank_in({{1, "go again to the center of the workpiece", false}}), "");
}

TEST(BlankHints, LatheEasyStep) {
  const CommentText diameter{1, "Rohteil Aussendurchmesser: 50.000 mm", false};
  const CommentText range{2, "Rohteil Z-Bereich: 1.000 bis -80.000 mm", false};
  EXPECT_EQ(blank_in({diameter, range}), "easystep cylinder:0,0,-80:1:50");
  EXPECT_EQ(blank_in({range, diameter}), "easystep cylinder:0,0,-80:1:50");
  EXPECT_EQ(blank_in({diameter}), "");
  EXPECT_EQ(blank_in({range}), "");
  EXPECT_EQ(blank_in({diameter, {2, "Rohteil Z-Bereich: -80.000 bis 1.000 mm", false}}), "");
  EXPECT_EQ(blank_in({{1, "Rohteil Aussendurchmesser: 2.000 mm", true},
                      {2, "Rohteil Z-Bereich: 1.000 bis -8.000 mm", true}}),
            "")
      << "inches that are called mm";
  EXPECT_EQ(blank_in({diameter, range, {3, "STOCK/BLOCK,100,50,20,50,25,20", false}}),
            "cutviewer box:-50,-25,-20:50,25,0");
  EXPECT_EQ(blank_in({{1, "WARN: Startpunkt X50.000 Z1.000 liegt im Rohteil", false}}), "");
}

TEST(BlankHints, CutAtEveryByteNeverCrashes) {
  const char* const texts[] = {
      "WORKPIECE,BOX,XMIN=0,YMIN=-5,ZMIN=-20,XMAX=100,YMAX=60,ZMAX=10",
      "WORKPIECE,TUBE,AXIS=X,XMIN=0,XMAX=80,Y=2,Z=-3,DIAMETER=50,INNER_DIAMETER=30",
      "STOCK/BLOCK,100,50,20,50,25,20"};
  int found = 0;
  for (const std::string text : texts) {
    for (std::size_t size = 0; size <= text.size(); ++size) {
      const std::optional<BlankHint> hint =
          find_blank_hint(std::vector<CommentText>{{1, text.substr(0, size), false}});
      if (!hint) continue;
      EXPECT_TRUE(parse_blank(hint->spec)) << hint->spec;
      ++found;
    }
  }
  EXPECT_GT(found, 3);
}

}  // namespace
}  // namespace kerf
