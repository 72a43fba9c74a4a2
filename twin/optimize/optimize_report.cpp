#include "twin/optimize/optimize_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <span>

#include "base/translate.h"
#include "twin/findings/finding_json.h"
#include "twin/report/report_words.h"

namespace kerf {
namespace {

using Json = nlohmann::ordered_json;

/// Shown one by one on the page.
constexpr std::size_t kLinesShown = 6, kSharedShown = 3;
/// Less than this is no difference between the ways in which a block is run.
constexpr double kDifferent = 1.1;

std::string indent() { return std::string(10, ' '); }

double less_percent(double before, double after) {
  return before > 0 ? 100 * (1 - after / before) : 0;
}

std::string saving(double before_s, double after_s) {
  const double percent = less_percent(before_s, after_s);
  if (std::abs(percent) < 0.05) return tr("as long as before");
  return percent > 0 ? trf("{:.1f} % less", percent) : trf("{:.1f} % more", -percent);
}

std::string time_text(const OptimizeReport& report) {
  std::string out = tr("time      ");
  out += trf("{} before, {} after: {}\n", duration_text(report.before.duration_s),
             duration_text(report.after.duration_s),
             saving(report.before.duration_s, report.after.duration_s));
  for (const auto& [tool, before_s] : report.before.seconds_by_tool) {
    const auto shape = report.shapes.find(tool);
    if (shape == report.shapes.end()) continue;
    const auto after = report.after.seconds_by_tool.find(tool);
    const double after_s = after != report.after.seconds_by_tool.end() ? after->second : 0;
    out += indent() + trf("T{} {}: {} before, {} after\n", tool, shape->second,
                          duration_text(before_s), duration_text(after_s));
  }
  return out;
}

std::string peak_words(CutLimit limit, double value) {
  switch (limit) {
    case CutLimit::kChip:
      return trf("{:.4f} mm", value);
    case CutLimit::kRate:
      return trf("{:.1f} mm3/s", value);
    case CutLimit::kForce:
      return trf("{:.0f} N", value);
    case CutLimit::kPower:
      return trf("{:.3f} kW", value);
    case CutLimit::kDeflection:
      return trf("{:.4f} mm", value);
  }
  return {};
}

std::string limit_words(CutLimit limit) {
  switch (limit) {
    case CutLimit::kChip:
      return tr("thickest chip");
    case CutLimit::kRate:
      return tr("removal rate");
    case CutLimit::kForce:
      return tr("force");
    case CutLimit::kPower:
      return tr("power");
    case CutLimit::kDeflection:
      return tr("bending of the tip");
  }
  return {};
}

std::string line_words(const PeakLoad& peak) {
  return peak.at.line > 0 && peak.at.file == 0 ? trf(" (line {})", peak.at.line) : std::string();
}

std::string peaks_text(const OptimizeReport& report) {
  std::string out;
  for (const CutLimit limit : kCutLimits) {
    const PeakLoad& before = report.before.peaks[limit];
    const PeakLoad& after = report.after.peaks[limit];
    if (before.most <= 0 && after.most <= 0) continue;
    const auto& most = report.aims.most[limit];
    out += out.empty() ? tr("at most   ") : indent();
    out += trf("{}: {}{} before, {}{} after", limit_words(limit), peak_words(limit, before.most),
               line_words(before), peak_words(limit, after.most), line_words(after));
    out += most ? trf("; allowed are {}\n", peak_words(limit, *most)) : "\n";
  }
  return out;
}

std::string reason_words(FeedLeft reason, std::size_t count) {
  const auto words = [&](const char* one, const char* many) { return count == 1 ? one : many; };
  switch (reason) {
    case FeedLeft::kNone:
      break;
    case FeedLeft::kInverseTime:
      return words(tr("block with inverse time (G93)"), tr("blocks with inverse time (G93)"));
    case FeedLeft::kPerTurn:
      return words(tr("block with a feed per turn (G95)"), tr("blocks with a feed per turn (G95)"));
    case FeedLeft::kSynchronous:
      return words(tr("block that taps or cuts a thread"), tr("blocks that tap or cut threads"));
    case FeedLeft::kProbe:
      return words(tr("block that probes"), tr("blocks that probe"));
    case FeedLeft::kComputed:
      return words(tr("block whose feed is worked out (F#..)"),
                   tr("blocks whose feeds are worked out (F#..)"));
    case FeedLeft::kMissing:
      return words(tr("block without a feed"), tr("blocks without a feed"));
    case FeedLeft::kUnmeasured:
      return words(tr("block of which the tool's engagement is not known"),
                   tr("blocks of which the tool's engagement is not known"));
    case FeedLeft::kOtherFile:
      break;
    case FeedLeft::kTangled:
      return words(tr("block whose feed others run at, that stay"),
                   tr("blocks whose feeds others run at, that stay"));
  }
  return {};
}

std::string list_of(std::span<const std::uint32_t> lines) {
  std::string out;
  for (const std::uint32_t line : lines.first(std::min(lines.size(), kLinesShown)))
    out += (out.empty() ? "" : ", ") + std::to_string(line);
  return out + (lines.size() > kLinesShown ? ", .." : "");
}

std::string left_text(const OptimizeReport& report) {
  std::string out;
  for (const auto& [reason, lines] : report.left) {
    out += out.empty() ? tr("left      ") : indent();
    out +=
        trf("{} {}: line {}\n", lines.size(), reason_words(reason, lines.size()), list_of(lines));
  }
  if (report.elsewhere > 0) {
    out += out.empty() ? tr("left      ") : indent();
    out += trf("{} motions of subroutines in other files\n", report.elsewhere);
  }
  return out;
}

std::string shared_text(const OptimizeReport& report) {
  std::string out;
  for (std::size_t i = 0; i < std::min(report.shared.size(), kSharedShown); ++i) {
    const OptimizeReport::Shared& one = report.shared[i];
    out += out.empty() ? tr("shared    ") : indent();
    out +=
        trf("line {} makes {} motions: {:.0f} mm/min for the fullest cut, where the lightest "
            "could have {:.0f} mm/min\n",
            one.line, one.motions, one.slowest_mm_per_min, one.fastest_mm_per_min);
  }
  if (report.shared.size() > kSharedShown)
    out += indent() + trf("and {} lines more\n", report.shared.size() - kSharedShown);
  return out;
}

}  // namespace

void add_plan(const FeedBlocks& blocks, const FeedPlan& plan, OptimizeReport& report) {
  report.blocks = blocks.by_line.size();
  report.elsewhere = blocks.elsewhere;
  report.changed = plan.changed;
  for (const auto& [line, reason] : plan.left) report.left[reason].push_back(line);
  for (const auto& [line, block] : blocks.by_line) {
    if (block.motions < 2 || plan.left.contains(line) || !std::isfinite(block.least_limit))
      continue;
    const double fastest = std::min(block.most_limit, block.allowed);
    if (fastest < kDifferent * block.least_limit) continue;
    report.shared.push_back({line, block.motions, block.least_limit, fastest});
  }
}

std::string optimize_text(const OptimizeReport& report) {
  std::string out = tr("feeds     ");
  out += report.changed == 0
             ? trf("none of {} blocks needs another one\n", report.blocks)
             : trf("{} of {} blocks have another one\n", report.changed, report.blocks);
  if (!report.unrolled_lines.empty()) {
    out +=
        indent() + trf("{} passes of loops and {} calls are written out, {} lines; lines are "
                       "those of the new program\n",
                       report.unrolled_passes, report.unrolled_calls, report.unrolled_lines.size());
  }
  if (report.split_blocks > 0)
    out += indent() + trf("{} now, in {} pieces; lines are those of the new program\n",
                          trnf("{} block is divided", "{} blocks are divided", report.split_blocks),
                          report.split_pieces);
  out += left_text(report) + shared_text(report) + time_text(report) + peaks_text(report);
  return out;
}

std::string optimize_json(const OptimizeReport& report, const std::string& version) {
  Json limits = Json::object();
  for (const CutLimit limit : kCutLimits) {
    if (const auto& most = report.aims.most[limit]) limits[key_of(limit)] = *most;
  }
  if (report.aims.most_feed_mm_per_min)
    limits["feed_mm_per_min"] = *report.aims.most_feed_mm_per_min;
  if (report.aims.air_feed_mm_per_min)
    limits["air_feed_mm_per_min"] = *report.aims.air_feed_mm_per_min;
  Json tools = Json::array();
  for (const auto& [tool, before_s] : report.before.seconds_by_tool) {
    const auto shape = report.shapes.find(tool);
    const auto after = report.after.seconds_by_tool.find(tool);
    tools.push_back(
        {{"number", tool},
         {"shape", shape != report.shapes.end() ? Json(shape->second) : Json(nullptr)},
         {"before_s", rounded(before_s)},
         {"after_s", after != report.after.seconds_by_tool.end() ? rounded(after->second) : 0.0}});
  }
  Json peaks = Json::object();
  for (const CutLimit limit : kCutLimits) {
    const PeakLoad& before = report.before.peaks[limit];
    const PeakLoad& after = report.after.peaks[limit];
    peaks[key_of(limit)] = {{"before", rounded(before.most)},
                            {"before_line", before.at.line},
                            {"after", rounded(after.most)},
                            {"after_line", after.at.line}};
  }
  Json left = Json::array();
  for (const auto& [reason, lines] : report.left) {
    const std::size_t count = std::min(lines.size(), kMostLines);
    left.push_back(
        {{"reason", key_of(reason)},
         {"blocks", lines.size()},
         {"lines", std::vector<std::uint32_t>(
                       lines.begin(), lines.begin() + static_cast<std::ptrdiff_t>(count))}});
  }
  Json shared = Json::array();
  for (const OptimizeReport::Shared& one : report.shared) {
    shared.push_back({{"line", one.line},
                      {"motions", one.motions},
                      {"slowest_mm_per_min", rounded(one.slowest_mm_per_min)},
                      {"fastest_mm_per_min", rounded(one.fastest_mm_per_min)}});
  }
  Json out;
  out["schema"] = "kerf-optimize/1";
  out["version"] = version;
  out["optimize"] = {{"program", report.program},
                     {"out", report.out},
                     {"limits", limits},
                     {"blocks", report.blocks},
                     {"changed", report.changed},
                     {"split", {{"blocks", report.split_blocks}, {"pieces", report.split_pieces}}},
                     {"unroll",
                      {{"passes", report.unrolled_passes},
                       {"calls", report.unrolled_calls},
                       {"line_before", report.unrolled_lines}}},
                     {"motions_elsewhere", report.elsewhere},
                     {"time_s",
                      {{"before", rounded(report.before.duration_s)},
                       {"after", rounded(report.after.duration_s)},
                       {"model", report.time_model}}},
                     {"tools", tools},
                     {"peaks", peaks},
                     {"left", left},
                     {"shared", shared},
                     {"digest", report.digest}};
  return out.dump(2) + "\n";
}

}  // namespace kerf
