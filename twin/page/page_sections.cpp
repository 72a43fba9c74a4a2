#include "twin/page/page_sections.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "base/translate.h"
#include "twin/job/load_text.h"
#include "twin/page/page_curve.h"
#include "twin/page/section_text.h"
#include "twin/report/compare_report.h"
#include "twin/report/finding_lists.h"
#include "twin/report/report_words.h"
#include "twin/report/rest_report.h"
#include "twin/report/shown_lengths.h"

namespace kerf {
namespace {

using Facts = std::vector<std::pair<std::string, std::string>>;

const char* class_of(const FindingLog& log) {
  if (log.count(Severity::kError) > 0) return "verdict error";
  return log.count(Severity::kWarning) > 0 ? "verdict warning" : "verdict";
}

std::string box_text(const Box& box) {
  return fmt::format("X{:.4g}..{:.4g} Y{:.4g}..{:.4g} Z{:.4g}..{:.4g}", box.min.x, box.max.x,
                     box.min.y, box.max.y, box.min.z, box.max.z);
}

/// Where the zero of the work offset lies on the blank: what is set at the machine.
std::string zero_text(const Box& box) {
  if (box.empty()) return {};
  const auto place = [](double low, double high, const char* at_low, const char* middle,
                        const char* at_high, const char* axis) {
    constexpr double kSame_mm = 0.005;
    if (std::abs(low) < kSame_mm) return std::string(at_low);
    if (std::abs(high) < kSame_mm) return std::string(at_high);
    if (std::abs(low + high) < 2 * kSame_mm) return std::string(middle);
    return trf("{}: {:.3f} mm from the lower end", axis, -low);
  };
  return place(box.min.x, box.max.x, tr("left edge"), tr("middle in X"), tr("right edge"), "X") +
         ", " +
         place(box.min.y, box.max.y, tr("front edge"), tr("middle in Y"), tr("back edge"), "Y") +
         ", " + place(box.min.z, box.max.z, tr("underside"), tr("half its height"), tr("top"), "Z");
}

std::string name_of_tool(const ToolUse& use) { return fmt::format("T{}", use.number); }

/// As the tool table has it: along Z, and along all axes where others count as well (a lathe).
std::string length_text(const ToolUse& use) {
  if (!use.offset_mm) return {};
  const auto& [x, y, z] = *use.offset_mm;
  if (x == 0 && y == 0) return fmt::format("{:.3f} mm", z);
  return y == 0 ? fmt::format("X{:.3f} Z{:.3f} mm", x, z)
                : fmt::format("X{:.3f} Y{:.3f} Z{:.3f} mm", x, y, z);
}

}  // namespace

std::string head_section(const Report& report, const PageOptions& options) {
  const std::string name =
      report.program_path.empty() && report.live ? report.live->source : report.program_path;
  std::string out = fmt::format("<header><h1>{}</h1>\n",
                                xml_text(options.heading.empty() ? name : options.heading));
  out += fmt::format("<p><span class=\"{}\">{}</span></p>\n", class_of(report.findings),
                     xml_text(verdict_text(report.findings)));
  if (!report.partial_reason.empty()) {
    out += fmt::format(
        "<p><b>{}</b></p>\n",
        xml_text(trf("Partial: {}. All here is of the part that was run.", report.partial_reason)));
  }
  Facts facts;
  if (!options.heading.empty()) facts.emplace_back(tr("Program"), name);
  const MotionTotals& m = report.motion;
  facts.emplace_back(tr("Time"), duration_text(m.duration_s));
  facts.emplace_back(tr("Way"), trf("feed {}, traverse {}", distance_text(m.feed_mm),
                                    distance_text(m.traverse_mm)));
  if (report.stock) {
    const StockReport& s = *report.stock;
    const double removed = s.blank_mm3 - s.remaining_mm3;
    facts.emplace_back(tr("Removed"),
                       trf("{} of {} ({:.1f} %)", volume_text(removed), volume_text(s.blank_mm3),
                           s.blank_mm3 > 0 ? 100 * removed / s.blank_mm3 : 0));
  }
  if (report.lines.from > 0 || report.lines.until > 0) {
    facts.emplace_back(tr("Lines"),
                       fmt::format("{} .. {}", report.lines.from > 0 ? report.lines.from : 1,
                                   report.lines.until > 0 ? fmt::format("{}", report.lines.until)
                                                          : std::string(tr("end"))));
  }
  out += "<dl class=\"facts\">\n";
  for (const auto& [key, value] : facts) {
    out += fmt::format("<dt>{}</dt><dd>{}</dd>\n", xml_text(key),
                       xml_text(in_unit(value, options.units)));
  }
  return out + "</dl></header>\n";
}

std::string finding_list(const Report& report, LengthUnit units) {
  std::string out = "<div class=\"findings\">\n";
  const auto& kept = report.findings.kept();
  for (std::size_t i = 0; i < std::min(kept.size(), kMostOnPage); ++i) {
    const Finding& finding = kept[i];
    Diagnostic d = in_unit(diagnostic_of(finding, report.program.files), units);
    std::string message = in_unit(message_of(finding), units);
    std::string place = d.line > 0 ? fmt::format("{}:{}", d.file, d.line) : d.file;
    if (finding.time_s) place += (place.empty() ? "" : ", ") + duration_text(*finding.time_s);
    out += fmt::format("<button type=\"button\" class=\"{}\"><b>{}</b> {}",
                       to_string(finding.severity), xml_text(to_string(finding.id)),
                       xml_text(message));
    if (!place.empty()) out += fmt::format("<small>{}</small>", xml_text(place));
    if (!d.hint.empty()) out += fmt::format("<small>{}</small>", xml_text(d.hint));
    out += "</button>\n";
  }
  if (kept.empty())
    out += fmt::format("<p class=\"soft\">&nbsp;{}</p>\n", xml_text(tr("no findings")));
  if (report.findings.total() > std::min(kept.size(), kMostOnPage)) {
    out += fmt::format(
        "<p class=\"soft\">&nbsp;{}</p>\n",
        xml_text(trf("and {} more", report.findings.total() - std::min(kept.size(), kMostOnPage))));
  }
  return out + "</div>\n";
}

std::string setup_section(const Report& report, const PageOptions& options, bool has_view) {
  if (!report.stock) return {};
  const StockReport& s = *report.stock;
  SectionText out(tr("Set-up"), options.units);
  Facts facts;
  facts.emplace_back(tr("Blank"), fmt::format("{} ({})", s.description, s.origin));
  if (!report.turning) facts.emplace_back(tr("Zero point"), zero_text(s.bounds_mm));
  facts.emplace_back(tr("Its ends"), box_text(s.bounds_mm) + " mm");
  std::string order;
  for (const ToolUse& use : report.tools) order += (order.empty() ? "" : ", ") + name_of_tool(use);
  if (!order.empty()) facts.emplace_back(tr("Tools"), order);
  out.facts(facts);
  if (has_view) {
    std::string pictures = "<div class=\"sheet\">";
    for (const char* view : {"iso", "top", "front"})
      pictures += fmt::format("<img alt=\"\" data-view=\"{}\">", view);
    out.raw(pictures + "</div>\n");
  }
  return std::move(out).done();
}

std::string tool_section(const Report& report, LengthUnit units) {
  if (report.tools.empty()) return {};
  SectionText out(tr("Tools, in their order"), units);
  const bool has_lengths = std::ranges::any_of(
      report.tools, [](const ToolUse& use) { return use.offset_mm.has_value(); });
  std::vector<PageColumn> columns{{tr("Tool")}, {tr("Shape")}};
  if (has_lengths) columns.push_back({tr("Length"), true});
  for (const PageColumn& column : {PageColumn{tr("Known from")},
                                   {tr("Cutting"), true},
                                   {tr("Way"), true},
                                   {tr("Removed"), true},
                                   {tr("Deepest"), true},
                                   {tr("Peak rate"), true}})
    columns.push_back(column);
  const bool has_teeth =
      std::ranges::any_of(report.tools, [](const ToolUse& use) { return use.chip.is_known(); });
  if (has_teeth) columns.push_back({tr("Feed per tooth, mean / most"), true});
  out.table(columns);
  for (const ToolUse& use : report.tools) {
    const bool is_known = !use.shape.empty();
    std::vector<std::string> cells{
        name_of_tool(use), is_known ? use.shape : std::string(tr("undefined, did not cut"))};
    if (has_lengths) cells.push_back(length_text(use));
    cells.push_back(use.guessed ? tr("guessed from ") + use.origin : use.origin);
    if (is_known) {
      for (std::string& cell :
           std::array{duration_text(use.cut_s), distance_text(use.feed_mm),
                      volume_text(use.removed_mm3), fmt::format("{:.2f} mm", use.max_depth_mm),
                      fmt::format("{:.1f} mm3/s", use.peak_mm3_per_s)})
        cells.push_back(std::move(cell));
      if (has_teeth)
        cells.push_back(use.chip.is_known()
                            ? fmt::format("{} mm / {} mm", load_text(use.chip.mean_mm()),
                                          load_text(use.chip.most_mm))
                            : std::string());
    }
    out.row(cells);
  }
  out.end_table();
  return std::move(out).done();
}

std::string collision_section(const Report& report, LengthUnit units) {
  if (report.collisions.empty()) return {};
  SectionText out(tr("Collisions and clearances"), units);
  out.table({{tr("What")},
             {tr("Against")},
             {tr("Contacts"), true},
             {tr("Least clearance"), true},
             {tr("Line"), true}});
  for (const CollisionPair& pair : report.collisions) {
    const std::string what =
        pair.first.empty() ? trf("{} of tool {}", name_of(pair.part), pair.tool) : pair.first;
    const std::string clearance =
        pair.contacts > 0         ? std::string(tr("touches"))
        : pair.least_clearance_mm ? fmt::format("{:.2f} mm", *pair.least_clearance_mm)
        : pair.clearance_above_mm ? trf("above {:.2f} mm", *pair.clearance_above_mm)
                                  : std::string(tr("not measured"));
    out.row({what, pair.other.empty() ? std::string(tr("workpiece")) : pair.other,
             fmt::format("{}", pair.contacts), clearance,
             pair.source.line > 0 ? fmt::format("{}", pair.source.line) : std::string()});
  }
  out.end_table();
  return std::move(out).done();
}

std::string compare_section(const Report& report, LengthUnit units) {
  SectionText out(tr("Against the design"), units);
  if (report.comparison) out.pre(compare_text(*report.comparison));
  if (report.rest) out.pre(rest_text(*report.rest));
  return std::move(out).done();
}

std::string part_section(const Report& report, LengthUnit units) {
  SectionText out(tr("What was made"), units);
  if (report.sheet) out.pre(sheet_text(*report.sheet));
  if (report.turning) out.pre(turning_text(*report.turning));
  return std::move(out).done();
}

namespace {

std::string load_svg(const PageCurves::Load& load, LengthUnit units) {
  struct Look {
    const char* title;
    const char* unit;
    const char* color;
    bool is_length = false;
  };
  const std::array<Look, kLoadKinds> looks{{{tr("Engagement"), "°", "#4b5c8a"},
                                            {tr("Chip thickness"), "mm", "#7a4b8a", true},
                                            {tr("Force"), "N", "#8a4b3c"},
                                            {tr("Torque, mean of a turn"), "Nm", "#3c7a6f"},
                                            {tr("Power"), "kW", "#6b6a1f"},
                                            {tr("Deflection"), "mm", "#5d5d66", true}}};
  const Look& look = looks[static_cast<std::size_t>(load.kind)];
  const bool in_inches = look.is_length && units == LengthUnit::kInch;
  const double factor = in_inches ? from_mm(1, units) : 1;
  std::vector<double> nominal(load.nominal), high(load.high);
  for (double& value : nominal) value *= factor;
  for (double& value : high) value *= factor;
  return curve_svg({look.title, in_inches ? name_of(units) : look.unit, look.color, load.step_s,
                    nominal, high, load.limit * factor});
}

}  // namespace

std::string curve_section(const PageCurves& curves, LengthUnit units) {
  const bool inch = units == LengthUnit::kInch;
  constexpr double kInch_mm = 25.4;
  const auto scaled = [](const std::vector<double>& values, double factor) {
    std::vector<double> out(values);
    for (double& value : out) value *= factor;
    return out;
  };
  const std::vector<double> rates =
      scaled(curves.removed_mm3_per_s, inch ? 60 / (kInch_mm * kInch_mm * kInch_mm) : 1);
  const std::vector<double> feeds = scaled(curves.feed_mm_per_min, inch ? 1 / kInch_mm : 1);
  SectionText out(tr("Over its time"), units);
  out.raw(curve_svg(
      {tr("Material removed"), inch ? "in3/min" : "mm3/s", "#2f6690", curves.step_s, rates}));
  out.raw(curve_svg(
      {tr("Speed of feed moves"), inch ? "in/min" : "mm/min", "#1d7a46", curves.step_s, feeds}));
  out.raw(curve_svg({tr("Spindle"), tr("rpm"), "#9a5b00", curves.step_s, curves.spindle_rpm}));
  for (const PageCurves::Load& load : curves.loads) out.raw(load_svg(load, units));
  if (!curves.spots.empty())
    out.paragraph(tr("A click on a curve shows the line that was run then, and its place."));
  return std::move(out).done();
}

std::string exactness_section(const Report& report, const PageOptions& options,
                              const std::string& mesh) {
  SectionText out(tr("How exact this is, and how to make it again"), options.units);
  Facts facts;
  if (report.stock) {
    const StockReport& s = *report.stock;
    if (report.sheet || report.turning) {
      facts.emplace_back(tr("Model"), s.model);
    } else {
      facts.emplace_back(tr("Model"), trf("{}, cells of {:.4g} mm", s.model, s.cell_mm));
    }
  }
  facts.emplace_back(tr("Times"), report.time_model);
  if (!mesh.empty()) facts.emplace_back(tr("3D view"), mesh);
  for (const GuessRow& row : rows_in(report.guesses, options.units)) {
    facts.emplace_back(
        trf("Guessed: {}", row.what),
        row.reason.empty() ? row.value : fmt::format("{} ({})", row.value, row.reason));
  }
  facts.emplace_back("kerf", report.version);
  if (!report.program.interpreter.empty())
    facts.emplace_back(tr("Interpreter"), report.program.interpreter);
  if (report.stock) facts.emplace_back(tr("Digest of the workpiece"), report.stock->digest);
  out.facts(facts);
  if (!options.command.empty()) out.raw(fmt::format("<pre>{}</pre>\n", xml_text(options.command)));
  return std::move(out).done();
}

}  // namespace kerf
