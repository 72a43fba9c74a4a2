// stock/zmap/zmap.h - the workpiece as one height per cell ("Z-map").
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "stock/blank.h"
#include "stock/column_runs.h"
#include "stock/present_heights.h"
#include "stock/sparse_surface.h"
#include "stock/stock_model.h"
#include "stock/zmap/zmap_kernel.h"

namespace kerf {

struct SavedState;

struct ZMapOptions {
  Blank blank;           ///< bodies, workpiece frame
  double cell_mm = 0.1;  ///< greatest edge of a cell: the true edges divide the blank evenly
  int threads = 1;       ///< cutting threads, >= 1
  ZMapKernel kernel = ZMapKernel::kAuto;
  bool keeps_cut_ids = false;  ///< StockModel::keep_cut_ids(), from the beginning
};

/// Workpiece that is solid from the floor of the blank up to a height in each cell. Holds no
/// undercuts. Reads no files, knows no GL. A cell whose height is the floor holds no material.
/// Where upright walls stand between the middles of cells is known to 1/512 of a cell
/// (wall_marks.h): mesh(), save(), blank_mm3() and remaining_mm3() have it. All else goes by cells:
/// what moves remove (CutReport; the sum differs from what is gone by what walls stand beside the
/// borders of cells), patches, contacts; and digest(), from which walls do not follow, though both
/// follow from the same cuts, in any order. Source: one-dexel case of T. Van Hook, "Real-time
/// shaded NC milling display", SIGGRAPH 1986.
class ZMap final : public StockModel,
                   public PresentHeights,
                   public ColumnSource,
                   public SparseSource {
 public:
  /// Error if cell_mm is not finite or <= 0, exceeds the blank, or makes more than kMaxCells cells
  /// (then the message says how much memory it would take), or if a body cannot be held (cylinder
  /// along x or y).
  static Result<std::unique_ptr<ZMap>> create(const ZMapOptions& options);
  /// Error if the cutter has an undercut or a hollow bottom: what it cuts has several surfaces
  /// above one point, or none that depends on one height only. cut() must not be given such a
  /// cutter.
  static Done can_cut(const Cutter& cutter);
  Done accepts(const Cutter& cutter) const override { return can_cut(cutter); }
  ~ZMap() override;

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
  /// A copy of one that was packed has heights, numbers and walls to the bit, but judges contacts
  /// and reports depths as a workpiece that was loaded does: the ways of tips are dropped.
  bool pack(std::span<StockModel* const> copies, std::size_t at) const override;
  std::size_t kept_bytes(const StockModel& before, const StockModel* after) const override;
  void keep_cut_ids(bool keep) override;
  bool keeps_cut_ids() const override;
  std::optional<std::uint32_t> cut_id_at(const Vec3& point_mm) const override;
  std::string name() const override { return "zmap"; }
  Box bounds_mm() const override;
  double cell_mm() const override;
  std::size_t cell_count() const override;
  double blank_mm3() const override;
  /// About 1 ms for each million cells, and 1 us for each wall between two of them.
  double remaining_mm3() const override;
  double beside_cells_mm3() const override;
  std::string digest() const override;
  TriangleMesh mesh(double tolerance_mm) const override;

  /// Tiles of kTileCells x kTileCells cells, row by row from low x, y; the last ones may be
  /// smaller.
  std::size_t tile_count() const override;
  Box tile_box(std::uint32_t tile) const override;
  std::vector<std::uint32_t> take_dirty_tiles() override;
  std::vector<std::uint32_t> differing_tiles(const StockModel& other) const override;
  std::uint64_t patch_version(std::uint32_t tile) const override;
  /// How it is made: stock/zmap/tile_patch.h.
  MeshPatch patch(std::uint32_t tile, int level) const override;
  std::unique_ptr<SparseSurface> sparse_surface(const SparseOptions& options) const override;
  std::shared_ptr<const HeightGrid> height_grid() const override;
  std::optional<HeightGrid> present_heights() const override;
  std::uint32_t present_cut_id(int i, int j) const override;
  std::array<std::uint32_t, 4> present_cut_ids_of_four(int i, int j) const override;
  void read_present_cut_ids(int i, int j, bool along_x,
                            std::span<std::uint32_t> out) const override;
  ColumnLayout column_layout() const override;
  bool has_heights_only() const override { return true; }
  std::uint64_t column_version(std::uint32_t tile) const override;
  void read_columns(std::uint32_t tile, ColumnRuns& out) const override;

  int nx() const;
  int ny() const;
  /// Height of the material in cell (i, j), mm in the workpiece frame; the floor if there is none.
  float height_mm(int i, int j) const;
  /// All heights row by row (y outer, x inner).
  std::vector<float> heights_mm() const;

  /// Saves and loads the workpiece (kerf-state/1: text head, then tiles; format in
  /// stock/zmap/state_file.h), without cut ids. Written to a temporary name and renamed. A damaged
  /// file is an error that says where.
  Done save(const std::string& path) const override;
  static Result<std::unique_ptr<ZMap>> load(const std::string& path, int threads = 1,
                                            ZMapKernel kernel = ZMapKernel::kAuto);

  /// Of heights that are there already, as load() has them.
  static std::unique_ptr<ZMap> of_heights(SavedState heights, int threads, ZMapKernel kernel);

  static constexpr std::size_t kMaxCells = std::size_t{1} << 30;

 private:
  struct Impl;
  explicit ZMap(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace kerf
