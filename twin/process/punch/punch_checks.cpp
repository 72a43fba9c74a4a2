#include "twin/process/punch/punch_checks.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <utility>

#include "base/translate.h"
#include "stock/sheet/punch_hits.h"
#include "stock/sheet/sheet.h"
#include "twin/machine/punch_moves.h"
#include "twin/motion/motion_geometry.h"

namespace kerf {
namespace {

/// Below it shapes only touch.
constexpr double kLeastOverlap_mm2 = 1e-4;
/// Of a stroke: less is what rounding and the chords of arcs leave at its edge.
constexpr double kLeastShare = 1e-3;
/// A punch with so much of it on the sheet is held by what it cuts: notches of the edge are made
/// so.
constexpr double kSteadyShare = 0.5;
/// A clamp is looked at in so many places each way.
constexpr int kGripPoints = 9;

struct Extent {
  Vec2 min{1e300}, max{-1e300};
};

Extent extent_of(const PlaneOutline& shape) {
  Extent extent;
  for (const std::vector<Vec2>& ring : shape.rings) {
    for (const Vec2& p : ring) {
      extent.min = glm::min(extent.min, p);
      extent.max = glm::max(extent.max, p);
    }
  }
  return extent;
}

bool meet(const Extent& a, const Vec2& min, const Vec2& max) {
  return a.min.x < max.x && a.max.x > min.x && a.min.y < max.y && a.max.y > min.y;
}

/// How far the shape reaches along a direction.
double reach_along(const PlaneOutline& shape, const Vec2& direction) {
  double low = 1e300, high = -1e300;
  for (const std::vector<Vec2>& ring : shape.rings) {
    for (const Vec2& p : ring) {
      low = std::min(low, glm::dot(p, direction));
      high = std::max(high, glm::dot(p, direction));
    }
  }
  return high - low;
}

}  // namespace

PunchChecks::PunchChecks(const Sheet& sheet, FindingLog& log, TurretPointer turret)
    : sheet_(sheet),
      log_(log),
      turret_(std::move(turret)),
      blank_(sheet.outline()),
      place_(turret_),
      uncut_pieces_(sheet.blank_piece_numbers()),
      freed_(freed_before(sheet)) {}

void PunchChecks::tell(FindingId id, Severity severity, const Motion& m, const TimedStep& step,
                       const Vec3& place, std::string text) {
  Told& told = told_[id];
  if (++told.count > kTold) {
    log_.reword(told.last, trf("{}; and later {} more", told.text, told.count - kTold));
    return;
  }
  Finding out;
  out.id = id;
  out.severity = severity;
  out.source = m.source;
  out.time_s = step.start_s;
  out.position_mm = place;
  out.tool = m.tool;
  out.text = text;
  told.text = std::move(text);
  told.last = log_.add(std::move(out));
}

void PunchChecks::go_on_from(const PunchChecks& other) {
  blank_ = other.blank_;
  place_ = other.place_;
  grip_checked_ = other.grip_checked_;
  unseen_told_ = other.unseen_told_;
  uncut_pieces_ = other.uncut_pieces_;
  freed_ = other.freed_;
}

void PunchChecks::follow(const Motion& m, const TimedStep& step, bool drags) {
  bool moved = !std::exchange(grip_checked_, true);
  if (place_.follow(m)) {
    ++regrips_;
    moved = true;
  }
  if (moved) check_grip(m, step);
  if (drags) {
    tell(FindingId::kPunchDown, Severity::kWarning, m, step, m.from_mm,
         tr("the sheet moves while the punch is down"));
  }
}

/// Some of the sheet has to lie between a clamp's jaws.
void PunchChecks::check_grip(const Motion& m, const TimedStep& step) {
  for (std::size_t i = 0; i < turret_->clamps.size(); ++i) {
    const Vec2 min = turret_->clamps[i].min_mm + place_.shift_mm();
    const Vec2 max = turret_->clamps[i].max_mm + place_.shift_mm();
    bool holds = false;
    for (int n = 0; n < kGripPoints * kGripPoints && !holds; ++n) {
      const Vec2 share(n % kGripPoints, n / kGripPoints);
      holds = sheet_.has_material(min + (share + 0.5) / double{kGripPoints} * (max - min));
    }
    if (holds) continue;
    tell(FindingId::kGripLost, Severity::kError, m, step, Vec3(0.5 * (min + max), m.to_mm.z),
         trf("clamp {} holds nothing of the sheet", i + 1));
  }
}

void PunchChecks::strikes_unseen(const Motion& m, const TimedStep& step) {
  if (std::exchange(unseen_told_, true)) return;
  Finding out;
  out.id = FindingId::kPositionUnknown;
  out.severity = Severity::kWarning;
  out.source = m.source;
  out.time_s = step.start_s;
  out.tool = m.tool;
  out.text = tr(
      "the punch strikes before the program has said where the machine is; what it strikes there "
      "is "
      "not cut");
  out.hint = tr("a move to X and Y before it, or --ini, which says where the machine starts");
  log_.add(std::move(out));
}

void PunchChecks::no_station(const Motion& m, const TimedStep& step, const Vec3& place) {
  if (m.tool == 0) {
    tell(FindingId::kNoPunch, Severity::kError, m, step, place,
         tr("the punch strikes with no tool; nothing is cut"));
  } else {
    tell(FindingId::kStationEmpty, Severity::kError, m, step, place,
         trf("station {} is empty; nothing is cut", m.tool));
  }
}

void PunchChecks::check_edge(const Motion& m, const TimedStep& step, const CutMove& stroke,
                             const PlaneOutline& shape) {
  const double share = blank_.share_of(shape);
  if (share < kLeastShare) {
    off_sheet_ = true;
    tell(FindingId::kHitOffSheet, Severity::kError, m, step, stroke.to_mm,
         tr("the punch strikes beside the sheet"));
  } else if (share < 1 - kLeastShare) {
    const bool pushes = share < kSteadyShare;
    tell(FindingId::kHitOverEdge, pushes ? Severity::kWarning : Severity::kNote, m, step,
         stroke.to_mm,
         trf("{:.1f} % of the punch hangs over the edge of the sheet{}", 100 * (1 - share),
             pushes ? tr(", which pushes it aside") : ""));
  }
}

void PunchChecks::check_clamps(const Motion& m, const TimedStep& step, const CutMove& stroke,
                               const PlaneOutline& shape) {
  const Extent extent = extent_of(shape);
  for (std::size_t i = 0; i < turret_->clamps.size(); ++i) {
    const SheetClamp& clamp = turret_->clamps[i];
    const Vec2 min = clamp.min_mm + place_.shift_mm() - clamp.clearance_mm;
    const Vec2 max = clamp.max_mm + place_.shift_mm() + clamp.clearance_mm;
    if (!meet(extent, min, max)) continue;
    if (overlap_mm2(shape, rectangle_outline(min, max)) < kLeastOverlap_mm2) continue;
    tell(FindingId::kHitOnClamp, Severity::kError, m, step, stroke.to_mm,
         trf("the punch comes down on clamp {}", i + 1));
    return;
  }
}

void PunchChecks::strikes(const Motion& m, const TimedStep& step, const Cutter& punch,
                          std::span<const CutMove> strokes) {
  for (const CutMove& stroke : strokes) {
    const PlaneOutline shape = footprint_at(punch, stroke);
    if (!turret_->clamps.empty()) check_clamps(m, step, stroke, shape);
    check_edge(m, step, stroke, shape);
    if (freed_.empty()) continue;
    const std::optional<std::uint32_t> number = sheet_.piece_at(Vec2(stroke.to_mm));
    if (!number || *number < uncut_pieces_) continue;
    tell(FindingId::kHitOnPart, Severity::kError, m, step, stroke.to_mm,
         trf("the punch strikes piece {}, which is {} and may have moved", *number,
             free_since(freed_[*number - uncut_pieces_])));
  }
}

/// Material between two strokes of a row that do not touch.
bool PunchChecks::web_between(const Cutter& punch, const CutMove& a, const CutMove& b) const {
  if (!sheet_.has_material(Vec2(0.5 * (a.to_mm + b.to_mm)))) return false;
  return overlap_mm2(footprint_at(punch, a), footprint_at(punch, b)) < kLeastOverlap_mm2;
}

/// Once a motion.
void PunchChecks::check_webs(const Motion& m, const TimedStep& step, const Cutter& punch,
                             std::span<const CutMove> strokes) {
  for (std::size_t i = 1; i < strokes.size(); ++i) {
    const CutMove &a = strokes[i - 1], &b = strokes[i];
    const Vec2 way = Vec2(b.to_mm) - Vec2(a.to_mm);
    const double length = glm::length(way);
    if (length <= 0 || !web_between(punch, a, b)) continue;
    const double reach = reach_along(footprint_at(punch, a), way / length);
    tell(FindingId::kWebLeft, Severity::kWarning, m, step, 0.5 * (a.to_mm + b.to_mm),
         trf("webs stay between the strokes, and the slug with them: {:.2f} mm from one to "
             "the next, and {} reaches {:.2f} mm that way",
             length, punch.spec(), reach));
    return;
  }
}

void PunchChecks::struck(const Motion& m, const TimedStep& step, const Cutter& punch,
                         std::span<const CutMove> strokes, double removed_mm3, bool nibbled) {
  const double stroke_mm3 = area_mm2(footprint_at(punch, strokes.front())) * sheet_.thickness_mm();
  if (removed_mm3 <= kLeastShare * stroke_mm3 && !off_sheet_) {
    tell(FindingId::kHitInAir, Severity::kWarning, m, step, strokes.front().to_mm,
         tr("the punch strikes where nothing is left of the sheet"));
  }
  const double wanted_mm = turret_->pitch_mm(m.tool), length_mm = path_length_mm(m);
  if (nibbled && length_mm > PunchMoves::kMostHits * wanted_mm) {
    tell(FindingId::kWebLeft, Severity::kError, m, step, m.to_mm,
         trf("the move is {:.0f} mm long: with a pitch of {} mm it would take more than {} "
             "strokes; it was nibbled every {:.3f} mm",
             length_mm, wanted_mm, PunchMoves::kMostHits, length_mm / PunchMoves::kMostHits));
  } else if (nibbled) {
    check_webs(m, step, punch, strokes);
  }
  off_sheet_ = false;
}

void PunchChecks::never_struck() {
  Finding out;
  out.id = FindingId::kNoHit;
  out.severity = Severity::kWarning;
  out.text =
      trf("the program never makes the punch strike, nothing is cut; punch.trigger in {} says what "
          "does",
          turret_->path);
  log_.add(std::move(out));
}

}  // namespace kerf
