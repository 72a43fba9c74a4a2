#include "twin/process/turning/nose_checks.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <set>
#include <utility>

#include "base/portable_math.h"
#include "base/translate.h"
#include "stock/cutter/insert_shape.h"
#include "stock/cutter/turning_shape.h"
#include "twin/process/finding_at.h"

namespace kerf {
namespace {

/// A surface that is so near to where a move has left it is that one.
constexpr double kSurface_mm = 2e-3;
/// Places along an arc: an error changes slowly with its direction.
constexpr int kArcPlaces = 32;

double turn_from(double from_rad, double to_rad) {
  const double turn = std::fmod(to_rad - from_rad, 2 * kPi);
  return turn < 0 ? turn + 2 * kPi : turn;
}

double distance_to(const Vec2& a, const Vec2& b, const Vec2& p) {
  const Vec2 along = b - a;
  const double length2 = glm::dot(along, along);
  const double share = length2 > 0 ? std::clamp(glm::dot(p - a, along) / length2, 0.0, 1.0) : 0;
  return glm::distance(p, a + share * along);
}

}  // namespace

bool NoseChecks::Nose::touches(const Vec2& way_out) const {
  constexpr double kSlack_rad = 1e-6;
  const double angle = portable::atan2(-way_out.y, -way_out.x);
  return turn_from(start_rad - kSlack_rad, angle) <= sweep_rad + 2 * kSlack_rad;
}

void NoseChecks::mount(const Cutter& cutter, int tool) {
  unmount();
  const InsertTip& tip = cutter.insert_tip();
  if (!cutter.insert() || tip.orientation < 1 || tip.orientation >= kOrientations ||
      tip.nose_radius_mm <= 0 || insert_use_of(cutter).goes_its_path) {
    return;
  }
  Nose nose;
  nose.radius_mm = tip.nose_radius_mm;
  nose.centre_mm = tip.nose_radius_mm * nose_direction(tip.orientation);
  nose.tool = tool;
  for (const InsertPart& part : cutter.insert()->parts) {
    Vec2 from = part.back().end_mm;
    for (const InsertEdge& edge : part) {
      const bool is_nose = edge.side == InsertSide::kNose && edge.center_mm &&
                           glm::distance(*edge.center_mm, nose.centre_mm) < kSurface_mm;
      if (is_nose) {
        const Vec2 a = from - nose.centre_mm, b = edge.end_mm - nose.centre_mm;
        nose.start_rad = portable::atan2(a.y, a.x);
        nose.sweep_rad = turn_from(nose.start_rad, portable::atan2(b.y, b.x));
        nose_ = nose;
      }
      from = edge.end_mm;
    }
  }
}

/// The surface is where the nose touches a line along the way; the programmed one goes through the
/// controlled point.
void NoseChecks::look(const TurnedMove& move, const Vec2& way, const Vec2& at, double share,
                      std::optional<Found>& worst) const {
  Vec2 out(-way.y, way.x);
  if (glm::dot(out, nose_->centre_mm) < 0) out = -out;
  if (!nose_->touches(out)) return;
  const double off = glm::dot(out, nose_->centre_mm) - nose_->radius_mm;
  if (std::abs(off) < kLeast_mm || (worst && std::abs(off) <= worst->off_mm)) return;
  const Vec2 surface = at + nose_->centre_mm - nose_->radius_mm * out;
  worst = Found{std::abs(off),
                surface,
                Vec3(at.y, move.motion.from_mm.y, at.x),
                move.motion.source,
                move.step.time_at(share),
                nose_->tool,
                nose_->radius_mm};
}

void NoseChecks::note(const TurnedMove& move, const TurnCut& cut) {
  const Motion& m = move.motion;
  if (!nose_ || m.compensated || cut.removed_mm3 <= 0) return;
  if (m.kind == MotionKind::kThread || m.length.displaces) return;
  std::optional<Found> worst;
  const Vec2 from(m.from_mm.z, m.from_mm.x), to(m.to_mm.z, m.to_mm.x);
  if (m.kind != MotionKind::kArc) {
    if (from == to) return;
    look(move, glm::normalize(to - from), 0.5 * (from + to), 0.5, worst);
  } else if (std::abs(m.arc.axis.y) == 1) {
    // Counter-clockwise with z to the right and x up is about +Y.
    const Vec2 centre(m.arc.center_mm.z, m.arc.center_mm.x);
    const Vec2 a = from - centre;
    const double start = portable::atan2(a.y, a.x), sweep = m.arc.axis.y * m.arc.sweep_rad;
    const double r0 = glm::length(a), r1 = glm::distance(to, centre);
    for (int i = 0; i <= kArcPlaces; ++i) {
      // Not its very ends, which what comes next may cut off.
      const double share = std::clamp(static_cast<double>(i) / kArcPlaces, 0.002, 0.998);
      const double angle = start + share * sweep, r = r0 + share * (r1 - r0);
      const Vec2 radial(portable::cos(angle), portable::sin(angle));
      look(move, {-radial.y, radial.x}, centre + r * radial, share, worst);
    }
  }
  if (!worst) return;
  const auto same = std::ranges::find_if(found_, [&](const Found& found) {
    return found.tool == worst->tool && found.source == worst->source;
  });
  if (same != found_.end()) {
    // Of one line the last cut is what may be left.
    *same = *worst;
    return;
  }
  found_.push_back(*worst);
  const auto of_tool =
      std::ranges::count_if(found_, [&](const Found& found) { return found.tool == worst->tool; });
  if (static_cast<std::size_t>(of_tool) <= kMostLines) return;
  auto least = found_.end();
  for (auto it = found_.begin(); it != found_.end(); ++it) {
    if (it->tool == worst->tool && (least == found_.end() || it->off_mm < least->off_mm))
      least = it;
  }
  found_.erase(least);
}

bool NoseChecks::is_there(const TurnedProfile& profile, const Vec2& place) const {
  const Vec2 p(place.x, std::abs(place.y));
  for (const std::vector<Vec2>& ring : profile) {
    for (std::size_t i = 0; i < ring.size(); ++i) {
      if (distance_to(ring[i], ring[(i + 1) % ring.size()], p) < kSurface_mm) return true;
    }
  }
  return false;
}

void NoseChecks::finish() {
  if (found_.empty()) return;
  std::ranges::stable_sort(found_,
                           [](const Found& a, const Found& b) { return a.off_mm > b.off_mm; });
  const TurnedProfile profile = stock_.part().profile();
  std::set<int> told;
  for (const Found& found : found_) {
    if (told.contains(found.tool) || !is_there(profile, found.surface_mm)) continue;
    told.insert(found.tool);
    Finding finding =
        finding_at(FindingId::kUncompensated, Severity::kNote, found.source, found.time_s);
    finding.text =
        trf("without nose radius compensation the contour that is cut is up to {:.3f} mm off the "
            "programmed one (a nose of R{:g})",
            found.off_mm, found.radius_mm);
    finding.position_mm = found.place_mm;
    finding.tool = found.tool;
    finding.hint =
        tr("G42 or G41 before the contour; where CAM has compensated the program beforehand, "
           "path=tool in the tool's SHAPE says so");
    log_.add(std::move(finding));
  }
  found_.clear();
}

}  // namespace kerf
