// Holds the tree to the include directions of ARCHITECTURE.md.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <regex>
#include <sstream>

#include "tests/layering/include_rules.h"

namespace kerf {
namespace {

namespace fs = std::filesystem;
using Strings = std::vector<std::string>;

const std::set<std::string> kSomeFiles{"base/result.h",
                                       "stock/blank.h",
                                       "stock/stock_model.h",
                                       "stock/cutter/cutter.h",
                                       "stock/zmap/zmap.h",
                                       "stock/sheet/sheet.h",
                                       "viewer/picture.h",
                                       "interp_bridge/motion.h",
                                       "twin/report/run.h",
                                       "twin/cli/options.h",
                                       "tests/stock/oracle.h",
                                       "machine_io/simulator/fault.h",
                                       "surface/relief.h",
                                       "viewer/camera.h",
                                       "viewer/window/layer.h",
                                       "viewer/csg/renderer.h",
                                       "viewer/raycast/tile.h",
                                       "twin/process/process.h",
                                       "twin/process/cut_stage.h",
                                       "twin/process/process_table.h",
                                       "twin/process/torch/plan.h"};

Strings check(std::string_view path, std::string_view text) {
  return check_includes(path, text, kSomeFiles);
}

TEST(Layering, FindsEveryFormOfInclude) {
  const auto found = find_includes("#include <a/b.h>\n// #include <no.h>\n  # include \"c.h\"\n");
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(found[0].target, "a/b.h");
  EXPECT_FALSE(found[0].quoted);
  EXPECT_EQ(found[1].target, "c.h");
  EXPECT_EQ(found[1].line, 3);
  EXPECT_TRUE(found[1].quoted);
}

TEST(Layering, DownwardsIsAllowed) {
  EXPECT_EQ(check("stock/zmap/zmap.cpp",
                  "#include \"base/result.h\"\n"
                  "#include \"stock/stock_model.h\"\n"
                  "#include \"stock/cutter/cutter.h\"\n"),
            Strings{});
  EXPECT_EQ(check("twin/scene/run.cpp",
                  "#include \"viewer/picture.h\"\n#include \"stock/zmap/zmap.h\"\n"),
            Strings{});
  EXPECT_EQ(check("twin/cli/main.cpp", "#include \"twin/cli/options.h\"\n#include <CLI/CLI.hpp>\n"),
            Strings{});
  EXPECT_EQ(check("viewer/gl.cpp", "#include <epoxy/gl.h>\n#include <vector>\n"), Strings{});
}

TEST(Layering, UpwardsAndSidewaysAreNot) {
  EXPECT_EQ(check("base/mesh.cpp", "\n#include \"stock/stock_model.h\"\n"),
            Strings{"base/mesh.cpp:2: base/ may not include \"stock/stock_model.h\""});
  EXPECT_EQ(check("stock/zmap/zmap.h", "#include \"interp_bridge/motion.h\"\n"),
            Strings{"stock/zmap/zmap.h:1: stock/ may not include \"interp_bridge/motion.h\""});
  EXPECT_EQ(check("viewer/window.cpp", "#include \"twin/report/run.h\"\n"),
            Strings{"viewer/window.cpp:1: viewer/ may not include \"twin/report/run.h\""});
  EXPECT_EQ(
      check("twin/process/run.cpp", "#include \"twin/cli/options.h\"\n"),
      Strings{"twin/process/run.cpp:1: twin/process/ may not include \"twin/cli/options.h\""});
}

TEST(Layering, OnlyTheSimulatedMachineWritesToDevices) {
  const std::string text = "#include \"machine_io/simulator/fault.h\"\n";
  EXPECT_EQ(check("twin/cli/kerf_machine/main.cpp", text), Strings{});
  EXPECT_EQ(check("twin/cli/kerf_machine/main.cpp", "#include \"twin/cli/options.h\"\n"),
            Strings{});
  EXPECT_EQ(check("machine_io/simulator/main.cpp", text + "#include <modbus/modbus.h>\n"),
            Strings{});
  for (const char* path :
       {"twin/cli/main.cpp", "twin/live/run.cpp", "machine_io/modbus/poll.cpp"}) {
    EXPECT_EQ(check(path, text),
              Strings{std::string(path) + ":1: \"machine_io/simulator/fault.h\": only "
                                          "twin/cli/kerf_machine/ may include it"});
  }
}

TEST(Layering, TheRoomsOfTwinHaveAnOrder) {
  EXPECT_EQ(find_circles(), Strings{});
  const std::string text = "#include \"twin/report/run.h\"\n";
  EXPECT_EQ(check("twin/session/a.cpp", text), Strings{});
  EXPECT_EQ(check("twin/machine/kinematics/a.cpp", text),
            Strings{"twin/machine/kinematics/a.cpp:1: twin/machine/kinematics/ may not include "
                    "\"twin/report/run.h\""});
  EXPECT_EQ(
      check("twin/a.cpp", text),
      Strings{"twin/a.cpp:1: lies in a folder that the layers of ARCHITECTURE.md do not name"});
  EXPECT_EQ(check("tests/twin/process/a_test.cpp", text), Strings{});
}

TEST(Layering, AProcessIsKnownToItsTableAlone) {
  const std::string torch = "#include \"twin/process/torch/plan.h\"\n";
  const std::string shared = "#include \"twin/process/process.h\"\n";
  EXPECT_EQ(check("twin/process/process_table.cpp", torch + shared), Strings{});
  EXPECT_EQ(check("twin/process/torch/plan.cpp", torch + shared), Strings{});
  EXPECT_EQ(check("twin/process/turning/plan.cpp", shared), Strings{}) << "one that is new";
  for (const char* path :
       {"twin/process/cut_stage.cpp", "twin/process/punch/plan.cpp", "twin/process/milling/a.cpp",
        "twin/report/a.cpp", "twin/session/a.cpp", "twin/playback/a.cpp", "twin/live/a.cpp",
        "twin/scene/a.cpp", "twin/cli/a.cpp"}) {
    EXPECT_EQ(check(path, torch),
              Strings{std::string(path) + ":1: \"twin/process/torch/plan.h\": only "
                                          "twin/process/torch/ and "
                                          "twin/process/process_table.cpp may include it"});
  }
  for (const std::string name : {"cut_stage.h", "process_table.h"}) {
    EXPECT_EQ(check("twin/process/torch/plan.cpp", "#include \"twin/process/" + name + "\"\n"),
              Strings{"twin/process/torch/plan.cpp:1: a process may not include "
                      "\"twin/process/" +
                      name + "\""});
  }
  EXPECT_EQ(check("tests/twin/live/a_test.cpp", torch), Strings{});
}

TEST(Layering, StockModelsDoNotKnowEachOther) {
  EXPECT_EQ(check("stock/zmap/zmap.cpp", "#include \"stock/sheet/sheet.h\"\n"),
            Strings{"stock/zmap/zmap.cpp:1: the model stock/zmap/ may not include the model "
                    "header \"stock/sheet/sheet.h\""});
  EXPECT_EQ(check("stock/cutter/hint.cpp", "#include \"stock/blank.h\"\n"), Strings{});
  EXPECT_EQ(check("stock/cutter/cutter.cpp", "#include \"stock/zmap/zmap.h\"\n"),
            Strings{"stock/cutter/cutter.cpp:1: stock/cutter/ may not include "
                    "\"stock/zmap/zmap.h\""});
}

TEST(Layering, TheSurfaceLiesBelowThoseWhoMakeAndShowIt) {
  const std::string text = "#include \"surface/relief.h\"\n";
  EXPECT_EQ(check("surface/relief.cpp", text + "#include \"base/result.h\"\n"), Strings{});
  for (const char* path :
       {"stock/zmap/zmap.cpp", "viewer/raycast/tile.cpp", "twin/scene/run.cpp"}) {
    EXPECT_EQ(check(path, text), Strings{}) << path;
  }
  for (const char* path : {"base/a.cpp", "stock/cutter/a.cpp", "interp_bridge/a.cpp"}) {
    EXPECT_EQ(check(path, text).size(), 1u) << path;
  }
  EXPECT_EQ(check("surface/relief.cpp", "#include \"stock/stock_model.h\"\n").size(), 1u);
}

TEST(Layering, FoldersOfTheViewerDoNotIncludeEachOther) {
  const auto includes = [](std::string_view target) {
    return "#include \"" + std::string(target) + "\"\n";
  };
  const std::string window = includes("viewer/window/layer.h");
  const std::string csg = includes("viewer/csg/renderer.h");
  const std::string raycast = includes("viewer/raycast/tile.h");
  const std::string camera = includes("viewer/camera.h");
  EXPECT_EQ(check("viewer/window/layer.cpp", window + csg + raycast + camera), Strings{});
  EXPECT_EQ(check("viewer/csg/renderer.cpp", csg + camera), Strings{});
  EXPECT_EQ(check("viewer/raycast/tile.cpp", raycast + camera), Strings{});
  EXPECT_EQ(check("viewer/csg/renderer.cpp", window),
            Strings{"viewer/csg/renderer.cpp:1: viewer/csg/ may not include "
                    "\"viewer/window/layer.h\""});
  EXPECT_EQ(check("viewer/csg/renderer.cpp", raycast).size(), 1u);
  EXPECT_EQ(check("viewer/raycast/tile.cpp", csg + window).size(), 2u);
  EXPECT_EQ(check("viewer/camera.cpp", csg + raycast + window).size(), 3u);
}

TEST(Layering, PathsStartAtTheRootAndFoldersAreKnown) {
  EXPECT_EQ(check("stock/zmap/zmap.cpp", "#include \"zmap.h\"\n"),
            Strings{"stock/zmap/zmap.cpp:1: \"zmap.h\" is no file of the project (paths start at "
                    "the root)"});
  EXPECT_EQ(check("helpers/a.cpp", "#include \"base/result.h\"\n"),
            Strings{"helpers/a.cpp:1: lies in a folder that the layers of ARCHITECTURE.md do not "
                    "name"});
}

TEST(Layering, OutsideLibrariesStayBehindTheirFolder) {
  EXPECT_EQ(check("interp_bridge/kerf_interp/main.cpp", "#include <interp_base.hh>\n"), Strings{});
  EXPECT_EQ(check("interp_bridge/program.cpp", "#include <canon.hh>\n"),
            Strings{"interp_bridge/program.cpp:1: <canon.hh> appears only in "
                    "interp_bridge/kerf_interp/"});
  EXPECT_EQ(check("twin/process/run.cpp", "#include <GL/gl.h>\n"),
            Strings{"twin/process/run.cpp:1: <GL/gl.h> appears only in viewer/"});
  EXPECT_EQ(check("machine_io/can/can.cpp", "#include <modbus/modbus.h>\n"),
            Strings{"machine_io/can/can.cpp:1: <modbus/modbus.h> appears only in "
                    "machine_io/modbus/ and machine_io/simulator/"});
  for (const char* header : {"yaml-cpp/yaml.h", "linux/can.h", "linux/can/raw.h", "GLFW/glfw3.h",
                             "EGL/egl.h", "epoxy/egl.h", "imgui/imgui.h", "imgui.h"}) {
    const std::string text = std::string("#include <") + header + ">\n";
    EXPECT_EQ(check("stock/zmap/zmap.cpp", text).size(), 1u) << header;
  }
}

TEST(Layering, TestsHaveTheRightsOfWhatTheyTest) {
  EXPECT_EQ(check("tests/stock/zmap_test.cpp",
                  "#include \"tests/stock/oracle.h\"\n"
                  "#include \"stock/zmap/zmap.h\"\n"),
            Strings{});
  EXPECT_EQ(check("tests/stock/zmap_test.cpp", "#include \"twin/report/run.h\"\n").size(), 1u);
  EXPECT_EQ(check("tests/stock/zmap_test.cpp", "#include <GL/gl.h>\n").size(), 1u);
  EXPECT_EQ(check("tests/twin/cli/app_test.cpp", "#include \"twin/cli/options.h\"\n"), Strings{});
  EXPECT_EQ(check("tests/fuzz/fuzz_any.cpp", "#include \"interp_bridge/motion.h\"\n"), Strings{});
  EXPECT_EQ(check("tests/fuzz/fuzz_any.cpp", "#include <xxhash.h>\n"), Strings{});
  EXPECT_EQ(check("stock/zmap/zmap.cpp", "#include \"tests/stock/oracle.h\"\n"),
            Strings{"stock/zmap/zmap.cpp:1: \"tests/stock/oracle.h\" belongs to the tests"});
}

/// Every C++ source and header of the project, by path from the root.
std::set<std::string> project_sources() {
  const fs::path root(KERF_SOURCE_DIR);
  std::set<std::string> found;
  for (const fs::directory_entry& folder : fs::directory_iterator(root)) {
    const std::string name = folder.path().filename().string();
    if (!folder.is_directory() || name.starts_with(".") || name == "build") continue;
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder)) {
      const fs::path extension = entry.path().extension();
      if (extension != ".h" && extension != ".cpp") continue;
      found.insert(fs::relative(entry.path(), root).generic_string());
    }
  }
  return found;
}

