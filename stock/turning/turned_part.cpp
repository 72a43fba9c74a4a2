#include "stock/turning/turned_part.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cassert>
#include <cmath>
#include <memory>
#include <span>
#include <utility>

#include "stock/turning/revolve.h"

#define XXH_INLINE_ALL
#include <xxhash.h>

namespace kerf {
namespace {

using turning::Contour;
using turning::Point;
using turning::Rect;
using turning::Ring;
using turning::Wide;

static_assert(TurnedPart::kWayReach_mm + kMaxInsertReach_mm <= turning::kMaxCoordinate_mm);

bool is_allowed(const Vec2& p) {
  return std::abs(p.x) <= kMaxTurnedZ_mm && p.y >= 0 &&
         p.y <= kMaxTurnedRadius_mm;  // not true of NaN
}

bool lies_in(const Contour& hole, const Ring& ring) {
  for (const Point& p : hole.ring()) {
    const plane::Side side = plane::locate(p, ring);
    if (side != plane::Side::kBorder) return side == plane::Side::kInside;
  }
  return false;
}

Contour contour_of(const Ring& ring) {
  turning::ContourBuilder builder;
  for (const Point& p : ring) builder.append(p);
  return builder.close();
}

Point mirrored(const Point& p) { return {p.X, -p.Y}; }

/// The piece that the chuck holds; none where there is but one.
std::optional<std::size_t> piece_held(const std::vector<Contour>& contours, ChuckSide chuck) {
  std::size_t outer = 0, held = 0;
  const auto before = [&](const Contour& a, const Contour& b) {
    const turning::Unit reach =
        chuck == ChuckSide::kLowZ ? b.box().min_x - a.box().min_x : a.box().max_x - b.box().max_x;
    if (reach != 0) return reach > 0;
    const turning::Unit wider = a.box().max_y - b.box().max_y;
    return wider != 0 ? wider > 0 : a.moment6() > b.moment6();
  };
  for (std::size_t i = 0; i < contours.size(); ++i) {
    if (!contours[i].is_outer()) continue;
    if (outer++ == 0 || before(contours[i], contours[held])) held = i;
  }
  if (outer < 2) return std::nullopt;
  return held;
}

/// With the holes in it.
void keep_piece(std::vector<Contour>& contours, std::size_t piece) {
  const Ring ring = contours[piece].ring();
  std::vector<Contour> kept;
  for (std::size_t i = 0; i < contours.size(); ++i) {
    if (i == piece || (!contours[i].is_outer() && lies_in(contours[i], ring)))
      kept.push_back(std::move(contours[i]));
  }
  contours = std::move(kept);
}

}  // namespace

TurnedProfile bar_profile(double low_z_mm, double high_z_mm, double diameter_mm) {
  const double r = diameter_mm / 2;
  return {{{low_z_mm, 0}, {high_z_mm, 0}, {high_z_mm, r}, {low_z_mm, r}}};
}

TurnedProfile tube_profile(double low_z_mm, double high_z_mm, double diameter_mm, double bore_mm) {
  const double r = diameter_mm / 2, bore = bore_mm / 2;
  return {{{low_z_mm, bore}, {high_z_mm, bore}, {high_z_mm, r}, {low_z_mm, r}}};
}

TurningTool::TurningTool(const InsertOutline& outline) {
  assert(outline_reach_mm(outline) <= kMaxInsertReach_mm);
  for (const InsertPart& part : outline.parts) parts_.emplace_back(part);
  for (const InsertPart& part : mirrored_in_x(outline).parts) below_.emplace_back(part);
}

TurningTool TurningTool::inset(double width_mm) const {
  TurningTool tool;
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    turning::GridPart part = parts_[i].inset(width_mm);
    if (part.empty()) continue;
    tool.parts_.push_back(std::move(part));
    tool.below_.push_back(below_[i].inset(width_mm));
  }
  return tool;
}

bool TurningTool::is_like(const TurningTool& other) const {
  const auto same = [](const turning::GridPart& a, const turning::GridPart& b) {
    return a.corners() == b.corners();
  };
  return std::equal(parts_.begin(), parts_.end(), other.parts_.begin(), other.parts_.end(), same);
}

