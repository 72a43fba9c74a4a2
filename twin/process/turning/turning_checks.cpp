#include "twin/process/turning/turning_checks.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <utility>

#include "base/translate.h"
#include "stock/way_contact.h"
#include "twin/collision/tool_bodies.h"
#include "twin/motion/motion_geometry.h"
#include "twin/process/contact_grounds.h"
#include "twin/process/finding_at.h"

namespace kerf {
namespace {

constexpr std::size_t kMostFaces = 64;
/// Of a traverse: it touches from the first, as soon as that is a contact (kContactTolerance_mm).
constexpr double kAtOnce_mm = 0.5;
/// Faces are turned along X alone.
constexpr double kAlong_mm = 1e-6;

double side_of(const std::array<double, kInsertSides>& sides, InsertSide side) {
  return sides[static_cast<std::size_t>(side)];
}

/// The tool lies on the side of positive X from its controlled point.
bool is_above(const InsertOutline& outline) {
  double low = 0, high = 0;
  for (const InsertPart& part : outline.parts) {
    for (const InsertEdge& edge : part) {
      low = std::min(low, edge.end_mm.y);
      high = std::max(high, edge.end_mm.y);
    }
  }
  return high >= -low;
}

/// Of the nose, the greatest; 0: it has none.
double nose_radius_mm(const InsertOutline& outline) {
  double radius = 0;
  for (const InsertPart& part : outline.parts) {
    for (const InsertEdge& edge : part) {
      if (edge.side != InsertSide::kNose || !edge.center_mm) continue;
      radius = std::max(radius, glm::length(edge.end_mm - *edge.center_mm));
    }
  }
  return radius;
}

/// Even-odd.
bool is_inside(const TurnedProfile& profile, const Vec2& p) {
  bool inside = false;
  for (const std::vector<Vec2>& ring : profile) {
    for (std::size_t i = 0, j = ring.size() - 1; i < ring.size(); j = i++) {
      const Vec2 &a = ring[i], &b = ring[j];
      if ((a.y > p.y) == (b.y > p.y)) continue;
      if (p.x < a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x)) inside = !inside;
    }
  }
  return inside;
}

}  // namespace

std::vector<TurnMove> rings_of(const TurnedMove& move) {
  std::vector<TurnMove> turns;
  for (const CutMove& cut : move.moves) {
    for (TurnMove& turn : turning_moves(cut)) {
      turn.lead_mm = 0;
      turns.push_back(std::move(turn));
    }
  }
  return turns;
}

bool TurningChecks::may_touch(const TurnedMove& move) const {
  const Box blank = stock_.bounds_mm();
  if (move.cutter.live()) {
    // A tool that reaches through the blank, at whatever angle.
    const double reach_mm = glm::length(blank.size()) + move.cutter.radius_mm();
    Box way;
    for (const CutMove& one : move.moves) {
      way.extend(one.from_mm);
      way.extend(one.to_mm);
    }
    for (int axis = 0; axis < 3; ++axis)
      if (way.min[axis] - reach_mm > blank.max[axis] || way.max[axis] + reach_mm < blank.min[axis])
        return false;
    return true;
  }
  const double reach_mm =
      move.cutter.insert() ? outline_reach_mm(*move.cutter.insert()) : move.cutter.radius_mm();
  // A tool that stands along the axis reaches towards +z from its tip.
  const double above_mm = move.cutter.insert() ? reach_mm : 0;
  const Box way = bounds_of(move.motion);
  return way.min.z - above_mm < blank.max.z && way.max.z + kMaxInsertReach_mm > blank.min.z &&
         way.min.x - reach_mm < blank.max.x && way.max.x + reach_mm > -blank.max.x;
}

Finding TurningChecks::finding_of(FindingId id, const TurnedMove& move, double share,
                                  std::string text) const {
  const Grounds grounds{options_.blank_guessed, move.tool_guessed};
  Finding finding =
      finding_at(id, severity_of(id, grounds), move.motion.source, move.step.time_at(share));
  finding.text = std::move(text) + doubt_of(id, grounds);
  finding.position_mm = point_at(move.motion, share);
  finding.tool = move.tool;
  return finding;
}

std::optional<TurningChecks::Touch> TurningChecks::first_touch(const TurnedMove& move) const {
  if (move.cutter.live()) return first_milled_touch(move);
  std::optional<Touch> first;
  for (std::size_t i = 0; i < move.moves.size(); ++i) {
    const auto met = stock_.first_turn_contact(move.edges, move.moves[i], kContactTolerance_mm);
    if (!met) continue;
    if (!first) first = Touch{0, move.share_of(i, met->t), true};
    first->by_edges = first->by_edges && side_of(met->side_mm, InsertSide::kBody) <= 0 &&
                      side_of(met->side_mm, InsertSide::kHolder) <= 0;
    first->depth_mm = std::max(first->depth_mm, met->depth_mm);
  }
  return first;
}

