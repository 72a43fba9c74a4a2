#include "twin/load_meter.h"

#include <algorithm>
#include <cmath>

#include "twin/motion_geometry.h"

namespace kerf {
namespace {

/// A window of the way is so much of the cutter's diameter, and so many cells at least.
constexpr double kWindowOfDiameter = 0.25;
constexpr double kWindowCells = 20;
/// Windows that differ by less are one rate.
constexpr double kSameRate = 0.02;
/// Divisions after the first one, each by so much.
constexpr int kRefinements = 3;
constexpr int kFiner = 8;
/// A span that removes at least so much of what its neighbour does cuts on its whole way.
constexpr double kFull = 0.98;
/// An end of the cutting is found to this part of the cutting time.
constexpr double kEnds = 0.002;
/// Fewer pieces that cut than this say little of how fast they do.
constexpr std::ptrdiff_t kFewPieces = 8;

Motion motion_of(const CutMove& move) {
  Motion motion;
  motion.kind = move.arc ? MotionKind::kArc : MotionKind::kFeed;
  motion.from_mm = move.from_mm;
  motion.to_mm = move.to_mm;
  if (move.arc) motion.arc = {move.arc->center_mm, move.arc->axis, move.arc->sweep_rad};
  return motion;
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

/// In a copy of the workpiece; spans that are known to be in the air are not cut again. Each piece
/// is finished: what the cutter's front takes must not wait for the last one.
void LoadMeter::cut_pieces(const Cutter& cutter, const CutMove& move) {
  const std::unique_ptr<StockModel> copy = stock_.snapshot();
  for (Span& span : spans_) {
    if (!span.cuts()) continue;
    moves_.assign(1, part_of(move, span.from, span.to));
    reports_.clear();
    copy->cut(cutter, moves_, reports_);
    copy->finish(reports_);
    span.removed_mm3 = 0;
    for (const CutReport& report : reports_) span.removed_mm3 += report.removed_mm3;
  }
}

/// Whether the cutting begins or ends within a span: nothing is cut beside it, and it removes less
/// than the span on its other side does in its place.
bool LoadMeter::is_end(std::size_t i) const {
  const bool first = i == 0 || !spans_[i - 1].cuts();
  const bool last = i + 1 == spans_.size() || !spans_[i + 1].cuts();
  if (first == last) return first;
  const Span& inner = spans_[first ? i + 1 : i - 1];
  return spans_[i].density() < kFull * inner.density();
}

/// Divides what lies at an end of the cutting, and all that cuts where that is little. False: it is
/// fine enough.
bool LoadMeter::refine(double least_part, double cell_part) {
  const auto cutting =
      std::count_if(spans_.begin(), spans_.end(), [](const Span& span) { return span.cuts(); });
  double cut_s = 0;
  for (const Span& span : spans_) {
    if (span.cuts()) cut_s += profile_.at(span.to) - profile_.at(span.from);
  }
  finer_.clear();
  bool divided = false;
  for (std::size_t i = 0; i < spans_.size(); ++i) {
    const Span& span = spans_[i];
    const double part = span.to - span.from;
    const bool at_end = is_end(i);
    const bool coarse = profile_.at(span.to) - profile_.at(span.from) > kEnds * cut_s;
    const bool ends = at_end && coarse && part > cell_part;
    const bool few = cutting < kFewPieces && part > 2 * least_part;
    if (!span.cuts() || !(ends || few)) {
      finer_.push_back(span);
      continue;
    }
    divided = true;
    for (int k = 0; k < kFiner; ++k) {
      const double to = k + 1 == kFiner ? span.to : span.from + part * (k + 1) / kFiner;
      finer_.push_back({span.from + part * k / kFiner, to, span.removed_mm3});
    }
  }
  if (divided) spans_.swap(finer_);
  return divided;
}

/// The windows that lie in a row are those of one stretch of cutting.
double LoadMeter::peak(double window_part) const {
  double greatest = 0, run_mm3 = 0, run_s = 0, run_rate = 0;
  const auto end_run = [&] {
    if (run_s > 0) greatest = std::max(greatest, run_mm3 / run_s);
    run_mm3 = run_s = 0;
  };
  double mm3 = 0, seconds = 0, part = 0, all_mm3 = 0, all_s = 0;
  for (const Span& span : spans_) {
    if (!span.cuts()) {
      mm3 = seconds = part = 0;
      end_run();
      continue;
    }
    const double lasts_s = profile_.at(span.to) - profile_.at(span.from);
    mm3 += span.removed_mm3;
    seconds += lasts_s;
    part += span.to - span.from;
    all_mm3 += span.removed_mm3;
    all_s += lasts_s;
    if (part < window_part || seconds <= 0) continue;
    const double rate = mm3 / seconds;
    if (run_s > 0 && std::abs(rate - run_rate) > kSameRate * run_rate) end_run();
    if (run_s == 0) run_rate = rate;
    run_mm3 += mm3;
    run_s += seconds;
    mm3 = seconds = part = 0;
  }
  end_run();
  if (greatest == 0 && all_s > 0) greatest = all_mm3 / all_s;
  return greatest;
}

MotionLoad LoadMeter::measure(const Cutter& cutter, const CutMove& move, double duration_s,
                              double speed_mm_per_s) {
  MotionLoad load;
  const double length_mm = path_length_mm(motion_of(move));
  if (length_mm <= 0 || duration_s <= 0) return load;
  profile_ = {length_mm, duration_s, std::max(length_mm / duration_s, speed_mm_per_s), 0, 0};
  profile_.ramp_s = duration_s - length_mm / profile_.speed_mm_per_s;
  profile_.ramp_mm = profile_.speed_mm_per_s * profile_.ramp_s / 2;
  if (profile_.ramp_mm * 2 > length_mm) profile_.ramp_mm = profile_.ramp_s = 0;
  const double cell_mm = stock_.cell_mm();
  const double window_mm =
      std::max(kWindowOfDiameter * 2 * cutter.radius_mm(), kWindowCells * cell_mm);
  const double window = std::min(1.0, window_mm / length_mm);
  const int pieces = std::clamp(static_cast<int>(2 / window), 1, kPieces);
  spans_.clear();
  for (int k = 0; k < pieces; ++k) {
    spans_.push_back({static_cast<double>(k) / pieces, static_cast<double>(k + 1) / pieces, 1});
  }
  cut_pieces(cutter, move);
  for (int n = 0; n < kRefinements && refine(window, cell_mm / 2 / length_mm); ++n) {
    cut_pieces(cutter, move);
  }
  for (const Span& span : spans_) {
    if (span.cuts()) load.cut_s += profile_.at(span.to) - profile_.at(span.from);
  }
  load.peak_mm3_per_s = peak(window);
  return load;
}

}  // namespace kerf
