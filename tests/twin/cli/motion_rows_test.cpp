// Rows of --csv beside the report of the same run, of real programs: what was in the air, tool by
// tool. Skipped without $KERF_SHARED_DATA.
#include <gtest/gtest.h>

#include <cstdlib>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "tests/twin/cli/kerf_process.h"

namespace kerf {
namespace {

using Json = nlohmann::json;

/// Of a line without quoted commas.
std::vector<std::string> cells_of(std::string line) {
  if (!line.empty() && line.back() == '\r') line.pop_back();
  std::vector<std::string> cells(1);
  for (const char c : line) {
    if (c == ',') {
      cells.emplace_back();
    } else {
      cells.back() += c;
    }
  }
  return cells;
}

/// Below nc/, and what it is run with.
struct Program {
  const char* file;
  std::vector<std::string> arguments;
};

class MotionRows : public testing::TestWithParam<Program> {};

/// What a row rounds to 1e-6 s, over all rows.
TEST_P(MotionRows, HaveTheAirOfTheReport) {
  const char* const shared = std::getenv("KERF_SHARED_DATA");
  if (shared == nullptr) GTEST_SKIP() << "KERF_SHARED_DATA is not set";
  const TestFolder folder;
  KerfCall call;
  call.folder = folder.path();
  call.arguments = {"run",         std::string(shared) + "/nc/" + GetParam().file,
                    "--csv",       "rows.csv",
                    "--json",      "report.json",
                    "--engagement"};
  for (const std::string& argument : GetParam().arguments) call.arguments.push_back(argument);
  const KerfResult result = run_kerf(call);
  ASSERT_LE(result.exit_code, 1) << result.err;

  std::istringstream rows(read_file(folder.file("rows.csv")));
  std::string line;
  std::getline(rows, line);
  std::map<std::string, std::size_t> column;
  for (const std::string& name : cells_of(line)) column.emplace(name, column.size());
  std::map<int, double> air_s;
  std::size_t count = 0;
  for (; std::getline(rows, line); ++count) {
    const std::vector<std::string> cells = cells_of(line);
    ASSERT_EQ(cells.size(), column.size()) << line;
    const std::string& air = cells[column["air_s"]];
    if (air.empty()) continue;
    EXPECT_LE(std::stod(air), std::stod(cells[column["duration_s"]]) + 2e-6) << line;
    air_s[std::stoi(cells[column["tool"]])] += std::stod(air);
  }
  const Json report = Json::parse(read_file(folder.file("report.json")));
  const Json& tools = report.at("engagement").at("tools");
  ASSERT_FALSE(tools.empty());
  for (const Json& tool : tools) {
    EXPECT_GT(tool.at("air_s").get<double>(), 0.1) << "it says nothing";
    EXPECT_NEAR(air_s[tool.at("tool").get<int>()], tool.at("air_s").get<double>(),
                1e-5 + 1e-6 * static_cast<double>(count))
        << tool.dump();
  }
}

INSTANTIATE_TEST_SUITE_P(Real, MotionRows,
                         testing::Values(Program{"mill3/lagun-linuxcnc__clamp.ngc",
                                                 {"--stock", "box:-92,-23,-16:92,23,16", "--cell",
                                                  "0.4", "--tool", "1=flat:12.7"}},
                                         Program{"mill3/linuxcnc__3D_Chips.ngc",
                                                 {"--stock", "box:-52,-56,-31:53,56,0", "--cell",
                                                  "0.5", "--tool", "1=ball:6"}},
                                         Program{"lathe/linuxcnc__lathe_g70_71_demo.ngc", {}}));

}  // namespace
}  // namespace kerf
