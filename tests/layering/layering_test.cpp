// Holds the tree to the include directions of ARCHITECTURE.md.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "tests/layering/include_rules.h"

namespace kerf {
namespace {

namespace fs = std::filesystem;
using Strings = std::vector<std::string>;

const std::set<std::string> kSomeFiles{
    "base/result.h",         "stock/blank.h",          "stock/stock_model.h",
    "stock/cutter/cutter.h", "stock/zmap/zmap.h",      "stock/sheet/sheet.h",
    "viewer/picture.h",      "interp_bridge/motion.h", "twin/run.h",
    "twin/app/options.h",    "tests/stock/oracle.h",   "machine_io/simulator/fault.h"};

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
  EXPECT_EQ(
      check("twin/run.cpp", "#include \"viewer/picture.h\"\n#include \"stock/zmap/zmap.h\"\n"),
      Strings{});
  EXPECT_EQ(check("twin/app/main.cpp", "#include \"twin/app/options.h\"\n#include <CLI/CLI.hpp>\n"),
            Strings{});
  EXPECT_EQ(check("viewer/gl.cpp", "#include <epoxy/gl.h>\n#include <vector>\n"), Strings{});
}

TEST(Layering, UpwardsAndSidewaysAreNot) {
  EXPECT_EQ(check("base/mesh.cpp", "\n#include \"stock/stock_model.h\"\n"),
            Strings{"base/mesh.cpp:2: base/ may not include \"stock/stock_model.h\""});
  EXPECT_EQ(check("stock/zmap/zmap.h", "#include \"interp_bridge/motion.h\"\n"),
            Strings{"stock/zmap/zmap.h:1: stock/ may not include \"interp_bridge/motion.h\""});
  EXPECT_EQ(check("viewer/window.cpp", "#include \"twin/run.h\"\n"),
            Strings{"viewer/window.cpp:1: viewer/ may not include \"twin/run.h\""});
  EXPECT_EQ(check("twin/run.cpp", "#include \"twin/app/options.h\"\n"),
            Strings{"twin/run.cpp:1: \"twin/app/options.h\": only twin/app/ and twin/machine/ may "
                    "include it"});
}

TEST(Layering, OnlyTheSimulatedMachineWritesToDevices) {
  const std::string text = "#include \"machine_io/simulator/fault.h\"\n";
  EXPECT_EQ(check("twin/machine/main.cpp", text), Strings{});
  EXPECT_EQ(check("twin/machine/main.cpp", "#include \"twin/app/options.h\"\n"), Strings{});
  EXPECT_EQ(check("machine_io/simulator/main.cpp", text + "#include <modbus/modbus.h>\n"),
            Strings{});
  for (const char* path : {"twin/app/main.cpp", "twin/run.cpp", "machine_io/modbus/poll.cpp"}) {
    EXPECT_EQ(check(path, text),
              Strings{std::string(path) + ":1: \"machine_io/simulator/fault.h\": only "
                                          "twin/machine/ may include it"});
  }
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
  EXPECT_EQ(check("twin/run.cpp", "#include <GL/gl.h>\n"),
            Strings{"twin/run.cpp:1: <GL/gl.h> appears only in viewer/"});
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
  EXPECT_EQ(check("tests/stock/zmap_test.cpp", "#include \"twin/run.h\"\n").size(), 1u);
  EXPECT_EQ(check("tests/stock/zmap_test.cpp", "#include <GL/gl.h>\n").size(), 1u);
  EXPECT_EQ(check("tests/twin/app_test.cpp", "#include \"twin/app/options.h\"\n"), Strings{});
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

}  // namespace
}  // namespace kerf