std::optional<TurningChecks::Touch> TurningChecks::first_milled_touch(
    const TurnedMove& move) const {
  const std::optional<WayContact> met =
      first_contact_of(model_, move.cutter, move.moves, kContactTolerance_mm, {});
  if (!met) return std::nullopt;
  const CutMove& at = move.moves[met->move];
  const double length_mm = glm::length(at.to_mm - at.from_mm);
  const double within =
      at.arc || length_mm <= 0
          ? 0
          : std::min(1.0, glm::length(met->contact.tip_mm - at.from_mm) / length_mm);
  return Touch{met->contact.depth_mm, move.share_of(met->move, within)};
}

void TurningChecks::check_traverse(const TurnedMove& move, bool behind_feed) {
  const std::optional<Touch> touch = first_touch(move);
  if (!touch) {
    rapid_.reset();
    return;
  }
  if (!rapid_) {
    // From a shoulder straight out the edge takes what its own slant has left there: it marks the
    // part, and breaks nothing.
    const bool drags = behind_feed && touch->by_edges &&
                       touch->share * move.step.length_mm < kAtOnce_mm &&
                       touch->depth_mm <= kSliver_mm;
    std::optional<FindingLog::Handle>& of_block = of_block_[drags ? 1 : 0];
    if (of_block) return log_.deepen(*of_block, touch->depth_mm);
    Finding finding =
        finding_of(FindingId::kRapidContact, move, touch->share,
                   drags ? tr("traverse drags along the shoulder that the feed before "
                              "it has left")
                         : tr("traverse touches the workpiece"));
    if (drags) {
      finding.severity = std::min(finding.severity, Severity::kWarning);
      finding.hint = tr("a feed along the shoulder first, or away from it along X and Z at once");
    }
    finding.bodies = {to_string(ToolPart::kCutter), kWorkpieceBody};
    rapid_ = of_block = log_.add(std::move(finding));
  }
  log_.deepen(*rapid_, touch->depth_mm);
}

void TurningChecks::check_standing(const TurnedMove& move) {
  const std::optional<Touch> touch = first_touch(move);
  if (!touch) return;
  if (!standing_) {
    const bool unsaid = move.motion.spindle != SpindleState::kStopped && !move.motion.speed_said;
    Finding finding = finding_of(
        FindingId::kSpindleOffContact, move, touch->share,
        move.cutter.live()
            ? tr("feed move of a driven tool touches the workpiece while no spindle turns")
        : move.motion.spindle == SpindleState::kStopped
            ? tr("feed move touches the workpiece while the spindle stands")
        : unsaid
            ? tr("feed move touches the workpiece at 0 rpm: the spindle is told to turn, and no S "
                 "word says how fast; is its speed set by hand?")
            : tr("feed move touches the workpiece while the spindle is told to turn at S0 (0 "
                 "rpm)"));
    if (unsaid) finding.severity = std::min(finding.severity, Severity::kWarning);
    finding.bodies = {to_string(ToolPart::kCutter), kWorkpieceBody};
    standing_ = log_.add(std::move(finding));
  }
  log_.deepen(*standing_, touch->depth_mm);
}

/// What is no edge must not touch at all; of two edges one leads, and the other one, which trails,
/// must not be in material. A move straight towards the axis or along it has no trailing edge in
/// that sense: a pointed tool that plunges cuts with both.
void TurningChecks::check_sides(const TurnedMove& move, const TurnCut& cut) {
  const double body_mm = side_of(cut.side_mm, InsertSide::kBody);
  const Vec3 way = move.motion.to_mm - move.motion.from_mm;
  const bool is_arc = move.motion.kind == MotionKind::kArc;
  const bool along = !is_arc && (std::abs(way.z) < kAlong_mm || std::abs(way.x) < kAlong_mm);
  const bool threads = move.motion.kind == MotionKind::kThread;
  const double flank_mm = along || threads ? 0 : cut.flanks_mm;
  const bool body = body_mm > kContactTolerance_mm;
  if (!body && flank_mm <= kFlank_mm) {
    flank_.reset();
    return;
  }
  if (!flank_) {
    Finding finding = finding_of(
        FindingId::kFlankContact, move, 0,
        body ? tr("what of the tool does not cut (the insert's body, its shank) runs into the "
                  "workpiece")
             : tr("the flank that trails runs into the workpiece: the contour falls more steeply "
                  "than the insert can follow"));
    // That edge cuts as well, and leaves another contour; it does not break.
    if (!body) finding.severity = std::min(finding.severity, Severity::kWarning);
    finding.bodies = {to_string(ToolPart::kCutter), kWorkpieceBody};
    flank_ = log_.add(std::move(finding));
  }
  log_.deepen(*flank_, std::max(body_mm, flank_mm));
}

