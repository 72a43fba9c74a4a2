#include "twin/process/milling/checks.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <utility>
#include <vector>

#include "base/translate.h"
#include "stock/way_contact.h"
#include "twin/collision/tool_bodies.h"
#include "twin/motion/motion_geometry.h"

namespace kerf {
namespace {

/// Arcs are searched piece by piece; between the places where a coordinate turns round, which begin
/// pieces of their own, it is monotone. The steps are for spirals and for arcs that climb on a
/// slant, whose coordinates turn elsewhere by a little.
constexpr double kArcStep_deg = 2.0;

/// Part of [t0, t1] where a + t * (b - a) <= limit (below) or >= limit (not below).
bool clip(double a, double b, double limit, bool below, double& t0, double& t1) {
  const double d = b - a;
  const double room = limit - a;
  if (d == 0) return below ? a <= limit : a >= limit;
  const double t = room / d;
  if ((d > 0) == below) {
    t1 = std::min(t1, t);
  } else {
    t0 = std::max(t0, t);
  }
  return t0 <= t1;
}

/// Of an arc: places in 0..1 between which X, Y and Z are monotone, ascending.
std::vector<double> monotone_pieces(const Motion& m) {
  const double sweep = std::abs(m.arc.sweep_rad);
  const int steps = static_cast<int>(std::ceil(sweep * 180 / kPi / kArcStep_deg)) + 1;
  std::vector<double> knots;
  for (int i = 0; i <= steps; ++i) knots.push_back(static_cast<double>(i) / steps);
  const Vec3 arm = m.from_mm - m.arc.center_mm;
  const Vec3 u = arm - glm::dot(arm, m.arc.axis) * m.arc.axis;
  const Vec3 v = glm::cross(m.arc.axis, u) * (m.arc.sweep_rad < 0 ? -1.0 : 1.0);
  for (int i = 0; i < 3 && sweep > 0; ++i) {
    if (u[i] == 0 && v[i] == 0) continue;
    double angle = std::atan2(v[i], u[i]);
    angle -= kPi * std::floor(angle / kPi);
    for (; angle < sweep; angle += kPi) knots.push_back(angle / sweep);
  }
  std::sort(knots.begin(), knots.end());
  return knots;
}

/// The part of [t0, t1], in which coordinate `axis` is monotone, where it is <= limit (below) or >=
/// limit (not below).
bool clip_arc(const Motion& m, int axis, double limit, bool below, double& t0, double& t1) {
  const auto inside = [&](double t) {
    const double place = point_at(m, t)[axis];
    return below ? place <= limit : place >= limit;
  };
  const bool first = inside(t0), last = inside(t1);
  if (first && last) return true;
  if (!first && !last) return false;
  double in = first ? t0 : t1, out = first ? t1 : t0;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (in + out);
    (inside(middle) ? in : out) = middle;
  }
  (first ? t1 : t0) = in;
  return true;
}

double fraction_of(const Motion& m, const Vec3& tip, double length_mm) {
  if (length_mm <= 0) return 0;
  if (m.kind == MotionKind::kArc) return 0;  // the start of the arc is near enough for a time
  return std::min(1.0, glm::length(tip - m.from_mm) / length_mm);
}

}  // namespace

bool Checks::may_touch(const Motion& m, double radius_mm) const {
  const Box way = bounds_of(m);
  return way.min.z < bounds_mm_.max.z && way.min.x - radius_mm < bounds_mm_.max.x &&
         way.max.x + radius_mm > bounds_mm_.min.x && way.min.y - radius_mm < bounds_mm_.max.y &&
         way.max.y + radius_mm > bounds_mm_.min.y;
}

Finding Checks::finding_at(FindingId id, const CheckedMove& move, const Vec3& place,
                           double fraction, std::string text) const {
  const Grounds grounds{options_.blank_guessed, move.tool_guessed};
  Finding finding;
  finding.id = id;
  finding.severity = severity_of(id, grounds);
  finding.text = std::move(text) + doubt_of(id, grounds);
  finding.source = move.motion.source;
  finding.time_s = move.step.time_at(fraction);
  finding.position_mm = place;
  finding.tool = move.tool;
  return finding;
}

/// Of the tool at all tilts that a move can have: the tool from its tip upward as far as the
/// blank's own size is inside a ball of that size.
bool Checks::may_touch(std::span<const CutMove> moves, const Cutter& cutter) const {
  Box way;
  for (const CutMove& move : moves) {
    way.extend(move.from_mm);
    way.extend(move.to_mm);
  }
  const double size = glm::length(bounds_mm_.size()) + cutter.radius_mm();
  for (int axis = 0; axis < 3; ++axis) {
    if (way.min[axis] - size > bounds_mm_.max[axis] || way.max[axis] + size < bounds_mm_.min[axis])
      return false;
  }
  return true;
}

