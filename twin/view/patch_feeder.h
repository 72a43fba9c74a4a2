// twin/view/patch_feeder.h - which tiles of the workpiece have to be drawn anew.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "stock/stock_model.h"
#include "twin/compare/design_part.h"
#include "viewer/scene.h"
#include "viewer/view_detail.h"

namespace kerf {

/// Compares a workpiece with what was handed out before and makes the patches of the tiles that
/// look different now: those in which something differs, and the ones about them, whose patches
/// look over their borders. A tool that passes over cut cells changes nothing. Works in slices, so
/// that a jump across the program, which changes every tile, does not keep the moment from being
/// shown. One thread.
class PatchFeeder {
 public:
  using Clock = std::chrono::steady_clock;

  /// From now on this workpiece is shown; a snapshot, or null for none. Of another blank than the
  /// one before: all is made anew.
  void follow(std::shared_ptr<const StockModel> stock);
  /// What a pixel shows: cells much finer than that are joined (StockModel::patch levels), tile
  /// by tile. Until it is told: as if the blank filled a picture of usual size.
  void set_detail(const ViewDetail& detail);

  /// Before the first patch is made: all get their deviation from `design`, coloured by
  /// `tolerance_mm`. They are made of every cell then, whatever a pixel shows: joined cells lie as
  /// low as their lowest, which is no deviation of the workpiece.
  void compare_with(std::shared_ptr<const DesignPart> design, double tolerance_mm);

  /// Patches made until `deadline`, at least one if there is one to be made. Tiles that were cut
  /// come before those that are made at another level only.
  std::vector<std::shared_ptr<const MeshPatch>> make_until(Clock::time_point deadline);
  /// Some tiles are not yet as they should be.
  bool behind() const { return behind_; }
  std::size_t triangles() const { return triangles_; }

 private:
  struct Shown {
    std::uint64_t version = 0;
    std::uint32_t triangles = 0;
    std::int8_t level = -1;  ///< -1: never
    bool is_old = true;      ///< it or one about it was cut since
  };
  void start_anew(const StockModel& stock);
  void find_neighbors(const StockModel& stock);
  bool is_old(std::size_t tile);
  void choose_levels();
  int level_for(const ViewDetail& detail, const Box& box) const;
  std::shared_ptr<const MeshPatch> patch(std::uint32_t tile, int level) const;

  std::shared_ptr<const StockModel> stock_;
  std::shared_ptr<const DesignPart> design_;
  double tolerance_mm_ = 0;
  std::vector<Shown> shown_;
  std::vector<std::vector<std::uint32_t>> neighbors_;  ///< of each tile, itself among them
  std::optional<ViewDetail> detail_;
  std::vector<std::int8_t> levels_;  ///< of each tile, as it should be drawn
  std::size_t next_ = 0;             ///< where looking for tiles goes on
  std::size_t triangles_ = 0;
  bool behind_ = false;
};

}  // namespace kerf
