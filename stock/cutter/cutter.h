// stock/cutter/cutter.h - a cutter as a surface of revolution about the spindle axis.
//
//      |<- shank ->|        A profile is a chain of line and arc pieces from the tip (radius 0)
//      |           |        outward and upward:
//   ___|           |___
//  |       flutes      |        z
//  |                   |        |        . end of the last piece: radius_mm()
//   \                 /         |      _/
//    `--__       __--'          |__.--'      height_mm(r): lowest point of the cutter at radius r
//         `--.--'               +------------ r
//            tip (z = 0)
#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/geometry.h"
#include "base/result.h"
#include "stock/cutter/insert.h"

namespace kerf {

/// One piece of a profile, radius not decreasing from start to end (not increasing on the upper
/// side of a head). All mm; r is the distance from the spindle axis, z the height above the tip.
struct ProfilePiece {
  enum class Kind { kLine, kArc };
  Kind kind = Kind::kLine;
  double r0 = 0, z0 = 0;  ///< start: inner end (outer end on the upper side)
  double r1 = 0, z1 = 0;  ///< end
  /// kArc: circle through both ends. The cutter is on the upper side; `convex` arcs bulge outward
  /// (ball, bull-nose: the centre is above the arc), others are hollow (corner-rounding cutter: the
  /// centre is below).
  double center_r = 0, center_z = 0, radius = 0;
  bool convex = true;
};

/// A cylinder of the tool above the flutes, kept for collision checks. mm above the tip.
struct ToolSection {
  double diameter_mm = 0;
  double from_z_mm = 0;
  double to_z_mm = 0;
};

/// What of a milling tool's edges counts for its forces, and what its maker allows. Mostly nobody
/// has said it.
struct EdgeTraits {
  std::optional<double> helix_deg, rake_deg;
  std::optional<double> most_chip_mm;  ///< feed per tooth at most
  std::optional<double> most_ramp_deg;
  bool cuts_centre = true;  ///< it may go straight down into material
  bool operator==(const EdgeTraits&) const = default;
};

/// How the driven tool of a lathe lies: along this axis, its tip towards less of it.
enum class LiveAxis : std::uint8_t { kX, kZ };

/// Immutable after construction.
class Cutter {
 public:
  using Footprint = std::vector<std::vector<Vec2>>;

  /// Checks the pieces: finite, a connected chain that starts at radius 0 and z = 0 is the lowest
  /// point, radius not decreasing, last radius above 0. Vertical steps are allowed (a line with r0
  /// == r1). The message names the piece.
  static Result<Cutter> from_profile(std::string spec, std::vector<ProfilePiece> pieces);

  /// A turning tool, which does not turn: insert() is what it is. Its profile is a flat disc as
  /// wide as the outline reaches, for who asks no more than how far a tool reaches.
  static Cutter from_insert(std::string spec, InsertOutline outline, InsertTip tip = {});

  /// Canonical SHAPE text, e.g. "bull:10:2:flute=22".
  const std::string& spec() const { return spec_; }
  std::span<const ProfilePiece> profile() const { return pieces_; }
  double radius_mm() const { return pieces_.back().r1; }

  /// Lowest point of the cutter above its tip at distance r from the axis: +infinity beyond
  /// radius_mm(). O(pieces).
  double height_mm(double r) const;

  /// True if some part of the cutter is wider than a part above it within the flutes (lollipop,
  /// T-slot): a Z-map cannot hold what it cuts. neck_radius_mm() is the radius of the part above.
  bool undercuts() const { return neck_radius_mm_.has_value(); }
  std::optional<double> neck_radius_mm() const { return neck_radius_mm_; }
  /// Upper side of a head that is wider than its neck: from the end of profile() inward and upward
  /// to the neck. Empty unless undercuts().
  ///
  ///        |   | <- neck          profile() goes from the tip outward to the widest point w,
  ///      __|   |__                upper_profile() from there to n, the foot of the neck; the neck
  ///     |    n    | upper side    goes on upward with the radius it has there.
  ///     |_________w
  std::span<const ProfilePiece> upper_profile() const { return upper_pieces_; }
  /// Highest point of the head at distance r from the axis: the foot of the neck where the neck is,
  /// -infinity beyond radius_mm(). For cutters that undercut. O(pieces).
  double upper_height_mm(double r) const;
  /// Checks the pieces: a connected chain that starts at the end of profile(), radius not rising,
  /// height not falling, last radius above 0 and below radius_mm(). The message names the piece.
  Done set_upper_profile(std::vector<ProfilePiece> pieces);

  std::optional<double> flute_length_mm() const { return flute_length_mm_; }
  void set_flute_length_mm(double length) { flute_length_mm_ = length; }
  /// Nobody has said it: a cone ends somewhere.
  bool is_flute_length_assumed() const { return flute_length_assumed_; }
  void assume_flute_length_mm(double length) {
    flute_length_mm_ = length;
    flute_length_assumed_ = true;
  }
  std::optional<double> shank_diameter_mm() const { return shank_diameter_mm_; }
  void set_shank_diameter_mm(double d) { shank_diameter_mm_ = d; }
  /// Between the flutes and the shank, upward and without gaps: the shank begins above them. Mostly
  /// none.
  std::span<const ToolSection> neck() const { return neck_; }
  void set_neck(std::vector<ToolSection> neck) { neck_ = std::move(neck); }
  std::optional<int> teeth() const { return teeth_; }
  void set_teeth(int teeth) { teeth_ = teeth; }
  const EdgeTraits& edge_traits() const { return edge_traits_; }
  void set_edge_traits(const EdgeTraits& traits) { edge_traits_ = traits; }
  /// Of a lathe's tool that is driven itself, so that it mills: how it lies. None: a tool that
  /// stands still there (and any tool of a mill).
  std::optional<LiveAxis> live() const { return live_; }
  void set_live(std::optional<LiveAxis> live) { live_ = live; }
  /// Of a punch: its outline about the axis at angle 0, closed chains of points, even-odd, mm, as
  /// it goes straight through (Sheet::cut() says how moves place it). Null: a cutter that turns.
  const Footprint* footprint() const { return footprint_.get(); }
  void set_footprint(Footprint rings) {
    footprint_ = std::make_shared<const Footprint>(std::move(rings));
  }
  /// Of a turning tool: its outline in the plane of the lathe's axis. Null: a cutter that turns.
  /// Copies of the cutter share it.
  const std::shared_ptr<const InsertOutline>& insert() const { return insert_; }
  const InsertTip& insert_tip() const { return insert_tip_; }
  std::span<const ToolSection> holder() const { return holder_; }
  void set_holder(std::vector<ToolSection> holder) { holder_ = std::move(holder); }
  void set_spec(std::string spec) { spec_ = std::move(spec); }

 private:
  Cutter() = default;
  std::string spec_;
  std::vector<ProfilePiece> pieces_;
  std::vector<ProfilePiece> upper_pieces_;
  std::optional<double> neck_radius_mm_;
  std::optional<double> flute_length_mm_;
  bool flute_length_assumed_ = false;
  std::optional<double> shank_diameter_mm_;
  std::vector<ToolSection> neck_;
  std::vector<ToolSection> holder_;
  std::optional<int> teeth_;
  EdgeTraits edge_traits_;
  std::optional<LiveAxis> live_;
  std::shared_ptr<const Footprint> footprint_;
  std::shared_ptr<const InsertOutline> insert_;
  InsertTip insert_tip_;
};

}  // namespace kerf
