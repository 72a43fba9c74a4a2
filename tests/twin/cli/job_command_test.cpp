// kerf job: parts in several setups against their closed forms, and what is said of bad files.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "base/geometry.h"
#include "tests/twin/cli/kerf_process.h"

namespace kerf {
namespace {

using Json = nlohmann::json;

constexpr const char* kHead = "G21 G90 G17 G54 G94\n";

/// A plunge of that tool at X Y down to Z.
std::string plunge(int tool, double x, double y, double z) {
  return fmt::format("{}T{} M6\nS3000 M3\nG0 X{} Y{} Z5\nG1 Z{} F200\nG0 Z20\nM30\n", kHead, tool,
                     x, y, z);
}

class Job : public testing::Test {
 protected:
  KerfResult job(const std::string& yaml, std::vector<std::string> more = {}) {
    folder_.write("job.yaml", yaml);
    KerfCall call;
    call.arguments = {"job", "job.yaml", "--json", "job.json"};
    call.arguments.insert(call.arguments.end(), more.begin(), more.end());
    call.folder = folder_.path();
    return run_kerf(call);
  }
  Json report() { return Json::parse(read_file(folder_.file("job.json")), nullptr, false); }
  double left_mm3(std::size_t setup) {
    return report()["setups"][setup]["stock"]["remaining_mm3"].get<double>();
  }
  TestFolder folder_;
};

TEST_F(Job, two_sides_are_flat_columns_and_exact) {
  folder_.write("top.ngc", plunge(1, 10, 10, -5));
  folder_.write("bottom.ngc", plunge(1, 10, 20, -8));
  const KerfResult result =
      job("setups:\n"
          "  - {program: top.ngc, stock: 'box:0,0,-20:40,30,0', tools: 1=flat:8, time_s: 60, name: "
          "top}\n"
          "  - {program: bottom.ngc, tools: 1=flat:8, flip: x, zero: top, time_s: 30}\n");
  EXPECT_EQ(result.exit_code, 0) << result.err;
  const double hole = kPi * 16;
  EXPECT_NEAR(left_mm3(0), 24000 - hole * 5, 24000 * 1e-4);
  // The same place from the other side: Y20 is Y10 of the first.
  EXPECT_NEAR(left_mm3(1), 24000 - hole * 13, 24000 * 1e-4);
  const Json all = report();
  EXPECT_EQ(all["schema"], "kerf-job/1");
  EXPECT_EQ(all["setups"][1]["setup"]["carried"]["from"], "zmap");
  EXPECT_EQ(all["setups"][1]["setup"]["carried"]["to"], "mmap");
  EXPECT_LT(all["setups"][1]["setup"]["carried"]["bound_mm"], 1e-5);
  EXPECT_EQ(all["setup_s"], 90);
  EXPECT_NEAR(all["time_s"].get<double>(), all["machining_s"].get<double>() + 90, 1e-5);
  ASSERT_EQ(all["tools"].size(), 1U);
  EXPECT_EQ(all["tools"][0]["setups"], Json({1, 2}));
  EXPECT_NEAR(all["tools"][0]["removed_mm3"].get<double>(), hole * 13, 2);
  EXPECT_NE(result.out.find("setup 2 of 2\n"), std::string::npos) << result.out;
  EXPECT_NE(result.out.find("what setup 1 (top) has left, flipped about X, Z0 on top"),
            std::string::npos)
      << result.out;
}

TEST_F(Job, on_its_side_it_is_an_octree_from_the_beginning) {
  folder_.write("top.ngc", plunge(1, 20, 15, -5));
  folder_.write("side.ngc", plunge(1, 10, 10, -12));
  const KerfResult result =
      job("setups:\n"
          "  - {program: top.ngc, stock: 'box:0,0,-20:40,30,0', tools: 1=flat:8}\n"
          "  - {program: side.ngc, tools: 1=flat:6, rotate: [90, 0, 0], zero: corner}\n");
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(report()["setups"][0]["stock"]["model"], "octree");
  EXPECT_EQ(report()["setups"][0]["stock"]["model_reason"], "setup 2 lays it otherwise than flat");
  EXPECT_NEAR(left_mm3(1), 24000 - kPi * 16 * 5 - kPi * 9 * 12, 24000 * 1e-4);
}

TEST_F(Job, heights_that_were_asked_for_become_an_octree_within_what_is_told) {
  folder_.write("top.ngc", plunge(1, 20, 15, -5));
  folder_.write("side.ngc", plunge(1, 10, 10, -12));
  const KerfResult result =
      job("setups:\n"
          "  - {program: top.ngc, stock: 'box:0,0,-20:40,30,0', tools: 1=flat:8, model: zmap,\n"
          "     cell_mm: 0.1}\n"
          "  - {program: side.ngc, tools: 1=flat:6, rotate: [90, 0, 0], zero: corner}\n");
  EXPECT_EQ(result.exit_code, 0) << result.err;
  const Json carried = report()["setups"][1]["setup"]["carried"];
  EXPECT_EQ(carried["from"], "zmap");
  EXPECT_EQ(carried["to"], "octree");
  const double cell_mm = report()["setups"][1]["stock"]["cell_mm"].get<double>();
  EXPECT_NEAR(carried["bound_mm"].get<double>(), std::sqrt(3.0) * cell_mm, 1e-6);
  EXPECT_NEAR(left_mm3(1), 24000 - kPi * 16 * 5 - kPi * 9 * 12, 24000 * 1e-4);
}

TEST_F(Job, a_turned_part_is_milled_upright_and_lying) {
  folder_.write("turn.ngc", std::string("G21 G90 G18 G54 G95 G8\nT1 M6\nS500 M3\nG0 X15 Z5\n") +
                                "G1 Z-30 F0.2\nG1 X30\nG0 Z5\nM30\n");
  folder_.write("mill.ngc", plunge(2, 0, 0, -10));
  folder_.write("side.ngc", plunge(2, 20, 0, -4));
  const KerfResult result =
      job("setups:\n"
          "  - {program: turn.ngc, stock: 'cylinder:0,0,-40:0:50', tools: '1=turn:0.4:2:85:30',\n"
          "     model: turning}\n"
          "  - {program: mill.ngc, tools: 2=flat:10, cell_mm: 0.2}\n"
          "  - {program: side.ngc, tools: 2=flat:6, rotate: [0, 90, 0], zero: middle}\n");
  EXPECT_LE(result.exit_code, 1) << result.err;
  const double turned = left_mm3(0);
  EXPECT_NEAR(turned, kPi * (15 * 15 * 30 + 25 * 25 * 10), 30) << "less the nose's round";
  EXPECT_EQ(report()["setups"][1]["setup"]["carried"]["from"], "turning");
  EXPECT_EQ(report()["setups"][1]["setup"]["carried"]["to"], "octree");
  EXPECT_NEAR(left_mm3(1), turned - kPi * 25 * 10, turned * 1e-4);
  // Z lies along X now, and the middle of its top is that of its widest part: 4 mm below its top,
  // 20 mm from its middle, is air beside the narrow part or the wide one: it is cut or it is not.
  EXPECT_LE(left_mm3(2), left_mm3(1) + 1);
}

TEST_F(Job, three_touched_points_say_how_it_lies) {
  folder_.write("top.ngc", plunge(1, 10, 10, -5));
  folder_.write("again.ngc", plunge(1, 10, 10, -8));
  // Turned by atan(3/4) about Z and shifted: (x, y) -> (0.8 x - 0.6 y + 5, 0.6 x + 0.8 y - 2).
  const KerfResult result =
      job("setups:\n"
          "  - {program: top.ngc, stock: 'box:0,0,-20:40,30,0', tools: 1=flat:8, cell_mm: 0.2}\n"
          "  - program: again.ngc\n"
          "    tools: 1=flat:8\n"
          "    points:\n"
          "      - {was: [0, 0, 0], is: [5, -2, 0]}\n"
          "      - {was: [40, 0, 0], is: [37, 22, 0]}\n"
          "      - {was: [0, 30, 0], is: [-13, 22, 0]}\n");
  EXPECT_EQ(result.exit_code, 0) << result.err;
  // X10 Y10 of the second is x = 0.8*5 + 0.6*12 = 11.2, y = -0.6*5 + 0.8*12 = 6.6 of the first:
  // two holes of r4, 3.6055 mm apart.
  const double d = std::hypot(1.2, 3.4);
  const double both = 2 * 16 * std::acos(d / 8) - d / 2 * std::sqrt(64 - d * d);
  const double left = 24000 - kPi * 16 * (5 + 8) + both * 5;
  EXPECT_NEAR(left_mm3(1), left, 24000 * 2e-4);
}

TEST_F(Job, what_comes_after_a_failure_is_not_run) {
  folder_.write("good.ngc", plunge(1, 10, 10, -5));
  folder_.write("bad.ngc", "G21 G90\nG1 X10 F100 Q Q\nM30\n");
  const KerfResult result =
      job("setups:\n"
          "  - {program: bad.ngc, stock: 'box:0,0,-20:40,30,0', tools: 1=flat:8}\n"
          "  - {program: good.ngc, tools: 1=flat:8, name: never}\n");
  EXPECT_EQ(result.exit_code, 4);
  EXPECT_NE(result.err.find("setup 1 did not come to its end; not run: never"), std::string::npos)
      << result.err;
  EXPECT_EQ(report()["not_run"], Json({"never"}));
  EXPECT_EQ(report()["partial"], true);
}

TEST_F(Job, findings_of_a_setup_do_not_stop_the_next) {
  folder_.write("crash.ngc",
                std::string(kHead) + "T1 M6\nS3000 M3\nG0 X-10 Y15 Z5\nZ-2\nX50\nZ20\nM30\n");
  folder_.write("good.ngc", plunge(1, 10, 5, -5));
  const KerfResult result =
      job("setups:\n"
          "  - {program: crash.ngc, stock: 'box:0,0,-20:40,30,0', tools: 1=flat:8}\n"
          "  - {program: good.ngc, tools: 1=flat:8}\n",
          {"--quiet"});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_EQ(report()["setups"].size(), 2U);
  EXPECT_EQ(report()["findings"][0]["id"], "rapid-contact");
  EXPECT_EQ(report()["findings"][0]["setup"], 1);
}

TEST_F(Job, a_gouge_of_the_first_setup_is_known_in_the_last) {
  folder_.write("design_top.ngc", plunge(1, 10, 10, -5));
  folder_.write("top.ngc", plunge(1, 10, 10, -5.5));
  folder_.write("bottom.ngc", plunge(1, 30, 20, -8));
  const std::string setups =
      "setups:\n"
      "  - {{program: {}, stock: 'box:0,0,-20:40,30,0', tools: 1=flat:8, cell_mm: 0.25, name: "
      "top}}\n"
      "  - {{program: bottom.ngc, tools: 1=flat:8, flip: x, zero: top}}\n";
  ASSERT_EQ(
      job(fmt::format(fmt::runtime(setups), "design_top.ngc"), {"--stl", "design.stl"}).exit_code,
      0);
  const KerfResult sound = job(fmt::format(fmt::runtime(setups), "design_top.ngc") +
                               "compare: {design: design.stl, tolerance_mm: 0.1}\n");
  EXPECT_EQ(sound.exit_code, 0) << sound.err;
  EXPECT_EQ(report()["compare"]["verdict"], "in tolerance");
  const KerfResult result = job(fmt::format(fmt::runtime(setups), "top.ngc") +
                                "compare: {design: design.stl, tolerance_mm: 0.1}\n");
  EXPECT_EQ(result.exit_code, 1) << result.err;
  const Json compare = report()["compare"];
  EXPECT_EQ(compare["verdict"], "gouged");
  EXPECT_NEAR(compare["gouge"]["mm"].get<double>(), 0.5, 0.02);
  ASSERT_TRUE(compare["regions"][0].contains("made_before")) << compare["regions"][0];
  EXPECT_EQ(compare["regions"][0]["made_before"]["name"], "top");
  EXPECT_EQ(compare["regions"][0]["made_before"]["line"], 5);
  EXPECT_NE(result.out.find("was made in setup 1 (top), top.ngc:5 (tool 1)"), std::string::npos)
      << result.out;
}

TEST_F(Job, faults_are_told_where_they_are_all_at_once) {
  folder_.write("good.ngc", plunge(1, 10, 10, -5));
  const KerfResult result =
      job("setups:\n"
          "  - program: missing.ngc\n"
          "    flip: x\n"
          "  - program: good.ngc\n"
          "    fliq: x\n"
          "    zero: bottom\n"
          "    stock: 'box:0,0,0:1,1,1'\n");
  EXPECT_EQ(result.exit_code, 2);
  for (const char* const said :
       {"job.yaml:2:14: error: setups[1].program: 'missing.ngc': there is no such file",
        "job.yaml:3:5: error: setups[1].flip: is for later setups: in the first one stock says how "
        "it lies",
        "job.yaml:5:5: error: setups[2].fliq: unknown key", "hint: did you mean flip?",
        "job.yaml:6:11: error: setups[2].zero: 'bottom' is not allowed; must be top, corner, "
        "middle "
        "or [x, y, z]",
        "job.yaml:7:5: error: setups[2].stock: is for the first setup"}) {
    EXPECT_NE(result.err.find(said), std::string::npos) << said << "\nin\n" << result.err;
  }
  EXPECT_FALSE(file_exists(folder_.file("job.json")));
}

TEST_F(Job, options_are_faulted_by_their_keys) {
  folder_.write("good.ngc", plunge(1, 10, 10, -5));
  const KerfResult result =
      job("setups:\n"
          "  - {program: good.ngc, tools: 1=flatt:6, cell_mm: 0}\n"
          "  - {program: good.ngc, model: mmapp}\n");
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_NE(
      result.err.find("job.yaml:2:32: error: setups[1].tools: tool 1: flatt:6: unknown shape"),
      std::string::npos)
      << result.err;
  EXPECT_NE(result.err.find("setups[1].cell_mm: 0 is not allowed"), std::string::npos);
  EXPECT_NE(result.err.find("setups[2].model: 'mmapp' is no model"), std::string::npos);
}

TEST_F(Job, a_model_that_cannot_take_it_over_is_named) {
  folder_.write("good.ngc", plunge(1, 10, 10, -5));
  const KerfResult result =
      job("setups:\n"
          "  - {program: good.ngc, stock: 'box:0,0,-20:40,30,0', tools: 1=flat:8, model: octree}\n"
          "  - {program: good.ngc, tools: 1=flat:8, model: zmap}\n",
          {"--quiet"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_NE(result.err.find("job.yaml:3:49: error: setups[2].model: the workpiece comes as octree "
                            "here; zmap cannot take it over"),
            std::string::npos)
      << result.err;
}

TEST_F(Job, a_setup_is_drawn_by_view) {
  folder_.write("top.ngc", plunge(1, 10, 10, -5));
  folder_.write("bottom.ngc", plunge(1, 30, 20, -8));
  folder_.write("job.yaml",
                "setups:\n"
                "  - {program: top.ngc, stock: 'box:0,0,-20:40,30,0', tools: 1=flat:8}\n"
                "  - {program: bottom.ngc, tools: 1=flat:8, flip: x, zero: top}\n");
  KerfCall call;
  call.arguments = {"view", "job.yaml", "--setup", "2", "--png", "second.png"};
  call.folder = folder_.path();
  const KerfResult drawn = run_kerf(call);
  EXPECT_EQ(drawn.exit_code, 0) << drawn.err;
  EXPECT_TRUE(file_exists(folder_.file("second.png")));
  call.arguments[3] = "3";
  const KerfResult beyond = run_kerf(call);
  EXPECT_EQ(beyond.exit_code, 2);
  EXPECT_NE(beyond.err.find("--setup: 3 is not allowed; the job has 2 setups"), std::string::npos)
      << beyond.err;
  call.arguments = {"view", "top.ngc", "--setup", "2", "--png", "second.png"};
  EXPECT_EQ(run_kerf(call).exit_code, 2);
}

}  // namespace
}  // namespace kerf
