// stock/turning/turned_part.h - a workpiece that turns, as a region of the half plane beside its
// axis.
//
//      r ^   ._______                  What the region sweeps about the z axis is the workpiece:
//        |   |       `-.__.-----.      bores, grooves, undercuts and faces as they are. An insert
//        |   |  .____           |      does not turn; it cuts what lies in the way of its outline,
//        |   |  |    |          |      and below the axis (x < 0) what lies at r = -x.
//        +---'--'----'----------'--> z
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/geometry.h"
#include "base/mesh_patch.h"
#include "base/triangle_mesh.h"
#include "stock/cutter/insert.h"
#include "stock/turning/bar_flats.h"
#include "stock/turning/contour.h"
#include "stock/turning/convex_cut.h"
#include "stock/turning/engagement.h"
#include "stock/turning/insert_sweep.h"
#include "stock/turning/kept_sections.h"
#include "stock/turning/thread_set.h"
#include "stock/turning/turn_move.h"

namespace kerf {

namespace turning {
struct SavedPart;
}  // namespace turning

/// Closed chains of (z, r), mm: even-odd, so holes may run either way.
using TurnedProfile = std::vector<std::vector<Vec2>>;

/// What a lathe may hold.
inline constexpr double kMaxTurnedZ_mm = 2000, kMaxTurnedRadius_mm = 1000;

TurnedProfile bar_profile(double low_z_mm, double high_z_mm, double diameter_mm);
TurnedProfile tube_profile(double low_z_mm, double high_z_mm, double diameter_mm, double bore_mm);

/// The side that the chuck holds: of two pieces the one that reaches farther there stays; of those
/// that reach as far, the one of the larger diameter; of those, the larger one.
enum class ChuckSide : std::uint8_t { kLowZ, kHighZ };

/// An insert as the part takes it: made once, used for all moves.
class TurningTool {
 public:
  /// Of an outline within kMaxInsertReach_mm.
  explicit TurningTool(const InsertOutline& outline);
  /// The same without a border of this width: what touches with it is that much inside the tool.
  /// Nothing is left of a tool that is nowhere twice as wide, and meets nothing.
  TurningTool inset(double width_mm) const;
  /// Of the same outline.
  bool is_like(const TurningTool& other) const;
  /// Its parts on the grid, or those of the tool as it is seen in a mirror, the axis.
  std::span<const turning::GridPart> parts(bool mirrored) const {
    return mirrored ? below_ : parts_;
  }

 private:
  friend class TurnedPart;
  TurningTool() = default;
  std::vector<turning::GridPart> parts_, below_;  // as it is, and mirrored in the axis
};

/// What one move did.
struct TurnCut {
  std::uint64_t id = 0;
  /// By the insert, without what came free. Corners are rounded either way, so where next to
  /// nothing is cut the part may become larger by some steps of them: that is 0.
  double removed_mm3 = 0;
  /// The depth of cut: how wide the material before the tool was at once (on the average of 10 um
  /// of its way), measured across its way. So it is radial for turning along the axis, axial for
  /// facing, and a groove's width for plunging. Of an outline of several parts that of the one that
  /// cuts deepest. 0 for a tool that stands still.
  double depth_mm = 0;
  double way_mm = 0;  ///< length of the way in material
  /// By InsertSide, width of the material, across the way, that edges of this side came to first.
  std::array<double, kInsertSides> side_mm{};
  /// The width that front and back flank came to at once, the lesser of the two: one leads, and the
  /// other one trails.
  double flanks_mm = 0;
  /// Cutting edges that met material: their length, and how wide they are across the way. What goes
  /// f along its way in a turn takes chips of f * edge_across_mm / edge_mm on the average: f by the
  /// sine of the lead angle of a straight edge.
  double edge_mm = 0, edge_across_mm = 0;

