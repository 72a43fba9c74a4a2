// stock/sheet/sheet.h - sheet metal as exact plane polygons.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "stock/plane/outline.h"
#include "stock/sheet/piece_origin.h"
#include "stock/stock_model.h"

namespace kerf {

struct SheetOptions {
  PlaneOutline outline;             ///< workpiece frame; check_outline() says what is allowed
  double bottom_mm = 0;             ///< z of the lower face
  double top_mm = 1;                ///< of the upper one
  double arc_tolerance_mm = 0.005;  ///< how far the polygon of an arc may be off: 0.0001 .. 1
  /// Moves that will come, if known: sets how finely the sheet is divided. Speed alone hangs on it.
  std::size_t expected_moves = 0;
  /// Columns and rows of tiles, for measurements; 0: as the model sees fit.
  int tiles_each_way = 0;
};

/// A part of the sheet that hangs together.
struct SheetPiece {
  std::uint32_t number = 0;  ///< stays the same as long as the piece does
  /// CutMove::id of the move that parted it from a larger piece; none: what is left of the blank.
  std::optional<std::uint64_t> freed_by;
  double area_mm2 = 0;
  Vec2 min_mm{0}, max_mm{0};  ///< bounding box
  double volume_mm3 = 0;
  /// What freed it, of a piece that was free when the sheet was saved; nothing of others.
  std::optional<PieceOrigin> origin;
  double weight_kg(double density_kg_per_m3) const { return volume_mm3 * 1e-9 * density_kg_per_m3; }
  bool is_main() const { return !freed_by; }
};

/// A sheet from which a torch, laser or jet cuts kerfs and a punch takes its shape, straight
/// through and whatever the height: z of moves plays no part (the caller hands over only the moves
/// with the torch on), and of a cutter only radius_mm() counts, half the kerf. Coordinates are
/// whole tenths of a micrometre. No error of a polygon operation is larger than one of these; arcs
/// are off by arc_tolerance_mm at most, and keep their area.
///
/// Each move takes one polygon operation for each tile that its contour passes through. Nothing is
/// held back: finish() has nothing to do, and every division into calls gives the same bits, if the
/// strokes of one nibbled move stay in one call. One thread.
///
/// Source of the idea of tiles and of direct contours for arcs: A. Moreno et al., "Real time 3D
/// simulation tool for NC sheet metal cutting and punching processes", 2012.
class Sheet final : public StockModel {
 public:
  /// Error: from check_outline(), or a thickness or tolerance out of range (shown).
  static Result<std::unique_ptr<Sheet>> create(const SheetOptions& options);
  ~Sheet() override;

  /// A move with a number that is not finite, or beyond 1e13 mm, removes nothing. depth_mm of a
  /// report is the thickness where something was removed.
  /// Of a cutter with a footprint each move is a stroke (punch_hits.h); those of one id that follow
  /// each other in a call are cut together, the first's report has what they remove.
  void cut(const Cutter& cutter, std::span<const CutMove> moves,
           std::vector<CutReport>& reports) override;
  void finish(std::vector<CutReport>& reports) override;
  /// One stroke: `shape` (even-odd rings, mm, about the punch's axis) turned by `angle_rad`, then
  /// moved to `position_mm`.
  CutReport punch(const PlaneOutline& shape, const Vec2& position_mm, double angle_rad,
                  std::uint64_t id);
  /// The first place of the tip at which there is material within radius_mm() - `tolerance_mm` of
  /// it. depth_mm is the thickness.
  std::optional<Contact> first_contact(const Cutter& cutter, const CutMove& move,
                                       double tolerance_mm) const override;
  /// Whether there is material at this place (its edge counts).
  bool has_material(const Vec2& point_mm) const;
  /// The number of the piece that has material at this place; nothing where there is none.
  /// O(corners of its tile).
  std::optional<std::uint32_t> piece_at(const Vec2& point_mm) const;

  /// Everything that hangs together, by number: the main sheet, parts, slugs, offcuts, slivers.
  /// Their areas add up to remaining_mm3() / thickness. Kept while cutting; O(tiles and rings).
  std::vector<SheetPiece> pieces() const;
  /// How many there have been so far; a change tells that something has come free, with the numbers
  /// from the former count to the new one.
  std::size_t piece_numbers() const;
  /// Numbers below this are those of the blank's pieces; the others have been cut free, by this
  /// sheet or by the one that was saved.
  std::size_t blank_piece_numbers() const;
  /// Rings round one piece, holes clockwise, across tiles. Empty for a number that is none.
  PlaneOutline outline_of(std::uint32_t piece) const;
  /// Of all of them.
  PlaneOutline outline() const;

  /// Saves and loads the sheet (stock/sheet/sheet_state.h); it is cut on, its pieces and their
  /// numbers are, as if it had never been saved. `origins`: by number, what freed those that are
  /// free since it was loaded or made. A damaged file is an error that says what is wrong with it.
  Done save(const std::string& path, const std::map<std::uint32_t, PieceOrigin>& origins) const;
  Done save(const std::string& path) const override { return save(path, {}); }
  static Result<std::unique_ptr<Sheet>> load(const std::string& path);

  std::unique_ptr<StockModel> snapshot() const override;
  std::size_t unique_bytes() const override;
  /// Error for a kerf of less than kMinKerf_mm.
  Done accepts(const Cutter& cutter) const override;
  const Sheet* sheet() const override { return this; }
  std::string name() const override { return "sheet"; }
  Box bounds_mm() const override;
  /// The step of the coordinates.
  double cell_mm() const override;
  /// Corners of polygons.
  std::size_t cell_count() const override;
  double blank_mm3() const override;
  double remaining_mm3() const override;
  double thickness_mm() const;
  double arc_tolerance_mm() const;
  double remaining_mm2() const;
  std::string digest() const override;

  /// The polygons, extruded. Exact, whatever the tolerance.
  TriangleMesh mesh(double tolerance_mm) const override;
  std::size_t tile_count() const override;
  Box tile_box(std::uint32_t tile) const override;
  std::vector<std::uint32_t> take_dirty_tiles() override;
  std::vector<std::uint32_t> differing_tiles(const StockModel& other) const override;
  std::uint64_t patch_version(std::uint32_t tile) const override;
  /// Top, bottom, and walls where the material ends; none along tile borders. The same at every
  /// level, so there are no skirts.
  MeshPatch patch(std::uint32_t tile, int level) const override;

  /// Polygon operations so far: for measurements.
  std::uint64_t operations() const;

  static constexpr double kMinKerf_mm = 0.01;

 private:
  struct Impl;
  explicit Sheet(std::unique_ptr<Impl> impl);
  void strike(const Cutter& punch, std::span<const CutMove> strokes,
              std::vector<CutReport>& reports);
  std::unique_ptr<Impl> impl_;
};

}  // namespace kerf
