// twin/process/milling/piece_watch.h - piece-free: what milling parts from the workpiece.
//
// What is held: where fixtures touch the blank (from the side or from above), each piece that they
// still touch; else, of what a move parts, the largest piece. Bodies that a blank consists of are
// held, each for itself. The others have come free.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "stock/stock_model.h"
#include "twin/process/check_options.h"
#include "twin/process/milling/piece_ledger.h"

namespace kerf {

/// Finds them in one kind of model. Called for each move that cuts, first before and then after the
/// model has been given it. One thread.
class PieceFinder {
 public:
  virtual ~PieceFinder() = default;
  virtual void before(const Cutter& cutter, const CutMove& move, const PieceCutter& by) = 0;
  virtual void after(const CutMove& move, const PieceCutter& by) = 0;
  /// The program is over: tells the ledger what is left of each.
  virtual void finish() = 0;
  /// After finish(): what is held.
  virtual const std::vector<PieceBody>& held() const = 0;
};

/// What finders share.
struct PieceSite {
  const StockModel& stock;
  PieceLedger& ledger;
  std::function<void()> complete;  ///< the model takes in all that it has been given
  FixtureList fixtures;
};

/// For models of heights; null: it is none. Told with the move that parts it. Costs nothing as long
/// as no move goes as low as the floor (stock/pieces/through_map.h).
std::unique_ptr<PieceFinder> find_height_pieces(const PieceSite& site);
/// For models that are read in columns; null: it is none. Looks at the workpiece after each
/// kMovesBetweenLooks moves from the first on that undercuts, tilts or goes as low as the floor,
/// and finds out which of them it was by cutting them once more: what is parted and cut up in
/// between is not seen.
std::unique_ptr<PieceFinder> find_column_pieces(const PieceSite& site);
inline constexpr std::size_t kMovesBetweenLooks = 64;

class PieceWatch {
 public:
  PieceWatch(const StockModel& stock, FindingLog& log, std::function<void()> complete)
      : stock_(stock), ledger_(log), complete_(std::move(complete)) {}

  void set_options(const CheckOptions& options) {
    ledger_.set_blank_guessed(options.blank_guessed);
    fixtures_ = options.collisions.fixtures;
  }
  void before(const Cutter& cutter, const CutMove& move, const PieceCutter& by);
  void after(const CutMove& move, const PieceCutter& by) {
    if (finder_) finder_->after(move, by);
  }
  void begin_reporting() { ledger_.forget(); }
  void finish() {
    if (finder_) finder_->finish();
  }
  /// Empty: nothing has come free.
  std::vector<LoosePiece> pieces() const;

 private:
  const StockModel& stock_;
  PieceLedger ledger_;
  std::function<void()> complete_;
  FixtureList fixtures_;
  bool begun_ = false;
  std::unique_ptr<PieceFinder> finder_;  ///< null: not begun, or nothing finds them
};

}  // namespace kerf