  /// With another part of the same motion: volumes and lengths add up, widths are the greatest,
  /// edges those of the part where they are longer.
  void extend(const TurnCut& other) {
    removed_mm3 += other.removed_mm3;
    way_mm += other.way_mm;
    depth_mm = std::max(depth_mm, other.depth_mm);
    flanks_mm = std::max(flanks_mm, other.flanks_mm);
    if (other.edge_mm > edge_mm) edge_mm = other.edge_mm, edge_across_mm = other.edge_across_mm;
    for (std::size_t i = 0; i < kInsertSides; ++i)
      side_mm[i] = std::max(side_mm[i], other.side_mm[i]);
  }
};

/// Where a move first meets material.
struct TurnContact {
  Vec2 at_mm{0};        ///< the controlled point then, (z, x)
  double t = 0;         ///< fraction of the move
  double depth_mm = 0;  ///< greatest way into material, along the move or across it: the lesser
  std::array<double, kInsertSides> side_mm{};  ///< as in TurnCut, over the whole move
};

class TurnedPart;

/// A piece that has come off; it is no part of the workpiece any more.
struct TurnedPiece {
  std::uint64_t freed_by = 0;  ///< TurnMove::id
  double volume_mm3 = 0;
  double low_z_mm = 0, high_z_mm = 0, low_r_mm = 0, high_r_mm = 0;
  /// As it came off, where it was.
  std::shared_ptr<const TurnedPart> part{};
};

/// Coordinates are whole steps of 10 nm. What straight ways make of edges and noses is exact to
/// that; the trace that an arc of the outline leaves where it stands keeps within 0.1 um of it, an
/// arc of the way within 0.02 um, and both keep their area. Volumes are those of the polygons,
/// exact. Order of moves, cutting twice, and moves in halves change corners by a few steps. Every
/// move is cut when it is given: any division into calls gives the same bits. One thread. A copy
/// shares what neither of the two changes, and may go to another thread.
///
/// A bar of flats is the round one through its corners with a note of the flats: volumes and
/// surfaces are those of the bar, a tool touches where the corners come by.
///
/// A move with a lead leaves a groove that winds. The region is then what is there at some angle,
/// and the grooves are kept beside it (thread_set.h): volumes, sections and meshes are without
/// them, contacts of moves that go all round are those of the region. What a groove is not there at
/// all round is in the region: the crests of a thread are judged as rings. Where a move with a lead
/// has ended in material, and does not go on, the tool leaves a ring, with the next move. A groove
/// that cuts through a wall does not set it free, and one beyond the flats of a bar counts as if
/// the bar were round there.
///
/// Not held: runout.
class TurnedPart {
 public:
  /// So far the controlled point is followed along either axis: farther away no tool reaches a
  /// blank.
  static constexpr double kWayReach_mm = kMaxTurnedZ_mm + kMaxInsertReach_mm;

  /// None: no area, below the axis, beyond 2 m, not a number, or more than one piece.
  /// With flats the blank is that of their corners' circle.
  static std::optional<TurnedPart> create(const TurnedProfile& blank,
                                          ChuckSide chuck = ChuckSide::kLowZ,
                                          const std::optional<BarFlats>& flats = std::nullopt);

  /// What is kept on disk (turning_state.h), and from it again, with what came off.
  turning::SavedPart saved() const;
  static TurnedPart restored(turning::SavedPart saved);

  /// The part as it lies when it is held the other way round: z becomes `at_z_mm` - z. Chuck and
  /// axis stay where they are, and what came off is left behind. None: it would lie beyond 2 m, or
  /// not a number.
  std::optional<TurnedPart> turned_about(double at_z_mm) const;
  /// The same moved: z becomes `at_z_mm` + z.
  std::optional<TurnedPart> moved(double at_z_mm) const;

  /// Removes what the tool sweeps. O(runs of corners), and what is near the way; as often for an
  /// arc as it has chords.
  TurnCut cut(const TurningTool& tool, const TurnMove& move);

  /// Where the tool first meets material; nothing is changed. With TurningTool::inset() only what
  /// is deeper counts.
  std::optional<TurnContact> first_contact(const TurningTool& tool, const TurnMove& move) const;

  /// The tool that a move with a lead has left in material goes back as it has come: where it
  /// turned round it leaves no ring.
  void turn_back() { winding_.reset(); }

  /// From now on remembers which move has made each edge of the contours; all of them count as not
  /// cut. Costs as much again as cutting does, and nothing while off. A move is named by its id, of
  /// which 0xffff'fffe and above count as 0xffff'fffe.
  void keep_cut_ids(bool keep);
  bool keeps_cut_ids() const { return marked_.has_value(); }
  /// The move that made the surface at (z, r), mm: the nearest edge to it, if that is no farther
  /// than `within_mm`; of several that are as near the first. Edges are kept apart where one move's
  /// ends and another's begins, also within a cylinder; what a move cuts that lies less than 20 nm
  /// below what was there keeps the id of that. O(corners).
  std::optional<std::uint32_t> cut_id_at(const Vec2& zr_mm, double within_mm) const;
  /// The same on the section at this angle: with threads these differ.
  std::optional<std::uint32_t> cut_id_at(const Vec2& zr_mm, double angle_rad,
                                         double within_mm) const;

  /// What came off so far, in order.
  const std::vector<TurnedPiece>& freed() const { return freed_; }

  /// Of the blank; none of one that is round.
  const std::optional<BarFlats>& flats() const { return flats_; }
  double blank_mm3() const { return blank_mm3_; }
  double remaining_mm3() const;
  /// Grooves that wind. Empty without moves that have a lead.
  const turning::ThreadSet& threads() const { return threads_; }
  /// Rings round the material at one angle of the workpiece, as profile() gives them.
  TurnedProfile section(double angle_rad) const;
  /// Of the blank. x and y from -r to r.
  Box bounds_mm() const;
  /// Rings round the material, holes clockwise. Corners (z, r).
  TurnedProfile profile() const;
  /// Of what is there at some angle.
  const std::vector<turning::Contour>& contours() const { return contours_; }
  std::size_t corner_count() const;
  /// Hash of the contours, 32 hex digits; whatever the runs that they are kept in.
  std::string digest() const;
  /// Memory for runs that no copy has.
  std::size_t unique_bytes() const;

