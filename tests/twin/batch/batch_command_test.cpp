// `kerf batch` from the outside: results, going on, bounds. Saved listings need no LinuxCNC.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <signal.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/twin/cli/kerf_process.h"
#include "tests/twin/cli/stl_text.h"

namespace kerf {
namespace {

using Json = nlohmann::json;
using Texts = std::vector<std::string>;

/// A slot of 20 mm, 1 mm deep; with `fault` a rapid goes through what is left.
std::string slot_text(double y, bool fault) {
  std::string text = fmt::format(
      "    1 N..... USE_LENGTH_UNITS(CANON_UNITS_MM)\n"
      "    2 N1     SELECT_TOOL(1)\n"
      "    3 N1     CHANGE_TOOL(1)\n"
      "    4 N2     SET_SPINDLE_SPEED(0, 1000.0000)\n"
      "    5 N2     START_SPINDLE_CLOCKWISE(0)\n"
      "    6 N3     STRAIGHT_TRAVERSE(0.0000, {0:.4f}, 5.0000, 0.0000, 0.0000, 0.0000)\n"
      "    7 N4     SET_FEED_RATE(300.0000)\n"
      "    8 N4     STRAIGHT_FEED(0.0000, {0:.4f}, -1.0000, 0.0000, 0.0000, 0.0000)\n"
      "    9 N5     STRAIGHT_FEED(20.0000, {0:.4f}, -1.0000, 0.0000, 0.0000, 0.0000)\n",
      y);
  if (fault) {
    text += "   10 N6     STRAIGHT_TRAVERSE(20.0000, 14.0000, -1.0000, 0.0000, 0.0000, 0.0000)\n";
  }
  return text + "   11 N8     PROGRAM_END()\n";
}

class BatchCommand : public testing::Test {
 protected:
  KerfCall call(Texts arguments) const {
    arguments.insert(arguments.begin(), "batch");
    arguments.insert(arguments.end(),
                     {"--stock", "box:-5,-5,-5:25,15,0", "--tool", "1=flat:6", "--cell", "0.5",
                      "--jobs", "2", "--max-commands", "1000000000000"});
    KerfCall call;
    call.arguments = std::move(arguments);
    call.folder = folder_.path();
    return call;
  }
  KerfResult batch(Texts arguments) const { return run_kerf(call(std::move(arguments))); }
  void write_slots(int count) const {
    std::filesystem::create_directory(folder_.file("parts"));
    for (int i = 0; i < count; ++i) {
      folder_.write(fmt::format("parts/{:02}.canon", i), slot_text(i, i == 1));
    }
  }
  Json json(const std::string& name) const {
    return Json::parse(read_file(folder_.file(name)), nullptr, false);
  }
  void write_endless() const {
    folder_.write("parts/99.ngc",
                  "G21 G90\nT1 M6\nM3 S1000\nF300\no1 while [1]\nG1 X20 Z-1\nG1 X0 Z-1\n"
                  "o1 endwhile\nM2\n");
  }
  /// By program.
  std::map<std::string, Json> lines(const std::string& name) const {
    std::map<std::string, Json> all;
    std::istringstream in(read_file(folder_.file(name)));
    for (std::string line; std::getline(in, line);) {
      Json one = Json::parse(line, nullptr, false);
      EXPECT_TRUE(one.is_object()) << line;
      const std::string program = one.value("program", "");
      EXPECT_EQ(all.count(program), 0U) << program;
      all[program] = std::move(one);
    }
    return all;
  }
  TestFolder folder_;
};

/// All of its programs begin with the mesh; where that changes, they are run again.
TEST_F(BatchCommand, ABlankFromAMeshIsThatOfEachProgram) {
  write_slots(1);
  folder_.write("parts/05.canon", slot_text(5, false));
  for (const double top : {0.0, -0.5}) {
    folder_.write("block.stl", stl_box({-5, -5, -5}, {25, 15, top}));
    KerfCall mesh = call({"parts", "--out", "out"});
    for (std::string& word : mesh.arguments)
      if (word.starts_with("box:")) word = "stl:block.stl";
    const KerfResult result = run_kerf(mesh);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    const std::map<std::string, Json> done = lines("out/results.jsonl");
    EXPECT_EQ(done.size(), 2U);
    for (const auto& [program, line] : done) {
      // 20 mm and two half circles of 6 mm, 1 mm deep or 0.5.
      EXPECT_NEAR(line["removed_mm3"].get<double>(), (20 * 6 + 9 * 3.14159265) * (1 + top), 4.5)
          << program;
    }
  }
}

TEST_F(BatchCommand, EachProgramHasAResultAndAPage) {
  write_slots(3);
  const KerfResult result = batch({"parts", "--out", "out"});
  EXPECT_EQ(result.exit_code, 1) << result.err;
  EXPECT_EQ(result.err, "");
  auto all = lines("out/results.jsonl");
  ASSERT_EQ(all.size(), 3U);
  const Json good = all["parts/00.canon"], bad = all["parts/01.canon"];
  EXPECT_EQ(good["verdict"], "good");
  EXPECT_EQ(good["message"], nullptr);
  EXPECT_EQ(bad["verdict"], "findings");
  EXPECT_EQ(bad["exit_code"], 1);
  EXPECT_GE(bad["errors"], 1);
  // A capsule: 20 x 6 x 1 and a disc of radius 3, in cells of 0.5.
  EXPECT_NEAR(good["removed_mm3"].get<double>(), 120 + 9 * 3.14159265, 4);
  EXPECT_GT(good["time_s"].get<double>(), 4);
  EXPECT_GT(good["peak_rss_mb"].get<double>(), 1);
  const Json summary = json("out/summary.json");
  EXPECT_EQ(summary["schema"], "kerf-batch/1");
  EXPECT_EQ(summary["verdicts"]["good"], 2);
  EXPECT_EQ(summary["verdicts"]["findings"], 1);
  EXPECT_EQ(summary["partial"], false);
  const std::string index = read_file(folder_.file("out/index.html"));
  for (const auto& [program, line] : all) {
    for (const char* key : {"report", "page", "picture", "junit", "said"}) {
      ASSERT_TRUE(line[key].is_string()) << program << " " << key;
      EXPECT_TRUE(file_exists(folder_.file("out/" + line[key].get<std::string>())));
    }
    EXPECT_NE(index.find("href=\"" + line["page"].get<std::string>()), index.npos);
  }
  const std::string junit = read_file(folder_.file("out/junit.xml"));
  EXPECT_NE(junit.find("<testsuite name=\"parts/01.canon\""), junit.npos);
  EXPECT_NE(junit.find("failures=\"1\" errors=\"0\""), junit.npos) << junit;
}

TEST_F(BatchCommand, WhatIsDoneAndUnchangedIsNotDoneAgain) {
  write_slots(3);
  batch({"parts", "--out", "out"});
  const std::string summary = read_file(folder_.file("out/summary.json"));
  const std::string results = read_file(folder_.file("out/results.jsonl"));
  KerfResult again = batch({"parts", "--out", "out"});
  EXPECT_EQ(again.exit_code, 1);
  EXPECT_NE(again.out.find("; 3 of them from before"), again.out.npos) << again.out;
  EXPECT_EQ(read_file(folder_.file("out/summary.json")), summary);
  EXPECT_EQ(read_file(folder_.file("out/results.jsonl")), results);
  folder_.write("parts/01.canon", slot_text(1, false));
  again = batch({"parts", "--out", "out"});
  EXPECT_EQ(again.exit_code, 0);
  EXPECT_NE(again.out.find("; 2 of them from before"), again.out.npos) << again.out;
  again = batch({"parts", "--out", "out", "--no-guess"});
  EXPECT_EQ(again.out.find("from before"), again.out.npos) << again.out;
  again = batch({"parts", "--out", "out", "--no-guess", "--again"});
  EXPECT_EQ(again.out.find("from before"), again.out.npos) << again.out;
  // Another list into the same folder leaves the others' results there.
  batch({"parts/00.canon", "--out", "out", "--no-guess"});
  EXPECT_EQ(lines("out/results.jsonl").size(), 3U);
  EXPECT_EQ(json("out/summary.json")["programs"], 1);
}

TEST_F(BatchCommand, ResultsCutOffAnywhereAreGoneOnWith) {
  write_slots(3);
  batch({"parts", "--out", "out"});
  const std::string summary = read_file(folder_.file("out/summary.json"));
  const std::string results = read_file(folder_.file("out/results.jsonl"));
  for (const std::size_t cut : {results.size() - 1, results.size() / 2, std::size_t{7}}) {
    folder_.write("out/results.jsonl", results.substr(0, cut));
    const KerfResult again = batch({"parts", "--out", "out"});
    EXPECT_EQ(again.exit_code, 1);
    EXPECT_EQ(read_file(folder_.file("out/summary.json")), summary) << cut;
    EXPECT_EQ(lines("out/results.jsonl").size(), 3U);
  }
}

TEST_F(BatchCommand, InterruptedTwiceItEndsWithTheSameSummary) {
  write_slots(8);
  batch({"parts", "--out", "whole"});
  for (const int after : {1, 3}) {
    RunningKerf running(call({"parts", "--out", "out"}));
    const std::string results = folder_.file("out/results.jsonl");
    ASSERT_TRUE(running.wait_until([&] {
      const std::string text = file_exists(results) ? read_file(results) : "";
      return std::count(text.begin(), text.end(), '\n') >= after;
    }));
    running.send(after == 1 ? SIGINT : SIGKILL);
    const KerfResult result = running.finish();
    EXPECT_EQ(result.exit_code, after == 1 ? 4 : 128 + SIGKILL) << result.out;
  }
  EXPECT_EQ(batch({"parts", "--out", "out"}).exit_code, 1);
  EXPECT_EQ(read_file(folder_.file("out/summary.json")),
            read_file(folder_.file("whole/summary.json")));
  EXPECT_EQ(lines("out/results.jsonl").size(), 8U);
}

TEST_F(BatchCommand, ABoundIsAResultAndNotTheEnd) {
  if (std::system("command -v rs274 >/dev/null") != 0) GTEST_SKIP() << "LinuxCNC is not installed";
  write_slots(2);
  write_endless();
  folder_.write("list", "parts/99.ngc\nparts/00.canon\n");
  KerfResult result = batch({"list", "--out", "out", "--each-seconds", "6"});
  EXPECT_EQ(result.exit_code, 4);
  auto all = lines("out/results.jsonl");
  EXPECT_EQ(all["parts/99.ngc"]["verdict"], "out-of-time");
  EXPECT_EQ(all["parts/99.ngc"]["message"], "not finished after 6 s");
  EXPECT_EQ(all["parts/00.canon"]["verdict"], "good");
  const std::string junit = read_file(folder_.file("out/junit.xml"));
  EXPECT_NE(junit.find("not finished after 6 s"), junit.npos) << junit;
  folder_.write("options", "01.canon: --stock box:-500,-500,-5:500,500,0 --cell 0.04\n");
  result = batch({"parts/0*.canon", "--out", "out", "--each-memory", "1000", "--options", "options",
                  "--model", "zmap"});
  EXPECT_EQ(result.exit_code, 4);
  all = lines("out/results.jsonl");
  EXPECT_EQ(all["parts/00.canon"]["verdict"], "good");
  EXPECT_EQ(all["parts/01.canon"]["verdict"], "out-of-memory") << all["parts/01.canon"];
}

TEST_F(BatchCommand, AFullDiskLeavesWholeLines) {
  write_slots(12);
  KerfCall full = call({"parts", "--out", "out"});
  full.file_size_limit = 3000;
  const KerfResult result = run_kerf(full);
  EXPECT_EQ(result.exit_code, 4);
  EXPECT_NE(result.err.find("out/results.jsonl: File too large"), result.err.npos) << result.err;
  const auto all = lines("out/results.jsonl");
  EXPECT_GT(all.size(), 1U);
  EXPECT_LT(all.size(), 12U);
  // What the disk has kept from being written is done again.
  EXPECT_EQ(batch({"parts", "--out", "out"}).exit_code, 1);
  for (const auto& [program, line] : lines("out/results.jsonl")) {
    EXPECT_EQ(line["verdict"], program == "parts/01.canon" ? "findings" : "good");
  }
}

TEST_F(BatchCommand, FaultsAreToldBeforeAnythingIsRun) {
  write_slots(1);
  folder_.write("list.txt", "parts/00.canon\nparts/gone.canon\n");
  folder_.write("options.txt", "00.canon: --cell 0\n");
  const KerfResult result = batch({"list.txt", "--out", "out", "--options", "options.txt"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_NE(result.err.find("list.txt:2:1: error: parts/gone.canon: no such file or folder"),
            result.err.npos)
      << result.err;
  EXPECT_NE(result.err.find("options.txt:1: error: --cell"), result.err.npos) << result.err;
  EXPECT_FALSE(file_exists(folder_.file("out")));
  folder_.write("options.txt", "other.ngc: --cell 1\n");
  const KerfResult unused = batch({"parts", "--out", "out", "--options", "options.txt"});
  EXPECT_EQ(unused.exit_code, 0);
  EXPECT_NE(unused.err.find("options.txt:1:1: warning: other.ngc fits none"), unused.err.npos);
}

TEST_F(BatchCommand, OneBatchAtATimeHasTheFolder) {
  if (std::system("command -v rs274 >/dev/null") != 0) GTEST_SKIP() << "LinuxCNC is not installed";
  write_slots(1);
  write_endless();
  RunningKerf first(call({"parts/99.ngc", "--out", "out"}));
  ASSERT_TRUE(first.wait_until([&] { return file_exists(folder_.file("out/results.jsonl")); }));
  const KerfResult second = batch({"parts/00.canon", "--out", "out"});
  EXPECT_EQ(second.exit_code, 4);
  EXPECT_NE(second.err.find("another kerf batch is at work"), second.err.npos) << second.err;
  first.send(SIGTERM);
  EXPECT_EQ(first.finish().exit_code, 4);
}

}  // namespace
}  // namespace kerf