void TurningChecks::check_centre(const TurnedMove& move, const TurnCut& cut) {
  if (cut.removed_mm3 <= 0 || !move.cutter.insert()) return;
  note_face(move);
  if (centre_told_) return;
  const InsertOutline& outline = *move.cutter.insert();
  const double sign = is_above(outline) ? 1 : -1;
  const double from = sign * move.motion.from_mm.x, to = sign * move.motion.to_mm.x;
  const double allowed = 2 * nose_radius_mm(outline) + kBeyond_mm;
  if (std::min(from, to) >= -allowed || std::max(from, to) <= -allowed) return;
  centre_told_ = true;
  const double share =
      std::abs(from - to) > 0 ? (std::max(from, to) + allowed) / std::abs(to - from) : 0;
  Finding finding = finding_of(
      FindingId::kPastCentre, move, from > to ? share : 0,
      tr("the tool cuts on beyond the axis, where the workpiece comes from the other side"));
  finding.severity = Severity::kWarning;
  finding.depth_mm = -std::min(from, to);
  log_.add(std::move(finding));
}

/// A feed along X that ends near the axis.
void TurningChecks::note_face(const TurnedMove& move) {
  const Motion& m = move.motion;
  if (m.kind != MotionKind::kFeed || std::abs(m.to_mm.z - m.from_mm.z) > kAlong_mm) return;
  if (std::abs(m.to_mm.x) > kPipWidest_mm / 2 || std::abs(m.from_mm.x) <= std::abs(m.to_mm.x))
    return;
  const auto known = std::find_if(faces_.begin(), faces_.end(), [&](const Face& face) {
    return std::abs(face.z_mm - m.to_mm.z) < kPipHeight_mm;
  });
  const Face face{m.to_mm.z, m.source, move.step.start_s, move.tool};
  if (known != faces_.end()) {
    *known = face;
  } else if (faces_.size() < kMostFaces) {
    faces_.push_back(face);
  }
}

void TurningChecks::tell_pip(const Face& face) {
  const TurnedProfile profile = stock_.part().profile();
  // Rather off the corners of the profile.
  constexpr double kOff_mm = 1.3e-4;
  const double z = face.z_mm + kPipHeight_mm;
  if (!is_inside(profile, {z, kOff_mm})) return;
  double low = 0, high = kPipWidest_mm / 2;
  if (is_inside(profile, {z, high})) return;
  // Behind it there is no more of the workpiece: it is the end.
  for (int i = 0; i < 40; ++i) {
    const double middle = (low + high) / 2;
    (is_inside(profile, {z, middle + kOff_mm}) ? low : high) = middle;
  }
  Finding finding = finding_at(FindingId::kPipLeft, Severity::kNote, face.source, face.time_s);
  finding.tool = face.tool;
  finding.position_mm = Vec3(low, 0, face.z_mm);
  finding.text =
      trf("a pip {:.2f} mm thick stays in the middle of the face at Z{:g}: a nose of radius R "
          "cleans it "
          "where it is driven by R beyond the axis",
          2 * low, face.z_mm);
  log_.add(std::move(finding));
}

void TurningChecks::check_plane(const Motion& m, const TimedStep& step) {
  if (plane_told_ || m.kind != MotionKind::kArc || std::abs(m.arc.axis.y) == 1) return;
  plane_told_ = true;
  Finding finding = finding_at(FindingId::kWrongPlane, Severity::kError, m, step);
  finding.tool = m.tool;
  finding.position_mm = m.from_mm;
  finding.text = std::abs(m.arc.axis.z) == 1
                     ? tr("the arc lies in the XY plane (G17), in which no lathe turns: it would "
                          "move Y")
                     : tr("the arc does not lie in the XZ plane");
  finding.hint = tr("G18 at the beginning: LinuxCNC begins with G17, on a lathe as well");
  log_.add(std::move(finding));
}

void TurningChecks::note_block(const SourceRef& source) {
  if (source == block_) return;
  block_ = source;
  of_block_ = {};
}

void TurningChecks::end_tool() {
  rapid_.reset();
  of_block_ = {};
  standing_.reset();
  flank_.reset();
  centre_told_ = false;
}

void TurningChecks::finish() {
  for (const Face& face : faces_) tell_pip(face);
  faces_.clear();
}

void TurningChecks::forget() {
  end_tool();
  faces_.clear();
  plane_told_ = false;
}

}  // namespace kerf
