// stock/millturn/mill_turn.h - a workpiece on a lathe that also mills: turned, and milled by tools
// that are driven themselves while it stands or turns slowly.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "stock/octree/kernel_choice.h"
#include "stock/octree/octree.h"
#include "stock/turning/turning_stock.h"
#include "stock/way_contact.h"

namespace kerf {

struct MillTurnOptions {
  double cell_mm = 0.1;  ///< of what is milled: OctreeOptions
  int threads = 1;       ///< while it is milled
  std::size_t memory_limit_bytes = std::size_t{4} << 30;
  octree::KernelChoice kernel = octree::KernelChoice::kAuto;
};

/// Until a driven tool (Cutter::live()) cuts it is a TurningStock and nothing else. With the first
/// cut it becomes an octree: the blank's box, less what lies beyond the profile, less what is
/// milled. What is removed adds up in whatever order, so profile and milled ways are kept apart:
///
///     workpiece = what the profile sweeps  AND  what the driven tools have left of the blank
///
/// Turned moves go on cutting the exact profile, and the octree follows before it is looked at or
/// milled again (Octree::keep_within()): what is turned later, and what comes off with it, is gone
/// there, too. So surfaces that are turned are cones to a 65536th of a cell, whenever they are cut.
///
/// A driven tool's moves are in the frame of the workpiece, spindle and all, as an octree takes
/// them; those of all other tools as a TurningStock takes them, which turned() is. That has the
/// profile alone: of turned moves contacts and what is removed are those of a ring which nobody has
/// milled. remaining_mm3(), digest(), mesh() and patches are of the whole; volumes are exact until
/// it is milled, then the octree's from there on.
///
/// Threads are not in the octree: it has them as what is there at some angle, plain cylinders and
/// cones. Their volume counts as if nobody had milled them.
///
/// Equal bits for any division into calls and any number of threads: the octree follows the profile
/// where a driven tool's moves begin, and for who looks it does so on a copy.
///
/// Tiles are the bands of the profile, and once it is milled those of the octree: cell_mm() and
/// tile_count() change then, which counts as another model for who compares tiles.
class MillTurn final : public StockModel, public WaySearcher {
 public:
  /// Error: the octree would not be made: Octree::create().
  static Result<std::unique_ptr<MillTurn>> create(TurningStock turned,
                                                  const MillTurnOptions& options);
  ~MillTurn() override;

  void cut(const Cutter& cutter, std::span<const CutMove> moves,
           std::vector<CutReport>& reports) override;
  void finish(std::vector<CutReport>& reports) override { turned_.finish(reports); }
  std::optional<Contact> first_contact(const Cutter& cutter, const CutMove& move,
                                       double tolerance_mm) const override;
  std::optional<WayContact> first_contact_of(const Cutter& cutter, std::span<const CutMove> moves,
                                             double tolerance_mm,
                                             const WayWatch& watch) const override;
  /// Of what driven tools carry: as the octree has it.
  bool checks_parts() const override { return true; }
  double part_spare_mm(const CarriedPart& part, const CutMove& move, double enough_mm,
                       double most_mm) const override;
  std::optional<PartContact> part_contact(const Cutter& cutter, const CarriedPart& part,
                                          const CutMove& move, double tolerance_mm) const override;
  std::optional<PartGap> part_gap(const Cutter& cutter, const CarriedPart& part,
                                  const CutMove& move, double below_mm) const override;
  bool is_milled() const { return milled_ != nullptr; }

  std::unique_ptr<StockModel> snapshot() const override;
  std::size_t unique_bytes() const override;
  /// Once it is milled patches name the moves of driven tools alone; cut_id_at() all of them.
  void keep_cut_ids(bool keep) override;
  bool keeps_cut_ids() const override { return turned_.keeps_cut_ids(); }
  std::optional<std::uint32_t> cut_id_at(const Vec3& point_mm) const override;
  /// TurningStock's file, or once it is milled an octree's, with the profile beside it: a mill goes
  /// on with the octree alone, a lathe with both.
  Done save(const std::string& path) const override;
  /// Of one that has been milled; its cells are those that it has. Error: cannot be read, damaged,
  /// an octree without a profile.
  static Result<std::unique_ptr<MillTurn>> load(const std::string& path,
                                                const MillTurnOptions& options);

  /// The workpiece as an octree alone, for a mill: threads are plain in it.
  std::unique_ptr<Octree> as_octree() const;

  /// Driven tools as an octree takes them, others as a TurningStock.
  static Done can_cut(const Cutter& cutter);
  Done accepts(const Cutter& cutter) const override { return can_cut(cutter); }
  double milling_cell_mm() const override { return options_.cell_mm; }
  const TurningStock* turned() const override { return &turned_; }
  std::string name() const override { return "turning"; }
  Box bounds_mm() const override { return turned_.bounds_mm(); }
  double cell_mm() const override;
  std::size_t cell_count() const override;
  double blank_mm3() const override { return turned_.blank_mm3(); }
  double remaining_mm3() const override;
  std::string digest() const override;
  TriangleMesh mesh(double tolerance_mm) const override;

  std::size_t tile_count() const override;
  Box tile_box(std::uint32_t tile) const override;
  std::vector<std::uint32_t> take_dirty_tiles() override;
  std::vector<std::uint32_t> differing_tiles(const StockModel& other) const override;
  std::uint64_t patch_version(std::uint32_t tile) const override;
  MeshPatch patch(std::uint32_t tile, int level) const override;

 private:
  /// An octree that has followed the profile up to these versions of its bands.
  struct Milled {
    std::unique_ptr<Octree> tree;
    std::vector<std::uint64_t> bands;
    double beside_mm3 = 0;  ///< by how much its volume was less than the exact one of the part
                            ///< without threads, when it was made
  };
  MillTurn(TurningStock turned, const MillTurnOptions& options);
  Result<std::unique_ptr<Octree>> box_tree() const;
  std::vector<std::uint64_t> bands() const;
  std::unique_ptr<Milled> begun() const;
  std::unique_ptr<Milled> copy_of(const Milled& milled) const;
  void follow_profile(Milled& milled) const;
  const Milled& shown() const;
  double threads_mm3() const { return turned_.part().threads().volume_mm3(); }
  const Octree& tree() const { return *shown().tree; }

  TurningStock turned_;
  MillTurnOptions options_;
  std::unique_ptr<Milled> milled_;         ///< null: not milled so far
  mutable std::unique_ptr<Milled> shown_;  ///< for who looks, while the profile is ahead of milled_
  std::unique_ptr<StockModel> seen_;       ///< the octree as take_dirty_tiles() saw it last
};

}  // namespace kerf