TEST(Layering, TheTreeKeepsTheRules) {
  const std::set<std::string> sources = project_sources();
  ASSERT_TRUE(sources.contains("stock/stock_model.h"));
  Strings violations;
  for (const std::string& path : sources) {
    std::ifstream in(fs::path(KERF_SOURCE_DIR) / path);
    std::ostringstream text;
    text << in.rdbuf();
    for (std::string& violation : check_includes(path, text.str(), sources)) {
      violations.push_back(std::move(violation));
    }
  }
  EXPECT_EQ(violations, Strings{});
}

/// What decides the contents of a workpiece calls no function of the C library whose last bit goes
/// by the processor: base/portable_math.h has them.
TEST(Layering, WhatCutsHasTheSameBitsOnEveryProcessor) {
  const std::regex by_processor(R"(\bstd::(sin|cos|tan|atan2?|asin|acos|hypot|log10)\()");
  const Strings cutting{"base/placement.cpp",
                        "stock/",
                        "mesh/",
                        "surface/",
                        "interp_bridge/",
                        "twin/motion/",
                        "twin/machine/",
                        "twin/machines/",
                        "twin/job/",
                        "twin/process/turning/",
                        "twin/collision/",
                        "twin/process/torch/",
                        "twin/process/punch/"};
  Strings violations;
  for (const std::string& path : project_sources()) {
    const auto holds = [&](const std::string& folder) { return path.starts_with(folder); };
    if (std::none_of(cutting.begin(), cutting.end(), holds)) continue;
    std::ifstream in(fs::path(KERF_SOURCE_DIR) / path);
    std::ostringstream text;
    text << in.rdbuf();
    if (std::regex_search(text.str(), by_processor)) violations.push_back(path);
  }
  EXPECT_EQ(violations, Strings{});
}

}  // namespace
}  // namespace kerf
