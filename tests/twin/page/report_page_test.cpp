#include "twin/page/report_page.h"

#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <regex>
#include <string>
#include <utility>
#include <vector>

#include "stock/blank.h"
#include "stock/cutter/shape_spec.h"
#include "stock/zmap/zmap.h"
#include "tests/base/temporary_folder.h"
#include "twin/job/load_text.h"
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

/// A tool that has cut for 12 s, of which all is known.
Report report_with_loads() {
  Report report = report_of("part.ngc");
  report.material.emplace().name = "steel-mild";
  ToolUse& tool = report.tools.front();
  tool.teeth = 4;
  tool.chip.add(0.0625, 0.05, 12, {0, 12});
  auto loads = std::make_shared<ToolLoads>();
  const auto spread = [](LoadSpread& into, double usual, double most) {
    into.add(usual, 9, {0, 11}, Vec3(5, 6, -7));
    into.add(most, 3, {0, 12}, Vec3(1, 2, -3));
  };
  spread(loads->chip_mm, 0.0213, 0.0487);
  spread(loads->speed_m_per_min, 61.7, 62.8);
  loads->has_forces = loads->has_bend = true;
  spread(loads->force_n, 143, 287);
  loads->force_most_n = {191, 287, 402};
  spread(loads->torque_nm, 0.43, 0.861);
  loads->torque_most_nm = {0.573, 0.861, 1.21};
  spread(loads->power_kw, 0.09, 0.18);
  loads->power_most_kw = {0.12, 0.18, 0.252};
  spread(loads->bend_mm, 0.0031, 0.00624);
  loads->bend_most_mm = {0.00415, 0.00624, 0.0262};
  spread(loads->wall_mm, 0.001, 0.002);
  loads->wall_most_mm = {-0.004, -0.002, -0.001};
  tool.loads = loads;
  EngagementOfTool engaged;
  engaged.tool = 7;
  engaged.diameter_mm = 6;
  engaged.passes = 3;
  engaged.sums.cut_mm = 100;
  engaged.sums.wide_sum_mm2 = 350;
  engaged.sums.wide_most_mm = 6;
  engaged.sums.angle_sum = 100 * kPi / 2;
  engaged.sums.angle_most_rad = kPi;
  engaged.sums.deep_sum_mm2 = 200;
  engaged.sums.deep_most_mm = 2.5;
  engaged.sums.full_mm = 25;
  engaged.sums.climb_mm = 75;
  engaged.feed_mm = 125;
  engaged.air_mm = 25;
  engaged.air_s = 1.5;
  report.engagement.emplace().tools.push_back(engaged);
  return report;
}

/// The cells of the row that begins with these, without what stands around them.
std::vector<std::string> row_of(const std::string& page, const std::string& begin) {
  std::vector<std::string> cells;
  const std::size_t from = page.find(begin);
  if (from == std::string::npos) return cells;
  const std::string row = page.substr(from, page.find("</tr>", from) - from);
  const std::regex cell("<td(?: class=\"n\")?>(.*?)</td>");
  for (std::sregex_iterator it(row.begin(), row.end(), cell); it != std::sregex_iterator(); ++it)
    cells.push_back((*it)[1]);
  return cells;
}

