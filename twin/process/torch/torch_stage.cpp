#include "twin/process/torch/torch_stage.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

#include "base/translate.h"
#include "twin/findings/finding_json.h"
#include "twin/machine/planned_pieces.h"
#include "twin/motion/motion_geometry.h"
#include "twin/process/finding_at.h"

namespace kerf {
namespace {

/// A way that removes less of its kerf lies in one that has been cut already.
constexpr double kLeastOfKerf = 0.01;

bool goes_up_or_down(const Motion& m) {
  return m.kind != MotionKind::kArc && m.from_mm.x == m.to_mm.x && m.from_mm.y == m.to_mm.y;
}

}  // namespace

TorchStage::TorchStage(ProcessSite& site, BeamSettings settings)
    : site_(site),
      feeds_(site.feeds),
      stock_(site.stock),
      log_(site.log),
      settings_(std::move(settings)),
      moves_(settings_.trigger, settings_.pierce_mm),
      kerfs_(site.tools, settings_.kerf_mm, settings_.is_qtplasmac),
      checks_(*site.stock.sheet(), site.log,
              {settings_.is_qtplasmac, settings_.slats_mm, settings_.guessed}) {}

void TorchStage::set_materials(std::span<const TorchMaterial> materials) {
  settings_.materials.assign(materials.begin(), materials.end());
}

void TorchStage::go_on_from(const Process& process) {
  const auto& other = static_cast<const TorchStage&>(process);
  pierced_ = other.pierced_;
  has_fed_ = other.has_fed_;
  has_burnt_ = other.has_burnt_;
  has_removed_ = other.has_removed_;
  checks_.go_on_from(other.checks_);
}

/// The programmed motion, or what the machine makes of it.
void TorchStage::take(const Motion& m, const TimedStep& step, std::span<const PathPiece> path) {
  if (is_feed(m) && m.start_known) feeds_.note(m, step);
  for_each_piece(m, step, path,
                 [this](const Motion& piece, const TimedStep& part) { take_piece(piece, part); });
}

void TorchStage::take_piece(const Motion& m, const TimedStep& step) {
  has_fed_ = has_fed_ || is_feed(m);
  if (!moves_.is_lit(m)) {
    if (std::exchange(pierced_, false)) totals_.beam_s += step.held_before_s;
    checks_.travels(m, step);
    return;
  }
  if (m.kind == MotionKind::kProgramEnd && !settings_.guessed) {
    checks_.stays_on(m.source, step.start_s);
  }
  totals_.beam_s += step.held_before_s + step.duration_s;
  if (moves_.burns(m)) cut(m, step);
}

void TorchStage::cut(const Motion& m, const TimedStep& step) {
  has_burnt_ = true;
  const bool pierces = !std::exchange(pierced_, true);
  const ResolvedTool& kerf = kerfs_.of(m, settings_.materials);
  if (&kerf != kerf_ || uses_.empty()) {
    kerf_ = &kerf;
    use_ = static_cast<std::size_t>(&use_of(kerf, m) - uses_.data());
  }
  if (!goes_up_or_down(m)) {
    totals_.cut_mm += step.length_mm;
    uses_[use_].feed_mm += step.length_mm;
  }
  if (pierces) ++totals_.pierces;
  if (!kerf.cutter) {
    report_no_kerf(kerf, m, step);
    return;
  }
  if (pierces) checks_.pierces(m, step);
  cut(m, step, pierces);
}

/// A kerf has one cross-section: what it takes says how much of the way was in material. Where that
/// is not all of it the machine starts and stops beside the material, more likely than in it.
double TorchStage::burnt_s(const Motion& m, const TimedStep& step, double burnt_mm) {
  if (goes_up_or_down(m) || !(burnt_mm < step.length_mm)) return step.duration_s;
  const double even_s = step.duration_s * burnt_mm / step.length_mm;
  if (step.peak_mm_per_min <= 0) return even_s;
  return std::min(even_s, 60 * burnt_mm / step.peak_mm_per_min);
}

void TorchStage::cut(const Motion& m, const TimedStep& step, bool pierces) {
  divided_.clear();
  moves_.append(m, pierces, *kerf_->cutter, 0, divided_);
  if (divided_.empty()) return;
  checks_.burns(m, step);
  reports_.clear();
  stock_.cut(*kerf_->cutter, divided_, reports_);
  stock_.finish(reports_);
  ToolUse& use = uses_[use_];
  double removed_mm3 = 0;
  for (const CutReport& report : reports_) {
    site_.note_cut(site_.motion, report.removed_mm3, report.depth_mm);
    removed_mm3 += report.removed_mm3;
    use.max_depth_mm = std::max(use.max_depth_mm, report.depth_mm);
  }
  use.removed_mm3 += removed_mm3;
  const double kerf_mm2 = 2 * kerf_->cutter->radius_mm() * stock_.bounds_mm().size().z;
  add_cutting(use, burnt_s(m, step, removed_mm3 / kerf_mm2), removed_mm3);
  has_removed_ = has_removed_ || removed_mm3 > 0;
  if (removed_mm3 > kLeastOfKerf * kerf_mm2 * step.length_mm) checks_.cuts_on_traverse(m, step);
  if (!has_removed_) burnt_mm_.extend(bounds_of(m));
  checks_.note_freed(m, step);
}

/// One row a tool and kerf: a change of material is a change of tool.
ToolUse& TorchStage::use_of(const ResolvedTool& kerf, const Motion& m) {
  const std::string shape = kerf.cutter ? kerf.cutter->spec() : std::string();
  for (ToolUse& use : uses_) {
    if (use.number == kerf.number && use.shape == shape) return use;
  }
  ToolUse& use = uses_.emplace_back();
  use.number = kerf.number;
  use.origin = kerf.cutter ? kerf.origin : std::string();
  use.shape = shape;
  use.guessed = kerf.cutter && kerf.guessed;
  announce(kerf, m);
  return use;
}

void TorchStage::announce(const ResolvedTool& kerf, const Motion& m) {
  if (!kerf.cutter || !(kerf.assumed || kerf.from_moves)) return;
  Finding finding;
  finding.id = FindingId::kToolAssumed;
  finding.severity = Severity::kNote;
  finding.source = m.source;
  finding.tool = kerf.number;
  if (kerf.from_moves) {
    finding.id = FindingId::kToolGuessed;
    finding.severity = Severity::kWarning;
    finding.text =
        trf("the kerf is taken to be {:g} mm wide, and that is a guess: {} "
            "(--kerf LENGTH says better)",
            2 * kerf.cutter->radius_mm(), kerf.guess);
    log_.add(std::move(finding));
    return;
  }
  finding.text =
      trf("the program cuts before any tool change; tool {} ({}, {}) is taken to be the torch",
          kerf.number, kerf.cutter->spec(), kerf.origin);
  log_.add(std::move(finding));
}

/// Once a tool.
void TorchStage::report_no_kerf(const ResolvedTool& kerf, const Motion& m, const TimedStep& step) {
  ToolUse& use = uses_[use_];
  if (!use.origin.empty()) return;
  use.origin = tr("nothing");
  const bool unknown = kerf.trouble.empty();
  Finding finding = finding_at(unknown ? FindingId::kToolUndefined : FindingId::kKerfZero,
                               Severity::kError, m, step);
  finding.tool = m.tool;
  if (unknown) {
    finding.text = trf(
        "the width of the kerf is not known; the moves of tool {} do not cut (--kerf LENGTH, or "
        "--tool N=kerf:WIDTH)",
        m.tool);
  } else {
    finding.text = trf("tool {}: {}; its moves do not cut", m.tool, kerf.trouble);
  }
  log_.add(std::move(finding));
}

void TorchStage::begin_reporting() {
  totals_ = {};
  uses_.clear();
  kerf_ = nullptr;
  checks_.forget_events();
}

void TorchStage::finish(bool whole) {
  if (whole) {
    if (has_fed_ && !has_burnt_) report_no_beam();
    if (!has_removed_ && !burnt_mm_.empty()) report_outside();
  }
  checks_.finish();
  for (ToolUse& use : uses_) {
    if (use.peak_mm3_per_s == 0) close_window(use);
  }
}

void TorchStage::report_no_beam() {
  Finding finding;
  finding.id = FindingId::kNoBeam;
  finding.severity = Severity::kWarning;
  finding.text = tr(
      "the program never turns the beam on, nothing is cut; --beam TRIGGER says what turns it on");
  log_.add(std::move(finding));
}

void TorchStage::report_outside() {
  const auto extent = [](const Box& box) {
    return fmt::format("X{:.1f}..{:.1f} Y{:.1f}..{:.1f}", box.min.x, box.max.x, box.min.y,
                       box.max.y);
  };
  Finding finding;
  finding.id = FindingId::kOutsideStock;
  finding.severity = Severity::kWarning;
  finding.text = trf(
      "the beam never meets the sheet: the cuts are at {}, the sheet at {}; is the sheet given in "
      "the coordinates that the program writes?",
      extent(burnt_mm_), extent(stock_.bounds_mm()));
  log_.add(std::move(finding));
}

std::shared_ptr<const ProcessSums> TorchStage::sums() const {
  return std::make_shared<TorchSums>(totals_);
}

void TorchSums::add_json(nlohmann::ordered_json& out) const {
  out["cut_mm"] = rounded(totals.cut_mm);
  out["pierces"] = totals.pierces;
  out["beam_s"] = rounded(totals.beam_s);
}

std::string TorchSums::text() const {
  return trf("sheet     cut {:.1f} mm, {}, beam on for {:.1f} s\n", totals.cut_mm,
             trnf("{} pierce", "{} pierces", totals.pierces), totals.beam_s);
}

std::string TorchSums::run_text() const {
  return trf("cut {:.1f} mm, {}", totals.cut_mm, trnf("{} pierce", "{} pierces", totals.pierces));
}

}  // namespace kerf
