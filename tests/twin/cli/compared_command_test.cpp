// --compare of what is no mill's dry run: sheets, turned parts, positions that are replayed.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <numbers>

#include "tests/twin/cli/kerf_process.h"

namespace kerf {
namespace {

using Json = nlohmann::json;
using Texts = std::vector<std::string>;

/// Lines of an interpreter's listing.
class Listing {
 public:
  Listing() { add("USE_LENGTH_UNITS(CANON_UNITS_MM)"); }
  Listing& add(const std::string& call) {
    ++number_;
    text_ += fmt::format("{0:>5} N{0:<5} {1}\n", number_, call);
    return *this;
  }
  Listing& tool(int tool) {
    add(fmt::format("SELECT_TOOL({})", tool)).add(fmt::format("CHANGE_TOOL({})", tool));
    add("SET_SPINDLE_SPEED(0, 1000.0000)").add("START_SPINDLE_CLOCKWISE(0)");
    return add("SET_FEED_RATE(600.0000)");
  }
  Listing& to(bool feeds, double x, double y, double z) {
    return add(fmt::format("STRAIGHT_{}({:.4f}, {:.4f}, {:.4f}, 0.0000, 0.0000, 0.0000)",
                           feeds ? "FEED" : "TRAVERSE", x, y, z));
  }
  std::string end() { return add("STOP_SPINDLE_TURNING(0)").add("PROGRAM_END()").text_; }
  int line() const { return number_; }

