// stock/zmap/mmap/mmap.h - the workpiece as several solid intervals per cell ("M-map").
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "stock/column_runs.h"
#include "stock/present_heights.h"
#include "stock/stock_model.h"
#include "stock/zmap/mmap/gap_grid.h"
#include "stock/zmap/zmap.h"

namespace kerf {

struct SavedColumns;

/// Workpiece that in each cell is solid from the floor of the blank up to a height, but for gaps
/// below it: what a Z-map holds, and the undercuts of T-slot cutters, lollipops and dovetails.
///
///      ___     ___          height of the top, as in the Z-map
///     |   |   |   |
///     |   |___|   |__       here: a gap under the lip (its upper side: cut from below)
///     |         gap  |
///     |______________|
///
/// Gaps lie beside the heights, in tiles of their own that exist only where there is an undercut. A
/// tile without costs and cuts what it does in the Z-map, by the same kernels: with cutters that do
/// not undercut the result is the Z-map's, bit for bit. Among gaps such cutters take up to twice
/// the time, to open those that they reach. Cutters with a head (Cutter::undercuts) are swept from
/// below and from above by those kernels too; above the head the neck cuts, however far up: its
/// radius is that at the end of Cutter::upper_profile(), shank and holder are none of the model's
/// business.
///
/// The spindle stands upright: cut() and first_contact() must not be given a move that
/// is_vertical() denies. Reads no files, knows no GL.
/// Source: several intervals per cell as in T. Van Hook, "Real-time shaded NC milling display",
/// SIGGRAPH 1986.
class MMap final : public StockModel, public PresentHeights, public ColumnSource {
 public:
  /// Errors as ZMap::create(), but that a mesh may have undercuts. `kernel` and `threads` change no
  /// bit of the result.
  static Result<std::unique_ptr<MMap>> create(const ZMapOptions& options);
  /// Error if the cutter has a hollow bottom (its lower side falls outward).
  static Done can_cut(const Cutter& cutter);
  Done accepts(const Cutter& cutter) const override { return can_cut(cutter); }
  ~MMap() override;

  /// A cutter with a head is cut at once; others as in the Z-map, which holds the last move back.
  void cut(const Cutter& cutter, std::span<const CutMove> moves,
           std::vector<CutReport>& reports) override;
  void finish(std::vector<CutReport>& reports) override;
  std::optional<Contact> first_contact(const Cutter& cutter, const CutMove& move,
                                       double tolerance_mm) const override;
  bool checks_parts() const override { return true; }
  double part_spare_mm(const CarriedPart& part, const CutMove& move, double enough_mm,
                       double most_mm) const override;
  std::optional<PartContact> part_contact(const Cutter& cutter, const CarriedPart& part,
                                          const CutMove& move, double tolerance_mm) const override;
  std::optional<PartGap> part_gap(const Cutter& cutter, const CarriedPart& part,
                                  const CutMove& move, double below_mm) const override;
  std::unique_ptr<StockModel> snapshot() const override;
  std::size_t unique_bytes() const override;
  /// Both ends of a gap have a number as well; those of a gap made before count as not cut.
  void keep_cut_ids(bool keep) override;
  bool keeps_cut_ids() const override;
  std::optional<std::uint32_t> cut_id_at(const Vec3& point_mm) const override;
  /// Saves and loads the workpiece (stock/zmap/mmap/mmap_state.h), without cut ids. A damaged file
  /// is an error that says where.
  Done save(const std::string& path) const override;
  static Result<std::unique_ptr<MMap>> load(const std::string& path, int threads = 1,
                                            ZMapKernel kernel = ZMapKernel::kAuto);
  /// Of columns that are there already, as load() has them.
  static std::unique_ptr<MMap> of_columns(SavedColumns columns, int threads, ZMapKernel kernel);
  std::string name() const override { return "mmap"; }
  Box bounds_mm() const override;
  double cell_mm() const override;
  std::size_t cell_count() const override;
  double blank_mm3() const override;
  double remaining_mm3() const override;
  /// The Z-map's where there are no gaps.
  std::string digest() const override;
  /// Without gaps the Z-map's mesh. With gaps: mmap_mesh.h.
  TriangleMesh mesh(double tolerance_mm) const override;

  std::size_t tile_count() const override;
  Box tile_box(std::uint32_t tile) const override;
  std::vector<std::uint32_t> take_dirty_tiles() override;
  std::vector<std::uint32_t> differing_tiles(const StockModel& other) const override;
  std::uint64_t patch_version(std::uint32_t tile) const override;
  /// The Z-map's where neither the tile nor one of its eight neighbours has gaps; else
  /// column_patch.h.
  MeshPatch patch(std::uint32_t tile, int level) const override;
  /// Null while there are gaps: heights alone would not show them.
  std::shared_ptr<const HeightGrid> height_grid() const override;
  std::optional<HeightGrid> present_heights() const override;
  std::uint32_t present_cut_id(int i, int j) const override;
  std::array<std::uint32_t, 4> present_cut_ids_of_four(int i, int j) const override;
  void read_present_cut_ids(int i, int j, bool along_x,
                            std::span<std::uint32_t> out) const override;
  ColumnLayout column_layout() const override;
  std::uint64_t column_version(std::uint32_t tile) const override;
  void read_columns(std::uint32_t tile, ColumnRuns& out) const override;

  int nx() const;
  int ny() const;
  /// Top of the material in cell (i, j), mm; the floor if there is none.
  float height_mm(int i, int j) const;
  /// What is hollow below it, the topmost first.
  std::vector<Gap> gaps(int i, int j) const;
  bool has_gaps() const;

 private:
  struct Impl;
  explicit MMap(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace kerf
