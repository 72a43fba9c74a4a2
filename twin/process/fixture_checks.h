// twin/process/fixture_checks.h - the tool against what stands around the workpiece:
// fixture-contact, near-miss.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "twin/collision/box_bound.h"
#include "twin/collision/sweep.h"
#include "twin/findings/finding.h"
#include "twin/process/carried_bodies.h"
#include "twin/process/check_options.h"
#include "twin/process/checked_move.h"
#include "twin/process/near_pair.h"

namespace kerf {

/// What stands still while tools move past it.
struct Obstacle {
  std::string name;
  SolidPointer solid;
  Pose obstacle_from_workpiece;
  std::optional<double> clearance_mm;     ///< Fixture::clearance_mm
  std::optional<HoldingBody::Kind> kind;  ///< it holds a workpiece that turns; else a fixture
};
/// Of fixtures, those that stand on no link.
std::vector<Obstacle> obstacles_of(const FixtureList& fixtures);
/// Of what holds a workpiece that turns: rings round its axis.
std::vector<Obstacle> obstacles_of(std::span<const HoldingBody> bodies);

/// Holds the parts of a tool against each obstacle on all moves of one program, and keeps how near
/// they came. One event of a part and an obstacle lasts until the first traverse on which they do
/// not touch, or the next tool.
class FixtureChecks {
 public:
  explicit FixtureChecks(FindingLog& log) : log_(log) {}

  /// Of the wishes: rules and clearances.
  void set_obstacles(std::vector<Obstacle> obstacles, const CollisionWishes& wishes);
  /// Something is to be looked for.
  bool active() const { return !obstacles_.empty(); }
  void mount(std::vector<CarriedBody> bodies, int tool, bool guessed);
  void unmount() {
    mounted_.clear();
    last_.reset();
  }
  bool is_mounted() const { return !mounted_.empty(); }
  /// From the tip to the farthest point of what is mounted; 0: nothing is. The moves of a tool that
  /// tilts are to be true so far up.
  double reach_mm() const;
  void check(const CheckedMove& move);
  /// What has been found is forgotten, and how near anything came.
  void begin_reporting();
  /// The program is over: what came near without touching is told.
  void finish();
  /// Rows of all tools so far, in the order of their first use.
  std::vector<CollisionPair> table() const;

 private:
  /// One part of one tool and one obstacle.
  struct Pair : NearPair {
    std::size_t obstacle = 0;
    double width_mm = 0, from_z_mm = 0;  ///< of the part
    double depth_mm = 0;                 ///< of the event
  };
  /// A part of the tool in use.
  struct Mounted {
    CarriedBody body;
    double reach_mm = 0;
    std::vector<std::size_t> pairs;  ///< by obstacle
    std::vector<double> spare_mm;    ///< no nearer than this at the end of the last move; < 0: ?
    std::vector<Vec3> guess;
  };
  struct Way;
  std::size_t pair_of(int tool, const CarriedBody& body, std::size_t obstacle);
  /// `tip`: around the tip's way in the obstacle's frame; nullopt: boxes say nothing.
  void check_pair(Mounted& part, std::size_t obstacle, const CheckedMove& move, std::size_t which,
                  const Way& way, const std::optional<Box>& tip, bool& touched);
  void meet(Mounted& part, Pair& pair, const CheckedMove& move, std::size_t which, const Way& way,
            double t);
  Finding contact_of(const Pair& pair) const;

  FindingLog& log_;
  std::vector<Obstacle> obstacles_;
  PairRules rules_;
  double clearance_mm_ = 0;
  std::vector<SolidBoxes> boxes_;  ///< by obstacle
  int tool_ = 0;
  bool guessed_ = false;
  std::optional<CutMove> last_;  ///< where it ended is where Mounted::spare_mm counts from
  std::vector<Mounted> mounted_;
  std::vector<Pair> pairs_;
};

}  // namespace kerf