std::optional<TurnedPart> TurnedPart::create(const TurnedProfile& blank, ChuckSide chuck,
                                             const std::optional<BarFlats>& flats) {
  turning::Rings rings, united;
  for (const std::vector<Vec2>& chain : blank) {
    Ring& ring = rings.emplace_back();
    for (const Vec2& p : chain) {
      if (!is_allowed(p)) return std::nullopt;
      ring.push_back(turning::to_units(p));
    }
  }
  ClipperLib::Clipper clipper;
  clipper.AddPaths(rings, ClipperLib::ptSubject, true);
  clipper.Execute(ClipperLib::ctUnion, united, ClipperLib::pftEvenOdd, ClipperLib::pftEvenOdd);
  TurnedPart part;
  std::size_t pieces = 0;
  for (const Ring& ring : united) {
    Contour contour = contour_of(ring);
    if (contour.runs().empty()) continue;
    pieces += contour.is_outer() ? 1 : 0;
    part.blank_.extend(contour.box());
    part.contours_.push_back(std::move(contour));
  }
  if (pieces != 1) return std::nullopt;
  part.chuck_ = chuck;
  part.flats_ = flats;
  part.blank_mm3_ = part.remaining_mm3();
  part.touch_all();
  return part;
}

/// How the tool was in material, over the move: calls each(chord, met) for every part of the tool
/// on every chord, above the axis and below, that meets material, which is then in scratch_.cut.
/// The side that the tool comes from is first: beyond the axis it finds what it has left. From the
/// axis itself, the side that it goes to.
template <class Each>
turning::Engagement TurnedPart::each_swept(const TurningTool& tool, const TurnMove& move,
                                           Each&& each) const {
  Scratch& s = scratch_;
  s.chords.clear();
  turning::append_way(move, kWayReach_mm, s.chords);
  turning::Engagement whole;
  for (const turning::WayChord& chord : s.chords) {
    const Point from = turning::to_units(chord.from.at_mm), to = turning::to_units(chord.to.at_mm);
    const bool begins_below = from.Y < 0 || (from.Y == 0 && to.Y < 0);
    turning::Engagement on_chord;
    for (std::size_t i = 0; i < tool.parts_.size(); ++i) {
      for (const bool is_below : {begins_below, !begins_below}) {
        const Point a = is_below ? mirrored(from) : from, b = is_below ? mirrored(to) : to;
        const turning::GridPart& part = is_below ? tool.below_[i] : tool.parts_[i];
        if (std::max(a.Y, b.Y) + turning::to_units(part.reach_mm()) <= 0) continue;
        part.sweep(a, b, s.sweep, s.swept, s.lead);
        if (s.swept.empty() || s.swept.box().max_y <= 0 || !s.cut.look(contours_, s.swept))
          continue;
        const turning::Engagement met = s.gauge.measure(s.cut, s.lead, Point{b.X - a.X, b.Y - a.Y});
        on_chord.join(met);
        each(chord, met);
      }
    }
    whole.extend(on_chord);
  }
  return whole;
}

/// Whether what is hardly there leaves less when it is cut: corners are rounded either way.
bool TurnedPart::thins() const {
  std::vector<Contour> rest = contours_;
  scratch_.cut.apply(rest);
  Wide after = 0;
  for (const Contour& contour : rest) after += contour.moment6();
  return after < moment6();
}

turning::Engagement TurnedPart::cut_ring(const TurningTool& tool, const TurnMove& move) {
  return each_swept(tool, move, [&](const turning::WayChord&, const turning::Engagement& met) {
    if (!met.any && !thins()) return;
    touch_bands(scratch_.cut.changed());
    scratch_.cut.apply(contours_);
    if (marked_) cut_marked(move.id);
  });
}

TurnCut TurnedPart::cut(const TurningTool& tool, const TurnMove& move) {
  scratch_.changed = {};
  sections_.reset();
  if (move.winds()) return cut_thread(tool, move);
  TurnCut report;
  report.id = move.id;
  const Wide before = moment6();
  const double missing_before = missing_mm3(), wound_before = threads_.volume_mm3();
  end_winding();
  const turning::Engagement engagement = cut_ring(tool, move);
  threads_.refresh(scratch_.changed, contours_);
  const double removed = turning::volume_mm3(before - moment6()) -
                         (missing_before - missing_mm3()) - (wound_before - threads_.volume_mm3());
  report.removed_mm3 = std::max(removed, 0.0);
  report.depth_mm = engagement.across_mm;
  report.way_mm = engagement.way_mm;
  report.side_mm = engagement.side_mm;
  report.edge_mm = engagement.edge_mm;
  report.edge_across_mm = engagement.edge_across_mm;
  report.flanks_mm = engagement.flanks_mm;
  drop_free_pieces(move.id);
  return report;
}

std::optional<TurnContact> TurnedPart::first_contact(const TurningTool& tool,
                                                     const TurnMove& move) const {
  if (move.winds()) return thread_contact(tool, move);
  if (winding_) {
    TurnedPart turned = *this;
    turned.end_winding();
    return turned.first_contact(tool, move);
  }
  TurnContact contact;
  contact.t = 2;  // not yet
  const turning::Engagement engagement =
      each_swept(tool, move, [&](const turning::WayChord& chord, const turning::Engagement& met) {
        const double t = chord.from.t + met.first * (chord.to.t - chord.from.t);
        if (!met.any || t >= contact.t) return;
        contact.t = t;
        contact.at_mm = chord.from.at_mm + met.first * (chord.to.at_mm - chord.from.at_mm);
      });
  if (!engagement.any) return std::nullopt;
  contact.depth_mm = std::min(engagement.across_mm, engagement.way_mm);
  contact.side_mm = engagement.side_mm;
  return contact;
}

