// stock/stock_model.h - the only seam between a workpiece model and the rest of kerf.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/geometry.h"
#include "base/mesh_patch.h"
#include "base/result.h"
#include "base/triangle_mesh.h"
#include "stock/cutter/cutter.h"
#include "surface/height_grid.h"

namespace kerf {

class Sheet;
class TurningStock;

/// Circular part of a CutMove: the tip turns about the axis through `center_mm` along `axis` (unit
/// vector) by `sweep_rad` (right-hand rule), and moves along the axis linearly in angle. If start
/// and end lie at different distances from the axis, the radius changes linearly in angle.
struct CutArc {
  Vec3 center_mm{0};
  Vec3 axis{0, 0, 1};
  double sweep_rad = 0;
};

/// One move of the tool tip in the workpiece frame, mm. Straight unless `arc` is set.
struct CutMove {
  Vec3 from_mm{0};
  Vec3 to_mm{0};
  std::optional<CutArc> arc;
  std::uint64_t id = 0;  ///< the caller's; comes back in CutReport
  /// Unit vector along the spindle, from the tip upward, at either end. Where they differ the
  /// spindle turns evenly along the great circle between them while the tip moves (by less than
  /// half a turn; not together with `arc`). Only models for tilted tools take any but (0, 0, 1).
  Vec3 axis_from{0, 0, 1};
  Vec3 axis_to{0, 0, 1};
  /// The workpiece turns with the move, which is straight: once a lead of its way, positive as M3
  /// turns it (seen along +Z clockwise), so that a way toward -Z leaves a right-hand thread. It is
  /// at angle 0 where the move begins, or goes on from a move with a lead that has ended there. 0:
  /// it turns so fast that any one move goes all round. Of models that turn.
  double lead_mm = 0;

  bool is_vertical() const {
    constexpr Vec3 kUp{0, 0, 1};
    return axis_from == kUp && axis_to == kUp;
  }
};

/// A wall, roof or floor that a move has left and that the model cannot hold: thinner than a cell,
/// and more than 0.01 mm. The workpiece does not have it any more.
struct CutFilm {
  double area_mm2 = 0;  ///< 0: there is none
  double thickness_mm = 0;
  Vec3 at_mm{0};  ///< on it
};

/// What one move did to the workpiece.
struct CutReport {
  std::uint64_t id = 0;
  double removed_mm3 = 0;
  double depth_mm = 0;  ///< greatest height of material removed above any one point of the result
  CutFilm film{};       ///< of models that lose films (Octree)
};

/// Where a move first meets material.
struct Contact {
  Vec3 tip_mm{0};       ///< tool tip at first contact
  double depth_mm = 0;  ///< greatest depth reached on the whole move
};

/// A part of the tool above its cutting edges, a cylinder from `from_z_mm` above the tip to
/// `to_z_mm`: shank, or a section of the holder. Models of heights take it as endless upward: what
/// stands there stands on what is below.
struct CarriedPart {
  double radius_mm = 0;
  double from_z_mm = 0;
  double to_z_mm = std::numeric_limits<double>::infinity();
};

/// Where a part of a tool first meets material on a move that the tool cuts as it goes.
struct PartContact {
  Vec3 tip_mm{0};   ///< tool tip then
  double t = 0;     ///< fraction of the move
  double depth_mm;  ///< so much higher the part would have to be to clear all of the move
};

/// How near such a part comes.
struct PartGap {
  double mm = 0;
  double t = 0;    ///< fraction of the move
  Vec3 tip_mm{0};  ///< tool tip then
};

/// Workpiece as it is now. One owner thread; snapshots are cheap, immutable in effect and may go to
/// other threads.
///
/// For views the workpiece is divided into tiles, 0 .. tile_count() - 1, the same for a model and
/// all its snapshots. What follows a model that cuts does, on the model's thread,
///     dirty = model.take_dirty_tiles();  frame = model.snapshot();
/// and hands `frame` over. The other thread makes patches anew where frame->patch_version(tile) is
/// no longer that of the patch it has. This holds for jumps between any two snapshots as well.
class StockModel {
 public:
  virtual ~StockModel() = default;

