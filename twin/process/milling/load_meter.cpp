#include "twin/process/milling/load_meter.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numeric>
#include <optional>
#include <vector>

#include "stock/present_heights.h"
#include "twin/process/milling/engagement_scan.h"
#include "twin/process/milling/front_section.h"
#include "twin/process/milling/lane_scan.h"
#include "twin/process/milling/piece_meter.h"
#include "twin/process/milling/way_profile.h"

namespace kerf {
namespace {

/// A window of the way is so much of the cutter's diameter, and so many cells at least.
constexpr double kWindowOfDiameter = 0.25;
constexpr double kWindowCells = 20;
/// What is removed within fewer cells of the way is taken to last as long as these.
constexpr double kLeastCells = 10;
/// Cells that are removed one after the other are no farther apart, by the way of the cutter.
constexpr double kNearCells = 1.5;
/// Windows that differ by less are one rate.
constexpr double kSameRate = 0.02;
/// Volumes of a scan are told to this part of a window.
constexpr int kBinsOfWindow = 8;
/// Looking at a height counts as much as cutting so many cells, and so much what is worked out of
/// one that is cut: some times what they cost, since what is free must not show.
constexpr double kCellsOfLook = 12;
constexpr double kCellsOfPlace = 50, kCellsOfPartPlace = 40;
constexpr double kCellsOfLaneLook = 8, kCellsOfArcLook = 12;
constexpr double kBlocksOfPoint = 0.2;
constexpr double kCellsOfTile = 1;  ///< of the workpiece, that a snapshot has to hold
/// Lanes along a move (EngagementScan::run_lanes), and when little is left to spend, which is when
/// it is this part of what is free: then steps are so much longer, too.
constexpr int kLanes = 41, kFewLanes = 13, kFewestLanes = 7;
constexpr double kFineShare = 0.5, kCoarser = 6;
/// Short moves are no longer measured when so much of what is free is left for those that last.
constexpr double kShortShare = 0.2;
constexpr int kFewColumns = 9;
constexpr double kFewRowsGrow = 2.5, kFewRowsOfDiameter = 0.25;
/// Of what is cut may be spent on looking closely, beside what is free and LoadMeter::kShare.
constexpr double kCloseShare = 0.01;
LaneScan::Grain few_lanes() {
  LaneScan::Grain grain;
  grain.lanes = kFewColumns;
  grain.row_grows = kFewRowsGrow;
  grain.row_of_diameter = kFewRowsOfDiameter;
  return grain;
}

/// Rates by lanes are good to this.
constexpr double kRough = 0.04;
/// So are those by points where layers are no thinner than lanes are apart; else they may be off by
/// half.
constexpr double kRoughOfPoints = 0.5;
/// Rates that are so many times what is known are few.
constexpr double kSurelyMore = 1.3;
/// All cells are looked at along so many windows.
constexpr double kMostWindows = 6;
/// Of windows that may have the greatest rate so many are looked at closely, of few ones at several
/// places.
constexpr std::size_t kMostFronts = 6, kFewWindows = 2;
constexpr int kPlacesOfFew = 4;
/// What is deeper in the material than this part of a cell the front removes.
constexpr double kWithinOfFront = 1e-4;

/// Straight up or down.
bool is_plunge(const CutMove& move) { return !move.arc && Vec2(move.from_mm) == Vec2(move.to_mm); }

}  // namespace

const double LoadMeter::kFreeCells = 150e6;
const double LoadMeter::kFreeBlocks = 16e5;
const double LoadMeter::kShare = 0.05;

struct LoadMeter::Impl {
  explicit Impl(const StockModel& stock)
      : stock_(stock),
        box_(stock.bounds_mm()),
        cell_mm_(stock.cell_mm()),
        left_looks_(free_cells()),
        left_cells_(free_cells()),
        pieces_(stock) {}
  double free_cells() const { return stock_.takes_tilted_tools() ? kFreeBlocks : kFreeCells; }
  double window_mm(const Cutter& cutter) const;
  double window_mm(const Cutter& cutter, const CutMove& move) const;
  void look(const Cutter& cutter, const CutMove& move, double duration_s, double speed_mm_per_s,
            MotionReach& reach);
  bool is_within(const CutMove& move) const;
  MotionLoad measure(const Cutter& cutter, const CutMove& move, double known);
  bool scan(const Cutter& cutter, const CutMove& move, double known, MotionLoad& load);
  void cut_parts(const Cutter& cutter, std::span<const CutMove> moves, std::vector<double>& parts);
  template <class Look>
  double closer_peak(double rough, double known, double good_to, Look&& look);
  const SolidPoints* points_of(const Cutter& cutter, const CutMove& move) const;
  bool scan_points(const Cutter& cutter, const CutMove& move, double known, MotionLoad& load);
  template <class Scan>
  void take_spans(const Scan& scan, double window, MotionLoad& load);
  double scanned_peak(std::span<const double> bins, double from, double to, double window);
  void keep_greatest_windows();
  double height_peak(double window, bool is_arc);
  double front_peak(const Cutter& cutter, const CutMove& move, const SolidPoints& solid);
  bool is_hollow();
  MotionLoad measure_by_pieces(const Cutter& cutter, const CutMove& move);
  void clip(const Cutter& cutter, const CutMove& move);
  FeedPart clipped_part(const CutMove& move) const;

