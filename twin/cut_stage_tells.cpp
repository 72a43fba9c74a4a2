// What CutStage tells beyond what its checks tell: tools, places, axes, cells, feeds.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "twin/blank_choice.h"
#include "twin/cut_stage.h"
#include "twin/motion_geometry.h"

namespace kerf {
namespace {

/// A blank is divided evenly: cells may be smaller than asked for, and rounded.
constexpr double kCoarse = 1 + 1e-6;

}  // namespace

void CutStage::announce(const ResolvedTool& tool, const Motion& m) {
  const auto known = std::find_if(uses_.begin(), uses_.end(),
                                  [&](const ToolUse& use) { return use.number == tool.number; });
  use_ = static_cast<std::uint32_t>(known - uses_.begin());
  if (known != uses_.end()) return;
  ToolUse use;
  use.number = tool.number;
  use.origin = tool.origin;
  use.guessed = tool.guessed;
  if (tool.cutter) use.shape = tool.cutter->spec();
  uses_.push_back(use);
  deepest_.emplace_back();
  if (!tool.cutter) return;
  Finding finding;
  finding.source = m.source;
  finding.tool = tool.number;
  if (tool.assumed) {
    finding.id = FindingId::kToolAssumed;
    finding.severity = Severity::kNote;
    finding.text = fmt::format(
        "the program moves before any tool change; tool {} ({}, {}) is taken to be in the spindle",
        tool.number, use.shape, use.origin);
    log_.add(finding);
  }
  if (tool.guessed) {
    finding.id = FindingId::kToolGuessed;
    finding.severity = Severity::kWarning;
    finding.text =
        tool.from_moves
            ? fmt::format(
                  "nothing is known of {}; by its moves it is taken for {}, and that is a "
                  "guess: {} (--tool {}=SHAPE says better)",
                  tool.number == 0 ? std::string("the tool in the spindle")
                                   : fmt::format("tool {}", tool.number),
                  use.shape, tool.guess, std::max(1, tool.number))
        : tool.guess.empty()
            ? fmt::format(
                  "only the diameter of tool {} is known ({}); a flat cutter is assumed: {} "
                  "(--tool "
                  "{}=SHAPE says better)",
                  tool.number, use.origin, use.shape, std::max(1, tool.number))
            : fmt::format(
                  "tool {} is taken for {} ({}), and that is a guess: {} (--tool {}=SHAPE "
                  "says better)",
                  tool.number, use.shape, use.origin, tool.guess, std::max(1, tool.number));
    log_.add(finding);
  }
}

/// That rapids come from an unknown place until every axis has been placed is how programs begin.
/// Once each: a feed move that is not cut, and a place of the machine.
void CutStage::report_unknown_place(const Motion& m, const TimedStep& step) {
  const bool to_machine = m.to_machine_place && !machine_place_told_;
  const bool feed = is_feed(m) && !unknown_feed_told_;
  if (!to_machine && !feed) return;
  (to_machine ? machine_place_told_ : unknown_feed_told_) = true;
  const unsigned axes = to_machine ? m.unknown_to : m.unknown_from | m.unknown_to;
  std::string letters;
  for (std::size_t i = 0; i < 3; ++i) {
    if ((axes >> i & 1) == 0) continue;
    letters += letters.empty() ? "" : ", ";
    letters += kAxisLetters[i];
  }
  const bool one = letters.size() == 1;
  Finding finding;
  finding.id = FindingId::kPositionUnknown;
  finding.severity = Severity::kNote;
  finding.source = m.source;
  finding.time_s = step.start_s;
  if (to_machine) {
    finding.text = fmt::format(
        "goes to a place of the machine (G53, G28, G30), and where the work lies in the machine is "
        "not known (--work-offset X,Y,Z or --ini says it): such moves are not checked, and {} {} "
        "unknown until a block places {}",
        letters, one ? "is" : "are", one ? "it" : "them");
  } else {
    finding.text = fmt::format(
        "a feed move while nothing has said where {} {} (--ini does, or a G0 before it that names "
        "the {}): such moves are not cut",
        letters, one ? "stands" : "stand", one ? "axis" : "axes");
  }
  log_.add(std::move(finding));
}

/// U, V or W move. Once for each that moves nothing that is known.
void CutStage::check_slides(const Motion& m, const TimedStep& step) {
  for (std::size_t i = 0; i < 3; ++i) {
    const auto axis = static_cast<int>(i);
    const bool known = kinematics_ && kinematics_->slides_uvw() &&
                       kinematics_->chain.is_driven_by(6 + i) && !torch_ && !punch_;
    if (known || slide_reported_[i] || m.from_uvw_mm[axis] == m.to_uvw_mm[axis]) continue;
    slide_reported_[i] = true;
    const char letter = kAxisLetters[6 + i];
    Finding finding;
    finding.id = FindingId::kSecondaryIgnored;
    finding.source = m.source;
    finding.time_s = step.start_s;
    finding.tool = m.tool;
    finding.text = fmt::format(
        "{} moves, and nothing says what it slides: it is cut as if {} stood still (a second "
        "carriage, the slide of a facing head, and the wire between XY and UV of a foam cutter are "
        "not modelled)",
        letter, letter);
    finding.hint =
        "with W among the axes (--ini, machine.joints) it is a quill along Z; machine.kinematics: "
        "links says what U, V and W slide on another machine";
    log_.add(std::move(finding));
  }
}

/// Once: what the machine is taken to be, where nothing says it.
void CutStage::report_assumptions(const Motion& m) {
  assumptions_told_ = true;
  for (const std::string& note : kinematics_->notes) {
    Finding finding;
    finding.id = FindingId::kKinematics;
    finding.severity = Severity::kNote;
    finding.source = m.source;
    finding.text = note;
    log_.add(std::move(finding));
  }
}

void CutStage::report_rotary_faults(const TimedStep& step) {
  for (RotaryFault& fault : rotary_faults_) {
    const bool too_fast = fault.kind == RotaryFaultKind::kJointTooFast;
    if (too_fast && !limits_known_ && std::exchange(invented_limits_told_, true)) continue;
    Finding finding;
    switch (fault.kind) {
      case RotaryFaultKind::kNoAxis:
        finding.id = FindingId::kNoRotaryAxis;
        break;
      case RotaryFaultKind::kSingularPose:
        finding.id = FindingId::kSingularPose;
        finding.severity = Severity::kWarning;
        break;
      case RotaryFaultKind::kJointTooFast:
        finding.id = FindingId::kOverFeed;
        finding.severity = limits_known_ ? Severity::kWarning : Severity::kNote;
        break;
      case RotaryFaultKind::kJointLimit:
        finding.id = FindingId::kAxisLimit;
        break;
      case RotaryFaultKind::kToolTooLong:
        finding.id = FindingId::kToolTooLong;
        break;
    }
    finding.source = fault.source;
    finding.time_s = step.start_s;
    finding.text = std::move(fault.text);
    finding.hint = std::move(fault.hint);
    log_.add(std::move(finding));
  }
  rotary_faults_.clear();
}

/// Once: a model for upright tools was asked for, and the program is not for one.
void CutStage::report_ignored_turn(const Motion& m, const TimedStep& step) {
  turn_reported_ = true;
  Finding finding;
  finding.id = FindingId::kRotaryIgnored;
  finding.source = m.source;
  finding.time_s = step.start_s;
  finding.tool = m.tool;
  finding.text = fmt::format(
      "A, B or C move, and the model {} is for upright tools over a workpiece that lies still: it "
      "is cut as if they stood{}",
      stock_.name(), torch_ ? "" : " (--model octree follows them)");
  log_.add(std::move(finding));
}

/// Of each such move: each is missing from the workpiece.
void CutStage::report_endless_turn(const Motion& m, const TimedStep& step) {
  double turns = 0;
  for (std::size_t i = 0; i < 3; ++i)
    turns = std::max(turns, std::abs(m.to_abc_deg[i] - m.from_abc_deg[i]) / 360);
  Finding finding;
  finding.id = FindingId::kRotaryIgnored;
  finding.source = m.source;
  finding.time_s = step.start_s;
  finding.tool = m.tool;
  finding.text = fmt::format(
      "{:.6g} turns in one move, whose way in the workpiece is more than {} straight pieces: it is "
      "not cut",
      turns, ToolPath::kMostPieces);
  finding.hint = "a slip of the pen? Otherwise fewer turns in a block, nearer to their axis";
  log_.add(std::move(finding));
}

/// Once a tool: what it leaves at its deepest is narrower than two cells. Contacts and depths do
/// not need cells; volumes, pictures and meshes do.
void CutStage::report_coarse_cells() {
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
    Finding finding;
    finding.id = FindingId::kCellCoarse;
    finding.severity = Severity::kWarning;
    finding.source = deepest.source;
    finding.time_s = deepest.time_s;
    finding.tool = uses_[i].number;
    finding.text = fmt::format(
        "the cells of {:.3g} mm are too coarse for {}, which leaves grooves {:.2g} mm wide at its "
        "deepest, {:.3g} mm: what it removes is not known, and pictures and meshes show it badly",
        cell, uses_[i].shape, 2 * half, depth);
    finding.hint = stock_.takes_tilted_tools()
                       ? fmt::format("--cell {:g} would do", fitting)
                       : fmt::format("--cell {:g} would do ({:.0f} million cells)", fitting,
                                     std::ceil(cells / 1e6));
    log_.add(std::move(finding));
  }
}

