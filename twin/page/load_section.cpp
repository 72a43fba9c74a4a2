#include "twin/page/load_section.h"

#include <fmt/format.h>

#include <utility>
#include <vector>

#include "base/translate.h"
#include "twin/job/load_text.h"
#include "twin/page/section_text.h"
#include "twin/report/report_words.h"

namespace kerf {
namespace {

constexpr double kDegrees = 180 / kPi;

std::string mean_and_most(double mean, double most, const char* unit) {
  return fmt::format("{0} {2} / {1} {2}", load_text(mean), load_text(most), unit);
}

std::string percent(double part, double whole) {
  return whole > 0 ? fmt::format("{:.0f} %", 100 * part / whole) : std::string();
}

void add_milled(const Engagement& engagement, SectionText& out) {
  if (engagement.tools.empty()) return;
  out.table({{tr("Tool")},
             {tr("Passes"), true},
             {tr("Angle, mean / most"), true},
             {tr("Width"), true},
             {tr("Depth"), true},
             {tr("Full slot"), true},
             {tr("In climb"), true},
             {tr("Straight down"), true},
             {tr("Removed"), true},
             {tr("Feeds in air"), true}});
  for (const EngagementOfTool& tool : engagement.tools) {
    const EngagementSums& sums = tool.sums;
    out.row({fmt::format("T{}", tool.tool), fmt::format("{}", tool.passes),
             fmt::format("{:.0f}° / {:.0f}°", kDegrees * sums.mean(sums.angle_sum),
                         kDegrees * sums.angle_most_rad),
             mean_and_most(sums.mean(sums.wide_sum_mm2), sums.wide_most_mm, "mm"),
             mean_and_most(sums.mean(sums.deep_sum_mm2), sums.deep_most_mm, "mm"),
             percent(sums.full_mm, sums.cut_mm), percent(sums.climb_mm, sums.cut_mm),
             fmt::format("{:.1f} mm", sums.plunge_mm),
             mean_and_most(sums.rate_mm3_per_s(), sums.rate_most_mm3_per_s, "mm3/s"),
             fmt::format("{}, {}", percent(tool.air_mm, tool.feed_mm), duration_text(tool.air_s))});
  }
  out.end_table();
}

void add_turned(const Engagement& engagement, SectionText& out) {
  if (engagement.turned.empty()) return;
  out.table({{tr("Tool")},
             {tr("Depth, mean / most"), true},
             {tr("Feed for each turn"), true},
             {tr("Chip"), true},
             {tr("Removed"), true},
             {tr("Feeds in air"), true}});
  for (const TurningEngagement& tool : engagement.turned) {
    out.row({fmt::format("T{}", tool.tool),
             mean_and_most(tool.mean(tool.depth_sum_mm2), tool.depth_most_mm, "mm"),
             mean_and_most(tool.mean(tool.feed_sum), tool.feed_most_mm, "mm"),
             mean_and_most(tool.mean(tool.chip_sum), tool.chip_most_mm, "mm"),
             mean_and_most(tool.rate_mm3_per_s(), tool.rate_most_mm3_per_s, "mm3/s"),
             fmt::format("{}, {}", percent(tool.air_mm, tool.feed_mm), duration_text(tool.air_s))});
  }
  out.end_table();
}

/// Of one tool; its name stands in the first row alone.
class LoadRows {
 public:
  LoadRows(const ToolUse& use, SectionText& out, PageSpots& spots)
      : name_(fmt::format("T{}", use.number)), out_(out), spots_(spots) {}

  void feed_per_tooth(const ChipLoad& chip) {
    add(tr("Feed per tooth"),
        {"", trf("mean {} mm", load_text(chip.mean_mm())), "",
         fmt::format("{} mm", load_text(chip.most_mm)), ""},
        spots_.link(chip.most_at, std::nullopt));
  }
  void spread(const char* what, const char* unit, const LoadSpread& spread,
              const ValueRange* most = nullptr) {
    const auto value = [unit](double number) {
      return fmt::format("{} {}", load_text(number), unit);
    };
    add(what,
        {"", value(spread.not_above(0.5)), value(spread.not_above(0.95)),
         value(most ? most->nominal : spread.most()),
         most ? trf("{} to {}", value(most->low), value(most->high)) : std::string()},
        spots_.link(spread.most_at(), spread.most_mm()));
  }

 private:
  void add(const char* what, std::vector<std::string> cells, const std::string& link) {
    cells.front() = what;
    cells.insert(cells.begin(), std::exchange(name_, {}));
    out_.row(cells, link);
  }

  std::string name_;
  SectionText& out_;
  PageSpots& spots_;
};

void add_loads(const Report& report, SectionText& out, PageSpots& spots) {
  bool has_any = false;
  for (const ToolUse& use : report.tools) has_any = has_any || use.chip.is_known();
  if (!has_any) return;
  out.table({{tr("Tool")},
             {""},
             {tr("Half of the time up to"), true},
             {tr("95 % up to"), true},
             {tr("Most"), true},
             {tr("That may be"), true},
             {tr("Line"), true}});
  for (const ToolUse& use : report.tools) {
    if (!use.chip.is_known()) continue;
    LoadRows rows(use, out, spots);
    rows.feed_per_tooth(use.chip);
    if (!use.loads) continue;
    const ToolLoads& loads = *use.loads;
    rows.spread(tr("Chip thickness"), "mm", loads.chip_mm);
    rows.spread(tr("Cutting speed"), "m/min", loads.speed_m_per_min);
    if (loads.has_forces) {
      rows.spread(tr("Force"), "N", loads.force_n, &loads.force_most_n);
      rows.spread(tr("Torque, most of a turn"), "Nm", loads.torque_nm, &loads.torque_most_nm);
      rows.spread(tr("Power"), "kW", loads.power_kw, &loads.power_most_kw);
    }
    if (loads.has_bend) {
      rows.spread(tr("Deflection of its tip"), "mm", loads.bend_mm, &loads.bend_most_mm);
      rows.spread(tr("Wall off by"), "mm", loads.wall_mm, &loads.wall_most_mm);
    }
  }
  out.end_table();
}

}  // namespace

std::string load_section(const Report& report, LengthUnit units, PageSpots& spots) {
  SectionText out(report.material ? trf("How the tools cut, in {}", report.material->name)
                                  : std::string(tr("How the tools cut")),
                  units);
  if (report.engagement) {
    add_milled(*report.engagement, out);
    add_turned(*report.engagement, out);
    if (report.engagement->unmeasured_mm > 0)
      out.paragraph(trf("Not measured: {:.0f} mm of feeds.", report.engagement->unmeasured_mm));
  }
  add_loads(report, out, spots);
  return std::move(out).done();
}

}  // namespace kerf
