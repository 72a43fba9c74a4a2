// stock/octree/octree.h - the workpiece as a sparse field of solid nodes and exact crossings.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/placement.h"
#include "stock/blank.h"
#include "stock/column_runs.h"
#include "stock/octree/hermite_grid.h"
#include "stock/octree/kernel_choice.h"
#include "stock/octree/revolved_cut.h"
#include "stock/solid_points.h"
#include "stock/stock_model.h"
#include "stock/way_contact.h"

namespace kerf {

struct OctreeOptions {
  Blank blank;            ///< bodies, workpiece frame; where material is added: the space for it
  double cell_mm = 0.1;   ///< greatest edge of a cell: the true edges divide the blank evenly
  int threads = 1;        ///< cutting threads, >= 1
  bool additive = false;  ///< begin with nothing; moves add material, within the blank's box
  octree::KernelChoice kernel = octree::KernelChoice::kAuto;
  std::size_t memory_limit_bytes = std::size_t{4} << 30;
};

/// Workpiece of any shape, for tools under any angle: undercuts, tilted spindles, moves that turn.
///
/// Nodes at half cells are solid or not; an edge between a solid and an empty one holds where the
/// surface crosses it (to 1/65536 of the edge) and the surface's normal there (0.005 degrees): what
/// a signed distance field, negative inside, is at its zero, where cutting is max(stock, -tool).
/// Only bricks of 8 x 8 x 8 nodes that the surface passes are stored; around them the space is
/// divided in fours (bricks, tiles) and tools are tested against the larger parts first, so a move
/// costs by the surface it touches. Straight moves and level arcs are cut by the exact swept
/// volume, at any fixed spindle direction; other arcs as chords, turning moves with the tool's true
/// pose at every moment, both to min(cell / 50, 2 um) (stock/octree/sweep.h).
///
/// Not held: what is thinner than a cell. A wall, roof or floor that is lost so is told with the
/// move that made it so thin (CutReport::film), if it is more than 0.01 mm thick, some cells wide
/// both ways, and its faces look away from each other within 45 degrees: ridges between passes are
/// not. It is told though a later move would have taken it. A snapshot that cuts on begins anew
/// with what it has seen of films. Of several crossings of one edge the odd ones count: a
/// slot or rib between two nodes may vanish, also where a later move makes it part of a wider cut:
/// on such an edge the later move's surface counts. The same moves once more take that away; within
/// one move it is seen to. Beside a cutter of radius r it is up to cell^2 / 8r too high. Beside a
/// sharp point it is what of the cutter is narrower than a cell: for a vee of half angle a at most
/// cell^2 / (4 tan a) mm3 for each mm of path; measured, with vees of 20 to 90 degrees on paths
/// that cross themselves, 0.012 cell^2 a mm and 4 cell^3 a move, of all that is cut 0.7 % in cells
/// of 0.5 mm and 0.004 % in cells of 0.1 mm. The surface stays closed nevertheless.
///
/// Sources: S. Frisken et al., "Adaptively sampled distance fields", SIGGRAPH 2000 (the field);
/// T. Ju et al., "Dual contouring of Hermite data", SIGGRAPH 2002 (what is kept of it).
class Octree final : public StockModel,
                     public WaySearcher,
                     public SolidPoints,
                     public ColumnSource {
 public:
  /// Of a blank from a mesh crossings and normals are those of its triangles. Error if cell_mm is
  /// not finite or <= 0 or exceeds the blank, if more than 20 000 cells lie between the blank's
  /// floor and its top (a tool without an end cuts through them all), or if the workpiece would
  /// need more memory than the limit: then with what it would need and the cell that would fit. The
  /// need is an estimate, for a part with twice the surface of the blank's box.
  static Result<std::unique_ptr<Octree>> create(const OctreeOptions& options);
  /// Error if the cutter has a hollow bottom.
  static Done can_cut(const Cutter& cutter);
  Done accepts(const Cutter& cutter) const override { return can_cut(cutter); }
  bool takes_tilted_tools() const override { return true; }
  ~Octree() override;

  /// Arcs with a tilted spindle are taken; arcs during which it turns are not (CutMove). Reports of
  /// an additive model count what is added as negative.
  void cut(const Cutter& cutter, std::span<const CutMove> moves,
           std::vector<CutReport>& reports) override;
  void finish(std::vector<CutReport>&) override {}  ///< no move is held back
  /// Takes away what lies beyond the body, as far as that is in the range (revolved_cut.h). From
  /// then on contacts with the blank are those of nodes and crossings. Gives the volume, mm3. Not
  /// of an additive model.
  double keep_within(const octree::RevolvedBody& body, const octree::ZRange& range);
  /// To a cell / 4000 along the path. Where no tool has come within a few cells yet it is the exact
  /// tool against the exact blank less the tolerance, whatever the cells (BlankContact); elsewhere,
  /// and of a workpiece that was loaded, nodes and crossings count, and a corner of material may be
  /// missed by less than a cell. Beside and below a slot, at whose walls and floor crossings are
  /// exact, level ways of flat, ball, bull and vee tools are told from the tolerance on (measured
  /// against points of the exact bodies, in cells of 0.25 and 0.5 mm). depth_mm is the greatest
  /// height of material in the sweep above any one point: of columns of nodes, and of an upright
  /// tool in the untouched blank exact. Never in an additive model: its tool always touches what it
  /// adds.
  std::optional<Contact> first_contact(const Cutter& cutter, const CutMove& move,
                                       double tolerance_mm) const override;
  std::optional<WayContact> first_contact_of(const Cutter& cutter, std::span<const CutMove> moves,
                                             double tolerance_mm,
                                             const WayWatch& watch) const override;
  /// stock/octree/part_contact.h says how exact these are. Nothing in an additive model.
  bool checks_parts() const override;
  double part_spare_mm(const CarriedPart& part, const CutMove& move, double enough_mm,
                       double most_mm) const override;
  std::optional<PartContact> part_contact(const Cutter& cutter, const CarriedPart& part,
                                          const CutMove& move, double tolerance_mm) const override;
  std::optional<PartGap> part_gap(const Cutter& cutter, const CarriedPart& part,
                                  const CutMove& move, double below_mm) const override;
  bool solid_at(const Vec3& point_mm, double within_mm) const override;
  std::unique_ptr<StockModel> snapshot() const override;
  std::size_t unique_bytes() const override;
  void keep_cut_ids(bool keep) override;
  bool keeps_cut_ids() const override;
  std::optional<std::uint32_t> cut_id_at(const Vec3& point_mm) const override;
  /// Saves and loads the workpiece (stock/octree/octree_state.h), without cut ids. A damaged file
  /// is an error that says what is wrong with it.
  Done save(const std::string& path) const override;
  static Result<std::unique_ptr<Octree>> load(
      const std::string& path, int threads = 1,
      octree::KernelChoice kernel = octree::KernelChoice::kAuto);
  /// The same with bytes that lie beside it in the file, and mean nothing to it: it does not keep
  /// them.
  Done save_with(const std::string& path, std::string beside) const;
  static Result<std::unique_ptr<Octree>> load_with(const std::string& path, int threads,
                                                   octree::KernelChoice kernel,
                                                   std::string& beside);
  bool is_additive() const;
  /// As it lies elsewhere, its axes on axes: nodes, crossings and normals change places, and none
  /// is looked for anew. Exact, but that a crossing at an edge's very end is a 65536th of it off.
  /// Not of an additive model.
  std::unique_ptr<Octree> placed(const AxisTurn& turn, const Vec3& at_mm) const;
  /// What this closed surface holds, as it is placed: crossings and normals are those of its
  /// triangles (mesh_bricks.h). `blank_mm3`: what there was before anything was cut, and
  /// blank_mm3() from then on. Errors as create() has them for the box of what is placed; an empty
  /// surface.
  static Result<std::unique_ptr<Octree>> of_surface(const TriangleMesh& surface,
                                                    const Placement& placement, double cell_mm,
                                                    int threads, double blank_mm3);
  /// What of_surface() tells wrongly is no farther from the surface than this, a cell's diagonal:
  /// mesh_bricks.h has the proof.
  static double surface_bound_mm(double cell_mm);
  std::string name() const override { return "octree"; }
  Box bounds_mm() const override;
  double cell_mm() const override;
  std::size_t cell_count() const override;
  /// Of a blank that is one box exact; otherwise, and for all that is removed, summed over nodes
  /// and crossings: off by O(cell^2), for flat and smooth surfaces of any direction alike
  /// (brick.h). In cells that a cutter rounds off, a move that takes next to nothing may count as a
  /// little less than nothing; sums are right.
  double blank_mm3() const override;
  double remaining_mm3() const override;
  std::string digest() const override;
  TriangleMesh mesh(double tolerance_mm) const override;

  /// Tiles of kTileNodes cells along each axis; x fastest, then y.
  std::size_t tile_count() const override;
  Box tile_box(std::uint32_t tile) const override;
  std::vector<std::uint32_t> take_dirty_tiles() override;
  std::vector<std::uint32_t> differing_tiles(const StockModel& other) const override;
  std::uint64_t patch_version(std::uint32_t tile) const override;
  MeshPatch patch(std::uint32_t tile, int level) const override;

  /// Not of an additive model, which has no tiles for it.
  ColumnLayout column_layout() const override;
  std::uint64_t column_version(std::uint32_t tile) const override;
  void read_columns(std::uint32_t tile, ColumnRuns& out) const override;

  /// A box of nodes for meshing. Nodes beyond the model are empty.
  HermiteGrid gather(const std::array<int, 3>& first_node, const std::array<int, 3>& nodes) const;
  /// The same into `grid`, whose memory is used again.
  void gather(const std::array<int, 3>& first_node, const std::array<int, 3>& nodes,
              HermiteGrid* grid) const;
  /// Nodes along each axis; all others are empty.
  std::array<int, 3> node_counts() const;
  /// Bricks that are stored: for benchmarks.
  std::size_t brick_count() const;

 private:
  struct Impl;
  explicit Octree(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace kerf