/// A program that never comes near its blank was written for another zero, or another blank.
void CutStage::report_outside_stock() {
  // A guessed blank lies where the program works: missing it says nothing of the program.
  if (reached_stock_ || feed_bounds_mm_.empty() || checks_.options().blank_guessed) return;
  const auto extent = [](const Box& box) {
    return fmt::format("X{:.1f}..{:.1f} Y{:.1f}..{:.1f} Z{:.1f}..{:.1f}", box.min.x, box.max.x,
                       box.min.y, box.max.y, box.min.z, box.max.z);
  };
  Finding finding;
  finding.id = FindingId::kOutsideStock;
  finding.severity = Severity::kWarning;
  finding.text = fmt::format(
      "no feed move comes near the workpiece: the moves are at {}, the blank at {}; is the blank "
      "given "
      "in the coordinates that the program writes?",
      extent(feed_bounds_mm_), extent(stock_.bounds_mm()));
  log_.add(std::move(finding));
}

/// Once a tool: its first feed move.
void CutStage::report_undefined(const Motion& m, const TimedStep& step) {
  ToolUse& use = uses_[use_];
  const bool first = use.origin.empty();
  use.feed_mm += step.length_mm;
  if (!first) return;
  use.origin = "nothing";
  Finding finding;
  finding.id = FindingId::kToolUndefined;
  finding.source = m.source;
  finding.time_s = step.start_s;
  finding.tool = mounted_->number;
  if (!mounted_->trouble.empty()) {
    finding.text = fmt::format("tool {}: {}; its moves do not cut", m.tool, mounted_->trouble);
  } else if (m.tool == 0) {
    finding.text =
        "feed moves with no tool in the spindle do not cut (one --tool N=SHAPE names the tool "
        "that is in it at the start)";
  } else {
    finding.text = fmt::format(
        "nothing is known of tool {}; its moves do not cut (--tool {}=SHAPE describes it)", m.tool,
        m.tool);
  }
  log_.add(std::move(finding));
}