 private:
  int number_ = 0;
  std::string text_;
};

class ComparedCommand : public testing::Test {
 protected:
  KerfResult call(Texts arguments, const Texts& more) const {
    arguments.insert(arguments.end(), more.begin(), more.end());
    arguments.emplace_back("--quiet");
    KerfCall call;
    call.arguments = std::move(arguments);
    call.folder = folder_.path();
    return run_kerf(call);
  }
  /// The section of the report; `code`: of the comparison's run.
  Json compare(Texts arguments, const std::string& design, int code) const {
    const KerfResult result = call(std::move(arguments), {"--compare", design, "--tolerance",
                                                          "0.05", "--json", "report.json"});
    EXPECT_EQ(result.exit_code, code) << result.err;
    return Json::parse(read_file(folder_.file("report.json")), nullptr, false)["compare"];
  }
  TestFolder folder_;
};

/// A slot of 1 mm along X at this Y through 3 mm.
std::string slot(double y) {
  Listing listing;
  listing.add("SELECT_PLANE(CANON_PLANE_XY)").to(false, -5, y, 1).add("SELECT_TOOL(1)");
  listing.add("CHANGE_TOOL(1)").add("SET_SPINDLE_SPEED(0, 1000.0000)");
  listing.add("START_SPINDLE_CLOCKWISE(0)").add("SET_FEED_RATE(600.0000)").to(true, 55, y, 1);
  return listing.end();
}

TEST_F(ComparedCommand, ASheetByItsOutline) {
  folder_.write("right.canon", slot(10));
  folder_.write("off.canon", slot(10.2));
  const auto run = [](const char* program) {
    return Texts{"run", program, "--stock", "sheet:0,0:50,20:3", "--kerf", "1"};
  };
  ASSERT_EQ(call(run("right.canon"), {"--stl", "design.stl"}).exit_code, 0);
  EXPECT_EQ(compare(run("right.canon"), "design.stl", 0)["verdict"], "in tolerance");
  const Json off = compare(run("off.canon"), "design.stl", 1);
  EXPECT_EQ(off["verdict"], "gouged");
  EXPECT_NEAR(off["gouge_max_mm"].get<double>(), 0.2, 0.002);
  EXPECT_NEAR(off["excess_max_mm"].get<double>(), 0.2, 0.002);
  // A strip on either side: 50 x 0.2 x 3.
  EXPECT_NEAR(off["gouge_mm3"].get<double>(), 30, 1);
  EXPECT_NEAR(off["excess_mm3"].get<double>(), 30, 1);
}

/// A bar of 40, turned to these radii down to Z-20, and where it is asked parted off there.
struct TurnedProgram {
  std::string text;
  int last_pass = 0;  ///< line of the pass at the last radius
};
TurnedProgram turned(const std::vector<double>& radii, bool parts_off) {
  TurnedProgram out;
  Listing listing;
  listing.add("SELECT_PLANE(CANON_PLANE_XZ)").tool(1);
  for (const double r : radii) {
    listing.to(false, r, 0, 2).to(true, r, 0, -20);
    out.last_pass = listing.line();
    listing.to(true, 30, 0, -20).to(false, 30, 0, 2);
  }
  if (parts_off) {
    listing.tool(2).to(false, 30, 0, -18).to(true, -0.1, 0, -18).to(false, 30, 0, -18);
  }
  out.text = listing.end();
  return out;
}

TEST_F(ComparedCommand, ATurnedPartByItsContour) {
  folder_.write("right.canon", turned({18, 17}, false).text);
  const TurnedProgram deep = turned({18, 16.9}, false);
  folder_.write("deep.canon", deep.text);
  const auto run = [](const char* program) {
    return Texts{"run",     program,
                 "--model", "turning",
                 "--stock", "cylinder:0,0,-60:0:40",
                 "--tool",  "1=turn:0.4:2:85:30"};
  };
  ASSERT_EQ(call(run("right.canon"), {"--stl", "design.stl"}).exit_code, 0);
  const Json same = compare(run("right.canon"), "design.stl", 0);
  EXPECT_EQ(same["verdict"], "in tolerance") << same;
  EXPECT_FALSE(same.contains("piece"));
  const Json gouged = compare(run("deep.canon"), "design.stl", 1);
  EXPECT_NEAR(gouged["gouge_max_mm"].get<double>(), 0.1, 0.006);
  EXPECT_EQ(gouged["gouge"]["line"], deep.last_pass);
  EXPECT_EQ(gouged["gouge"]["tool"], 1);
  // 20 mm of a ring from 16.9 to 17, but for the nose's corner.
  const double ring = std::numbers::pi * (17 * 17 - 16.9 * 16.9) * 20;
  EXPECT_NEAR(gouged["gouge_mm3"].get<double>(), ring, 0.05 * ring);
}

TEST_F(ComparedCommand, WhatIsPartedOffIsThePart) {
  folder_.write("right.canon", turned({18, 17}, true).text);
  const TurnedProgram deep = turned({18, 16.9}, true);
  folder_.write("deep.canon", deep.text);
  const auto run = [](const char* program) {
    return Texts{"run",     program,
                 "--model", "turning",
                 "--stock", "cylinder:0,0,-60:0:40",
                 "--tool",  "1=turn:0.4:2:85:30",
                 "--tool",  "2=part:3:0.2:orient=2"};
  };
  ASSERT_EQ(call(run("right.canon"), {"--stl", "part.stl"}).exit_code, 0);
  const Json same = compare(run("right.canon"), "part-part-1.stl", 0);
  EXPECT_EQ(same["verdict"], "in tolerance") << same;
  EXPECT_EQ(same["piece"], 1);
  // The bar that is left has nothing to do with the piece.
  EXPECT_FALSE(compare(run("right.canon"), "part.stl", 0).contains("piece"));
  const Json gouged = compare(run("deep.canon"), "part-part-1.stl", 1);
  EXPECT_EQ(gouged["piece"], 1);
  EXPECT_NEAR(gouged["gouge_max_mm"].get<double>(), 0.1, 0.006);
  EXPECT_EQ(gouged["gouge"]["line"], deep.last_pass);
}

TEST_F(ComparedCommand, ReplayedPositions) {
  const auto record = [](double z) {
    std::string text = "t,x,y,z,tool\n";
    for (int i = 0; i <= 500; ++i)
      text += fmt::format("{:.2f},{:.1f},10,{:.2f},1\n", 0.05 * i, -5 + 0.1 * i, z);
    return text;
  };
  folder_.write("right.csv", record(-1));
  folder_.write("deep.csv", record(-1.3));
  const auto replay = [](const char* log) {
    return Texts{"replay",  log,        "--stock",  "box:0,0,-5:40,20,0",
                 "--tool",  "1=flat:6", "--cell",   "0.1",
                 "--speed", "max",      "--no-view"};
  };
  ASSERT_EQ(call(replay("right.csv"), {"--stl", "design.stl"}).exit_code, 0);
  EXPECT_EQ(compare(replay("right.csv"), "design.stl", 0)["verdict"], "in tolerance");
  const Json deep = compare(replay("deep.csv"), "design.stl", 1);
  EXPECT_NEAR(deep["gouge_max_mm"].get<double>(), 0.3, 0.001);
  EXPECT_NEAR(deep["gouge_mm3"].get<double>(), 40 * 6 * 0.3, 1);
  // Moves are not kept there: walls are known to half a cell.
  EXPECT_NEAR(deep["walls_mm"].get<double>(), 0.05, 1e-9);
}

}  // namespace
}  // namespace kerf
