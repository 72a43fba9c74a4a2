// Both interpreters over real programs: kerf-interp's records and rs274's text must command the
// same. Needs KERF_SHARED_DATA.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>

#include "tests/interp_bridge/program_test_support.h"

namespace kerf {
namespace {

/// Half a digit of rs274's four decimals in each of two numbers (a work offset and a position), in
/// the program's unit.
double print_precision_mm(bool inches) { return inches ? 1e-4 * 25.4 * 1.01 : 1.01e-4; }

/// Programs whose interpreters differ, and why. Everything else must agree.
const std::map<std::string, std::string>& known_differences() {
  static const std::map<std::string, std::string> known = {
      {"engrave/linuxcnc__systems.ngc", "splines: the text of rs274 does not hold their points"},
      {"mill4/linuxcnc__xyzc.ngc", "user M-codes: an error of rs274"},
      {"sheet/linuxcnc__metric_air_scribe.ngc", "pins of QtPlasmaC: an error of rs274"},
      {"sheet/linuxcnc__metric_circles.ngc", "the same"},
      {"sheet/linuxcnc__metric_material_change.ngc", "the same"},
      {"sheet/linuxcnc__metric_pipe.ngc", "the same"},
      {"sheet/linuxcnc__metric_wrench.ngc", "the same"},
      {"weird/linuxcnc__130207LZW.ngc", "the axis W: an error of rs274"},
      {"weird/linuxcnc__smartprobe.ngc",
       "probing: rs274 backs off 0.254 mm behind every probing move"},
      {"weird/pcb2gcode__back.ngc", "probing, the same"}};
  return known;
}

ProgramRun run_by(InterpreterChoice interpreter, ProgramOptions options) {
  options.interpreter = interpreter;
  options.kerf_interp_path = KERF_INTERP_EXECUTABLE;
  return run_program(options);
}

/// Empty if the two agree.
std::string difference(const ProgramRun& bridge, const ProgramRun& text, double precision_mm) {
  const std::size_t count = std::min(bridge.motions.size(), text.motions.size());
  for (std::size_t i = 0; i < count; ++i) {
    const Motion& a = bridge.motions[i];
    const Motion& b = text.motions[i];
    std::ostringstream what;
    what << "motion " << i << ", line " << a.source.line << " and " << b.source.line << ": ";
    if (a.kind != b.kind) {
      what << "kinds " << static_cast<int>(a.kind) << " and " << static_cast<int>(b.kind);
      return what.str();
    }
    const double off = glm::length(a.to_mm - b.to_mm);
    if (off > precision_mm * 1.8) {
      what << "ends " << off << " mm apart, X" << a.to_mm.x << " Y" << a.to_mm.y << " Z"
           << a.to_mm.z << " and X" << b.to_mm.x << " Y" << b.to_mm.y << " Z" << b.to_mm.z;
      return what.str();
    }
    if (a.kind == MotionKind::kArc && b.start_known &&
        std::abs(a.arc.sweep_rad - b.arc.sweep_rad) > 0.1) {
      what << "sweeps " << a.arc.sweep_rad << " and " << b.arc.sweep_rad;
      return what.str();
    }
    if (a.tool != b.tool) {
      what << "tools " << a.tool << " and " << b.tool;
      return what.str();
    }
    if (a.spindle != b.spindle || std::abs(a.spindle_rpm - b.spindle_rpm) > 0.01) {
      what << "spindles " << a.spindle_rpm << " and " << b.spindle_rpm;
      return what.str();
    }
    if (std::abs(a.feed_mm_per_min - b.feed_mm_per_min) > 1e-3 + 1e-3 * b.feed_mm_per_min) {
      what << "feeds " << a.feed_mm_per_min << " and " << b.feed_mm_per_min;
      return what.str();
    }
  }
  if (bridge.motions.size() != text.motions.size()) {
    return std::to_string(bridge.motions.size()) + " and " + std::to_string(text.motions.size()) +
           " motions";
  }
  return {};
}

TEST(BridgeCorpus, BothInterpretersAgree) {
  if (shared_data().empty()) GTEST_SKIP() << "KERF_SHARED_DATA is not set";
  const std::filesystem::path root = shared_data() / "nc";
  std::size_t agreed = 0, moves = 0, same_lines = 0;
  for (const Row& row : index_rows(root / "index.tsv")) {
    const TestFolder folder;
    ProgramOptions options;
    options.path = (root / row.at("path")).string();
    const auto table =
        root / "tables" / (std::filesystem::path(options.path).filename().string() + ".tbl");
    if (std::filesystem::exists(table)) options.tool_table_path = table.string();
    const ProgramRun bridge = run_by(InterpreterChoice::kBridge, options);
    const ProgramRun text = run_by(InterpreterChoice::kText, options);
    ASSERT_TRUE(bridge.opened) << bridge.messages();
    EXPECT_EQ(bridge.summary.interpreter, "bridge");
    EXPECT_TRUE(folder.nothing_left_behind());
    const std::string found = difference(bridge, text, print_precision_mm(row.at("units") != "mm"));
    const auto known = known_differences().find(row.at("path"));
    if (known != known_differences().end()) {
      EXPECT_NE(found, "") << row.at("path") << " agrees now";
      continue;
    }
    EXPECT_EQ(found, "") << row.at("path") << "\n" << bridge.messages() << text.messages();
    if (row.at("rs274_status") == "ok") {
      EXPECT_FALSE(has_error(bridge.diagnostics)) << row.at("path") << bridge.messages();
      EXPECT_TRUE(bridge.summary.has_program_end) << row.at("path");
      ++agreed;
    }
    moves += bridge.motions.size();
    for (std::size_t i = 0; i < std::min(bridge.motions.size(), text.motions.size()); ++i) {
      same_lines += bridge.motions[i].source == text.motions[i].source ? 1 : 0;
    }
  }
  EXPECT_GE(agreed, 67U);
  std::cout << agreed << " whole programs agree; " << moves << " motions, " << same_lines
            << " with the line that numbering finds\n";
}

}  // namespace
}  // namespace kerf