  /// Removes what `cutter` sweeps on each move, in order, and appends one CutReport a finished move
  /// to `reports` (in order; each id once). A model may hold the last moves back until it has seen
  /// what follows (their reports then come with a later call or finish()). The final workpiece is
  /// bit for bit the same for any division of a sequence of moves into calls, and for any number of
  /// threads.
  virtual void cut(const Cutter& cutter, std::span<const CutMove> moves,
                   std::vector<CutReport>& reports) = 0;

  /// Completes moves held back. Needed before anything below is asked; called by tool changes as
  /// well.
  virtual void finish(std::vector<CutReport>& reports) = 0;

  /// Would this move touch material, deeper than `tolerance_mm` inside the tool's sweep? Changes
  /// nothing.
  virtual std::optional<Contact> first_contact(const Cutter& cutter, const CutMove& move,
                                               double tolerance_mm) const = 0;

  /// Whether the three below look for anything.
  virtual bool checks_parts() const { return false; }
  /// All material is at least this far from the part on the whole move, as far as up to `most_mm`;
  /// a lower bound, moves held back or not. Cheap: it is not looked at closely what is farther than
  /// `enough_mm` for sure.
  virtual double part_spare_mm(const CarriedPart&, const CutMove&, double /*enough_mm*/,
                               double most_mm) const {
    return most_mm;
  }
  /// Would this part of a tool touch material that `cutter`, on its way along this move, has not
  /// cut before the part comes there? What stands higher than the flutes reach is not cut. Where it
  /// goes deeper than `tolerance_mm`. Changes nothing.
  virtual std::optional<PartContact> part_contact(const Cutter&, const CarriedPart&, const CutMove&,
                                                  double /*tolerance_mm*/) const {
    return std::nullopt;
  }
  /// How near the part comes to what the move leaves of the workpiece, where that is less than
  /// `below_mm`; 0: it touches. Good to a cell.
  virtual std::optional<PartGap> part_gap(const Cutter&, const CarriedPart&, const CutMove&,
                                          double /*below_mm*/) const {
    return std::nullopt;
  }

  /// The workpiece as it is now, moves held back completed. Shares its tiles with this model: costs
  /// some nanoseconds a tile, and memory only for tiles that either of the two changes later. May
  /// be read and dropped on another thread, also while this model cuts on.
  virtual std::unique_ptr<StockModel> snapshot() const = 0;
  /// Memory for heights that nobody but this model or snapshot keeps: what dropping it would free.
  /// A guess while others that share tiles with it are being changed or dropped.
  virtual std::size_t unique_bytes() const = 0;
  /// Of copies of one model in the order of its cuts, that are only kept: nobody asks anything of
  /// them any more but this, kept_bytes() and snapshot(), on one thread. Finds memory that
  /// copies[at] can share with its neighbours, and what is left in memory that no others share is
  /// packed; snapshot() unpacks it, to the bit. Models that have no way to do so leave it.
  /// False: others hold some of it still, which may be packed when they have let go of it.
  virtual bool pack(std::span<StockModel* const> copies, std::size_t at) const;
  /// Memory that this copy takes beside those before and after it, as far as it is known; after the
  /// last one (null), what it would if the model had cut on.
  virtual std::size_t kept_bytes(const StockModel& before, const StockModel* after) const;

  /// From now on remembers for each cell the move that lowered it last, for cut_id_at() and
  /// MeshPatch::cut_by: off in a new model; on, all cells count as not cut. A snapshot has what
  /// its model had. To be called while no move is held back, best before anything is cut. Costs
  /// as much memory as the heights do, and some cutting time; nothing while off. The workpiece and
  /// its digest() are the same either way. A model that cannot do it ignores the call.
  ///
  /// A move is named by its CutMove::id, of which 0xffff'fffe and above count as 0xffff'fffe. Of
  /// moves that cut equally deep the first is kept; the same for any division of a sequence of
  /// moves into calls, and for any number of threads. The corner where two moves meet is the
  /// first one's.
  virtual void keep_cut_ids(bool) {}
  virtual bool keeps_cut_ids() const { return false; }
  /// The move that made the surface at `point_mm`, a point on it as patches of level 0 have it:
  /// good to a cell. On a wall the move that lowered the lower side. None where nothing was cut
  /// (or the point is beyond the blank), and where it is not kept.
  virtual std::optional<std::uint32_t> cut_id_at(const Vec3&) const { return std::nullopt; }