std::optional<Checks::Touch> Checks::first_touch(const CheckedMove& move) const {
  const std::optional<WayContact> met =
      first_contact_of(stock_, move.cutter, move.moves, kContactTolerance_mm, watch_);
  if (!met) return std::nullopt;
  const double within = move.moves.size() == 1
                            ? fraction_of(move.motion, met->contact.tip_mm, move.step.length_mm)
                            : 0;
  return Touch{met->contact, move.share_of(met->move, within)};
}

bool Checks::check_traverse(const CheckedMove& move) {
  const std::optional<Touch> touch = first_touch(move);
  if (!touch) {
    rapid_.reset();
    return false;
  }
  if (!rapid_) {
    Finding finding = finding_at(FindingId::kRapidContact, move, touch->contact.tip_mm,
                                 touch->fraction, tr("traverse touches the workpiece"));
    finding.bodies = {to_string(ToolPart::kCutter), kWorkpieceBody};
    rapid_ = log_.add(std::move(finding));
  }
  log_.deepen(*rapid_, touch->contact.depth_mm);
  return true;
}

std::optional<FindingLog::Handle> Checks::check_standing_spindle(const CheckedMove& move,
                                                                 std::string_view text,
                                                                 Severity severity) {
  const std::optional<Touch> touch = first_touch(move);
  if (!touch) return std::nullopt;
  Finding finding = finding_at(FindingId::kSpindleOffContact, move, touch->contact.tip_mm,
                               touch->fraction, std::string(text));
  finding.severity = std::min(finding.severity, severity);
  finding.depth_mm = touch->contact.depth_mm;
  finding.bodies = {to_string(ToolPart::kCutter), kWorkpieceBody};
  return spindle_ = log_.add(std::move(finding));
}

void Checks::deepen_spindle_event(double depth_mm) {
  if (spindle_) log_.deepen(*spindle_, depth_mm);
}

std::optional<Checks::Below> Checks::below_floor(const Motion& m) const {
  const double limit = bounds_mm_.min.z - options_.below_mm - kContactTolerance_mm;
  if (m.kind != MotionKind::kArc) {
    if (std::min(m.from_mm.z, m.to_mm.z) >= limit) return std::nullopt;
    double t0 = 0;
    double t1 = 1;
    bool inside = clip(m.from_mm.z, m.to_mm.z, limit, true, t0, t1);
    for (int i = 0; inside && i < 2; ++i) {
      inside = clip(m.from_mm[i], m.to_mm[i], bounds_mm_.min[i], false, t0, t1) &&
               clip(m.from_mm[i], m.to_mm[i], bounds_mm_.max[i], true, t0, t1);
    }
    if (!inside) return std::nullopt;
    const double lowest = std::min(point_at(m, t0).z, point_at(m, t1).z);
    return Below{point_at(m, t0), t0, bounds_mm_.min.z - lowest};
  }
  if (bounds_of(m).min.z >= limit) return std::nullopt;
  std::optional<Below> below;
  const std::vector<double> knots = monotone_pieces(m);
  for (std::size_t i = 1; i < knots.size(); ++i) {
    double t0 = knots[i - 1], t1 = knots[i];
    bool inside = clip_arc(m, 2, limit, true, t0, t1);
    for (int axis = 0; inside && axis < 2; ++axis) {
      inside = clip_arc(m, axis, bounds_mm_.min[axis], false, t0, t1) &&
               clip_arc(m, axis, bounds_mm_.max[axis], true, t0, t1);
    }
    if (!inside) continue;
    const Vec3 first = point_at(m, t0);
    if (!below) below = Below{first, t0, 0};
    const double lowest = std::min(first.z, point_at(m, t1).z);
    below->depth_mm = std::max(below->depth_mm, bounds_mm_.min.z - lowest);
  }
  return below;
}

void Checks::check_floor(const CheckedMove& move) {
  const std::optional<Below> below = below_floor(move.motion);
  if (!below) {
    below_.reset();
    return;
  }
  if (!below_) {
    std::string text = tr("tool cuts into the table under the workpiece");
    if (options_.below_mm > 0) {
      text = trf("tool goes deeper under the workpiece than the {:g} mm that are allowed",
                 options_.below_mm);
    }
    Finding finding =
        finding_at(FindingId::kBelowStock, move, below->first_mm, below->fraction, std::move(text));
    if (options_.below_mm == 0) {
      finding.hint =
          tr("over a spoilboard: --below LENGTH (stock.below_mm) says how deep it may go");
    }
    below_ = log_.add(std::move(finding));
  }
  log_.deepen(*below_, below->depth_mm);
}

}  // namespace kerf
