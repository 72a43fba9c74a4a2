// How often a program is interpreted that a machine is watched with.
#include "twin/live/program_readings.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "stock/cutter/shape_spec.h"
#include "tests/base/temporary_folder.h"
#include "tests/twin/live/listed_source.h"
#include "twin/live/live_session.h"

namespace kerf {
namespace {

/// A zigzag of a minute and a half; rs274 in a wrapper that counts how often it is started.
class ProgramReadingsTest : public ::testing::Test {
 protected:
  void SetUp() override {
    if (std::system("command -v rs274 >/dev/null") != 0) GTEST_SKIP() << "LinuxCNC is missing";
    std::string text = "G21 G90 G17 G64\nT1 M6\nS1000 M3\nG0 X0 Y0 Z5\nG1 Z-1 F600\n";
    for (int i = 0; i < 30; ++i) {
      text += "G1 X" + std::to_string(i % 2 ? 0 : 30) + "\nG1 Y" + std::to_string(i + 1) + "\n";
    }
    write("part.ngc", text + "G0 Z5\nM2\n");
    write("rs274", "#!/bin/sh\necho start >>'" + path("starts") + "'\nexec rs274 \"$@\"\n");
    std::filesystem::permissions(path("rs274"), std::filesystem::perms::owner_all);
  }
  std::string path(const std::string& name) const { return folder_ / name; }
  void write(const std::string& name, const std::string& text) const {
    write_file(path(name), text);
  }
  int starts() const {
    const std::string lines = read_file(path("starts"));
    return static_cast<int>(std::count(lines.begin(), lines.end(), '\n'));
  }
  ProgramOptions program() const {
    ProgramOptions options;
    options.path = path("part.ngc");
    options.interpreter = InterpreterChoice::kText;
    options.rs274_path = path("rs274");
    return options;
  }
  /// A machine on its way along the zigzag's line 46, X from 0 to 30 at Y20, 10 mm/s.
  static void add_cut(std::vector<AxisSample>& samples) {
    for (int i = 0; i < 250; ++i) add(samples, {0.1 * i, 20, -1}, 46);
  }
  static void add(std::vector<AxisSample>& samples, const Vec3& tip, int line) {
    AxisSample sample;
    for (int i = 0; i < 3; ++i) sample.set(static_cast<std::size_t>(i), tip[i]);
    sample.tool = 1;
    sample.line = line;
    sample.device_ns = static_cast<std::int64_t>(samples.size()) * 10'000'000;
    samples.push_back(sample);
  }
  /// The watch, with nothing known but the program.
  Report watch(std::vector<AxisSample> samples) const {
    LiveOptions options;
    options.program = program();
    options.stock.cell_mm = 0.5;
    options.tools.push_back(std::move(parse_tool_argument("1=flat:4").value()));
    options.speed = 20;
    options.cutting.frame.tool_length = ToolLengthFrom::kNone;
    Diagnostics diagnostics;
    Outcome outcome = Outcome::kFailed;
    const auto session =
        LiveSession::open(std::move(options), std::make_unique<ListedSource>(std::move(samples)),
                          diagnostics, outcome);
    if (!session) return {};
    EXPECT_EQ(session->run({}, diagnostics), Outcome::kFinished);
    return std::move(session->report());
  }
  TemporaryFolder folder_;
};

TEST_F(ProgramReadingsTest, WhatOneProgramIsNeededForIsInterpretedOnce) {
  // The blank is guessed from it, its time is measured, it is followed, and the machine that is in
  // its middle is looked for in all of it.
  std::vector<AxisSample> samples;
  add_cut(samples);
  const Report report = watch(samples);
  ASSERT_TRUE(report.live);
  EXPECT_GT(report.live->facts.on_path, 150U);
  const auto& found = report.findings.kept();
  EXPECT_TRUE(std::any_of(found.begin(), found.end(), [](const Finding& finding) {
    return finding.id == FindingId::kLateStart;
  }));
  EXPECT_EQ(starts(), 1);
}

TEST_F(ProgramReadingsTest, FromAnotherStartItIsInterpretedAgain) {
  // The machine is seen where it stands before the program begins: not at its zero.
  std::vector<AxisSample> samples;
  for (int i = 0; i < 50; ++i) add(samples, {-7, -3, 20}, 0);
  add_cut(samples);
  ASSERT_TRUE(watch(samples).live);
  EXPECT_EQ(starts(), 2);
}

TEST_F(ProgramReadingsTest, EqualStartsShareOneReadingAndChangedFilesDoNot) {
  Diagnostics diagnostics;
  const auto readings = ProgramReadings::open(program(), diagnostics);
  ASSERT_TRUE(readings);
  const auto run = [&](const ProgramReadings::Start& start) {
    const auto reader = readings->reader(start, diagnostics);
    std::size_t motions = 0;
    reader->run(
        [&](std::span<const Motion> some) {
          motions += some.size();
          return true;
        },
        {}, diagnostics);
    return motions;
  };
  const ProgramReadings::Start elsewhere{1, 2, 3};
  const std::size_t motions = run({});
  EXPECT_EQ(run({}), motions);
  EXPECT_EQ(starts(), 1);
  EXPECT_EQ(run(elsewhere), motions);
  EXPECT_EQ(run(elsewhere), motions);
  EXPECT_EQ(run({}), motions);
  EXPECT_EQ(starts(), 2);
  write("part.ngc", "G21\nT1 M6\nG0 X1\nM2\n");
  EXPECT_LT(run({}), motions);
  EXPECT_EQ(starts(), 3);
}

}  // namespace
}  // namespace kerf