  /// Error if the model cannot hold what this cutter leaves; the message says what and why. cut()
  /// and first_contact() must not be given such a cutter.
  virtual Done accepts(const Cutter&) const { return Done{std::monostate{}}; }
  /// Whether moves may have other spindle directions than straight up.
  virtual bool takes_tilted_tools() const { return false; }
  /// Writes the workpiece into a file from which it can be loaded again. Written to a temporary
  /// name and renamed. Error: also from a model that has no such file.
  virtual Done save(const std::string& path) const;

  /// The model itself, where this one only stands before another.
  virtual const StockModel& bare() const { return *this; }
  /// The sheet that this is, or stands before; null: it is another model.
  virtual const Sheet* sheet() const { return nullptr; }
  /// The same of a workpiece that turns.
  virtual const TurningStock* turned() const { return nullptr; }

  /// Of one that turns and may be milled as well, by driven tools (Cutter::live()), whose moves it
  /// takes in the frame of the workpiece: the cells of what is milled. 0: it is none.
  virtual double milling_cell_mm() const { return 0; }

  virtual std::string name() const = 0;  ///< "zmap", ...
  virtual Box bounds_mm() const = 0;     ///< of the blank
  virtual double cell_mm() const = 0;
  virtual std::size_t cell_count() const = 0;
  virtual double blank_mm3() const = 0;  ///< of the blank as the model holds it
  virtual double remaining_mm3() const = 0;
  /// By how much that is more than what cuts have left of the blank, which they count by cells: by
  /// what stands between the middles of cells and walls. Moves held back do not count yet.
  virtual double beside_cells_mm3() const { return 0; }
  virtual std::string digest() const = 0;  ///< hash of the contents, 32 hex digits

  /// Closed surface of the workpiece; deviates from the model by at most `tolerance_mm` (0 = every
  /// cell is kept).
  virtual TriangleMesh mesh(double tolerance_mm) const = 0;

  virtual std::size_t tile_count() const = 0;
  /// What the tile's patches can occupy: its cells, from the floor to the top of the blank.
  virtual Box tile_box(std::uint32_t tile) const = 0;
  /// The tiles in which a height has changed since the last call, ascending; all of them the first
  /// time (a snapshot has not been asked yet). Exact up to collisions of a 64-bit hash. Moves held
  /// back do not count yet. About a microsecond for each tile that moves came over; nothing is paid
  /// before the first call.
  virtual std::vector<std::uint32_t> take_dirty_tiles() = 0;
  /// The tiles in which the two differ (in heights, or in cut ids if both keep them), ascending;
  /// exact. Fast where one is a snapshot of the
  /// other, or both of a third. All tiles if `other` is another model, or of another size.
  virtual std::vector<std::uint32_t> differing_tiles(const StockModel& other) const = 0;
  /// Changes whenever a patch of this tile may have changed: by what was cut in the tile or at its
  /// neighbours' borders. Equal numbers mean equal patches, whichever snapshots they come from. May
  /// change without cause where a move came over the tile and removed nothing, unless
  /// take_dirty_tiles() was called between that move and the snapshot.
  virtual std::uint64_t patch_version(std::uint32_t tile) const = 0;
  /// The tile's surface. Level n, 0 .. kPatchLevels - 1, has one cell for 2^n x 2^n, as low as the
  /// lowest of them: what was cut, however narrow, never disappears. Neighbours of equal level meet
  /// in the same vertices; for others there are skirts (base/mesh_patch.h).
  virtual MeshPatch patch(std::uint32_t tile, int level) const = 0;
  /// The heights themselves, for a view that casts rays instead of drawing patches; its surface is
  /// that of the patches of level 0. Shares tiles like a snapshot, and moves held back do not count
  /// yet. Null from a model that has no heights.
  virtual std::shared_ptr<const HeightGrid> height_grid() const { return nullptr; }

  static constexpr int kPatchLevels = 5;
};

}  // namespace kerf
