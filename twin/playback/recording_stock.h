// twin/playback/recording_stock.h - a stock model that remembers how it was cut and leaves copies
// of itself along the way.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "stock/stock_model.h"
#include "twin/machine/motion_moves.h"
#include "twin/playback/cut_record.h"
#include "twin/playback/keyframe_store.h"
#include "twin/playback/program_track.h"

namespace kerf {

/// Smooth runs of more moves than this, or that sweep more cells, get a seam: the model is finished
/// there, so that a copy can be made. Counted in moves and cells, not in time, so that a program
/// has its seams in the same places always.
inline constexpr std::size_t kLongestRun = 50'000;
inline constexpr double kLongestRunCells = 5e7;

/// Cells that a move comes over, roughly: to cut in slices of a bounded length.
double cells_under(const CutMove& move, const Cutter& cutter, double cell_mm);

/// Stands between CutStage and the model proper. The model's moves have the numbers of their
/// motions (CutMove::id), so that what it says of them can be placed. CutStage alone knows which
/// motions cut, with which cutter, and when it has the model finished; here it is written down,
/// motion by motion.
///
/// Keyframes are made only where a copy (which has nothing held back) goes on cutting as its
/// original does: where the path begins anew, behind level circles, and in corners so sharp that no
/// model joins the two sides.
class RecordingStock final : public StockModel {
 public:
  /// `moves`: how the program's motions are cut.
  RecordingStock(std::unique_ptr<StockModel> stock, const ProgramTrack& track,
                 const MotionMoves& moves, CutRecord& record, KeyframeStore& store);

  /// The caller is about to take motions [0, end); all below `settled` it has given to the model or
  /// will not.
  void expect(std::size_t settled, std::size_t end);
  /// Seconds spent cutting so far.
  double cost_s() const { return cost_s_; }

  void cut(const Cutter& cutter, std::span<const CutMove> moves,
           std::vector<CutReport>& reports) override;
  void finish(std::vector<CutReport>& reports) override;

  std::optional<Contact> first_contact(const Cutter& cutter, const CutMove& move,
                                       double tolerance_mm) const override {
    return stock_->first_contact(cutter, move, tolerance_mm);
  }
  std::unique_ptr<StockModel> snapshot() const override { return stock_->snapshot(); }
  std::size_t unique_bytes() const override { return stock_->unique_bytes(); }
  const StockModel& bare() const override { return stock_->bare(); }
  const Sheet* sheet() const override { return stock_->sheet(); }
  const TurningStock* turned() const override { return stock_->turned(); }
  double milling_cell_mm() const override { return stock_->milling_cell_mm(); }
  std::string name() const override { return stock_->name(); }
  Box bounds_mm() const override { return stock_->bounds_mm(); }
  double cell_mm() const override { return stock_->cell_mm(); }
  std::size_t cell_count() const override { return stock_->cell_count(); }
  double blank_mm3() const override { return stock_->blank_mm3(); }
  double remaining_mm3() const override { return stock_->remaining_mm3(); }
  std::string digest() const override { return stock_->digest(); }
  TriangleMesh mesh(double tolerance_mm) const override { return stock_->mesh(tolerance_mm); }
  std::size_t tile_count() const override { return stock_->tile_count(); }
  Box tile_box(std::uint32_t tile) const override { return stock_->tile_box(tile); }
  std::vector<std::uint32_t> take_dirty_tiles() override { return stock_->take_dirty_tiles(); }
  std::vector<std::uint32_t> differing_tiles(const StockModel& other) const override {
    return stock_->differing_tiles(other);
  }
  std::uint64_t patch_version(std::uint32_t tile) const override {
    return stock_->patch_version(tile);
  }
  MeshPatch patch(std::uint32_t tile, int level) const override {
    return stock_->patch(tile, level);
  }
  void keep_cut_ids(bool wanted) override { stock_->keep_cut_ids(wanted); }
  bool keeps_cut_ids() const override { return stock_->keeps_cut_ids(); }
  Done accepts(const Cutter& cutter) const override { return stock_->accepts(cutter); }
  bool takes_tilted_tools() const override { return stock_->takes_tilted_tools(); }
  Done save(const std::string& path) const override { return stock_->save(path); }
  std::optional<std::uint32_t> cut_id_at(const Vec3& point_mm) const override {
    return stock_->cut_id_at(point_mm);
  }
  std::shared_ptr<const HeightGrid> height_grid() const override { return stock_->height_grid(); }

 private:
  std::size_t motion_of(const Cutter& cutter, const CutMove& move);
  void cut_part(const Cutter& cutter, std::span<const CutMove> moves,
                std::vector<CutReport>& reports);
  void finish_here(std::vector<CutReport>& reports);
  void note_removed(std::span<const CutReport> reports);
  void offer_keyframe(std::size_t motion);

  std::unique_ptr<StockModel> stock_;
  const ProgramTrack& track_;
  const MotionMoves& moves_;
  CutRecord& record_;
  KeyframeStore& store_;
  double cell_mm_;
  std::vector<CutMove> numbered_;  ///< those to be cut, with the numbers of their motions
  double cost_s_ = 0;
  std::size_t next_motion_ = 0;  ///< the next move given belongs to this one or a later one
  std::size_t expected_end_ = 0;
  std::vector<CutMove> divided_;     ///< the motion before next_motion_
  std::size_t pieces_left_ = 0;      ///< of it, still to come
  std::optional<CutMove> previous_;  ///< move; empty: nothing is held back
  std::size_t previous_motion_ = 0;
  std::string previous_cutter_;
  std::size_t run_moves_ = 0;  ///< since the last break
  double run_cells_ = 0;
};

}  // namespace kerf
