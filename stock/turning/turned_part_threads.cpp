// Moves with a lead: the workpiece turns with them.
#include <algorithm>
#include <cassert>
#include <cmath>
#include <glm/geometric.hpp>
#include <utility>

#include "base/portable_math.h"
#include "stock/turning/turned_part.h"

namespace kerf {
namespace {

using turning::Contour;
using turning::ThreadPass;
using PassPointer = std::shared_ptr<const ThreadPass>;

/// Ends of moves that go on from each other keep this near to the way that is made of them.
constexpr double kStraight_mm = turning::kWayBound_mm;
/// As many places along a pass are looked at for how it cuts, evenly; more only of long ones.
constexpr std::size_t kPlaces = 64;
/// What a pass meets with less area in the section than this is rounding.
constexpr double kLeastArea_mm2 = 1e-6;

struct Radii {
  double low = 0, high = -1;
};

/// Of the material between two places along z.
Radii radii_between(std::span<const Contour> region, double low_z, double high_z) {
  Radii radii{1e300, -1};
  const auto take = [&](const turning::Point& p, const turning::Point& q) {
    Vec2 a = turning::to_mm(p), b = turning::to_mm(q);
    if (a.x > b.x) std::swap(a, b);
    if (b.x < low_z || a.x > high_z) return;
    const auto height = [&](double z) {
      return a.x == b.x ? a.y : a.y + (b.y - a.y) * ((z - a.x) / (b.x - a.x));
    };
    const double first = a.x == b.x ? a.y : height(std::max(low_z, a.x));
    const double last = a.x == b.x ? b.y : height(std::min(high_z, b.x));
    radii.low = std::min({radii.low, first, last});
    radii.high = std::max({radii.high, first, last});
  };
  for (const Contour& contour : region) {
    const std::vector<turning::RunPointer>& runs = contour.runs();
    for (std::size_t r = 0; r < runs.size(); ++r) {
      const turning::Run& run = *runs[r];
      for (std::size_t i = 1; i < run.points.size(); ++i) take(run.points[i - 1], run.points[i]);
      take(run.points.back(), runs[r + 1 == runs.size() ? 0 : r + 1]->points.front());
    }
  }
  return radii;
}

bool is_finite(const Vec2& p) { return std::isfinite(p.x) && std::isfinite(p.y); }

Vec2 mirrored(const Vec2& p) { return {p.x, -p.y}; }

double angle_between(double heading_rad, const Vec2& way) {
  const Vec2 ahead(portable::cos(heading_rad), portable::sin(heading_rad));
  return portable::atan2(ahead.x * way.y - ahead.y * way.x, glm::dot(ahead, way));
}

}  // namespace

std::vector<PassPointer> TurnedPart::passes_of(const TurningTool& tool, const Vec2& from_mm,
                                               const Vec2& to_mm, double lead_mm, double from_turns,
                                               std::uint64_t id) const {
  std::vector<PassPointer> passes;
  for (const bool is_below : {false, true}) {
    const std::vector<turning::GridPart>& parts = is_below ? tool.below_ : tool.parts_;
    const Vec2 from = is_below ? mirrored(from_mm) : from_mm,
               to = is_below ? mirrored(to_mm) : to_mm;
    // Beyond the axis is half a turn farther.
    const double turns = is_below ? from_turns + 0.5 : from_turns;
    for (const turning::GridPart& part : parts) {
      if (std::max(from.y, to.y) + part.reach_mm() <= 0) continue;
      Vec2 low = glm::min(from, to) - part.reach_mm(), high = glm::max(from, to) + part.reach_mm();
      std::optional<ThreadPass> pass;
      // Once more with what the outline then has along z.
      for (int i = 0; i < 2; ++i) {
        const Radii radii = radii_between(contours_, low.x, high.x);
        pass.reset();
        if (radii.low > radii.high) break;
        pass = ThreadPass::create(part, from, to, lead_mm, turns, radii.low, radii.high, id);
        if (!pass) break;
        low = pass->swept_low_mm();
        high = pass->swept_high_mm();
      }
      if (!pass) continue;
      turning::ConvexRegion swept;
      pass->swept(swept);
      turning::ConvexCut cut;
      if (!cut.look(contours_, swept)) continue;
      passes.push_back(std::make_shared<const ThreadPass>(std::move(*pass)));
    }
  }
  return passes;
}

/// From where a move with a lead has ended, in phase: LinuxCNC's spindle stays in step as long as
/// moves with a lead follow each other.
bool TurnedPart::goes_on(const TurnMove& move) const {
  return winding_ && winding_->at_mm == move.from_mm &&
         (winding_->lead_mm < 0) == (move.lead_mm < 0);
}

/// Where the move leaves the part, and what it is a part of. `passes` is that of the move before.
TurnedPart::Winding TurnedPart::winding_after(const TurningTool& tool, const TurnMove& move) const {
  const Vec2 way = move.to_mm - move.from_mm;
  const double length = glm::length(way);
  const bool is_next = goes_on(move);
  Winding after;
  if (is_next) after = *winding_;
  const bool is_same_tool = is_next && winding_->tool->is_like(tool);
  after.id = move.id;
  after.at_mm = move.to_mm;
  if (!is_same_tool) after.tool = std::make_shared<const TurningTool>(tool);
  const double turns = is_next ? winding_->turns : 0;
  after.turns = turns - length / move.lead_mm;
  const Vec2 whole = move.to_mm - after.from_mm;
  const double angle = angle_between(after.heading_rad, whole);
  if (is_same_tool && winding_->lead_mm == move.lead_mm && length > 0 && angle >= after.low_rad &&
      angle <= after.high_rad && glm::dot(whole, way) > 0) {
    const double wide = portable::asin(std::min(1.0, kStraight_mm / glm::length(whole)));
    after.low_rad = std::max(after.low_rad, angle - wide);
    after.high_rad = std::min(after.high_rad, angle + wide);
    return after;
  }
  after.lead_mm = move.lead_mm;
  after.from_mm = move.from_mm;
  after.from_turns = turns;
  after.heading_rad = portable::atan2(way.y, way.x);
  after.high_rad = length > 0 ? portable::asin(std::min(1.0, kStraight_mm / length)) : 0;
  after.low_rad = -after.high_rad;
  after.passes.clear();
  return after;
}

TurnCut TurnedPart::cut_thread(const TurningTool& tool, const TurnMove& move) {
  TurnCut report;
  report.id = move.id;
  // Farther away no tool reaches a blank; the way there would be turns without end.
  std::vector<turning::WayChord> chords;
  turning::append_way(move, kWayReach_mm, chords);
  const bool is_near = chords.size() == 1 && chords[0].from.t == 0 && chords[0].to.t == 1;
  const turning::Wide before = moment6();
  const double missing_before = missing_mm3(), wound_before = threads_.volume_mm3();
  if (!is_finite(move.from_mm) || !is_finite(move.to_mm)) return report;
  Winding after = winding_after(tool, move);
  const std::vector<PassPointer> replaced = std::move(after.passes);
  if (!goes_on(move)) end_winding();
  Vec2 from_mm = after.from_mm, to_mm = move.to_mm;
  double from_turns = after.from_turns;
  if (!is_near && !chords.empty()) {
    from_mm = chords[0].from.at_mm;
    to_mm = chords[0].to.at_mm;
    from_turns -= glm::distance(after.from_mm, from_mm) / move.lead_mm;
  }
  after.passes.clear();
  if (!chords.empty())
    after.passes = passes_of(tool, from_mm, to_mm, move.lead_mm, from_turns, move.id);
  TurnContact first;
  if (is_near)
    measure_thread(after.passes, glm::distance(after.from_mm, move.from_mm), report, first);
  for (const PassPointer& pass : after.passes) touch_bands(pass->swept_box());
  clear_all_round(after.passes);
  threads_.refresh(scratch_.changed, contours_);
  threads_.add(after.passes, replaced, contours_);
  winding_ = std::move(after);
  const double removed = turning::volume_mm3(before - moment6()) -
                         (missing_before - missing_mm3()) - (wound_before - threads_.volume_mm3());
  report.removed_mm3 = std::max(removed, 0.0);
  drop_free_pieces(move.id);
  return report;
}

/// Looks along the ways of new passes, which are not among threads_ yet, from a place on.
void TurnedPart::measure_thread(const std::vector<PassPointer>& fresh, double from_way_mm,
                                TurnCut& report, TurnContact& first) const {
  turning::ThreadIntegral integral;
  for (std::size_t i = 0; i < fresh.size(); ++i) {
    const ThreadPass& pass = *fresh[i];
    std::vector<turning::ProfileEdge>& edges = scratch_.edges;
    edges.clear();
    const Vec2 low = pass.swept_low_mm(), high = pass.swept_high_mm();
    turning::append_edges(contours_, low.x, high.x, low.y, edges);
    const double way = pass.length_mm() - from_way_mm;
    const double cells = way / turning::ThreadIntegral::cell_mm(pass);
    const std::size_t places =
        std::clamp<std::size_t>(static_cast<std::size_t>(cells) + 1, 1, 4 * kPlaces);
    const double step = way / static_cast<double>(places);
    double met_mm = 0;
    for (std::size_t k = 0; k < places; ++k) {
      const double at = from_way_mm + (static_cast<double>(k) + 0.5) * step;
      const turning::ThreadIntegral::Place place =
          integral.look(pass, at, threads_.passes(), edges);
      if (place.area_mm2 < kLeastArea_mm2) continue;
      met_mm += step;
      report.depth_mm = std::max(report.depth_mm, place.height_mm);
      const double t = (at - from_way_mm) / way;
      if (t >= first.t) continue;
      first.t = t;
      first.at_mm = pass.at(at);
    }
    report.way_mm = std::max(report.way_mm, met_mm);
  }
}

/// What passes that lie evenly beside each other, each of them going on from turn to turn, leave
/// nothing of at any angle.
void TurnedPart::clear_all_round(std::span<const PassPointer> fresh) {
  for (const PassPointer& pass : fresh) {
    const double lead = std::abs(pass->lead_mm());
    std::vector<double> places{0};  // of the same outline on the same line, within a lead
    for (const PassPointer& other : threads_.passes()) {
      const Vec2 apart = other->from_mm() - pass->from_mm();
      const double across = apart.x * pass->direction().y - apart.y * pass->direction().x;
      if (glm::distance(other->step_mm(), pass->step_mm()) > 1e-6 * lead ||
          std::abs(across) > turning::kThreadFilm_mm || other->corners() != pass->corners() ||
          other->length_mm() + lead < pass->length_mm())
        continue;
      const double along = glm::dot(apart, pass->direction()) / pass->lead_mm() -
                           (pass->from_turns() - other->from_turns());
      places.push_back(lead * (along - std::floor(along)));
    }
    std::sort(places.begin(), places.end());
    double gap = places.front() + lead - places.back();
    for (std::size_t i = 1; i < places.size(); ++i) gap = std::max(gap, places[i] - places[i - 1]);
    // Where all of them are: from the beginning of the last to the end of the first.
    pass->swept_all_round(gap, scratch_.swept);
    if (scratch_.swept.empty() || !scratch_.cut.look(contours_, scratch_.swept)) continue;
    touch_bands(scratch_.cut.changed());
    scratch_.cut.apply(contours_);
    if (marked_) cut_marked(pass->id());
  }
}

/// The part has turned under the tool where a move with a lead has ended.
void TurnedPart::end_winding() {
  if (!winding_) return;
  const std::shared_ptr<const TurningTool> tool = winding_->tool;
  const TurnMove stop{winding_->at_mm, winding_->at_mm, std::nullopt, winding_->id};
  winding_.reset();
  cut_ring(*tool, stop);
}

/// The grooves of what has fallen are no longer anybody's.
void TurnedPart::drop_threads_of_pieces(std::size_t first_piece) {
  if (threads_.empty()) return;
  for (std::size_t i = first_piece; i < freed_.size(); ++i) {
    TurnedPiece& piece = freed_[i];
    const double before_mm3 = threads_.volume_mm3();
    turning::Rect box;
    box.extend(turning::to_units(Vec2(piece.low_z_mm, piece.low_r_mm)));
    box.extend(turning::to_units(Vec2(piece.high_z_mm, piece.high_r_mm)));
    threads_.refresh(box, contours_);
    piece.volume_mm3 -= before_mm3 - threads_.volume_mm3();
  }
}

std::optional<TurnContact> TurnedPart::thread_contact(const TurningTool& tool,
                                                      const TurnMove& move) const {
  if (!is_finite(move.from_mm) || !is_finite(move.to_mm)) return std::nullopt;
  TurnContact contact;
  contact.t = 2;  // not yet
  TurnCut met;
  const double turns = goes_on(move) ? winding_->turns : 0;
  measure_thread(passes_of(tool, move.from_mm, move.to_mm, move.lead_mm, turns, move.id), 0, met,
                 contact);
  if (contact.t > 1) return std::nullopt;
  contact.depth_mm = met.depth_mm;
  return contact;
}

TurnedProfile TurnedPart::section(double angle_rad) const {
  std::vector<Contour> region = contours_;
  threads_.carve(angle_rad / (2 * kPi), turning::to_mm(blank_.min_x), turning::to_mm(blank_.max_x),
                 scratch_.cut, region);
  if (flats_) turning::cut_flat(*flats_, angle_rad, scratch_.cut, region);
  TurnedProfile profile;
  for (const Contour& contour : region) {
    std::vector<Vec2>& chain = profile.emplace_back();
    for (const turning::Point& p : contour.ring()) chain.push_back(turning::to_mm(p));
  }
  return profile;
}

}  // namespace kerf
