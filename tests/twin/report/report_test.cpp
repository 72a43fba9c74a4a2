#include "twin/report/report.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace kerf {
namespace {

using Json = nlohmann::ordered_json;

Report sample() {
  Report r;
  r.version = "0.1.0";
  r.program_path = "part.ngc";
  r.program.files = {"part.ngc"};
  r.program.program_lines = 120;
  r.program.interpreter = "text";
  r.program.canonical_commands = {{"STRAIGHT_FEED", 4681}, {"STRAIGHT_TRAVERSE", 3}};
  r.motion.moves = 4684;
  r.motion.feed_moves = 4681;
  r.motion.traverse_moves = 3;
  r.motion.feed_mm = 12345.6789012;
  r.motion.duration_s = 3725;
  r.time_model = "length / feed";
  StockReport stock;
  stock.model = "zmap";
  stock.description = "box 100 x 60 x 20 mm, X0..100 Y0..60 Z-20..0";
  stock.origin = "--stock";
  stock.cell_mm = 0.05;
  stock.blank_mm3 = 120000;
  stock.remaining_mm3 = 90000;
  stock.bounds_mm = Box{{0, 0, -20}, {100, 60, 0}};
  stock.cells = 2400000;
  stock.digest = "00ff";
  r.stock = stock;
  ToolUse use;
  use.number = 3;
  use.shape = "ball:6";
  use.origin = "--tool";
  use.cut_s = 61;
  use.removed_mm3 = 30000;
  use.max_depth_mm = 2.5;
  use.peak_mm3_per_s = 40;
  r.tools.push_back(use);
  Finding f;
  f.source.line = 118;
  f.time_s = 12.5;
  f.position_mm = Vec3(1, 2, -3);
  f.tool = 3;
  f.depth_mm = 2.31;
  f.text = "traverse touches the workpiece";
  r.findings.add(f);
  return r;
}

std::vector<std::string> keys(const Json& object) {
  std::vector<std::string> out;
  for (const auto& item : object.items()) out.push_back(item.key());
  return out;
}

using Keys = std::vector<std::string>;

TEST(ReportJson, HasThePublishedKeys) {
  const Json json = Json::parse(json_text(sample()));
  EXPECT_EQ(keys(json),
            (Keys{"schema", "version", "partial", "program", "motion", "stock", "tools",
                  "collisions", "findings", "findings_total", "timing_s", "peak_rss_mb"}));
  EXPECT_EQ(json["schema"], "kerf-report/1");
  EXPECT_EQ(keys(json["program"]), (Keys{"path", "lines", "interpreter", "canonical_commands"}));
  EXPECT_EQ(keys(json["motion"]),
            (Keys{"moves", "feed_moves", "traverse_moves", "arcs", "moves_without_feed", "feed_mm",
                  "traverse_mm", "duration_s", "time_model"}));
  EXPECT_EQ(keys(json["stock"]), (Keys{"model", "origin", "cell_mm", "blank_mm3", "removed_mm3",
                                       "remaining_mm3", "bounds_mm", "cells", "digest"}));
  EXPECT_EQ(keys(json["tools"][0]),
            (Keys{"number", "shape", "origin", "guessed", "shank_checked", "holder_checked",
                  "cut_s", "feed_mm", "removed_mm3", "max_depth_mm", "peak_mm3_per_s"}));
  EXPECT_EQ(keys(json["findings"][0]),
            (Keys{"id", "severity", "file", "line", "time_s", "position_mm", "tool", "depth_mm",
                  "bodies", "message"}));
  EXPECT_EQ(keys(json["timing_s"]), (Keys{"interpret", "cut", "cut_cpu", "mesh", "total"}));
}

TEST(ReportJson, CarriesTheValues) {
  const Json json = Json::parse(json_text(sample()));
  EXPECT_EQ(json["partial"], false);
  EXPECT_EQ(json["program"]["canonical_commands"]["STRAIGHT_FEED"], 4681);
  EXPECT_EQ(json["motion"]["feed_mm"], 12345.678901);
  EXPECT_EQ(json["stock"]["removed_mm3"], 30000.0);
  EXPECT_EQ(json["stock"]["bounds_mm"], Json::parse("[[0,0,-20],[100,60,0]]"));
  const Json& finding = json["findings"][0];
  EXPECT_EQ(finding["id"], "rapid-contact");
  EXPECT_EQ(finding["file"], "part.ngc");
  EXPECT_EQ(finding["line"], 118);
  EXPECT_EQ(finding["position_mm"], Json::parse("[1,2,-3]"));
  EXPECT_EQ(finding["message"],
            "traverse touches the workpiece, 2.31 mm deep at X1.00 Y2.00 Z-3.00 (tool 3)");
}

TEST(ReportJson, PartialReportsSayWhyAndMayLackAStock) {
  Report r = sample();
  r.partial_reason = "interrupted before the end of the program";
  r.stock.reset();
  const Json json = Json::parse(json_text(r));
  EXPECT_EQ(json["partial"], true);
  EXPECT_EQ(json["partial_reason"], r.partial_reason);
  EXPECT_TRUE(json["stock"].is_null());
}

TEST(ReportJson, TextThatIsNotUtf8StaysValidJson) {
  Report r = sample();
  r.program_path =
      "pi\xe8"
      "ce.ngc";
  EXPECT_EQ(Json::parse(json_text(r))["program"]["path"],
            "pi\xef\xbf\xbd"
            "ce.ngc");
}

TEST(ReportText, IsAPageThatReadsInTenSeconds) {
  EXPECT_EQ(
      summary_text(sample()),
      "verdict   part.ngc: 1 error\n"
      "errors    1 rapid-contact\n"
      "time      1 h 02 min 05 s (length / feed)\n"
      "removed   30.000 cm3 of 120.000 cm3 (25.0 %)\n"
      "tools     3   ball:6 (--tool)\n"
      "              removed 30.000 cm3, cutting 1 min 01 s, deepest cut 2.50 mm, peak 40.0 mm3/s\n"
      "unchecked T3: no holder and no length of flutes known (--tool "
      "3=SHAPE:flute=L:holder=er20:stickout=L)\n"
      "stock     box 100 x 60 x 20 mm, X0..100 Y0..60 Z-20..0 (--stock)\n"
      "          zmap, cells of 0.05 mm, 2.40 million\n");
}

TEST(ReportText, WhatEachToothHasToDo) {
  Report r = sample();
  ToolUse& use = r.tools.front();
  use.teeth = 2;
  const auto has = [&](const char* text) {
    return summary_text(r).find(text) != std::string::npos;
  };
  EXPECT_FALSE(has("feed per tooth")) << "nothing was cut while the spindle turned";
  use.chip.add(0.05, 0.04, 3, {0, 7});
  use.chip.add(0.1, 0.1, 1, {0, 9});
  use.chip.add(0.02, 0.01, 1, {0, 11});
  use.chip.speed_m_per_min = 125.66;
  EXPECT_TRUE(
      has("2 teeth: feed per tooth 0.046 mm, 0.1 mm at most (line 9), cutting speed 126 m/min"));
  const Json tool = Json::parse(json_text(r))["tools"][0];
  EXPECT_EQ(tool["engagement"]["feed_per_tooth_mm"], 0.1);
  EXPECT_EQ(tool["engagement"]["feed_per_tooth_mean_mm"], 0.046);
  EXPECT_EQ(tool["engagement"]["line"], 9);
}

TEST(ReportText, WhatIsUnknownOfToolsIsOneLine) {
  const auto line_of = [](std::initializer_list<std::pair<bool, bool>> shank_and_holder) {
    Report r = sample();
    const ToolUse use = r.tools.front();
    r.tools.clear();
    for (const auto& [shank, holder] : shank_and_holder) {
      r.tools.push_back(use);
      r.tools.back().number = static_cast<int>(r.tools.size());
      r.tools.back().shank_checked = shank;
      r.tools.back().holder_checked = holder;
    }
    const std::string text = summary_text(r);
    const std::size_t at = text.find("unchecked");
    return at == std::string::npos ? "" : text.substr(at, text.find('\n', at) - at);
  };
  EXPECT_EQ(line_of({{true, true}}), "");
  EXPECT_EQ(line_of({{true, true}, {true, false}, {true, false}}),
            "unchecked T2, T3: no holder known (--tool 2=SHAPE:holder=er20:stickout=L)");
  EXPECT_EQ(line_of({{true, true}, {false, true}}),
            "unchecked T2: no length of flutes known (--tool 2=SHAPE:flute=L)");
  EXPECT_EQ(line_of({{false, false}, {true, false}}),
            "unchecked T1, T2: no holder known; T1: no length of flutes "
            "(--tool 1=SHAPE:flute=L:holder=er20:stickout=L)");

  Report spindle = sample();
  spindle.tools.resize(1);
  spindle.tools.front().number = 0;  // --tool 0 there is none
  spindle.tools.front().holder_checked = spindle.tools.front().shank_checked = false;
  EXPECT_NE(summary_text(spindle).find("unchecked T0: no holder and no length of flutes known "
                                       "(--tool 1=SHAPE:"),
            std::string::npos);
}

TEST(ReportText, TellsFindingsBySeverityAndKind) {
  Report r = sample();
  const auto add = [&r](FindingId id, Severity severity) {
    Finding finding;
    finding.id = id;
    finding.severity = severity;
    r.findings.add(finding);
  };
  add(FindingId::kBelowStock, Severity::kError);
  add(FindingId::kBelowStock, Severity::kError);
  add(FindingId::kToolGuessed, Severity::kWarning);
  add(FindingId::kKinematics, Severity::kNote);
  EXPECT_EQ(summary_text(r).rfind("verdict   part.ngc: 3 errors, 1 warning\n"
                                  "errors    1 rapid-contact, 2 below-stock\n"
                                  "warnings  1 tool-guessed\n"
                                  "notes     1 kinematics\n"
                                  "time ",
                                  0),
            0U)
      << summary_text(r);
  r.findings = {};
  EXPECT_EQ(summary_text(r).rfind("verdict   part.ngc: no findings\ntime ", 0), 0U);
  add(FindingId::kToolGuessed, Severity::kWarning);
  EXPECT_EQ(summary_text(r).rfind("verdict   part.ngc: no errors, 1 warning\n", 0), 0U);
}

TEST(ReportText, HasItsDetailsByWish) {
  Report r = sample();
  r.time_model = "LinuxCNC 2.9 trajectory planner, limits of mill.ini: X 60 mm/s, and so on";
  const std::string text = summary_text(r);
  EXPECT_NE(text.find("(LinuxCNC 2.9 trajectory planner, limits of mill.ini)\n"), text.npos)
      << text;
  EXPECT_EQ(text.find("X 60 mm/s"), text.npos);
  EXPECT_EQ(text.find("distance"), text.npos);
  const std::string all = summary_text(r, {true, {}, LengthUnit::kMm});
  EXPECT_NE(
      all.find("program   120 lines, 4684 moves (0 arcs)\n"
               "distance  feed 12.35 m, traverse 0.0 mm\n"
               "model     LinuxCNC 2.9 trajectory planner, limits of mill.ini: X 60 mm/s, and "
               "so on\n"
               "run       0.00 s (interpreting 0.00, cutting 0.00, surface 0.00), 0 MB\n"),
      all.npos)
      << all;
}

TEST(ReportText, EndsWithWhatWasGuessed) {
  Report r = sample();
  r.guesses = {{"blank", "--stock", "box:0,0,-20:100,60,0", "the feed moves plus 5 mm"}};
  const std::string text =
      summary_text(r, {false, "kerf run part.ngc --stock box:0,0,-20:100,60,0", LengthUnit::kMm});
  EXPECT_TRUE(
      text.ends_with("guessed   blank   box:0,0,-20:100,60,0 (the feed moves plus 5 mm)\n"
                     "          correct what is wrong, and run it again:\n"
                     "          kerf run part.ngc --stock box:0,0,-20:100,60,0\n"))
      << text;
  const Json json = Json::parse(json_text(r));
  EXPECT_EQ(json["guessed"][0]["option"], "--stock");
  EXPECT_EQ(json["guessed"][0]["value"], "box:0,0,-20:100,60,0");
}

TEST(ReportText, IsInInchesByWishAndTheJsonNever) {
  Report r = sample();
  r.guesses = {{"blank", "--stock", "box:0,0,-20:100,60,0", "the feed moves plus 5 mm"}};
  const std::string text = summary_text(r, {true, "kerf run part.ngc", LengthUnit::kInch});
  for (const char* const line :
       {"removed   1.8307 in3 of 7.3228 in3 (25.0 %)\n", "tools     3   ball:0.2362 (--tool)\n",
        "deepest cut 0.098 in, peak 0.1465 in3/min\n",
        "stock     box 3.937 x 2.362 x 0.787 in, X0..3.937 Y0..2.362 Z-0.787..0 (--stock)\n",
        "          zmap, cells of 0.002 in, 2.40 million\n",
        "guessed   blank   box:0,0,-0.7874:3.937,2.3622,0 (the feed moves plus 0.197 in)\n",
        "distance  feed 486.2 in, traverse 0 in\n"}) {
    EXPECT_NE(text.find(line), text.npos) << line << "in\n" << text;
  }
  EXPECT_EQ(text.find("mm"), text.npos) << text;
  EXPECT_EQ(Json::parse(json_text(r))["guessed"][0]["value"], "box:0,0,-20:100,60,0");
}

TEST(ReportText, MarksPartialRuns) {
  Report r = sample();
  r.partial_reason = "interrupted before the end of the program";
  EXPECT_NE(summary_text(r).find("PARTIAL   interrupted before the end of the program"),
            std::string::npos);
}

}  // namespace
}  // namespace kerf
