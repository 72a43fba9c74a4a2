// twin/scene/patch_feeder.h - which tiles of the workpiece have to be drawn anew.
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
  /// by tile. Until it is told: as if the blank filled a picture of usual size. When more than
  /// `easy_triangles` would have to be made of what was cut (0: never), and have been kRounds times
  /// of the last eight, these tiles come a level coarser, a quarter of the triangles. They are made
  /// anew when it has not been too much for kCalm: not before, as then what is redrawn would be
  /// spread over the picture. A jump is one time.
  void set_detail(const ViewDetail& detail, std::size_t easy_triangles = 0);
  static constexpr std::size_t kTogether = 100;
  static constexpr int kRounds = 4;
  static constexpr std::chrono::milliseconds kCalm{1000};

  /// Before the first patch is made: all get their deviation from `design`, coloured by
  /// `tolerance_mm`. They are made of every cell then, whatever a pixel shows: joined cells lie as
  /// low as their lowest, which is no deviation of the workpiece.
  void compare_with(std::shared_ptr<const DesignPart> design, double tolerance_mm);

  /// Patches made until `deadline`, at least one if there is one to be made. Tiles that were cut
  /// come before those that are made at another level only, and up to kTogether of them at once,
  /// whatever it takes: between one as it is and one as it was the picture has a slit. To be called
  /// every now and then: it may be calm.
  std::vector<std::shared_ptr<const MeshPatch>> make_until(Clock::time_point deadline);
  /// Some tiles are not yet as they should be, other than those that come when it is calm.
  bool behind() const { return behind_; }
  std::size_t triangles() const { return triangles_; }

 private:
  struct Shown {
    std::uint64_t version = 0;
    std::uint32_t triangles = 0;
    std::int8_t level = -1;   ///< -1: never
    bool is_old = true;       ///< it or one about it was cut since
    bool is_hurried = false;  ///< to be coarser
  };
  void start_anew(const StockModel& stock);
  void find_neighbors(const StockModel& stock);
  bool is_old(std::size_t tile);
  std::vector<std::uint32_t> old_tiles();
  int wanted_level(std::size_t tile) const;
  void hurry(const std::vector<std::uint32_t>& cut_ones, Clock::time_point now);
  void calm_down(Clock::time_point now);
  std::shared_ptr<const MeshPatch> make(std::size_t tile);
  void choose_levels();
  int level_for(const ViewDetail& detail, const Box& box) const;

  std::shared_ptr<const StockModel> stock_;
  std::shared_ptr<const DesignPart> design_;
  double tolerance_mm_ = 0;
  std::vector<Shown> shown_;
  std::vector<std::vector<std::uint32_t>> neighbors_;  ///< of each tile, itself among them
  std::optional<ViewDetail> detail_;
  std::vector<std::int8_t> levels_;  ///< of each tile, as it should be drawn
  std::size_t easy_triangles_ = 0;
  bool has_news_ = false;               ///< since hurry()
  std::uint8_t too_much_ = 0;           ///< whether it was, the last eight times, a bit each
  std::vector<std::uint32_t> hurried_;  ///< tiles with Shown::is_hurried
  Clock::time_point last_hurry_;
  std::size_t next_ = 0;  ///< where looking for tiles goes on
  std::size_t triangles_ = 0;
  bool behind_ = false;
};

}  // namespace kerf