  const StockModel& stock_;
  Box box_;
  double cell_mm_;
  double left_looks_;  ///< to spend on lanes along moves, in cells that are cut
  double left_cells_;  ///< and on looking closely
  EngagementScan scan_;
  LaneScan lanes_;
  FrontSection front_;
  PieceMeter pieces_;
  std::vector<double> rates_;
  /// A window, or a stretch that is shorter than one.
  struct Window {
    double from = 0, to = 0, rate = 0;
  };
  std::vector<Window> windows_;  ///< of all stretches that take_spans() has found
  struct Asked {
    Vec3 from_mm{0}, to_mm{0};
    const void* cutter = nullptr;  ///< null: none, or an arc
  };
  Asked asked_, held_;          ///< the last two moves that reach() was asked about
  std::optional<bool> hollow_;  ///< below its heights; asked when it is needed
  WayProfile profile_;
  bool lasts_ = false;        ///< LoadMeter::kLasting_s
  double least_ = 0;          ///< of the way, that a rate is taken over
  double from_ = 0, to_ = 1;  ///< of the way, where the cutter is where the blank was
};

LoadMeter::LoadMeter(const StockModel& stock) : impl_(std::make_unique<Impl>(stock)) {}
LoadMeter::~LoadMeter() = default;

void LoadMeter::look(const Cutter& cutter, const CutMove& move, double duration_s,
                     double speed_mm_per_s, MotionReach& reach) {
  impl_->look(cutter, move, duration_s, speed_mm_per_s, reach);
}

bool LoadMeter::affords_short() const {
  return impl_->left_looks_ >= kShortShare * impl_->free_cells();
}

double LoadMeter::window_mm(const Cutter& cutter) const { return impl_->window_mm(cutter); }

MotionLoad LoadMeter::measure(const Cutter& cutter, const CutMove& move, double known_mm3_per_s) {
  return impl_->measure(cutter, move, known_mm3_per_s);
}

void LoadMeter::cut_parts(const Cutter& cutter, std::span<const CutMove> moves,
                          std::vector<double>& parts) {
  impl_->cut_parts(cutter, moves, parts);
}

double LoadMeter::Impl::window_mm(const Cutter& cutter) const {
  return std::max(kWindowOfDiameter * 2 * cutter.radius_mm(), kWindowCells * cell_mm_);
}

/// Straight up or down heights tell finer than cells are.
double LoadMeter::Impl::window_mm(const Cutter& cutter, const CutMove& move) const {
  return is_plunge(move) ? kWindowOfDiameter * 2 * cutter.radius_mm() : window_mm(cutter);
}

/// Straight, upright, and its middle where the blank was: so is all of it.
bool LoadMeter::Impl::is_within(const CutMove& move) const {
  if (move.arc || !move.is_vertical()) return false;
  const auto within = [&](const Vec3& p) {
    return p.x > box_.min.x && p.x < box_.max.x && p.y > box_.min.y && p.y < box_.max.y &&
           p.z < box_.max.z;
  };
  return within(move.from_mm) && within(move.to_mm);
}

/// A straight way of an upright tool is in the blank's box between two of its points.
void LoadMeter::Impl::clip(const Cutter& cutter, const CutMove& move) {
  from_ = 0, to_ = 1;
  if (move.arc || !move.is_vertical()) return;
  const Box box = stock_.bounds_mm();
  const auto half_space = [&](double from, double to, double limit) {  // where it is below limit
    if (from >= limit && to >= limit) to_ = from_;
    if ((from < limit) == (to < limit)) return;
    const double part = (limit - from) / (to - from);
    if (from < limit) {
      to_ = std::min(to_, part);
    } else {
      from_ = std::max(from_, part);
    }
  };
  const Vec3 &a = move.from_mm, &b = move.to_mm;
  const double r = cutter.radius_mm();
  half_space(a.z, b.z, box.max.z);
  half_space(a.x, b.x, box.max.x + r);
  half_space(a.y, b.y, box.max.y + r);
  half_space(-a.x, -b.x, r - box.min.x);
  half_space(-a.y, -b.y, r - box.min.y);
  to_ = std::max(from_, to_);
}

FeedPart LoadMeter::Impl::clipped_part(const CutMove& move) const {
  FeedPart part;
  part.known = true;
  part.near_mm = kNearCells * stock_.cell_mm();
  part.window_mm = kWindowCells * stock_.cell_mm();
  if (to_ <= from_) return part;
  part.seconds = profile_.at_s(to_) - profile_.at_s(from_);
  part.way_mm = (to_ - from_) * profile_.length_mm();
  part.enters = from_ > 0;
  if (move.arc || !move.is_vertical()) return part;
  const Box box = stock_.bounds_mm();
  double inside = 1;
  for (int axis = 0; axis < 2; ++axis) {
    const double from = move.from_mm[axis], to = move.to_mm[axis];
    const double side = to > from ? box.max[axis] : box.min[axis];
    if (to == from || (to > from) != (to > side) || (to > side) == (from > side)) continue;
    inside = std::min(inside, (side - from) / (to - from));
  }
  if (inside < 1 && inside > from_) {
    part.leaves_s = profile_.at_s(inside) - profile_.at_s(from_);
    part.leaves_mm = (inside - from_) * profile_.length_mm();
  }
  return part;
}

void LoadMeter::Impl::look(const Cutter& cutter, const CutMove& move, double duration_s,
                           double speed_mm_per_s, MotionReach& reach) {
  if (cutter.undercuts()) hollow_ = true;
  held_ = asked_;
  asked_.from_mm = move.from_mm;
  asked_.to_mm = move.to_mm;
  asked_.cutter = move.arc ? nullptr : cutter.profile().data();
  const double length_mm = move.arc ? way_length_mm(move) : glm::length(move.to_mm - move.from_mm);
  profile_ = WayProfile(length_mm, duration_s, speed_mm_per_s);
  if (profile_.length_mm() <= 0) return;
  lasts_ = duration_s >= kLasting_s;
  if (is_within(move)) {
    from_ = 0, to_ = 1;
    reach.part.known = true;
    reach.part.near_mm = kNearCells * cell_mm_;
    reach.part.window_mm = kWindowCells * cell_mm_;
    reach.part.seconds = duration_s;
    reach.part.way_mm = length_mm;
  } else {
    clip(cutter, move);
    reach.part = clipped_part(move);
  }
  const double way_mm = (to_ - from_) * length_mm, cell_mm = cell_mm_;
  if (way_mm >= window_mm(cutter)) {
    reach.speed_per_mm = profile_.greatest_speed(from_, to_) / way_mm;
  }
  // A move up or down sweeps its disc alone.
  const double diameter_mm = 2 * cutter.radius_mm();
  const Vec3 step = move.to_mm - move.from_mm;
  const bool level = move.arc || step.x * step.x + step.y * step.y > step.z * step.z;
  if (move.is_vertical()) {
    const double speed = profile_.speed_mm_per_s(), radius_mm = cutter.radius_mm();
    reach.side_mm2_per_s = diameter_mm * speed;
    reach.disc_mm3_per_s = kPi * radius_mm * radius_mm * speed * std::abs(step.z) / length_mm;
  }
  const double swept_mm2 = diameter_mm * (level ? way_mm : std::min(way_mm, diameter_mm));
  left_looks_ += kShare * swept_mm2 / (cell_mm * cell_mm);
  left_cells_ += kCloseShare * swept_mm2 / (cell_mm * cell_mm);
}

/// Something is, below the heights: an M-map's may say less than what is there. Asked once; what
/// undercuts tells reach().
bool LoadMeter::Impl::is_hollow() {
  if (hollow_) return *hollow_;
  double sum_mm = 0;
  if (stock_.name() == "mmap") {
    const std::unique_ptr<StockModel> whole = stock_.snapshot();
    const std::shared_ptr<const HeightGrid> grid = whole->height_grid();
    // Without one there are gaps: a saved workpiece, a blank from a mesh.
    if (!grid) return *(hollow_ = true);
    const HeightGrid& heights = *grid;
    const double floor = static_cast<double>(heights.floor_mm());
    for (int j = 0; j < heights.ny(); ++j) {
      for (int i = 0; i < heights.nx(); ++i) {
        sum_mm += static_cast<double>(heights.height(i, j)) - floor;
      }
    }
    const double all_mm3 = sum_mm * heights.cell_x_mm() * heights.cell_y_mm();
    hollow_ = std::abs(all_mm3 - whole->remaining_mm3()) > 1e-6 * all_mm3;
  } else {
    hollow_ = false;
  }
  return *hollow_;
}

/// Of the windows within a stretch that is cut the greatest, together with its neighbours that are
/// as great; or the rate of the whole stretch.
double LoadMeter::Impl::scanned_peak(std::span<const double> bins, double span_from, double span_to,
                                     double window) {
  const double bin = (to_ - from_) / static_cast<double>(bins.size());
  const auto index = [&](double part) {
    const double at = std::floor((part - from_) / bin);
    return static_cast<std::size_t>(std::clamp(at, 0.0, static_cast<double>(bins.size() - 1)));
  };
  const std::size_t first = index(span_from), last = index(span_to * (1 - 1e-12));
  const auto rate = [&](double mm3, double from, double to) {
    const double found = mm3 / (std::max(to - from, least_) * profile_.length_mm()) *
                         profile_.greatest_speed(from, to);
    windows_.push_back({from, to, found});
    return found;
  };
  const auto n = static_cast<std::size_t>(std::max(1.0, std::round(window / bin)));
  double mm3 = 0;
  rates_.clear();
  for (std::size_t b = first; b <= last; ++b) {
    mm3 += bins[b];
    if (b >= first + n) mm3 -= bins[b - n];
    if (b + 1 < first + n) continue;
    const double to = from_ + static_cast<double>(b + 1) * bin;
    rates_.push_back(rate(mm3, to - static_cast<double>(n) * bin, to));
  }
  if (span_to - span_from <= window + bin || rates_.empty()) {
    windows_.resize(windows_.size() - rates_.size());
    mm3 = 0;
    for (std::size_t b = first; b <= last; ++b) mm3 += bins[b];
    return rate(mm3, span_from, span_to);
  }
  const auto greatest = std::max_element(rates_.begin(), rates_.end());
  auto begin = greatest, end = greatest;
  double sum = 0;
  while (begin != rates_.begin() && *(begin - 1) >= (1 - kSameRate) * *greatest) --begin;
  while (end != rates_.end() && *end >= (1 - kSameRate) * *greatest) sum += *end++;
  for (auto it = begin; it != greatest; ++it) sum += *it;
  return sum / static_cast<double>(end - begin);
}

/// False: the model, the cutter or the move is not one for it.
bool LoadMeter::Impl::scan(const Cutter& cutter, const CutMove& move, double known,
                           MotionLoad& load) {
  if (!EngagementScan::takes(cutter, move)) return false;
  const auto* const model = dynamic_cast<const PresentHeights*>(&stock_.bare());
  if (model == nullptr || is_hollow()) return false;
  const std::optional<HeightGrid> present = model->present_heights();
  if (!present) return false;
  left_looks_ -= kCellsOfTile * static_cast<double>(stock_.tile_count());
  const double window = std::min(window_mm(cutter, move) / profile_.length_mm(), to_ - from_);
  least_ = is_plunge(move) ? 0 : kLeastCells * cell_mm_ / profile_.length_mm();
  const double bin_mm = window * profile_.length_mm() / kBinsOfWindow;
  const bool fine = lasts_ && left_looks_ > kFineShare * free_cells();
  EngagementScan::Lanes lanes;
  lanes.bin_mm = bin_mm;
  lanes.gap_mm = EngagementScan::kLeastGapBins * bin_mm;
  lanes.step_mm = fine ? lanes.gap_mm : kCoarser * lanes.gap_mm;
  lanes.count = fine ? kLanes : left_looks_ > 0 ? kFewLanes : kFewestLanes;
  CutMove held;
  held.from_mm = held_.from_mm, held.to_mm = held_.to_mm;
  if (held_.cutter == cutter.profile().data()) lanes.held = &held;
  const EngagementScan::Cost looked = scan_.run_lanes(*present, cutter, move, from_, to_, lanes);
  left_looks_ -= (move.arc ? kCellsOfArcLook : kCellsOfLaneLook) * looked.looks;
  left_looks_ = std::max(left_looks_ - kCellsOfPlace * looked.places, 0.0);
  take_spans(scan_, window, load);
  load.peak_mm3_per_s = closer_peak(load.peak_mm3_per_s, known, kRough,
                                    [&] { return height_peak(window, move.arc.has_value()); });
  return true;
}

template <class Scan>
void LoadMeter::Impl::take_spans(const Scan& scan, double window, MotionLoad& load) {
  load = {};
  windows_.clear();
  for (const auto& span : scan.spans()) {
    load.cut_s += profile_.at_s(span.to) - profile_.at_s(span.from);
    load.peak_mm3_per_s =
        std::max(load.peak_mm3_per_s, scanned_peak(scan.bins_mm3(), span.from, span.to, window));
  }
}

/// A rate by lanes may exceed what is known: what a close look makes of it. When little is left
/// only one that does so for certain is looked at, for which something is borrowed; then it is
/// taken as it is. 0: it does not.
template <class Look>
double LoadMeter::Impl::closer_peak(double rough, double known, double good_to, Look&& look) {
  if (rough * (1 + good_to) <= known) return 0;
  if (left_cells_ >= 0) return look();
  if (rough / (1 + good_to) <= known) return 0;
  if (left_cells_ >= -free_cells() || rough > kSurelyMore * known) return look();
  return rough / (1 + good_to);
}

/// Leaves those of windows_ that may be the greatest.
void LoadMeter::Impl::keep_greatest_windows() {
  double greatest = 0;
  for (const Window& window : windows_) greatest = std::max(greatest, window.rate);
  std::erase_if(windows_,
                [&](const Window& window) { return window.rate < (1 - 2 * kRough) * greatest; });
}

/// By all cells about the greatest of windows_, as far along as kMostWindows.
double LoadMeter::Impl::height_peak(double window, bool is_arc) {
  const Window greatest =
      *std::max_element(windows_.begin(), windows_.end(),
                        [](const Window& a, const Window& b) { return a.rate < b.rate; });
  keep_greatest_windows();
  const double about = kMostWindows / 2 * window;
  double from = greatest.from, to = greatest.to;
  for (const Window& other : windows_) {
    if (other.from < greatest.from - about || other.to > greatest.to + about) continue;
    from = std::min(from, other.from), to = std::max(to, other.to);
  }
  // What the cutter stands in when the part begins is in a bin of its own; and an arc may come
  // again to where it has been.
  const double about_bin = window / kBinsOfWindow;
  double start = from - about_bin >= from_ ? from - about_bin : from_;
  if (is_arc) start = from_;
  const int bins = static_cast<int>(std::ceil((to - start) / about_bin - 1e-6));
  const double bin = (to - start) / bins;
  const int first = static_cast<int>((from - start) / bin + 1e-6);
  from = start + first * bin;
  const EngagementScan::Cost cost = scan_.run_part(start, to, bins);
  left_cells_ -= kCellsOfLook * cost.looks + kCellsOfPartPlace * cost.places;
  const std::span<const double> found = scan_.bins_mm3().subspan(static_cast<std::size_t>(first));
  const double all_from = from_, all_to = to_;
  from_ = from, to_ = to;
  const double peak = scanned_peak(found, from, to, window);
  from_ = all_from, to_ = all_to;
  return peak;
}

/// By the cutter's front in the middle of those of windows_ that may be the greatest.
double LoadMeter::Impl::front_peak(const Cutter& cutter, const CutMove& move,
                                   const SolidPoints& solid) {
  keep_greatest_windows();
  front_.set(stock_.bounds_mm(), stock_.cell_mm(), cutter, move);
  rates_.clear();
  const std::size_t each = 1 + (windows_.size() - 1) / kMostFronts;
  const int places = windows_.size() <= kFewWindows ? kPlacesOfFew : 1;
  for (std::size_t i = (windows_.size() - 1) % each / 2; i < windows_.size(); i += each) {
    const Window& window = windows_[i];
    double mm2 = 0;
    for (int k = 0; k < places; ++k) {
      const double part = (k + 0.5) / places;
      const double at = window.from + part * (window.to - window.from);
      mm2 += front_.mm2_at(at, solid, kWithinOfFront * cell_mm_) / places;
    }
    rates_.push_back(mm2 * profile_.greatest_speed(window.from, window.to));
  }
  const double best = *std::max_element(rates_.begin(), rates_.end());
  std::erase_if(rates_, [best](double rate) { return rate < (1 - kSameRate) * best; });
  return std::accumulate(rates_.begin(), rates_.end(), 0.0) / static_cast<double>(rates_.size());
}

/// Null: the model has none, or the move is not one for LaneScan.
const SolidPoints* LoadMeter::Impl::points_of(const Cutter& cutter, const CutMove& move) const {
  if (move.arc || cutter.footprint() != nullptr) return nullptr;
  return dynamic_cast<const SolidPoints*>(&stock_.bare());
}

/// False: it cannot be done so. Rates that may be the greatest so far are looked at by pieces.
bool LoadMeter::Impl::scan_points(const Cutter& cutter, const CutMove& move, double known,
                                  MotionLoad& load) {
  const SolidPoints* const solid = points_of(cutter, move);
  if (solid == nullptr) return false;
  from_ = 0, to_ = 1;
  const double window = std::min(window_mm(cutter, move) / profile_.length_mm(), 1.0);
  least_ = 0;
  LaneScan::Grain grain;
  grain.bin_mm = window * profile_.length_mm() / kBinsOfWindow;
  grain.gap_mm = grain.step_mm = EngagementScan::kLeastGapBins * grain.bin_mm;
  if (left_looks_ <= kFineShare * free_cells()) {
    const LaneScan::Grain few = few_lanes();
    grain = {grain.bin_mm, grain.gap_mm,  kCoarser * grain.step_mm,
             few.lanes,    few.row_grows, few.row_of_diameter};
  }
  left_looks_ -= kBlocksOfPoint *
                 lanes_.run(*solid, stock_.bounds_mm(), stock_.cell_mm(), cutter, move, grain);
  take_spans(lanes_, window, load);
  load.peak_mm3_per_s = closer_peak(load.peak_mm3_per_s, known, kRoughOfPoints, [&] {
    if (!FrontSection::takes(cutter, move)) return measure_by_pieces(cutter, move).peak_mm3_per_s;
    const double peak = front_peak(cutter, move, *solid);
    left_cells_ -= kBlocksOfPoint * front_.looks();
    return peak;
  });
  return true;
}

MotionLoad LoadMeter::Impl::measure(const Cutter& cutter, const CutMove& move, double known) {
  MotionLoad load;
  if (profile_.length_mm() <= 0 || to_ <= from_) return load;
  if (scan(cutter, move, known, load) || scan_points(cutter, move, known, load)) return load;
  return measure_by_pieces(cutter, move);
}

/// Each by lanes, as if the spindle kept its middle direction, and as if those before had not cut:
/// what the cutter stands in when a move begins takes none of its time. Where turning is more than
/// half of what a move does all of it counts.
void LoadMeter::Impl::cut_parts(const Cutter& cutter, std::span<const CutMove> moves,
                                std::vector<double>& parts) {
  parts.assign(moves.size(), 1.0);
  const double diameter_mm = 2 * cutter.radius_mm(), cell_mm = stock_.cell_mm();
  for (std::size_t i = 0; i < moves.size() && left_looks_ >= 0; ++i) {
    const CutMove& move = moves[i];
    const SolidPoints* const solid = points_of(cutter, move);
    const double length_mm = glm::length(move.to_mm - move.from_mm);
    const double turned_mm = glm::length(move.axis_to - move.axis_from) * diameter_mm;
    if (solid == nullptr || turned_mm > length_mm / 2 || length_mm <= 0) continue;
    LaneScan::Grain grain = few_lanes();
    grain.bin_mm = length_mm;
    grain.gap_mm = EngagementScan::kLeastGapBins * window_mm(cutter) / kBinsOfWindow;
    grain.step_mm = grain.gap_mm;
    left_looks_ += kShare * diameter_mm * length_mm / (cell_mm * cell_mm);
    left_looks_ -=
        kBlocksOfPoint * lanes_.run(*solid, stock_.bounds_mm(), cell_mm, cutter, move, grain);
    parts[i] = 0;
    for (const WaySpan& span : lanes_.spans()) parts[i] += span.to - span.from;
  }
}

MotionLoad LoadMeter::Impl::measure_by_pieces(const Cutter& cutter, const CutMove& move) {
  const double window = window_mm(cutter) / profile_.length_mm();
  const MotionLoad load = pieces_.measure(cutter, move, profile_, {from_, to_}, window);
  left_cells_ -= pieces_.cost_cells();
  return load;
}

}  // namespace kerf
