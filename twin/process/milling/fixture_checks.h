// twin/process/milling/fixture_checks.h - the tool against what stands around the workpiece:
// fixture-contact, near-miss.
#pragma once

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "twin/collision/box_bound.h"
#include "twin/collision/sweep.h"
#include "twin/findings/finding.h"
#include "twin/process/collision_table.h"
#include "twin/process/milling/checks.h"

namespace kerf {

/// Holds cutter, shank, holder and spindle against each fixture on all moves of one program, and
/// keeps how near they came. One event of a part and a fixture lasts until the first traverse on
/// which they do not touch, or the next tool.
class FixtureChecks {
 public:
  explicit FixtureChecks(FindingLog& log) : log_(log) {}

  /// Fixtures on links of the machine are left to MachineChecks.
  void set_wishes(const CollisionWishes& wishes);
  /// Something is to be looked for.
  bool active() const { return wishes_.fixtures && !wishes_.fixtures->empty(); }
  /// `nose_mm`: of the spindle above the tip; 0: not known.
  void mount(const Cutter& cutter, int tool, bool guessed, double nose_mm);
  void unmount() {
    mounted_.clear();
    last_.reset();
  }
  bool checks_spindle() const;
  void check(const CheckedMove& move);
  /// What has been found is forgotten, and how near anything came.
  void begin_reporting();
  /// The program is over: what came near without touching is told.
  void finish();
  /// Rows of all tools so far, in the order of their first use.
  std::vector<CollisionPair> table() const;

 private:
  /// One part of one tool and one fixture.
  struct Pair {
    CollisionPair row;
    std::size_t fixture = 0;
    double width_mm = 0, from_z_mm = 0;  ///< of the part
    double least_mm = std::numeric_limits<double>::infinity();
    std::optional<FindingLog::Handle> event;
    double depth_mm = 0;   ///< of the event
    Finding nearest;       ///< text and place of the least clearance
    double near_mm = 0;    ///< what counts as near
    bool ignored = false;  ///< PairRules
  };
  /// A part of the tool in the spindle.
  struct Mounted {
    ToolBody body;
    SolidPointer thin;  ///< less what a contact may be deep
    SolidPointer bare;  ///< less what rounding may be: where a contact begins
    double reach_mm = 0;
    std::vector<std::size_t> pairs;  ///< by fixture
    std::vector<double> spare_mm;    ///< no nearer than this at the end of the last move; < 0: ?
    std::vector<Vec3> guess;
  };
  struct Way;
  std::size_t pair_of(int tool, const ToolBody& body, std::size_t fixture);
  /// `tip`: around the tip's way in the fixture's frame; nullopt: the tool leans.
  void check_pair(Mounted& part, std::size_t fixture, const CheckedMove& move, std::size_t which,
                  const Way& way, const std::optional<Box>& tip, bool& touched);
  void note_least(Pair& pair, const CheckedMove& move, std::size_t which, const Way& way,
                  const LeastGap& gap);
  void meet(Mounted& part, Pair& pair, const CheckedMove& move, std::size_t which, const Way& way,
            double t);

  FindingLog& log_;
  CollisionWishes wishes_;
  std::vector<SolidBoxes> boxes_;  ///< by fixture
  int tool_ = 0;
  bool guessed_ = false;
  std::optional<CutMove> last_;  ///< where it ended is where Mounted::spare_mm counts from
  std::vector<Mounted> mounted_;
  std::vector<Pair> pairs_;
};

}  // namespace kerf