/// Page, summary and JSON have one set of figures; the page rounds them as the summary does.
TEST(ReportPage, LoadsAreThoseOfTheJsonAndOfTheSummary) {
  const Report report = report_with_loads();
  const std::string page = report_page(report, nullptr);
  const std::string summary = summary_text(report);
  const nlohmann::json json = nlohmann::json::parse(json_text(report));
  const nlohmann::json& tool = json["tools"][0]["engagement"];
  struct Quantity {
    const char* title;
    const char* name;
    const char* key_unit;
    const char* unit;
    bool has_range;
  };
  for (const Quantity& one : {Quantity{"Chip thickness", "chip", "mm", "mm", false},
                              Quantity{"Cutting speed", "speed", "m_min", "m/min", false},
                              Quantity{"Force", "force", "n", "N", true},
                              Quantity{"Torque, most of a turn", "torque", "nm", "Nm", true},
                              Quantity{"Power", "power", "kw", "kW", true},
                              Quantity{"Deflection of its tip", "deflection", "mm", "mm", true},
                              Quantity{"Wall off by", "wall", "mm", "mm", true}}) {
    const std::vector<std::string> cells = row_of(page, std::string("<td>") + one.title + "</td>");
    ASSERT_EQ(cells.size(), 6u) << one.title;
    const auto key = [&](const char* what) {
      return tool.at(std::string(one.name) + "_" + what + "_" + one.key_unit);
    };
    const auto shown = [&](const nlohmann::json& value) {
      return load_text(value.get<double>()) + " " + one.unit;
    };
    EXPECT_EQ(cells[1], shown(key("p50"))) << one.title;
    EXPECT_EQ(cells[2], shown(key("p95"))) << one.title;
    EXPECT_EQ(cells[3], shown(key("max"))) << one.title;
    if (one.has_range)
      EXPECT_EQ(cells[4], shown(key("range")[0]) + " to " + shown(key("range")[1])) << one.title;
    else
      EXPECT_EQ(cells[4], "") << one.title;
    EXPECT_TRUE(has(
        cells[5], ">" + std::to_string(tool.at(std::string(one.name) + "_line").get<int>()) + "<"))
        << cells[5];
  }
  EXPECT_TRUE(has(summary, "287 N (191 to 402, line 12)"));
  EXPECT_TRUE(has(summary, "0.861 Nm (0.573 to 1.21, line 12)"));
  EXPECT_TRUE(has(summary, "0.18 kW (0.12 to 0.252, line 12)"));
  const std::vector<std::string> tooth = row_of(page, "<td>Feed per tooth</td>");
  ASSERT_EQ(tooth.size(), 6u);
  EXPECT_EQ(tooth[1], "mean " + load_text(tool["feed_per_tooth_mean_mm"].get<double>()) + " mm");
  EXPECT_EQ(tooth[3], load_text(tool["feed_per_tooth_mm"].get<double>()) + " mm");
  EXPECT_TRUE(has(page, "<td class=\"n\">0.05 mm / 0.0625 mm</td>")) << "beside the other tools";
  // How it was engaged.
  const nlohmann::json& engaged = json["engagement"]["tools"][0];
  const std::vector<std::string> row = row_of(page, "<td>T7</td><td class=\"n\">3</td>");
  ASSERT_EQ(row.size(), 10u);
  EXPECT_EQ(row[2], "90° / 180°");
  EXPECT_EQ(engaged["angle_deg"]["mean"], 90);
  EXPECT_EQ(row[3], "3.5 mm / 6 mm");
  EXPECT_EQ(engaged["ae_mm"]["mean"], 3.5);
  EXPECT_EQ(row[4], "2 mm / 2.5 mm");
  EXPECT_EQ(row[5], "25 %");
  EXPECT_EQ(row[6], "75 %");
  EXPECT_TRUE(has(row[9], "20 %"));
  // Lines lead to their places.
  const nlohmann::json data = data_of(page);
  ASSERT_GE(data["spots"].size(), 8u);
  EXPECT_TRUE(data["spots"][0][2].is_null()) << "of feeds per tooth the line alone is known";
  EXPECT_EQ(data["spots"][1], nlohmann::json::parse("[0, 12, [1.0, 2.0, -3.0]]"));
  EXPECT_EQ(data["files"][0], "part.ngc");
}

TEST(ReportPage, WithoutTeethAndEngagementThereIsNoSectionOfThem) {
  const std::string page = report_page(report_of("part.ngc"), nullptr);
  EXPECT_FALSE(has(page, "How the tools cut"));
  EXPECT_FALSE(has(page, "Feed per tooth"));
  EXPECT_TRUE(data_of(page)["spots"].empty());
}

TEST(ReportPage, LoadsInInchesKeepTheirFigures) {
  PageOptions inches;
  inches.units = LengthUnit::kInch;
  const std::string page = report_page(report_with_loads(), nullptr, inches);
  const std::vector<std::string> chip = row_of(page, "<td>Chip thickness</td>");
  ASSERT_EQ(chip.size(), 6u);
  EXPECT_TRUE(chip[3].ends_with(" in")) << chip[3];
  EXPECT_NEAR(std::stod(chip[3]), 0.0487 / 25.4, 0.00005);
  EXPECT_EQ(row_of(page, "<td>Force</td>")[3], "287 N");
}

TEST(ReportPage, CurvesOfLoadsHaveTheirLimitAndLeadToLines) {
  PageOptions options;
  options.curves.step_s = 0.5;
  options.curves.removed_mm3_per_s.assign(200, 3);
  PageCurves::Load power;
  power.kind = LoadKind::kPower;
  power.step_s = 0.5;
  power.nominal.assign(200, 1.0);
  power.nominal[50] = 80;
  power.high.assign(200, 1.4);
  power.high[50] = 110;
  power.limit = 1.2;
  options.curves.loads.push_back(power);
  for (std::uint32_t i = 0; i < 200; ++i)
    options.curves.spots.push_back({{0, i / 10}, Vec3(i, 0, -1)});
  const std::string page = report_page(report_of("part.ngc"), nullptr, options);
  EXPECT_TRUE(has(page, "Power, 80 kW (may be 110); peaks beyond 1.4 are cut off; limit 1.2 kW"));
  EXPECT_TRUE(has(page, "stroke-dasharray")) << "the limit";
  const nlohmann::json data = data_of(page);
  ASSERT_EQ(data["columns"].size(), 200u);
  EXPECT_EQ(data["columns"][123], nlohmann::json::parse("[0, 12, [123.0, 0.0, -1.0]]"));
  EXPECT_TRUE(has(page, "A click on a curve"));
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
