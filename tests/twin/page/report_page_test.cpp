#include "twin/page/report_page.h"

#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <regex>
#include <string>
#include <utility>

#include "stock/blank.h"
#include "stock/cutter/shape_spec.h"
#include "stock/zmap/zmap.h"
#include "tests/base/temporary_folder.h"
#include "twin/page/page_curve.h"

namespace kerf {
namespace {

Report report_of(const std::string& program) {
  Report report;
  report.version = "0.1.0";
  report.program_path = program;
  report.program.files = {program};
  report.motion.duration_s = 75;
  report.time_model = "planned";
  StockReport stock;
  stock.model = "zmap";
  stock.description = "box 40 x 30 x 10 mm, X0..40 Y-15..15 Z-10..0";
  stock.origin = "--stock";
  stock.cell_mm = 0.2;
  stock.blank_mm3 = 12000;
  stock.remaining_mm3 = 11000;
  stock.bounds_mm = {{0, -15, -10}, {40, 15, 0}};
  stock.digest = "0123456789abcdef0123456789abcdef";
  report.stock = stock;
  ToolUse tool;
  tool.number = 7;
  tool.shape = "flat:6";
  tool.origin = "--tool";
  report.tools.push_back(tool);
  Finding finding;
  finding.id = FindingId::kRapidContact;
  finding.source = {0, 3};
  finding.time_s = 12.5;
  finding.position_mm = Vec3(1, 2, -3);
  finding.depth_mm = 0.75;
  finding.text = "traverse touches the workpiece";
  report.findings.add(finding);
  return report;
}

/// What the script of the page is given.
nlohmann::json data_of(const std::string& page) {
  const std::string begin = "<script class=\"kerf-data\" type=\"application/json\">";
  const std::size_t from = page.find(begin) + begin.size();
  return nlohmann::json::parse(page.substr(from, page.find("</script>", from) - from));
}

bool has(const std::string& page, const std::string& text) {
  return page.find(text) != std::string::npos;
}

TEST(ReportPage, TellsWhatTheReportDoes) {
  const std::string page = report_page(report_of("part.ngc"), nullptr);
  EXPECT_TRUE(has(page, "<h1>part.ngc</h1>"));
  EXPECT_TRUE(has(page, "<span class=\"verdict error\">1 error</span>"));
  EXPECT_TRUE(has(page, "1 min 15 s"));
  EXPECT_TRUE(has(page, "1.000 cm3 of 12.000 cm3 (8.3 %)"));
  EXPECT_TRUE(has(page, "<b>rapid-contact</b> traverse touches the workpiece, 0.75 mm deep"));
  EXPECT_TRUE(has(page, "left edge, middle in Y, top"));
  EXPECT_TRUE(has(page, "<td>T7</td><td>flat:6</td>"));
  EXPECT_TRUE(has(page, "0123456789abcdef0123456789abcdef"));
  EXPECT_TRUE(data_of(page)["mesh"].is_null());
}

TEST(ReportPage, AsksNothingOfANetwork) {
  const std::string page = report_page(report_of("part.ngc"), nullptr);
  EXPECT_FALSE(std::regex_search(page, std::regex("(src|href)\\s*=\\s*\"?(https?:|//|file:)")));
  EXPECT_FALSE(has(page, "fetch("));
  EXPECT_FALSE(has(page, "@import"));
  EXPECT_TRUE(has(page, "Content-Security-Policy\" content=\"default-src 'none'"));
}

TEST(ReportPage, HasTheLinesOfFindingsAndNothingThatEndsItsScript) {
  const TemporaryFolder folder;
  const std::string path = folder.path() + "/</script><b>.ngc";
  const std::string plain = folder.path() + "/part.ngc";
  std::ofstream(plain) << "G21\r\n(</script><script>alert(1)</script>)\nG0 Z-3\nM2\n";
  Report report = report_of(plain);
  report.findings.add([&] {
    Finding finding;
    finding.id = FindingId::kNoProgramEnd;
    finding.severity = Severity::kWarning;
    finding.text = "</script>&<i>";
    finding.file = path;
    return finding;
  }());
  const std::string page = report_page(report, nullptr);
  const nlohmann::json data = data_of(page);
  EXPECT_EQ(data["sources"][plain]["1"], "G21");
  EXPECT_EQ(data["sources"][plain]["2"], "(</script><script>alert(1)</script>)");
  EXPECT_EQ(data["sources"][plain]["3"], "G0 Z-3");
  EXPECT_EQ(data["findings"][0]["line"], 3);
  EXPECT_EQ(data["findings"][0]["place"][2], -3.0);
  EXPECT_TRUE(data["findings"][1]["place"].is_null());
  EXPECT_EQ(page.find("<script>alert"), std::string::npos);
  EXPECT_EQ(page.find("&<i>"), std::string::npos);
  // The two that are meant.
  std::size_t ends = 0;
  for (std::size_t at = 0; (at = page.find("</script>", at)) != std::string::npos; ++at) ++ends;
  EXPECT_EQ(ends, 2u);
}

TEST(ReportPage, ShowsInchesToWhoReadsThem) {
  PageOptions options;
  options.units = LengthUnit::kInch;
  const std::string page = report_page(report_of("part.ngc"), nullptr, options);
  EXPECT_TRUE(has(page, "0.03 in deep"));
  EXPECT_TRUE(data_of(page)["inch"]);
}

TEST(ReportPage, HasThePart) {
  ZMapOptions zmap;
  zmap.blank = *parse_blank("box:0,-15,-10:40,15,0");
  zmap.cell_mm = 0.2;
  const auto stock = ZMap::create(zmap);
  ASSERT_TRUE(stock);
  PageOptions options;
  options.groups = {{"T7 flat:6", "#56a0d2"}};
  options.curves.step_s = 1;
  options.curves.removed_mm3_per_s = {0, 5, 2};
  const std::string page = report_page(report_of("part.ngc"), stock->get(), options);
  const nlohmann::json data = data_of(page);
  EXPECT_EQ(data["groups"][0]["color"], "#56a0d2");
  EXPECT_EQ(data["box"][1][0], 40.0);
  EXPECT_FALSE(data["mesh"]["triangles"].get<std::string>().empty());
  EXPECT_TRUE(has(page, "Material removed, 5 mm3/s"));
  EXPECT_FALSE(has(page, "Speed of feed moves"));  // nothing was told of them
  EXPECT_LT(page.size(), 80'000u);                 // a box needs twelve triangles
}

TEST(PageCurve, GoesThroughItsValues) {
  const std::vector<double> values{0, 10, 5, 0};
  const std::string svg = curve_svg({"Rate", "mm3/s", "#123456", 0.5, values});
  // 984 wide from 8 on, 68 high above 90.
  EXPECT_NE(svg.find("H254.0V22.0H500.0V56.0H746.0V90.0H992.0V90Z"), std::string::npos) << svg;
  EXPECT_NE(svg.find("Rate, 10 mm3/s"), std::string::npos);
  EXPECT_EQ(curve_svg({"Rate", "mm3/s", "#123456", 0.5, std::vector<double>{0, 0}}), "");
  EXPECT_EQ(curve_svg({"Rate", "mm3/s", "#123456", 0.5, {}}), "");
}

}  // namespace
}  // namespace kerf
