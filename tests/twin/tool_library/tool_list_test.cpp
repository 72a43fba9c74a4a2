// kerf's own libraries, YAML.
#include <gtest/gtest.h>

#include <fstream>

#include "tests/base/temporary_folder.h"
#include "tests/twin/tool_library/library_support.h"

namespace kerf {
namespace {

TEST(ToolList, ToolsWithNumberShapeAndName) {
  const ReadLibrary read(
      "tools:\n"
      "  - {number: 3, shape: \"flat:6:flute=20:holder=er20:stickout=40:teeth=3\", name: 6 mm}\n"
      "  - number: 4\n"
      "    shape: ball:6\n");
  EXPECT_EQ(text_of(read), "3: flat:6:flute=20:holder=er20:stickout=40:teeth=3\n4: ball:6\n");
  EXPECT_EQ(read.library->tools[0].name, "6 mm");
  EXPECT_EQ(text_of(ReadLibrary("units: inch\ntools: [{number: 1, shape: \"flat:0.25\"}]\n")),
            "1: flat:6.35\n");
  EXPECT_EQ(text_of(ReadLibrary(R"({"tools": [{"number": 1, "shape": "flat:6"}]})")), "1: flat:6\n")
      << "JSON is YAML";
}

TEST(ToolList, AllFaultsAtTheirPlaces) {
  const ReadLibrary read(
      "units: cm\n"
      "tools:\n"
      "  - {number: 0, shape: \"flat:6\"}\n"
      "  - {number: 3, shap: \"flat:6\"}\n"
      "  - {number: 4, shape: \"flet:6\"}\n"
      "  - {number: 4.5, shape: \"flat:-6\"}\n"
      "  - {number: 6, shape: \"flat:6\"}\n"
      "  - {number: 6, shape: \"flat:6\", name: [a]}\n"
      "  - {shape: \"flat:.nan\"}\n"
      "  - 7\n");
  EXPECT_FALSE(read.library);
  EXPECT_EQ(
      read.said(),
      "1:8: units: 'cm' is not allowed; must be one of mm, inch\n"
      "3:14: tools[1].number: '0' is not allowed; must be a whole number from 1 to 99999\n"
      "4:17: tools[2].shap: unknown key\n"
      "4:5: tools[2]: shape is missing; `kerf tools` lists the shapes\n"
      "5:24: tools[3].shape: flet:6: unknown shape 'flet'; did you mean 'flat'? Shapes: flat, "
      "ball, bull, vee, taper, drill, lollipop, tslot, dovetail, kerf, profile; to turn with: "
      "turn, iso, groove, part, facegroove, thread, bore\n"
      "6:14: tools[4].number: '4.5' is not allowed; must be a whole number from 1 to 99999\n"
      "6:26: tools[4].shape: flat:-6: diameter D: -6 is not allowed; must be from 0.001 to 1000 "
      "(mm)\n"
      "8:40: tools[6].name: a list is not allowed; must be a value\n"
      "8:14: tools[6].number: tool 6 is given twice\n"
      "9:5: tools[7]: number is missing; must be 1 to 99999\n"
      "9:13: tools[7].shape: flat:.nan: diameter D: '.nan' is not a number\n"
      "10:5: tools[8]: must be a group of keys: number, shape, name\n");
}

TEST(ToolList, FilesOfShapesAreBesideTheList) {
  const TemporaryFolder folder;
  std::ofstream(folder / "nut.txt") << "line 14 0\nline 14 20\n";
  std::ofstream(folder / "form.txt") << "line 3 0\nline 3 9\n";
  const ReadLibrary read(
      "tools:\n"
      "  - {number: 1, shape: \"flat:6:flute=9:holder=profile:nut.txt:stickout=30\"}\n"
      "  - {number: 2, shape: \"profile:form.txt\"}\n",
      folder / "shop.yaml");
  EXPECT_EQ(text_of(read), "1: flat:6:flute=9:holder=profile:" + (folder / "nut.txt") +
                               ":stickout=30\n2: profile:" + (folder / "form.txt") + "\n");
}

TEST(ToolList, WithoutTools) {
  EXPECT_EQ(text_of(ReadLibrary("tools:\n")),
            "1:1: tools: must be a list of tools, each with number and shape\n");
  EXPECT_EQ(text_of(ReadLibrary("tool: 1\n# no tools\n")),
            "1:1: tool: unknown key\ntools is missing; must be a list of tools\n");
}

}  // namespace
}  // namespace kerf
