// twin/machine/kinematics/tool_chain.h - the way from the workpiece to the tool as a row of steps,
// with its derivatives: what bounds on curved tool paths come from.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "twin/machine/kinematics/kinematic_chain.h"

namespace kerf {

/// Inputs of a chain as functions of t in [0, 1] at one t: value, first and second derivative. mm,
/// and degrees of what turns.
struct InputJet {
  AxisValues value{};
  AxisValues rate{};
  AxisValues acceleration{};
};

/// Bounds of an input's derivatives over all t, absolute. What turns does so evenly: second and
/// third are 0 there.
struct InputBounds {
  AxisValues rate{};
  AxisValues acceleration{};
  AxisValues jerk{};
};

/// A rigid body in motion: where it is, how it turns, how its origin moves. Per unit of t, radians.
struct PoseJet {
  Pose pose;
  Vec3 turning{0};
  Vec3 turning_rate{0};
  Vec3 velocity_mm{0};
  Vec3 acceleration_mm{0};

  /// Second derivative of a direction that is fixed in the body (outer frame).
  Vec3 bend(const Vec3& direction) const;
};

/// Bounds on the derivatives of a moving point and of everything that turns with it.
struct PathBounds {
  double speed_mm = 0;
  double acceleration_mm = 0;
  double jerk_mm = 0;
  double turning_rad = 0;  ///< Sum of the turns of all joints; |d^n direction / dt^n| <= its n-th
                           ///< power.
};

/// A serial chain between two bodies, cut out of a tree and laid flat: shifts, slides and turns,
/// each in the frame that the ones before it have made.
class ToolChain {
 public:
  enum class Kind : std::uint8_t { kShift, kSlide, kTurn };
  struct Step {
    Kind kind = Kind::kShift;
    std::uint8_t input = 0;  ///< Axis; of slides and turns.
    Vec3 vector{0};          ///< Shift in mm, or unit direction with the sign of the input.
  };

  ToolChain() = default;
  explicit ToolChain(std::vector<Step> steps) : steps_(std::move(steps)) {}
  /// From the workpiece link of `chain` to its tool link. A link that is driven by joint n follows
  /// the axis that `joint_letters` has there.
  ToolChain(const KinematicChain& chain, std::string_view joint_letters);
  /// Between any two links: the second as seen from the first. No steps: they move as one, and lie
  /// in the same place.
  ToolChain(const KinematicChain& chain, std::string_view joint_letters, std::size_t from_link,
            std::size_t to_link);

  const std::vector<Step>& steps() const { return steps_; }
  std::vector<Step>& steps() { return steps_; }
  /// Number of turning steps whose input has a rate.
  int turning_steps(const AxisValues& rate) const;

  Pose pose(const AxisValues& inputs) const;
  /// Exact, by the composition of moving frames. Of the origin; `end` is a point of the last frame.
  PoseJet jet(const InputJet& inputs, const Vec3& end_mm) const;
  /// For the point `end_mm` of the last frame while the inputs stay within `h` / 2 of those of
  /// `middle` in t. Rigorous: norms of all terms are added. `around_mm`: for all points of the last
  /// frame that are no farther from `end_mm`.
  PathBounds bounds(const AxisValues& middle, const InputBounds& inputs, double h,
                    const Vec3& end_mm, double around_mm = 0) const;

 private:
  std::vector<Step> steps_;
};

}  // namespace kerf