std::uint64_t TurnedPart::next_version() {
  static std::atomic<std::uint64_t> last{0};
  return last.fetch_add(1, std::memory_order_relaxed) + 1;
}

void TurnedPart::touch_all() { versions_.fill(next_version()); }

void TurnedPart::touch_bands(const Rect& box) {
  scratch_.changed.extend(box);
  const std::uint64_t version = next_version();
  // A border belongs to both of its bands.
  for (std::size_t i = 0; i < kBands; ++i) {
    if (band_low(i) <= box.max_x && band_low(i + 1) >= box.min_x) versions_[i] = version;
  }
}

/// One of its pieces by itself, the holes in it included.
std::shared_ptr<const TurnedPart> TurnedPart::piece_of(std::size_t contour,
                                                       std::size_t held) const {
  auto piece = std::make_shared<TurnedPart>(*this);
  piece->freed_.clear();
  piece->winding_.reset();
  piece->sections_.reset();
  const Rect box = contours_[contour].box();
  keep_piece(piece->contours_, contour);
  piece->threads_.refresh(contours_[held].box(), piece->contours_);
  if (!piece->marked_) return piece;
  // Corners of the two may differ by some units.
  std::size_t same = 0;
  const auto off = [&](const Contour& other) {
    return std::abs(other.box().min_x - box.min_x) + std::abs(other.box().max_x - box.max_x);
  };
  for (std::size_t i = 0; i < piece->marked_->size(); ++i) {
    const std::vector<Contour>& marked = *piece->marked_;
    if (marked[i].is_outer() && (!marked[same].is_outer() || off(marked[i]) < off(marked[same])))
      same = i;
  }
  if (!piece->marked_->empty()) keep_piece(*piece->marked_, same);
  return piece;
}

/// What the chuck does not hold falls, with the holes in it.
void TurnedPart::drop_free_pieces(std::uint64_t id) {
  const std::optional<std::size_t> held = piece_held(contours_, chuck_);
  if (!held) return;
  const std::size_t first = freed_.size();
  if (first > 0) {  // it is not shown any more
    const TurnedPiece& last = freed_.back();
    Rect box;
    box.extend(turning::to_units(Vec2(last.low_z_mm, last.low_r_mm)));
    box.extend(turning::to_units(Vec2(last.high_z_mm, last.high_r_mm)));
    touch_bands(box);
  }
  for (std::size_t i = 0; i < contours_.size(); ++i) {
    if (i == *held || !contours_[i].is_outer()) continue;
    const Rect& box = contours_[i].box();
    const Ring ring = contours_[i].ring();
    Wide moment6 = contours_[i].moment6();
    double missing = flats_ ? turning::missing_mm3(contours_[i], *flats_) : 0;
    for (const Contour& hole : contours_) {
      if (hole.is_outer() || !lies_in(hole, ring)) continue;
      moment6 += hole.moment6();
      missing += flats_ ? turning::missing_mm3(hole, *flats_) : 0;
    }
    freed_.push_back({id, turning::volume_mm3(moment6) - missing, turning::to_mm(box.min_x),
                      turning::to_mm(box.max_x), turning::to_mm(box.min_y),
                      turning::to_mm(box.max_y), piece_of(i, *held)});
    touch_bands(box);
  }
  keep_piece(contours_, *held);
  drop_threads_of_pieces(first);
  if (!marked_) return;
  if (const std::optional<std::size_t> same = piece_held(*marked_, chuck_))
    keep_piece(*marked_, *same);
}

Wide TurnedPart::moment6() const {
  Wide sum = 0;
  for (const Contour& contour : contours_) sum += contour.moment6();
  return sum;
}

double TurnedPart::missing_mm3() const {
  return flats_ ? turning::missing_mm3(contours_, *flats_) : 0;
}

double TurnedPart::remaining_mm3() const {
  return turning::volume_mm3(moment6()) - missing_mm3() - threads_.volume_mm3();
}

Box TurnedPart::bounds_mm() const {
  const double r = turning::to_mm(blank_.max_y);
  return {{-r, -r, turning::to_mm(blank_.min_x)}, {r, r, turning::to_mm(blank_.max_x)}};
}

TurnedProfile TurnedPart::profile() const {
  TurnedProfile profile;
  for (const Contour& contour : contours_) {
    std::vector<Vec2>& chain = profile.emplace_back();
    for (const Point& p : contour.ring()) chain.push_back(turning::to_mm(p));
  }
  return profile;
}

