// What MillingStage tells beyond what its checks tell: tools, cells, the blank.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "base/translate.h"
#include "twin/job/blank_choice.h"
#include "twin/motion/motion_geometry.h"
#include "twin/process/finding_at.h"
#include "twin/process/milling/milling_stage.h"
#include "twin/process/tool_tells.h"

namespace kerf {
namespace {

/// A blank is divided evenly: cells may be smaller than asked for, and rounded.
constexpr double kCoarse = 1 + 1e-6;

}  // namespace

void MillingStage::announce(const ResolvedTool& tool, const Motion& m) {
  use_ = static_cast<std::uint32_t>(place_of_use(uses_, tool, m, log_));
  deepest_.resize(uses_.size());
}

/// Of each such move: each is missing from the workpiece.
void MillingStage::report_endless_turn(const Motion& m, const TimedStep& step) {
  double turns = 0;
  for (std::size_t i = 0; i < 3; ++i)
    turns = std::max(turns, std::abs(m.to_abc_deg[i] - m.from_abc_deg[i]) / 360);
  Finding finding = finding_at(FindingId::kRotaryIgnored, Severity::kError, m, step);
  finding.tool = m.tool;
  finding.text = trf(
      "{:.6g} turns in one move, whose way in the workpiece is more than {} straight pieces: it is "
      "not cut",
      turns, ToolPath::kMostPieces);
  finding.hint = tr("a slip of the pen? Otherwise fewer turns in a block, nearer to their axis");
  log_.add(std::move(finding));
}

/// Once a tool: what it leaves at its deepest is narrower than two cells. Contacts and depths do
/// not need cells; volumes, pictures and meshes do.
void MillingStage::report_coarse_cells() {
  const Box bounds = stock_.bounds_mm();
  const double cell = stock_.cell_mm();
  for (std::size_t i = 0; i < deepest_.size(); ++i) {
    const Deepest& deepest = deepest_[i];
    const double depth = bounds.max.z - std::max(deepest.tip_z_mm, bounds.min.z);
    if (!deepest.cutter || depth <= kContactTolerance_mm) continue;
    const double half = half_width_mm(*deepest.cutter, depth);
    if (cell <= half * kCoarse) continue;
    const double fitting = cell_no_larger_mm(half);
    const Vec3 size = bounds.size();
    const double cells = size.x / fitting * (size.y / fitting);
    Finding finding =
        finding_at(FindingId::kCellCoarse, Severity::kWarning, deepest.source, deepest.time_s);
    finding.tool = uses_[i].number;
    finding.text = trf(
        "the cells of {:.3g} mm are too coarse for {}, which leaves grooves {:.2g} mm wide at its "
        "deepest, {:.3g} mm: what it removes is not known, and pictures and meshes show it badly",
        cell, uses_[i].shape, 2 * half, depth);
    finding.hint = stock_.takes_tilted_tools() ? trf("--cell {:g} would do", fitting)
                                               : trf("--cell {:g} would do ({:.0f} million cells)",
                                                     fitting, std::ceil(cells / 1e6));
    log_.add(std::move(finding));
  }
}

/// Once a tool, of the first move that removes something.
void MillingStage::report_reversed(const InFlight& move, int tool) {
  if (!reversed_told_.insert(tool).second) return;
  Finding finding =
      finding_at(FindingId::kSpindleReversed, Severity::kWarning, move.source, move.start_s);
  finding.tool = tool;
  finding.text = tr("cuts while the spindle runs anticlockwise (M4)");
  log_.add(std::move(finding));
}

void MillingStage::note_tap(const Motion& m) {
  if (!is_feed(m)) return;
  const Vec3 way = m.to_mm - m.from_mm;
  const bool is_along = way.x == 0 && way.y == 0;
  const bool goes_back = is_along && way.z > 0 && m.spindle == SpindleState::kClockwise;
  if (goes_back && last_down_ && last_down_->second == m.from_mm) taps_.insert(last_down_->first);
  last_down_.reset();
  if (is_along && way.z < 0 && m.spindle == SpindleState::kCounterclockwise)
    last_down_.emplace(site_.motion, m.to_mm);
}

/// A program that never comes near its blank was written for another zero, or another blank.
void MillingStage::report_outside_stock() {
  // A guessed blank lies where the program works: missing it says nothing of the program.
  if (reached_stock_ || feed_bounds_mm_.empty() || checks_.options().blank_guessed) return;
  const auto extent = [](const Box& box) {
    return fmt::format("X{:.1f}..{:.1f} Y{:.1f}..{:.1f} Z{:.1f}..{:.1f}", box.min.x, box.max.x,
                       box.min.y, box.max.y, box.min.z, box.max.z);
  };
  Finding finding;
  finding.id = FindingId::kOutsideStock;
  finding.severity = Severity::kWarning;
  finding.text = trf(
      "no feed move comes near the workpiece: the moves are at {}, the blank at {}; is the blank "
      "given "
      "in the coordinates that the program writes?",
      extent(feed_bounds_mm_), extent(stock_.bounds_mm()));
  log_.add(std::move(finding));
}

/// Once a tool: its first feed move.
void MillingStage::report_undefined(const Motion& m, const TimedStep& step) {
  ToolUse& use = uses_[use_];
  const bool first = use.origin.empty();
  use.feed_mm += step.length_mm;
  if (!first) return;
  use.origin = mounted_->origin.empty() ? tr("nothing") : mounted_->origin;
  tell_undefined(*mounted_, m, step, log_);
}

}  // namespace kerf
