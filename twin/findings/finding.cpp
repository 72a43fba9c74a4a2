#include "twin/findings/finding.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/translate.h"

namespace kerf {
namespace {

/// Two decimals, and never "-0.00".
std::string coordinate(double value) {
  const double rounded = std::round(value * 100) / 100;
  return fmt::format("{:.2f}", rounded == 0 ? 0.0 : rounded);
}

const char* depth_word(FindingId id) {
  if (id == FindingId::kBelowStock) return tr("below its floor");
  if (id == FindingId::kExcess) return tr("at most");
  return id == FindingId::kOffPath ? tr("off at most, first") : tr("deep");
}

}  // namespace

const char* to_string(FindingId id) {
  switch (id) {
    case FindingId::kRapidContact:
      return "rapid-contact";
    case FindingId::kSpindleOffContact:
      return "spindle-off-contact";
    case FindingId::kBelowStock:
      return "below-stock";
    case FindingId::kToolUndefined:
      return "tool-undefined";
    case FindingId::kToolGuessed:
      return "tool-guessed";
    case FindingId::kToolAssumed:
      return "tool-assumed";
    case FindingId::kStockGuessed:
      return "stock-guessed";
    case FindingId::kNoProgramEnd:
      return "no-program-end";
    case FindingId::kRotaryIgnored:
      return "rotary-ignored";
    case FindingId::kFeedMissing:
      return "feed-missing";
    case FindingId::kInterpreterError:
      return "interpreter-error";
    case FindingId::kInterpreterWarning:
      return "interpreter-warning";
    case FindingId::kInterrupted:
      return "interrupted";
    case FindingId::kAxisLimit:
      return "axis-limit";
    case FindingId::kOverFeed:
      return "over-feed";
    case FindingId::kOutsideStock:
      return "outside-stock";
    case FindingId::kNotSimulated:
      return "not-simulated";
    case FindingId::kSourceFault:
      return "source-fault";
    case FindingId::kSourceGap:
      return "source-gap";
    case FindingId::kSourceRestarted:
      return "source-restarted";
    case FindingId::kOffPath:
      return "off-path";
    case FindingId::kNotThisProgram:
      return "not-this-program";
    case FindingId::kToolMismatch:
      return "tool-mismatch";
    case FindingId::kLengthUnknown:
      return "length-unknown";
    case FindingId::kLateStart:
      return "late-start";
    case FindingId::kLineNotReached:
      return "line-not-reached";
    case FindingId::kKinematics:
      return "kinematics";
    case FindingId::kNoRotaryAxis:
      return "no-rotary-axis";
    case FindingId::kSecondaryIgnored:
      return "secondary-ignored";
    case FindingId::kSingularPose:
      return "singular-pose";
    case FindingId::kToolTooLong:
      return "tool-too-long";
    case FindingId::kTorchLeftOn:
      return "torch-left-on";
    case FindingId::kNoBeam:
      return "no-beam";
    case FindingId::kKerfZero:
      return "kerf-zero";
    case FindingId::kPierceInPart:
      return "pierce-in-part";
    case FindingId::kCrossesPart:
      return "crosses-part";
    case FindingId::kBeamOff:
      return "beam-off";
    case FindingId::kSmallPart:
      return "small-part";
    case FindingId::kStationEmpty:
      return "station-empty";
    case FindingId::kNoPunch:
      return "no-punch";
    case FindingId::kHitOnClamp:
      return "hit-on-clamp";
    case FindingId::kHitOffSheet:
      return "hit-off-sheet";
    case FindingId::kHitOverEdge:
      return "hit-over-edge";
    case FindingId::kHitInAir:
      return "hit-in-air";
    case FindingId::kHitOnPart:
      return "hit-on-part";
    case FindingId::kWebLeft:
      return "web-left";
    case FindingId::kPunchDown:
      return "punch-down";
    case FindingId::kGripLost:
      return "grip-lost";
    case FindingId::kNoHit:
      return "no-hit";
    case FindingId::kPositionUnknown:
      return "position-unknown";
    case FindingId::kToolLength:
      return "tool-length";
    case FindingId::kNotModelled:
      return "not-modelled";
    case FindingId::kNothingCut:
      return "nothing-cut";
    case FindingId::kToolUnused:
      return "tool-unused";
    case FindingId::kToolNotChanged:
      return "tool-not-changed";
    case FindingId::kStopInPart:
      return "stop-in-part";
    case FindingId::kDrillSideways:
      return "drill-sideways";
    case FindingId::kBeamOnTraverse:
      return "beam-on-traverse";
    case FindingId::kCellCoarse:
      return "cell-coarse";
    case FindingId::kHolderContact:
      return "holder-contact";
    case FindingId::kShankContact:
      return "shank-contact";
    case FindingId::kFluteTooShort:
      return "flute-too-short";
    case FindingId::kFixtureContact:
      return "fixture-contact";
    case FindingId::kSpindleContact:
      return "spindle-contact";
    case FindingId::kMachineCollision:
      return "machine-collision";
    case FindingId::kNearMiss:
      return "near-miss";
    case FindingId::kThinFilm:
      return "thin-film";
    case FindingId::kFeedLost:
      return "feed-lost";
    case FindingId::kFlankContact:
      return "flank-contact";
    case FindingId::kThreadSpeed:
      return "thread-speed";
    case FindingId::kWrongPlane:
      return "wrong-plane";
    case FindingId::kPastCentre:
      return "past-centre";
    case FindingId::kPipLeft:
      return "pip-left";
    case FindingId::kChuckContact:
      return "chuck-contact";
    case FindingId::kJawContact:
      return "jaw-contact";
    case FindingId::kBarContact:
      return "bar-contact";
    case FindingId::kOverDepth:
      return "over-depth";
    case FindingId::kOverSpeed:
      return "over-speed";
    case FindingId::kThreadShallow:
      return "thread-shallow";
    case FindingId::kUncompensated:
      return "uncompensated";
    case FindingId::kGouge:
      return "gouge";
    case FindingId::kExcess:
      return "excess";
  }
  return "";
}

std::string message_of(const Finding& finding) {
  std::string out = finding.text;
  if (finding.depth_mm) {
    out += fmt::format(", {:.2f} mm {}", *finding.depth_mm, depth_word(finding.id));
  }
  if (finding.position_mm) {
    const Vec3& p = *finding.position_mm;
    out += trf(" at X{} Y{} Z{}", coordinate(p.x), coordinate(p.y), coordinate(p.z));
    if (finding.tool) out += trf(" (tool {})", *finding.tool);
  }
  return out;
}

Diagnostic diagnostic_of(const Finding& finding, const std::vector<std::string>& files) {
  Diagnostic out;
  out.severity = finding.severity;
  out.line = static_cast<int>(finding.source.line);
  out.file = finding.file;
  if (out.file.empty() && finding.source.file < files.size()) out.file = files[finding.source.file];
  out.excerpt = finding.excerpt;
  out.hint = finding.hint;
  out.message = fmt::format("{}: {}", to_string(finding.id), message_of(finding));
  return out;
}

FindingLog::Handle FindingLog::add(Finding finding) {
  if (muted_) return kMaxKept;
  ++counts_[static_cast<std::size_t>(finding.severity)];
  if (kept_.size() >= kMaxKept) return kMaxKept;
  kept_.push_back(std::move(finding));
  return kept_.size() - 1;
}

void FindingLog::raise(Handle handle, Severity severity) {
  if (handle >= kept_.size()) return;
  --counts_[static_cast<std::size_t>(kept_[handle].severity)];
  ++counts_[static_cast<std::size_t>(severity)];
  kept_[handle].severity = severity;
}

void FindingLog::forget_from(std::size_t count) {
  while (kept_.size() > count) {
    --counts_[static_cast<std::size_t>(kept_.back().severity)];
    kept_.pop_back();
  }
}

void FindingLog::join(const FindingLog& other, const std::vector<std::string>& files) {
  for (std::size_t i = 0; i < other.kept_.size() && kept_.size() < kMaxKept; ++i) {
    Finding& finding = kept_.emplace_back(other.kept_[i]);
    const std::size_t file = finding.source.file;
    if (finding.file.empty() && file < files.size()) finding.file = files[file];
  }
  for (std::size_t i = 0; i < 3; ++i) counts_[i] += other.counts_[i];
}

void FindingLog::deepen(Handle handle, double depth_mm) {
  if (handle >= kept_.size()) return;
  Finding& finding = kept_[handle];
  finding.depth_mm = std::max(finding.depth_mm.value_or(0.0), depth_mm);
}

}  // namespace kerf
