// twin/process/turning/nose_checks.h - what a nose makes of a contour that is programmed for a
// sharp point: uncompensated.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "stock/turning/turning_stock.h"
#include "twin/findings/finding.h"
#include "twin/process/turning/turning_checks.h"

namespace kerf {

/// Where compensation (G41, G42) is off, the controlled point runs along the programmed contour,
/// and the nose cuts another one: where its tangent is that of the way. Cylinders and faces are
/// right, tapers and arcs are not. By how much is worked out move by move, and told of surfaces
/// that are still there at the program's end: once a tool, at the line of the greatest error. Of
/// orientation 9 the controlled point is the nose's centre: such programs mean a centre's path, and
/// nothing is told.
class NoseChecks {
 public:
  NoseChecks(const TurningStock& stock, FindingLog& log) : stock_(stock), log_(log) {}

  void mount(const Cutter& cutter, int tool);
  void unmount() { nose_.reset(); }
  /// A feed move that has been cut.
  void note(const TurnedMove& move, const TurnCut& cut);
  /// The program is over.
  void finish();
  void forget() {
    unmount();
    found_.clear();
  }

  /// Less is none.
  static constexpr double kLeast_mm = 0.01;
  /// Of each tool so many lines are kept, those with the greatest errors.
  static constexpr std::size_t kMostLines = 200;

 private:
  struct Nose {
    double radius_mm = 0;
    Vec2 centre_mm{0};                    ///< from the controlled point, (z, x)
    double start_rad = 0, sweep_rad = 0;  ///< of its arc
    int tool = 0;
    bool touches(
        const Vec2& way_out) const;  ///< a line with this normal, from the part to the tool
  };
  /// Where the surface of a move is, and how far from the programmed one.
  struct Found {
    double off_mm = 0;
    Vec2 surface_mm{0};
    Vec3 place_mm{0};  ///< of the controlled point
    SourceRef source;
    double time_s = 0;
    int tool = 0;
    double radius_mm = 0;
  };
  void look(const TurnedMove& move, const Vec2& way, const Vec2& at, double share,
            std::optional<Found>& worst) const;
  bool is_there(const TurnedProfile& profile, const Vec2& place) const;

  const TurningStock& stock_;
  FindingLog& log_;
  std::optional<Nose> nose_;
  std::vector<Found> found_;
};

}  // namespace kerf
