#include "twin/playback/recording_stock.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <chrono>
#include <cmath>
#include <glm/geometric.hpp>
#include <utility>

namespace kerf {
namespace {

/// Models may join moves that turn by little (the Z-map: a sine up to 0.3). A sine above this, or
/// turning back, is a corner for all.
constexpr double kCornerSine = 0.5;
/// A level circle must be one beyond all doubt of rounding; mm.
constexpr double kSameRadius_mm = 1e-4;
constexpr double kLeastRadius_mm = 1e-2;
constexpr double kLeastSweep_rad = 1e-3;
/// A path shorter than this in XY has no direction there; mm.
constexpr double kVertical_mm = 1e-6;
/// Moves between two looks at the clock.
constexpr std::size_t kMovesAPart = 512;

bool same_bits(const Vec3& a, const Vec3& b) {
  for (int axis = 0; axis < 3; ++axis) {
    if (std::bit_cast<std::uint64_t>(a[axis]) != std::bit_cast<std::uint64_t>(b[axis])) {
      return false;
    }
  }
  return true;
}

bool same_move(const CutMove& a, const CutMove& b) {
  if (!same_bits(a.from_mm, b.from_mm) || !same_bits(a.to_mm, b.to_mm)) return false;
  if (a.axis_from != b.axis_from || a.axis_to != b.axis_to) return false;
  if (a.arc.has_value() != b.arc.has_value()) return false;
  return !a.arc ||
         (same_bits(a.arc->center_mm, b.arc->center_mm) && same_bits(a.arc->axis, b.arc->axis) &&
          std::bit_cast<std::uint64_t>(a.arc->sweep_rad) ==
              std::bit_cast<std::uint64_t>(b.arc->sweep_rad));
}

bool level_circle(const CutMove& move) {
  if (!move.arc || move.arc->axis.x != 0 || move.arc->axis.y != 0) return false;
  const Vec2 center(move.arc->center_mm);
  const double r0 = glm::length(Vec2(move.from_mm) - center);
  const double r1 = glm::length(Vec2(move.to_mm) - center);
  return std::abs(r0 - r1) < kSameRadius_mm && r0 > kLeastRadius_mm &&
         std::abs(move.arc->sweep_rad) > kLeastSweep_rad;
}

/// No model joins `next` to `before`.
bool breaks_between(const CutMove& before, const CutMove& next) {
  if (before.to_mm != next.from_mm) return true;
  if (!before.is_vertical() || !next.is_vertical()) return true;
  if (level_circle(before) || level_circle(next)) return true;
  if (before.arc || next.arc) return false;
  const Vec2 a = Vec2(before.to_mm) - Vec2(before.from_mm);
  const Vec2 b = Vec2(next.to_mm) - Vec2(next.from_mm);
  const double lengths = glm::length(a) * glm::length(b);
  if (!(lengths > kVertical_mm * kVertical_mm)) return false;
  return glm::dot(a, b) <= 0 || std::abs(a.x * b.y - a.y * b.x) > kCornerSine * lengths;
}

}  // namespace

double cells_under(const CutMove& move, const Cutter& cutter, double cell_mm) {
  double length = glm::length(Vec2(move.to_mm) - Vec2(move.from_mm));
  if (move.arc) {
    length = std::max(
        length, std::abs(move.arc->sweep_rad) * glm::length(move.from_mm - move.arc->center_mm));
  }
  const double width = 2 * cutter.radius_mm();
  return width * (length + width) / (cell_mm * cell_mm);
}

RecordingStock::RecordingStock(std::unique_ptr<StockModel> stock, const ProgramTrack& track,
                               const MotionMoves& moves, CutRecord& record, KeyframeStore& store)
    : stock_(std::move(stock)),
      track_(track),
      moves_(moves),
      record_(record),
      store_(store),
      cell_mm_(stock_->cell_mm()) {
  store_.add(0, 0, stock_->snapshot());
}

void RecordingStock::expect(std::size_t settled, std::size_t end) {
  next_motion_ = std::max(next_motion_, settled);
  expected_end_ = end;
}

/// The moves come in the order of the motions, some of which are left out; those of one motion
/// follow each other.
std::size_t RecordingStock::motion_of(const Cutter& cutter, const CutMove& move) {
  if (pieces_left_ > 0) {
    --pieces_left_;
    return next_motion_ - 1;
  }
  for (; next_motion_ < expected_end_; ++next_motion_) {
    divided_.clear();
    track_.append_moves(next_motion_, moves_, cutter, divided_);
    if (!divided_.empty() && same_move(divided_.front(), move)) break;
  }
  assert(next_motion_ < expected_end_);
  pieces_left_ = divided_.size() - 1;
  return next_motion_++;
}

void RecordingStock::cut_part(const Cutter& cutter, std::span<const CutMove> moves,
                              std::vector<CutReport>& reports) {
  if (moves.empty()) return;
  const auto start = std::chrono::steady_clock::now();
  const std::size_t before = reports.size();
  stock_->cut(cutter, moves, reports);
  note_removed(std::span(reports).subspan(before));
  cost_s_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  record_.note_cost(previous_motion_ + 1, cost_s_);
}

void RecordingStock::finish_here(std::vector<CutReport>& reports) {
  const std::size_t before = reports.size();
  stock_->finish(reports);
  note_removed(std::span(reports).subspan(before));
  if (previous_) record_.note_finish(previous_motion_);
  previous_.reset();
}

void RecordingStock::note_removed(std::span<const CutReport> reports) {
  for (const CutReport& report : reports) record_.note_removed(report.id, report.removed_mm3);
}

void RecordingStock::finish(std::vector<CutReport>& reports) { finish_here(reports); }

void RecordingStock::offer_keyframe(std::size_t motion) {
  if (store_.wants(motion, cost_s_)) store_.add(motion, cost_s_, stock_->snapshot());
}

void RecordingStock::cut(const Cutter& cutter, std::span<const CutMove> moves,
                         std::vector<CutReport>& reports) {
  if (cutter.spec() != previous_cutter_) previous_.reset();  // the model finishes by itself
  previous_cutter_ = cutter.spec();
  numbered_.assign(moves.begin(), moves.end());
  std::size_t done = 0;
  for (std::size_t n = 0; n < moves.size(); ++n) {
    const bool goes_on = pieces_left_ > 0;
    const std::size_t motion = motion_of(cutter, moves[n]);
    numbered_[n].id = motion;
    if (goes_on) continue;
    bool breaks = !previous_ || breaks_between(*previous_, moves[n]);
    const bool seam = !breaks && (run_moves_ > kLongestRun || run_cells_ > kLongestRunCells);
    if (seam || (breaks && (n - done >= kMovesAPart || done == 0))) {
      cut_part(cutter, std::span(numbered_).subspan(done, n - done), reports);
      done = n;
      if (seam) finish_here(reports);
      breaks = true;
      offer_keyframe(motion);
    }
    if (breaks) {
      record_.note_break(motion);
      run_moves_ = 0;
      run_cells_ = 0;
    }
    record_.note_cut(motion, track_.tool(motion), cutter);
    ++run_moves_;
    run_cells_ += cells_under(moves[n], cutter, cell_mm_);
    previous_ = moves[n];
    previous_motion_ = motion;
  }
  cut_part(cutter, std::span(numbered_).subspan(done), reports);
}

}  // namespace kerf
