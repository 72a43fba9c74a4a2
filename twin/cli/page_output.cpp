#include "twin/cli/page_output.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "base/atomic_file.h"
#include "twin/page/page_mesh.h"
#include "twin/page/page_printer.h"
#include "twin/page/report_page.h"
#include "twin/scene/cut_colors.h"
#include "twin/scene/value_colors.h"
#include "viewer/deviation_colors.h"

namespace kerf {
namespace {

/// 0xAABBGGRR as "#rrggbb".
std::string web_color(std::uint32_t color) {
  return fmt::format("#{:02x}{:02x}{:02x}", color & 0xff, color >> 8 & 0xff, color >> 16 & 0xff);
}

/// In the middle of each class.
std::array<std::string, kDeviationClasses> deviation_colors(double tolerance_mm) {
  std::array<std::string, kDeviationClasses> out;
  for (std::size_t i = 0; i < out.size(); ++i) {
    constexpr std::array kTolerances{-3.0, -1.5, 0.0, 1.5, 3.0};
    const auto [red, green, blue] = deviation_rgb(kTolerances[i] * tolerance_mm, tolerance_mm);
    out[i] = fmt::format("#{:02x}{:02x}{:02x}", red, green, blue);
  }
  return out;
}

PageCurves curves_of(const RunCurve& curve) {
  PageCurves out;
  out.step_s = curve.step_s();
  for (const RunCurve::Column& column : curve.columns()) {
    out.removed_mm3_per_s.push_back(column.removed_mm3 / curve.step_s());
    out.feed_mm_per_min.push_back(column.feed_s > 0 ? 60 * column.feed_mm / column.feed_s : 0);
    out.spindle_rpm.push_back(60 * column.turns / curve.step_s());
    PageSpot& spot = out.spots.emplace_back();
    if (column.motion_s > 0) spot = {column.source, column.at_mm};
  }
  return out;
}

/// In the columns of the others, which are no finer.
void add_loads(const LoadCurve& found, const CuttingWish& wish, PageCurves& curves) {
  const std::size_t count = curves.removed_mm3_per_s.size();
  for (std::size_t k = 0; k < kLoadKinds; ++k) {
    const auto kind = static_cast<LoadKind>(k);
    const auto nominal = found.nominal(kind), high = found.high(kind);
    if (nominal.empty() || count == 0) continue;
    PageCurves::Load& load = curves.loads.emplace_back();
    load.kind = kind;
    load.step_s = curves.step_s;
    load.limit = limit_of(static_cast<CutLoadKind>(k), wish);
    load.nominal.resize(count);
    if (needs_material(static_cast<CutLoadKind>(k))) load.high.resize(count);
    for (std::size_t i = 0; i < nominal.size(); ++i) {
      const double begin_s = static_cast<double>(i) * found.step_s();
      const auto at = std::min(count - 1, static_cast<std::size_t>(begin_s / curves.step_s + 1e-9));
      load.nominal[at] = std::max(load.nominal[at], static_cast<double>(nominal[i]));
      if (!load.high.empty()) load.high[at] = std::max(load.high[at], static_cast<double>(high[i]));
    }
  }
}

void note(const Done& done, Diagnostics& diagnostics) {
  if (done) return;
  Diagnostic d;
  d.message = done.error();
  diagnostics.push_back(std::move(d));
}

/// `group_of` reads `facts`, which must live as long.
PageOptions options_of(const Report& report, const PageFacts& facts) {
  PageOptions options;
  options.units = facts.units;
  options.command = facts.command;
  if (facts.curve) options.curves = curves_of(*facts.curve);
  if (facts.curve && facts.loads) add_loads(*facts.loads, facts.cutting, options.curves);
  // By number, as cuts are: of one with several shapes all are named.
  std::vector<int> numbers;
  for (const ToolUse& use : report.tools) {
    const auto known = std::find(numbers.begin(), numbers.end(), use.number);
    if (known != numbers.end()) {
      options.groups[static_cast<std::size_t>(known - numbers.begin())].name += ", " + use.shape;
      continue;
    }
    if (options.groups.size() == kNoGroup) break;
    numbers.push_back(use.number);
    options.groups.push_back(
        {legend_text({use.number, use.shape}), web_color(color_of_number(options.groups.size()))});
  }
  if (facts.design && report.comparison) {
    const double tolerance_mm = report.comparison->tolerance_mm;
    options.design = {facts.design, tolerance_mm, deviation_colors(tolerance_mm)};
  }
  if (facts.labels.empty()) return options;
  options.group_of = [&facts, numbers](std::uint32_t label) {
    if (label >= facts.labels.size()) return kNoGroup;
    const auto known = std::find(numbers.begin(), numbers.end(), facts.labels[label].tool);
    return known == numbers.end() ? kNoGroup : static_cast<std::uint8_t>(known - numbers.begin());
  };
  return options;
}

}  // namespace

std::string article_of(const Report& report, const StockModel* stock, const PageFacts& facts,
                       const std::string& heading, const std::string& anchor) {
  PageOptions options = options_of(report, facts);
  options.heading = heading;
  options.anchor = anchor;
  return page_article(report, stock, options);
}

void write_page(const OutputPaths& paths, const std::string& page, Diagnostics& diagnostics) {
  if (!paths.html.empty()) note(write_text(paths.html, page), diagnostics);
  if (!paths.pdf.empty()) note(print_page(page, paths.pdf), diagnostics);
}

void write_pages(const OutputPaths& paths, const Report& report, const StockModel* stock,
                 const PageFacts& facts, Diagnostics& diagnostics) {
  if (!paths.wants_page()) return;
  write_page(paths, report_page(report, stock, options_of(report, facts)), diagnostics);
}

}  // namespace kerf
