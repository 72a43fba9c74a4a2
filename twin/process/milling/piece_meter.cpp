#include "twin/process/milling/piece_meter.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace kerf {
namespace {

/// Windows that differ by less are one rate.
constexpr double kSamePieceRate = 0.02;
/// An end of the cutting is found to this part of the way that cuts.
constexpr double kEnds = 0.002;
/// Fewer pieces that cut than this say little of how fast they do.
constexpr std::size_t kFewPieces = 5;
constexpr int kFinerPieces = 8;

}  // namespace

/// Finished: what the cutter's front takes must not wait for the next part.
double PieceMeter::cut_part(StockModel& stock, double from, double to) {
  moves_.assign(1, part_of(*move_, from, to));
  reports_.clear();
  stock.cut(*cutter_, moves_, reports_);
  stock.finish(reports_);
  double removed_mm3 = 0;
  for (const CutReport& report : reports_) removed_mm3 += report.removed_mm3;
  const double diameter_mm = 2 * cutter_->radius_mm(), cell_mm = stock_.cell_mm();
  const double swept_mm2 = diameter_mm * (diameter_mm + (to - from) * profile_.length_mm());
  cost_cells_ += swept_mm2 / (cell_mm * cell_mm) + static_cast<double>(stock_.tile_count());
  return removed_mm3;
}

void PieceMeter::cut_pieces(const StockModel& before, double from, double to, int pieces) {
  pieces_.clear();
  before_.clear();
  const std::unique_ptr<StockModel> copy = before.snapshot();
  for (int k = 0; k < pieces; ++k) {
    Piece piece;
    piece.from = from + (to - from) * k / pieces;
    piece.to = k + 1 == pieces ? to : from + (to - from) * (k + 1) / pieces;
    before_.push_back(copy->snapshot());
    piece.removed_mm3 = cut_part(*copy, piece.from, piece.to);
    pieces_.push_back(piece);
  }
}

/// Of a piece that cuts, and before which nothing does.
double PieceMeter::find_begin(const Piece& piece, const StockModel& before, double least) {
  const auto cuts = [&](double from, double to) {
    return cut_part(*before.snapshot(), from, to) > 0;
  };
  double from = piece.from, to = piece.to;
  if (from == 0 && cuts(0, std::min(to, least))) return 0;
  while (to - from > least) {
    const double middle = (from + to) / 2;
    (cuts(from, middle) ? to : from) = middle;
  }
  return from == piece.from ? from : (from + to) / 2;
}

/// Of a piece that cuts, and behind which nothing does.
double PieceMeter::find_end(const Piece& piece, const StockModel& before, double least) {
  std::unique_ptr<StockModel> state = before.snapshot();
  double from = piece.from, to = piece.to;
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
  return to == piece.to ? to : (from + to) / 2;
}

/// The windows that lie in a row are those of one stretch of cutting.
double PieceMeter::peak(std::size_t first, std::size_t end, double window) const {
  double greatest = 0, all_mm3 = 0, mm3 = 0, from = pieces_[first].from, to = from, density = 0;
  const auto end_run = [&] {
    const double way_mm = (to - from) * profile_.length_mm();
    if (way_mm > 0) greatest = std::max(greatest, mm3 / way_mm * profile_.greatest_speed(from, to));
  };
  for (std::size_t i = first; i < end; ++i) {
    const Piece& piece = pieces_[i];
    all_mm3 += piece.removed_mm3;
    if (piece.to - piece.from < window) continue;
    const double own = piece.removed_mm3 / (piece.to - piece.from);
    if (to != piece.from || std::abs(own - density) > kSamePieceRate * density) {
      end_run();
      from = piece.from;
      mm3 = 0;
      density = own;
    }
    to = piece.to;
    mm3 += piece.removed_mm3;
  }
  end_run();
  if (greatest > 0) return greatest;
  from = pieces_[first].from, to = pieces_[end - 1].to, mm3 = all_mm3;
  end_run();
  return greatest;
}

void PieceMeter::add_run(std::size_t first, std::size_t end, double window,
                         MotionLoad& load) const {
  load.cut_s += profile_.at_s(pieces_[end - 1].to) - profile_.at_s(pieces_[first].from);
  load.peak_mm3_per_s = std::max(load.peak_mm3_per_s, peak(first, end, window));
}

MotionLoad PieceMeter::measure(const Cutter& cutter, const CutMove& move, const WayProfile& profile,
                               WaySpan way, double window) {
  MotionLoad load;
  cost_cells_ = 0;
  cutter_ = &cutter;
  move_ = &move;
  profile_ = profile;
  const double length_mm = profile.length_mm(), way_part = way.to - way.from;
  const int pieces = std::clamp(static_cast<int>(way_part / window), 1, kPieces);
  cut_pieces(stock_, way.from, way.to, pieces);
  double cutting = 0;
  for (const Piece& piece : pieces_) cutting += piece.cuts() ? piece.to - piece.from : 0;
  const double least = std::max(stock_.cell_mm() / 2 / length_mm, kEnds * cutting);
  struct Run {
    double from, to;
    std::unique_ptr<StockModel> before;  ///< null: it is not looked at again
  };
  std::vector<Run> again;
  for (std::size_t first = 0, end = 0; first < pieces_.size(); first = end) {
    end = first + 1;
    if (!pieces_[first].cuts()) continue;
    while (end < pieces_.size() && pieces_[end].cuts()) ++end;
    pieces_[first].from = find_begin(pieces_[first], *before_[first], least);
    pieces_[end - 1].to = find_end(pieces_[end - 1], *before_[end - 1], least);
    const double run_part = pieces_[end - 1].to - pieces_[first].from;
    if (end - first < kFewPieces && run_part > 2 * window) {
      again.push_back({pieces_[first].from, pieces_[end - 1].to, std::move(before_[first])});
    } else {
      add_run(first, end, std::min(window, way_part / pieces) * 0.999, load);
    }
  }
  for (const Run& run : again) {
    const double run_part = run.to - run.from;
    const int finer = std::clamp(static_cast<int>(run_part / window), 1, kFinerPieces);
    cut_pieces(*run.before, run.from, run.to, finer);
    add_run(0, pieces_.size(), std::min(window, run_part / finer) * 0.999, load);
  }
  pieces_.clear();
  before_.clear();
  return load;
}

}  // namespace kerf
