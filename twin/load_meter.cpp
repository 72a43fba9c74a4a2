#include "twin/load_meter.h"

#include <algorithm>
#include <cmath>

#include "twin/motion_geometry.h"

namespace kerf {
namespace {

/// A window of the way is so much of the cutter's diameter, and so many cells at least.
constexpr double kWindowOfDiameter = 0.25;
constexpr double kWindowCells = 20;
/// Cells that are removed one after the other are no farther apart, by the way of the cutter.
constexpr double kNearCells = 1.5;
/// Windows that differ by less are one rate.
constexpr double kSameRate = 0.02;
/// An end of the cutting is found to this part of the way that cuts.
constexpr double kEnds = 0.002;
/// Fewer pieces that cut than this say little of how fast they do.
constexpr std::size_t kFewPieces = 5;
constexpr int kFinerPieces = 8;
/// Volumes of a scan are told to this part of a window.
constexpr int kBinsOfWindow = 8;
/// Looking at a height counts as much as cutting so many cells, and so much what is worked out of
/// one that is cut: some times what they cost, since what is free must not show.
constexpr double kCellsOfLook = 12;
constexpr double kCellsOfPlace = 120;

Motion motion_of(const CutMove& move) {
  Motion motion;
  motion.kind = move.arc ? MotionKind::kArc : MotionKind::kFeed;
  motion.from_mm = move.from_mm;
  motion.to_mm = move.to_mm;
  if (move.arc) motion.arc = {move.arc->center_mm, move.arc->axis, move.arc->sweep_rad};
  return motion;
}

double length_of(const CutMove& move) {
  return move.arc ? path_length_mm(motion_of(move)) : glm::length(move.to_mm - move.from_mm);
}

CutMove part_of(const CutMove& whole, double from, double to) {
  const Motion motion = motion_of(whole);
  CutMove part = whole;
  if (from > 0) part.from_mm = point_at(motion, from);
  if (to < 1) part.to_mm = point_at(motion, to);
  if (part.arc) part.arc->sweep_rad *= to - from;
  return part;
}

}  // namespace

/// Up to full speed within ramp_mm, and down again.
double LoadMeter::Profile::at(double part) const {
  const double way = part * length_mm;
  if (ramp_mm <= 0) return part * duration_s;
  const double acceleration = speed_mm_per_s / ramp_s;
  if (way < ramp_mm) return std::sqrt(2 * way / acceleration);
  const double left = length_mm - way;
  if (left < ramp_mm) return duration_s - std::sqrt(std::max(0.0, 2 * left / acceleration));
  return ramp_s + (way - ramp_mm) / speed_mm_per_s;
}

double LoadMeter::Profile::speed_at(double part) const {
  const double way = std::min(part, 1 - part) * length_mm;
  if (way >= ramp_mm) return speed_mm_per_s;
  return std::sqrt(2 * std::max(0.0, way) * speed_mm_per_s / ramp_s);
}

double LoadMeter::Profile::greatest_speed(double from, double to) const {
  return speed_at(std::clamp(0.5, from, to));
}

double LoadMeter::window_mm(const Cutter& cutter) const {
  return std::max(kWindowOfDiameter * 2 * cutter.radius_mm(), kWindowCells * stock_.cell_mm());
}

/// A straight way of an upright tool is in the blank's box between two of its points.
void LoadMeter::clip(const Cutter& cutter, const CutMove& move) {
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

FeedPart LoadMeter::clipped_part(const CutMove& move) const {
  FeedPart part;
  part.known = true;
  part.near_mm = kNearCells * stock_.cell_mm();
  part.window_mm = kWindowCells * stock_.cell_mm();
  if (to_ <= from_) return part;
  part.seconds = profile_.at(to_) - profile_.at(from_);
  part.way_mm = (to_ - from_) * profile_.length_mm;
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
    part.leaves_s = profile_.at(inside) - profile_.at(from_);
    part.leaves_mm = (inside - from_) * profile_.length_mm;
  }
  return part;
}

MotionReach LoadMeter::reach(const Cutter& cutter, const CutMove& move, double duration_s,
                             double speed_mm_per_s) {
  MotionReach reach;
  if (cutter.undercuts()) hollow_ = true;
  const double length_mm = length_of(move);
  profile_ = {};
  if (length_mm <= 0 || duration_s <= 0) return reach;
  profile_ = {length_mm, duration_s, std::max(length_mm / duration_s, speed_mm_per_s), 0, 0};
  profile_.ramp_s = duration_s - length_mm / profile_.speed_mm_per_s;
  profile_.ramp_mm = profile_.speed_mm_per_s * profile_.ramp_s / 2;
  if (profile_.ramp_mm * 2 > length_mm) profile_.ramp_mm = profile_.ramp_s = 0;
  clip(cutter, move);
  reach.part = clipped_part(move);
  const double way_mm = (to_ - from_) * length_mm, cell_mm = stock_.cell_mm();
  if (way_mm >= window_mm(cutter)) {
    reach.speed_per_mm = profile_.greatest_speed(from_, to_) / way_mm;
  }
  // A move up or down sweeps its disc alone.
  const double diameter_mm = 2 * cutter.radius_mm();
  const Vec3 step = move.to_mm - move.from_mm;
  const bool level = move.arc || std::hypot(step.x, step.y) > std::abs(step.z);
  if (move.is_vertical()) {
    const double speed = profile_.speed_mm_per_s, radius_mm = cutter.radius_mm();
    reach.side_mm2_per_s = diameter_mm * speed;
    reach.disc_mm3_per_s = kPi * radius_mm * radius_mm * speed * std::abs(step.z) / length_mm;
  }
  const double swept_mm2 = diameter_mm * (level ? way_mm : std::min(way_mm, diameter_mm));
  left_cells_ += kShare * swept_mm2 / (cell_mm * cell_mm);
  return reach;
}

/// Finished: what the cutter's front takes must not wait for the next part.
double LoadMeter::cut_part(StockModel& stock, double from, double to) {
  moves_.assign(1, part_of(*move_, from, to));
  reports_.clear();
  stock.cut(*cutter_, moves_, reports_);
  stock.finish(reports_);
  double removed_mm3 = 0;
  for (const CutReport& report : reports_) removed_mm3 += report.removed_mm3;
  const double diameter_mm = 2 * cutter_->radius_mm(), cell_mm = stock_.cell_mm();
  const double swept_mm2 = diameter_mm * (diameter_mm + (to - from) * profile_.length_mm);
  left_cells_ -= swept_mm2 / (cell_mm * cell_mm) + static_cast<double>(stock_.tile_count());
  return removed_mm3;
}

void LoadMeter::cut_spans(const StockModel& before, double from, double to, int pieces) {
  spans_.clear();
  before_.clear();
  const std::unique_ptr<StockModel> copy = before.snapshot();
  for (int k = 0; k < pieces; ++k) {
    Span span;
    span.from = from + (to - from) * k / pieces;
    span.to = k + 1 == pieces ? to : from + (to - from) * (k + 1) / pieces;
    before_.push_back(copy->snapshot());
    span.removed_mm3 = cut_part(*copy, span.from, span.to);
    spans_.push_back(span);
  }
}

/// Of a span that cuts, and before which nothing does.
double LoadMeter::find_begin(const Span& span, const StockModel& before, double least) {
  const auto cuts = [&](double from, double to) {
    return cut_part(*before.snapshot(), from, to) > 0;
  };
  double from = span.from, to = span.to;
  if (from == 0 && cuts(0, std::min(to, least))) return 0;
  while (to - from > least) {
    const double middle = (from + to) / 2;
    (cuts(from, middle) ? to : from) = middle;
  }
  return from == span.from ? from : (from + to) / 2;
}

/// Of a span that cuts, and behind which nothing does.
double LoadMeter::find_end(const Span& span, const StockModel& before, double least) {
  std::unique_ptr<StockModel> state = before.snapshot();
  double from = span.from, to = span.to;
  while (to - from > least) {
    const double middle = to == 1 ? std::max(from, 1 - least) : (from + to) / 2;
    std::unique_ptr<StockModel> half = state->snapshot();
    cut_part(*half, from, middle);
    if (cut_part(*half->snapshot(), middle, to) > 0) {
      if (to == 1) return 1;
      state = std::move(half);
      from = middle;
    } else {
      to = middle;
    }
  }
  return to == span.to ? to : (from + to) / 2;
}

/// The windows that lie in a row are those of one stretch of cutting.
double LoadMeter::peak(std::size_t first, std::size_t end, double window) const {
  double greatest = 0, all_mm3 = 0, mm3 = 0, from = spans_[first].from, to = from, density = 0;
  const auto end_run = [&] {
    const double way_mm = (to - from) * profile_.length_mm;
    if (way_mm > 0) greatest = std::max(greatest, mm3 / way_mm * profile_.greatest_speed(from, to));
  };
  for (std::size_t i = first; i < end; ++i) {
    const Span& span = spans_[i];
    all_mm3 += span.removed_mm3;
    if (span.to - span.from < window) continue;
    const double own = span.removed_mm3 / (span.to - span.from);
    if (to != span.from || std::abs(own - density) > kSameRate * density) {
      end_run();
      from = span.from;
      mm3 = 0;
      density = own;
    }
    to = span.to;
    mm3 += span.removed_mm3;
  }
  end_run();
  if (greatest > 0) return greatest;
  from = spans_[first].from, to = spans_[end - 1].to, mm3 = all_mm3;
  end_run();
  return greatest;
}

void LoadMeter::add_run(std::size_t first, std::size_t end, double window, MotionLoad& load) {
  load.cut_s += profile_.at(spans_[end - 1].to) - profile_.at(spans_[first].from);
  load.peak_mm3_per_s = std::max(load.peak_mm3_per_s, peak(first, end, window));
}

/// Something is, below the heights: an M-map's may say less than what is there. Asked once; what
/// undercuts tells reach().
bool LoadMeter::is_hollow(const HeightGrid& heights) {
  if (hollow_) return *hollow_;
  double sum_mm = 0;
  if (stock_.name() == "mmap") {
    const double floor = static_cast<double>(heights.floor_mm());
    for (int j = 0; j < heights.ny(); ++j) {
      for (int i = 0; i < heights.nx(); ++i) {
        sum_mm += static_cast<double>(heights.height(i, j)) - floor;
      }
    }
    const double all_mm3 = sum_mm * heights.cell_x_mm() * heights.cell_y_mm();
    hollow_ = std::abs(all_mm3 - stock_.remaining_mm3()) > 1e-6 * all_mm3;
  } else {
    hollow_ = false;
  }
  return *hollow_;
}

/// Of the windows within a stretch that is cut the greatest, together with its neighbours that are
/// as great; or the rate of the whole stretch.
double LoadMeter::scanned_peak(const EngagementScan::Span& span, double window) {
  const std::span<const double> bins = scan_.bins_mm3();
  const double bin = (to_ - from_) / static_cast<double>(bins.size());
  const auto index = [&](double part) {
    const double at = std::floor((part - from_) / bin);
    return static_cast<std::size_t>(std::clamp(at, 0.0, static_cast<double>(bins.size() - 1)));
  };
  const std::size_t first = index(span.from), last = index(span.to * (1 - 1e-12));
  const auto rate = [&](double mm3, double from, double to) {
    return mm3 / ((to - from) * profile_.length_mm) * profile_.greatest_speed(from, to);
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
  if (span.to - span.from <= window + bin || rates_.empty()) {
    mm3 = 0;
    for (std::size_t b = first; b <= last; ++b) mm3 += bins[b];
    return rate(mm3, span.from, span.to);
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
bool LoadMeter::scan(const Cutter& cutter, const CutMove& move, MotionLoad& load) {
  if (!EngagementScan::takes(cutter, move)) return false;
  const std::shared_ptr<const HeightGrid> heights = stock_.snapshot()->height_grid();
  if (!heights || is_hollow(*heights)) return false;
  const double window = std::min(window_mm(cutter) / profile_.length_mm, to_ - from_);
  const EngagementScan::Cost cost =
      scan_.run(*heights, cutter, move, from_, to_, window * profile_.length_mm / kBinsOfWindow);
  left_cells_ -= kCellsOfLook * cost.looks + kCellsOfPlace * cost.places +
                 2 * static_cast<double>(stock_.tile_count());
  for (const EngagementScan::Span& span : scan_.spans()) {
    load.cut_s += profile_.at(span.to) - profile_.at(span.from);
    load.peak_mm3_per_s = std::max(load.peak_mm3_per_s, scanned_peak(span, window));
  }
  return true;
}

MotionLoad LoadMeter::measure(const Cutter& cutter, const CutMove& move) {
  MotionLoad load;
  if (profile_.length_mm <= 0 || to_ <= from_) return load;
  return scan(cutter, move, load) ? load : measure_by_pieces(cutter, move);
}

MotionLoad LoadMeter::measure_by_pieces(const Cutter& cutter, const CutMove& move) {
  MotionLoad load;
  cutter_ = &cutter;
  move_ = &move;
  const double length_mm = profile_.length_mm;
  const double window = window_mm(cutter) / length_mm;
  const int pieces = std::clamp(static_cast<int>((to_ - from_) / window), 1, kPieces);
  cut_spans(stock_, from_, to_, pieces);
  double cutting = 0;
  for (const Span& span : spans_) cutting += span.cuts() ? span.to - span.from : 0;
  const double least = std::max(stock_.cell_mm() / 2 / length_mm, kEnds * cutting);
  struct Run {
    double from, to;
    std::unique_ptr<StockModel> before;  ///< null: it is not looked at again
  };
  std::vector<Run> again;
  for (std::size_t first = 0, end = 0; first < spans_.size(); first = end) {
    end = first + 1;
    if (!spans_[first].cuts()) continue;
    while (end < spans_.size() && spans_[end].cuts()) ++end;
    spans_[first].from = find_begin(spans_[first], *before_[first], least);
    spans_[end - 1].to = find_end(spans_[end - 1], *before_[end - 1], least);
    const double way = spans_[end - 1].to - spans_[first].from;
    if (end - first < kFewPieces && way > 2 * window) {
      again.push_back({spans_[first].from, spans_[end - 1].to, std::move(before_[first])});
    } else {
      add_run(first, end, std::min(window, (to_ - from_) / pieces) * 0.999, load);
    }
  }
  for (const Run& run : again) {
    const double way = run.to - run.from;
    const int finer = std::clamp(static_cast<int>(way / window), 1, kFinerPieces);
    cut_spans(*run.before, run.from, run.to, finer);
    add_run(0, spans_.size(), std::min(window, way / finer) * 0.999, load);
  }
  spans_.clear();
  before_.clear();
  return load;
}

}  // namespace kerf
