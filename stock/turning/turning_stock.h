// stock/turning/turning_stock.h - a turned part as a stock model.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "stock/stock_model.h"
#include "stock/turning/turned_part.h"

namespace kerf {

/// What a lathe cuts with: Cutter::insert(), or of any other cutter its outline as it stands still
/// along the axis. Null: it has none, as TurningStock::can_cut() says.
std::shared_ptr<const InsertOutline> turning_outline(const Cutter& cutter);
/// What a move is in the plane of the axis: one move as a rule.
std::vector<TurnMove> turning_moves(const CutMove& move);

/// A workpiece on a lathe: it turns about the z axis of the workpiece frame. x of a move's tip is
/// how far the controlled point is from the axis, negative beyond it; y plays no part, nor does the
/// spindle's direction. Arcs about the y axis are cut as such, others as what they are in the plane
/// of z and x, within 0.02 um.
///
/// Of a cutter with an outline (Cutter::insert()) that is cut; any other stands still along the
/// axis with its tip towards -z, as a drill in the tailstock does. With a lead such a one is a tap
/// of that pitch and its own diameter (tap.h).
///
/// Nothing is held back: finish() has nothing to do. One thread.
class TurningStock final : public StockModel {
 public:
  explicit TurningStock(TurnedPart part);

  void cut(const Cutter& cutter, std::span<const CutMove> moves,
           std::vector<CutReport>& reports) override;
  void finish(std::vector<CutReport>& reports) override;
  std::optional<Contact> first_contact(const Cutter& cutter, const CutMove& move,
                                       double tolerance_mm) const override;
  /// The same with the sides that touch, and when.
  std::optional<TurnContact> first_turn_contact(const Cutter& cutter, const CutMove& move,
                                                double tolerance_mm) const;
  /// With which sides they were made, and how long the tool was in material: of the moves of the
  /// last call of cut(), in order.
  std::span<const TurnCut> last_cuts() const { return last_cuts_; }
  /// With what has come off.
  const TurnedPart& part() const { return part_; }

  Done save(const std::string& path) const override;
  /// Error: cannot be read, no such file, damaged.
  static Result<std::unique_ptr<TurningStock>> load(const std::string& path);

  std::unique_ptr<StockModel> snapshot() const override;
  std::size_t unique_bytes() const override;
  void keep_cut_ids(bool keep) override { part_.keep_cut_ids(keep); }
  bool keeps_cut_ids() const override { return part_.keeps_cut_ids(); }
  /// Points of patches lie within the round of the part: what a facet is short of it is added.
  std::optional<std::uint32_t> cut_id_at(const Vec3& point_mm) const override;
  /// Error for a cutter without an outline whose profile has hollow arcs or that is too long.
  static Done can_cut(const Cutter& cutter);
  Done accepts(const Cutter& cutter) const override { return can_cut(cutter); }
  const TurningStock* turned() const override { return this; }
  std::string name() const override { return "turning"; }
  Box bounds_mm() const override;
  double cell_mm() const override;          ///< the step of the coordinates
  std::size_t cell_count() const override;  ///< corners
  double blank_mm3() const override;
  double remaining_mm3() const override;
  std::string digest() const override;
  TriangleMesh mesh(double tolerance_mm) const override;

  /// Tiles are bands along z.
  std::size_t tile_count() const override { return TurnedPart::kBands; }
  Box tile_box(std::uint32_t tile) const override;
  std::vector<std::uint32_t> take_dirty_tiles() override;
  std::vector<std::uint32_t> differing_tiles(const StockModel& other) const override;
  std::uint64_t patch_version(std::uint32_t tile) const override;
  /// With the last piece that has come off, where it came off.
  MeshPatch patch(std::uint32_t tile, int level) const override;

 private:
  /// A tool as the part takes it, kept while the same cutter cuts on, or two take turns: a tool and
  /// its insert alone.
  struct Ready {
    std::shared_ptr<const InsertOutline> outline;
    std::optional<TurningTool> tool;
    std::optional<double> inset_mm;
    std::optional<TurningTool> inset;
  };
  const TurningTool& tool_of(const Cutter& cutter) const;
  bool cut_by_tap(const Cutter& cutter, const CutMove& move, TurnCut& whole);

  TurnedPart part_;
  std::vector<TurnCut> last_cuts_;
  std::vector<std::uint64_t> seen_versions_;  // by take_dirty_tiles()
  mutable Ready ready_, ready_before_;
};

}  // namespace kerf