void CutStage::report_missing_feed(const Motion& m, const TimedStep& step) {
  if (feed_missing_reported_) return;
  feed_missing_reported_ = true;
  Finding finding;
  finding.id = FindingId::kFeedMissing;
  finding.severity = Severity::kWarning;
  finding.source = m.source;
  finding.time_s = step.start_s;
  finding.text =
      "feed move without a feed rate (or without spindle speed under G95); it takes no time in "
      "this report";
  log_.add(std::move(finding));
}

/// One finding for the whole program: where one move is too fast, most are.
void CutStage::report_over_feed() {
  // Of a machine that was made up one note is enough.
  if (over_feed_.count == 0 || invented_limits_told_) return;
  Finding finding;
  finding.id = FindingId::kOverFeed;
  finding.severity = limits_known_ ? Severity::kWarning : Severity::kNote;
  finding.source = over_feed_.source;
  finding.time_s = over_feed_.time_s;
  finding.text = fmt::format(
      "{} feed move{} for more than the machine can do, the first for {:.0f} mm/min where it "
      "can do {:.0f} mm/min ({})",
      over_feed_.count, over_feed_.count == 1 ? " asks" : "s ask", over_feed_.programmed_mm_per_min,
      over_feed_.allowed_mm_per_min, limits_origin_);
  log_.add(std::move(finding));
}

}  // namespace kerf
