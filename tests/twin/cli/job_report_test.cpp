// kerf job: its page, its table, and what it refuses.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <sstream>
#include <utility>

#include "tests/twin/cli/kerf_process.h"

namespace kerf {
namespace {

std::string plunge_with_offset(int tool, double x, double y, double z) {
  return fmt::format(
      "G21 G90 G17\nT{0} M6\nG43 H{0}\nS3000 M3\nG0 X{1} Y{2} Z5\nG1 Z{3} F200\n"
      "G0 Z20\nM30\n",
      tool, x, y, z);
}

class JobReport : public testing::Test {
 protected:
  void SetUp() override {
    folder_.write("top.ngc", plunge_with_offset(1, 10, 10, -5));
    folder_.write("bottom.ngc", plunge_with_offset(7, 10, 20, -8));
    folder_.write("tool.tbl", "T1 P1 D8 Z52.5 ;flat:8\nT7 P7 D6 Z40.125 ;flat:6\n");
    folder_.write("job.yaml",
                  "setups:\n"
                  "  - {program: top.ngc, stock: 'box:0,0,-20:40,30,0', tools: 1=flat:8, name: top,"
                  " tool_table: tool.tbl, time_s: 600}\n"
                  "  - {program: bottom.ngc, tools: 7=flat:6, flip: x, zero: top, tool_table: "
                  "tool.tbl}\n");
  }
  KerfResult job(std::vector<std::string> arguments) const {
    KerfCall call;
    call.arguments = std::move(arguments);
    call.arguments.insert(call.arguments.begin(), "job");
    call.folder = folder_.path();
    return run_kerf(call);
  }
  void check_page(const std::string& page) const;
  void check_table() const;

  TestFolder folder_;
};

/// All setups one after the other.
void JobReport::check_page(const std::string& page) const {
  const auto has = [&page](const std::string& text) {
    return page.find(text) != std::string::npos;
  };
  EXPECT_TRUE(has("<a href=\"#setup-1\">setup 1 of 2: top</a>"));
  EXPECT_TRUE(has("<a href=\"#setup-2\">setup 2 of 2</a>"));
  const std::size_t first = page.find("<article id=\"setup-1\">");
  const std::size_t second = page.find("<article id=\"setup-2\">");
  ASSERT_NE(first, std::string::npos);
  ASSERT_NE(second, std::string::npos);
  EXPECT_LT(first, second);
  EXPECT_NE(page.find("<h1>setup 1 of 2: top</h1>"), std::string::npos);
  EXPECT_TRUE(has("<td>flipped about X, Z0 on top</td>"));
  EXPECT_TRUE(has("what setup 1 (top) has left, flipped about X, Z0 on top (the job)"));
  EXPECT_TRUE(has("<dt>setting up</dt><dd>10 min 00 s</dd>"));
  // Of each setup its own part.
  const std::string begin = "<script class=\"kerf-data\" type=\"application/json\">";
  std::vector<nlohmann::json> parts;
  for (std::size_t at = 0; (at = page.find(begin, at)) != std::string::npos;) {
    at += begin.size();
    parts.push_back(nlohmann::json::parse(page.substr(at, page.find("</script>", at) - at)));
  }
  ASSERT_EQ(parts.size(), 2u);
  EXPECT_NE(parts[0]["mesh"]["places"], parts[1]["mesh"]["places"]);
  EXPECT_EQ(parts[1]["groups"][0]["name"], "T7 flat:6");
  // Lengths are those of the tool table.
  EXPECT_TRUE(has("<td>T1</td><td>flat:8</td><td class=\"n\">52.500 mm</td>"));
  EXPECT_TRUE(has("<td>T7</td><td>flat:6</td><td class=\"n\">40.125 mm</td>"));
}

/// The motions of all setups.
void JobReport::check_table() const {
  std::istringstream in(read_file(folder_.file("job.csv")));
  std::string line;
  ASSERT_TRUE(std::getline(in, line));
  EXPECT_TRUE(line.starts_with("line,file,type,")) << line;
  EXPECT_TRUE(line.ends_with(",removed_mm3_per_s,setup\r")) << line;
  const auto columns = std::ranges::count(line, ',');
  int rows[3] = {};
  while (std::getline(in, line)) {
    EXPECT_EQ(std::ranges::count(line, ','), columns) << line;
    const bool is_first = line.ends_with(",1\r");
    EXPECT_TRUE(is_first || line.ends_with(",2\r")) << line;
    EXPECT_NE(line.find(is_first ? "top.ngc" : "bottom.ngc"), std::string::npos) << line;
    ++rows[is_first ? 1 : 2];
  }
  EXPECT_GT(rows[1], 2);
  EXPECT_EQ(rows[1], rows[2]);
}

TEST_F(JobReport, there_is_one_page_and_one_table_of_all_setups) {
  const KerfResult done =
      job({"job.yaml", "--quiet", "--html", "job.html", "--csv", "job.csv", "--json", "job.json"});
  ASSERT_EQ(done.exit_code, 0) << done.err;
  check_page(read_file(folder_.file("job.html")));
  check_table();
  const auto report = nlohmann::json::parse(read_file(folder_.file("job.json")));
  EXPECT_EQ(report["setups"][1]["tools"][0]["offset_mm"], nlohmann::json({0.0, 0.0, 40.125}));
}

TEST_F(JobReport, outputs_of_one_run_are_refused) {
  for (const char* const option : {"--dxf", "--svg", "--finding-png", "--view", "--draw"}) {
    std::vector<std::string> arguments{"job.yaml", option};
    if (std::string(option) != "--view") arguments.emplace_back("x");
    const KerfResult result = job(std::move(arguments));
    EXPECT_EQ(result.exit_code, 2) << option;
    EXPECT_NE(result.err.find(
                  fmt::format("unknown option {}; kerf run has it, for a single program", option)),
              std::string::npos)
        << result.err;
  }
  const std::string all = "is for all setups, not for one",
                    one = "is for a single program, not for";
  const std::pair<const char*, std::string> keys[] = {
      {"json", all},
      {"png", all},
      {"html", all},
      {"pdf", all},
      {"csv", all},
      {"stl", all},
      {"dxf", one},
      {"junit", all},
      {"view", one},
      {"finding_png", one},
      {"compare", "is for what the last setup leaves"},
      {"htmll", "unknown key"}};
  for (const auto& [key, said] : keys) {
    folder_.write("bad.yaml", fmt::format("setups:\n  - {{program: top.ngc, {}: x}}\n", key));
    const KerfResult result = job({"bad.yaml"});
    EXPECT_EQ(result.exit_code, 2) << key;
    EXPECT_NE(result.err.find(fmt::format("bad.yaml:2:24: error: setups[1].{}: {}", key, said)),
              std::string::npos)
        << result.err;
  }
}

TEST_F(JobReport, two_outputs_to_one_file_are_a_fault) {
  const KerfResult result = job({"job.yaml", "--html", "x", "--stl", "x"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_FALSE(file_exists(folder_.file("x")));
}

}  // namespace
}  // namespace kerf
