// twin/machine/kinematics/kinematic_chain.h - a machine as a tree of links that slide and turn on
// each other. The cutter's motion and the drawn machine are to come from the same chain.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.h"
#include "interp_bridge/machine_limits.h"
#include "twin/machine/kinematics/pose.h"

namespace kerf {

/// X Y Z A B C U V W (or joints 0 .. 8): mm, and degrees of what turns.
using AxisValues = std::array<double, kAxisCount>;

/// Where the machine stands. Of a machine with trivial kinematics every joint has the value of its
/// axis: joints_of().
struct MachinePosition {
  AxisValues axes{};
  AxisValues joints{};
};

/// Each joint the value of its axis: letters "XYYZ" say that joints 1 and 2 move Y. Letters beyond
/// nine, and those that are no axis, are passed over.
AxisValues joints_of(const AxisValues& axes, std::string_view joint_letters);

enum class JointKind : std::uint8_t { kFixed, kPrismatic, kRotary };

/// One link and the joint by which it hangs on its parent. At value 0 its frame lies at `origin_mm`
/// of the parent's frame and is parallel to it; at value v it has moved by v * direction, or turned
/// right-handed by v degrees about that direction through its origin.
///
/// The direction is that of the link itself. LinuxCNC's axes are named as the tool sees them, so
/// what carries the tool goes along the axis (X: 1,0,0) and what carries the workpiece against it
/// (table in X: -1,0,0). A table that turns has the sign of its controller.
struct ChainLink {
  std::string name;
  std::string parent;  ///< Empty: the machine's base, which does not move.
  JointKind joint = JointKind::kFixed;
  std::uint8_t input = 0;  ///< 0 .. 8: index into axes, or into joints.
  bool by_joint = false;   ///< The input is a joint's number, not an axis.
  Vec3 direction{0.0, 0.0, 1.0};
  Vec3 origin_mm{0.0};
};

/// What is wrong with a chain and where, so that a configuration can point at it.
struct ChainFault {
  enum class Field : std::uint8_t { kName, kParent, kDirection, kWorkpiece, kTool };
  std::size_t link = 0;  ///< Of kName, kParent, kDirection.
  Field field = Field::kName;
  std::string message;  ///< "'tabel' is no link; there are base, table"
};

/// Any tree of fixed, prismatic and rotary joints; one branch carries the workpiece, another (or
/// the same) the tool. Poses are exact but for rounding: no small-angle or iteration. Closed loops
/// (hexapods, deltas) are none of its business.
///
///     base --- column --- head (Z)                     base_from_link[i]
///        \---- saddle (Y) --- table (X)                = base_from_link[parent] * shift * joint
class KinematicChain {
 public:
  /// All faults at once; empty: create() will succeed. Names must be there and differ, parents
  /// exist, no link be its own ancestor, directions be of some length, `workpiece` and `tool` name
  /// links.
  static std::vector<ChainFault> faults_of(const std::vector<ChainLink>& links,
                                           std::string_view workpiece, std::string_view tool);

  /// Directions are brought to unit length. Error: the first fault.
  static Result<KinematicChain> create(std::vector<ChainLink> links, std::string_view workpiece,
                                       std::string_view tool);

  const std::vector<ChainLink>& links() const { return links_; }
  std::size_t workpiece_link() const { return workpiece_; }
  std::size_t tool_link() const { return tool_; }
  /// The link of that name.
  std::optional<std::size_t> find(std::string_view name) const;
  /// Whether some joint between base and workpiece, or base and tool, is driven by this axis.
  bool is_driven_by(std::size_t axis) const;
  /// The same by this joint's number (ChainLink::by_joint).
  bool is_driven_by_joint(std::size_t joint) const;

  /// Pose of every link in the base's frame, in the order of links(). `base_from_link` has
  /// links().size() elements. O(links), allocates nothing; about 0.1 us a rotary joint.
  void forward(const MachinePosition& position, std::span<Pose> base_from_link) const;

  /// The tool link seen from the workpiece link: forward() for these two branches alone.
  Pose workpiece_from_tool(const MachinePosition& position) const;

 private:
  bool is_driven(bool by_joint, std::size_t input) const;
  Pose joint_pose(std::size_t link, const MachinePosition& position) const;
  Pose base_from(std::size_t link, const MachinePosition& position) const;

  std::vector<ChainLink> links_;
  std::vector<std::int32_t> parents_;  ///< -1: the base
  std::vector<std::size_t> order_;     ///< Parents before their children.
  std::size_t workpiece_ = 0;
  std::size_t tool_ = 0;
};

}  // namespace kerf