std::size_t TurnedPart::corner_count() const {
  std::size_t count = 0;
  for (const Contour& contour : contours_) count += contour.corner_count();
  for (const auto& pass : threads_.passes()) count += pass->corners().size();
  return count;
}

std::string TurnedPart::digest() const {
  // From the corner of lowest z, of these the lowest, contour by contour in the order of these.
  const auto comes_first = [](const Point& a, const Point& b) {
    return a.X != b.X ? a.X < b.X : a.Y < b.Y;
  };
  std::vector<Ring> rings;
  for (const Contour& contour : contours_) {
    Ring& ring = rings.emplace_back(contour.ring());
    std::rotate(ring.begin(), std::min_element(ring.begin(), ring.end(), comes_first), ring.end());
  }
  // Contours that touch may share that corner.
  std::sort(rings.begin(), rings.end(), [&](const Ring& a, const Ring& b) {
    return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end(), comes_first);
  });
  XXH3_state_t state;
  XXH3_128bits_reset(&state);
  const std::int64_t frame[4] = {blank_.min_x, blank_.min_y, blank_.max_x, blank_.max_y};
  XXH3_128bits_update(&state, frame, sizeof frame);
  if (flats_) {
    const std::int64_t flats[2] = {flats_->count, turning::to_units(flats_->inner_radius_mm)};
    XXH3_128bits_update(&state, flats, sizeof flats);
  }
  for (const Ring& ring : rings) {
    const std::uint64_t size = ring.size();
    XXH3_128bits_update(&state, &size, sizeof size);
    XXH3_128bits_update(&state, ring.data(), ring.size() * sizeof(Point));
  }
  for (const auto& pass : threads_.passes()) {
    const double way[6] = {pass->from_mm().x, pass->from_mm().y, pass->to_mm().x,
                           pass->to_mm().y,   pass->lead_mm(),   pass->from_turns()};
    XXH3_128bits_update(&state, way, sizeof way);
    XXH3_128bits_update(&state, pass->corners().data(), pass->corners().size() * sizeof(Vec2));
  }
  const XXH128_hash_t hash = XXH3_128bits_digest(&state);
  return fmt::format("{:016x}{:016x}", hash.high64, hash.low64);
}

std::size_t TurnedPart::unique_bytes() const {
  std::size_t bytes = threads_.unique_bytes();
  const auto add = [&bytes](const Contour& contour) {
    bytes += contour.runs().capacity() * sizeof(turning::RunPointer);
    for (const turning::RunPointer& run : contour.runs()) {
      if (run.use_count() > 1) continue;
      bytes += sizeof *run + run->points.capacity() * sizeof(Point) +
               run->marks.capacity() * sizeof(std::uint32_t);
    }
  };
  for (const Contour& contour : contours_) add(contour);
  if (marked_) {
    for (const Contour& contour : *marked_) add(contour);
  }
  return bytes;
}

turning::Unit TurnedPart::band_low(std::size_t band) const {
  const turning::Unit width = blank_.max_x - blank_.min_x;
  return blank_.min_x +
         width * static_cast<turning::Unit>(band) / static_cast<turning::Unit>(kBands);
}

double TurnedPart::band_low_z_mm(std::size_t band) const { return turning::to_mm(band_low(band)); }

TriangleMesh TurnedPart::mesh(double tolerance_mm) const {
  if (!threads_.empty()) return turning::wind(contours_, threads_, tolerance_mm, flats());
  return turning::revolve(contours_, tolerance_mm, flats());
}

int TurnedPart::level_within(double tolerance_mm) {
  int level = 0;
  for (double next_mm = 4 * kFinestPatch_mm; level < 4 && next_mm <= tolerance_mm; next_mm *= 4)
    ++level;
  return level;
}

MeshPatch TurnedPart::patch(std::size_t band, int level) const {
  const double tolerance_mm = kFinestPatch_mm * std::pow(4.0, level);
  const turning::Unit low = band_low(band), high = band_low(band + 1);
  const bool is_last = band + 1 == kBands;
  const Rect wound = threads_.box();
  const bool is_wound = !threads_.empty() && wound.min_x <= high && wound.max_x >= low;
  std::shared_ptr<const turning::WoundSections> sections;
  if (is_wound) {
    sections = sections_.get([&] {
      return turning::wound_sections(shown(), threads_, turning::kPatchSegments, flats_);
    });
  }
  MeshPatch patch =
      is_wound ? turning::wind_band(*sections, shown(), low, high, is_last, tolerance_mm, flats())
               : turning::revolve_band(shown(), low, high, is_last, tolerance_mm, flats());
  patch.tile = static_cast<std::uint32_t>(band);
  patch.version = versions_[band];
  patch.level = level;
  return patch;
}

}  // namespace kerf