  /// Closed surface (revolve.h), about the z axis of the workpiece frame. With threads as
  /// wound_surface.h has it.
  TriangleMesh mesh(double tolerance_mm) const;

  /// For views the part is divided along z into kBands of equal width.
  static constexpr std::size_t kBands = 64;
  /// Grows whenever something within the band has changed; equal numbers mean equal bands,
  /// whichever copies they come from.
  std::uint64_t band_version(std::size_t band) const { return versions_[band]; }
  double band_low_z_mm(std::size_t band) const;
  /// The band's surface. The contour of level n, 0 .. 4, is within 0.002 mm times 4^n of it; round
  /// the axis it is as revolve_band() divides it: neighbours of any levels fit together, there are
  /// no skirts. `tile` is the band.
  MeshPatch patch(std::size_t band, int level) const;
  /// Of level 0: what no view shows; of level 4.
  static constexpr double kFinestPatch_mm = 0.002, kCoarsestPatch_mm = 256 * kFinestPatch_mm;
  /// The coarsest level that keeps within the tolerance; 0 where none does.
  static int level_within(double tolerance_mm);

  /// How often a general polygon library was asked: for measurements.
  std::uint64_t library_calls() const { return scratch_.cut.library_calls(); }

 private:
  /// Kept between moves for its memory; a copy has its own.
  struct Scratch {
    Scratch() = default;
    Scratch(const Scratch&) {}
    Scratch& operator=(const Scratch&) { return *this; }

    turning::ConvexCut cut, marked_cut;
    turning::ConvexRegion swept;
    turning::GridPart::Lead lead;
    turning::GridPart::Scratch sweep;
    turning::EngagementGauge gauge;
    std::vector<turning::WayChord> chords;
    turning::Rect changed;  // by the move that is cut
    std::vector<turning::ProfileEdge> edges;
  };
  /// The last move, which had a lead: another one may go on from there. Else the tool stands there
  /// until the part has turned.
  struct Winding {
    std::shared_ptr<const TurningTool> tool;
    Vec2 at_mm{0};
    double lead_mm = 0, turns = 0;  // there
    std::uint64_t id = 0;
    // Where it began to go straight, and the directions, relative to the first, that keep to it.
    Vec2 from_mm{0};
    double from_turns = 0, heading_rad = 0, low_rad = 0, high_rad = 0;
    std::vector<std::shared_ptr<const turning::ThreadPass>> passes;  // of that
  };

  TurnedPart() = default;
  template <class Each>
  turning::Engagement each_swept(const TurningTool& tool, const TurnMove& move, Each&& each) const;
  turning::Engagement cut_ring(const TurningTool& tool, const TurnMove& move);
  TurnCut cut_thread(const TurningTool& tool, const TurnMove& move);
  std::optional<TurnContact> thread_contact(const TurningTool& tool, const TurnMove& move) const;
  std::vector<std::shared_ptr<const turning::ThreadPass>> passes_of(
      const TurningTool& tool, const Vec2& from_mm, const Vec2& to_mm, double lead_mm,
      double from_turns, std::uint64_t id) const;
  bool goes_on(const TurnMove& move) const;
  Winding winding_after(const TurningTool& tool, const TurnMove& move) const;
  void measure_thread(const std::vector<std::shared_ptr<const turning::ThreadPass>>& fresh,
                      double from_way_mm, TurnCut& report, TurnContact& first) const;
  void clear_all_round(std::span<const std::shared_ptr<const turning::ThreadPass>> fresh);
  void end_winding();
  void drop_threads_of_pieces(std::size_t first_piece);
  std::shared_ptr<const TurnedPart> piece_of(std::size_t contour, std::size_t held) const;
  const std::vector<turning::Contour>& shown() const { return marked_ ? *marked_ : contours_; }
  turning::Wide moment6() const;
  bool thins() const;
  void drop_free_pieces(std::uint64_t id);
  void cut_marked(std::uint64_t id);
  double missing_mm3() const;
  std::optional<TurnedPart> placed(double at_z_mm, bool turned_about) const;
  static std::uint64_t next_version();
  void touch_all();
  void touch_bands(const turning::Rect& box);
  turning::Unit band_low(std::size_t band) const;

  std::vector<turning::Contour> contours_;
  /// The same by moves, where these are kept: cut for itself, so that contours_ are the same
  /// whether they are or not. Corners may differ by some units.
  std::optional<std::vector<turning::Contour>> marked_;
  turning::ThreadSet threads_;
  std::optional<Winding> winding_;
  turning::Rect blank_;
  double blank_mm3_ = 0;
  ChuckSide chuck_ = ChuckSide::kLowZ;
  std::optional<BarFlats> flats_;
  std::vector<TurnedPiece> freed_;
  std::array<std::uint64_t, kBands> versions_{};
  mutable Scratch scratch_;
  turning::KeptSections sections_;  ///< for patches, until it is cut
};

}  // namespace kerf
