#include "twin/process/milling/checks.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <utility>
#include <vector>

#include "base/translate.h"
#include "stock/way_contact.h"
#include "twin/collision/tool_bodies.h"
#include "twin/job/blank_mesh.h"
#include "twin/motion/motion_geometry.h"

namespace kerf {
namespace {

/// Arcs are looked at as chords that are no farther from them.
constexpr double kChord_mm = 1e-4;

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

/// Along the longer side of a blank from a mesh, where its outline is asked for.
constexpr double kShadowCells = 1024;

struct UnderSpan {
  double begin = 0, end = 1;
};

/// The part in which a straight way, seen from above, is within a circle.
std::optional<UnderSpan> within_circle(const Vec3& from, const Vec3& to, const Vec3& center,
                                       double radius_mm) {
  const Vec2 way(to - from), arm(from - center);
  const double a = glm::dot(way, way), b = glm::dot(way, arm);
  const double c = glm::dot(arm, arm) - radius_mm * radius_mm;
  if (a == 0) return c <= 0 ? std::optional<UnderSpan>(UnderSpan{}) : std::nullopt;
  const double square = b * b - a * c;
  if (square < 0) return std::nullopt;
  const UnderSpan span{std::max(0.0, (-b - std::sqrt(square)) / a),
                       std::min(1.0, (-b + std::sqrt(square)) / a)};
  return span.begin <= span.end ? std::optional<UnderSpan>(span) : std::nullopt;
}

/// Parts of a straight way: a tube's outline has a hole.
/// Makes of a span what of it comes under the blank, from its first place to its last; false: none
/// does. Looked at cell by cell.
bool enter_shadow(const BlankShadow& shadow, const Vec3& from, const Vec3& to, UnderSpan& span) {
  const Vec3 way = to - from;
  const double length = (span.end - span.begin) * std::hypot(way.x, way.y);
  const int steps = static_cast<int>(std::ceil(length / shadow.cell_mm())) + 1;
  std::optional<UnderSpan> under;
  for (int n = 0; n <= steps; ++n) {
    const double t = span.begin + (span.end - span.begin) * n / steps;
    const Vec3 at = from + t * way;
    if (!shadow.covers(at.x, at.y)) continue;
    if (!under) under = UnderSpan{t, t};
    under->end = t;
  }
  if (under) span = *under;
  return under.has_value();
}

struct UnderSpans {
  std::array<UnderSpan, 2> of;
  int count = 0;
  void add(double begin, double end) {
    if (begin <= end) of[static_cast<std::size_t>(count++)] = {begin, end};
  }
};

/// Where it is no higher than the limit, and under the body.
UnderSpans spans_under(const BlankBody& body, const Vec3& from, const Vec3& to, double limit_mm) {
  UnderSpans out;
  UnderSpan in;
  bool inside = clip(from.z, to.z, limit_mm, true, in.begin, in.end);
  for (int i = 0; inside && i < 2; ++i) {
    inside = clip(from[i], to[i], body.bounds_mm.min[i], false, in.begin, in.end) &&
             clip(from[i], to[i], body.bounds_mm.max[i], true, in.begin, in.end);
  }
  const bool is_tube = body.kind == BlankBody::Kind::kTube && body.axis == 'z';
  const bool is_round = is_tube || (body.kind == BlankBody::Kind::kCylinder && body.axis == 'z');
  if (inside && is_round) {
    const auto round = within_circle(from, to, body.center_mm, body.diameter_mm / 2);
    if (!round) return out;
    in = {std::max(in.begin, round->begin), std::min(in.end, round->end)};
  }
  if (!inside || in.begin > in.end) return out;
  const auto hole =
      is_tube ? within_circle(from, to, body.center_mm, body.inner_diameter_mm / 2) : std::nullopt;
  if (!hole) {
    out.add(in.begin, in.end);
    return out;
  }
  // A way that ends in the hole ends at its end.
  if (in.begin < hole->begin) out.add(in.begin, std::min(in.end, hole->begin));
  if (hole->end < in.end) out.add(std::max(in.begin, hole->end), in.end);
  return out;
}

/// Places in 0..1 between which the motion is taken as straight, ascending; of an arc also those
/// where a coordinate turns round, so that its lowest place is one.
std::vector<double> chord_ends(const Motion& m) {
  if (m.kind != MotionKind::kArc) return {0, 1};
  const double sweep = std::abs(m.arc.sweep_rad);
  const double radius =
      std::max(glm::length(m.from_mm - m.arc.center_mm), glm::length(m.to_mm - m.arc.center_mm));
  const double step = 2 * std::acos(std::max(0.0, 1 - kChord_mm / std::max(radius, kChord_mm)));
  const int steps = std::max(1, static_cast<int>(std::ceil(sweep / step)));
  std::vector<double> ends;
  for (int i = 0; i <= steps; ++i) ends.push_back(static_cast<double>(i) / steps);
  const Vec3 arm = m.from_mm - m.arc.center_mm;
  const Vec3 u = arm - glm::dot(arm, m.arc.axis) * m.arc.axis;
  const Vec3 v = glm::cross(m.arc.axis, u) * (m.arc.sweep_rad < 0 ? -1.0 : 1.0);
  for (int i = 0; i < 3 && sweep > 0; ++i) {
    if (u[i] == 0 && v[i] == 0) continue;
    double angle = std::atan2(v[i], u[i]);
    angle -= kPi * std::floor(angle / kPi);
    for (; angle < sweep; angle += kPi) ends.push_back(angle / sweep);
  }
  std::ranges::sort(ends);
  return ends;
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

void Checks::set_options(const CheckOptions& options) {
  options_ = options;
  shadow_ = nullptr;
  if (!options.blank.mesh || !options.blank.mesh->body) return;
  const Vec3 size = bounds_mm_.size();
  shadow_ = std::make_shared<const BlankShadow>(*options.blank.mesh->body,
                                                std::max(size.x, size.y) / kShadowCells);
}

std::optional<Checks::Below> Checks::below_floor(const Motion& m) const {
  const double floor = bounds_mm_.min.z;
  const double limit = floor - options_.below_mm - kContactTolerance_mm;
  if (bounds_of(m).min.z >= limit) return std::nullopt;
  BlankBody box;
  box.bounds_mm = bounds_mm_;
  const std::span<const BlankBody> bodies =
      options_.blank.bodies.empty() ? std::span<const BlankBody>(&box, 1) : options_.blank.bodies;
  std::optional<Below> below;
  const std::vector<double> ends = chord_ends(m);
  Vec3 from = point_at(m, 0);
  for (std::size_t i = 1; i < ends.size(); ++i) {
    const Vec3 to = point_at(m, ends[i]);
    for (const BlankBody& body : bodies) {
      const UnderSpans spans = spans_under(body, from, to, limit);
      for (UnderSpan span : std::span(spans.of).first(static_cast<std::size_t>(spans.count))) {
        if (shadow_ && !enter_shadow(*shadow_, from, to, span)) continue;
        const double fraction = ends[i - 1] + span.begin * (ends[i] - ends[i - 1]);
        const double low =
            std::min(from.z + span.begin * (to.z - from.z), from.z + span.end * (to.z - from.z));
        const double depth = std::max(below ? below->depth_mm : 0, floor - low);
        if (!below || fraction < below->fraction)
          below = Below{from + span.begin * (to - from), fraction, depth};
        below->depth_mm = depth;
      }
    }
    from = to;
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
