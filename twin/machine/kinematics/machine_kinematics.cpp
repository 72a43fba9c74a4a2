#include "twin/machine/kinematics/machine_kinematics.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "base/portable_math.h"
#include "base/text_scan.h"
#include "base/translate.h"
#include "base/units.h"

namespace kerf {
namespace {

/// Three slides whose directions span less than this are no X, Y and Z.
constexpr double kLeastSpan = 1e-9;

enum class Module : std::uint8_t {
  kStraight,
  kCorexy,
  kRotate,
  kTiltA,
  kTiltB,
  kDualTable,
  kBridge,
  kMax,
  kMillTurn,
  kScara,
  kPuma,
  kGenser,
};

/// How the types of a module are numbered.
enum class Switching : std::uint8_t { kNone, kModuleFirst, kIdentityFirst, kOwn };

struct ModuleSpec {
  std::string_view name;
  Module module = Module::kStraight;
  std::string_view letters;  ///< Of its joints; empty: any, as the INI has them.
  Switching switching = Switching::kNone;
  KinematicsMode mode = KinematicsMode::kAxes;
};

constexpr std::array<ModuleSpec, 17> kModules{{
    {"trivkins", Module::kStraight, "", Switching::kNone, KinematicsMode::kAxes},
    {"gentrivkins", Module::kStraight, "", Switching::kNone, KinematicsMode::kAxes},
    {"gantrykins", Module::kStraight, "", Switching::kNone, KinematicsMode::kAxes},
    {"corexykins", Module::kCorexy, "XYZABCUVW", Switching::kNone, KinematicsMode::kAxes},
    {"rotatekins", Module::kRotate, "XYZABC", Switching::kNone, KinematicsMode::kTip},
    {"xyzac-trt-kins", Module::kTiltA, "XYZAC", Switching::kModuleFirst, KinematicsMode::kTip},
    {"xyzbc-trt-kins", Module::kTiltB, "XYZBC", Switching::kModuleFirst, KinematicsMode::kTip},
    {"xyzab_tdr_kins", Module::kDualTable, "XYZAB", Switching::kIdentityFirst,
     KinematicsMode::kTip},
    {"5axiskins", Module::kBridge, "XYZBCW", Switching::kModuleFirst, KinematicsMode::kTip},
    {"maxkins", Module::kMax, "XYZABCUVW", Switching::kNone, KinematicsMode::kTip},
    {"millturn", Module::kMillTurn, "XYZA", Switching::kOwn, KinematicsMode::kAxes},
    {"scarakins", Module::kScara, "XYZABC", Switching::kModuleFirst, KinematicsMode::kArm},
    {"pumakins", Module::kPuma, "XYZABC", Switching::kModuleFirst, KinematicsMode::kArm},
    {"genserkins", Module::kGenser, "XYZABC", Switching::kModuleFirst, KinematicsMode::kArm},
    {"genser-switchkins", Module::kGenser, "XYZABC", Switching::kModuleFirst, KinematicsMode::kArm},
    {"ugenserkins", Module::kGenser, "XYZABC", Switching::kModuleFirst, KinematicsMode::kArm},
    {"userkins", Module::kStraight, "", Switching::kNone, KinematicsMode::kAxes},
}};

const ModuleSpec* find_module(std::string_view name) {
  const auto at = std::find_if(kModules.begin(), kModules.end(),
                               [&](const ModuleSpec& spec) { return spec.name == name; });
  return at != kModules.end() ? &*at : nullptr;
}

/// The value of `key=` among the words behind a module's name.
std::string_view word_of(std::string_view words, std::string_view key) {
  const std::size_t at = words.find(key);
  if (at == words.npos) return {};
  const std::string_view rest = words.substr(at + key.size());
  return rest.substr(0, rest.find_first_of(" \t"));
}

class Geometry {
 public:
  Geometry(std::string_view module, const KinematicsGeometry& given)
      : pins_(geometry_pins(module)), given_(given) {}
  double operator[](std::string_view pin) const {
    const auto set = given_.find(pin);
    if (set != given_.end()) return set->second;
    for (const GeometryPin& one : pins_) {
      if (one.name == pin) return one.standard;
    }
    return 0;
  }
  Vec3 rotation_point() const {
    return {(*this)["x-rot-point"], (*this)["y-rot-point"], (*this)["z-rot-point"]};
  }

 private:
  std::vector<GeometryPin> pins_;
  const KinematicsGeometry& given_;
};

Arm genser_arm(const Geometry& geometry) {
  std::array<ArmJoint, 6> joints;
  for (std::size_t i = 0; i < joints.size(); ++i) {
    joints[i] = {geometry[fmt::format("A-{}", i)],
                 geometry[fmt::format("ALPHA-{}", i)] * kDegPerRad,
                 geometry[fmt::format("D-{}", i)]};
  }
  return arm_chain(joints);
}

void set_chain(MachineKinematics& machine, Module module, const Geometry& geometry,
               const RotaryPlacement& placement) {
  switch (module) {
    case Module::kStraight:
    case Module::kCorexy:
    case Module::kMillTurn:
      machine.belts = module == Module::kCorexy;
      machine.chain = straight_chain(machine.joint_letters, placement.side, placement.center_mm);
      return;
    case Module::kRotate:
      machine.chain = rotate_chain();
      return;
    case Module::kTiltA:
      machine.chain =
          xyzac_trt_chain(geometry.rotation_point(), geometry["y-offset"], geometry["z-offset"]);
      return;
    case Module::kTiltB:
      machine.chain =
          xyzbc_trt_chain(geometry.rotation_point(), geometry["x-offset"], geometry["z-offset"]);
      return;
    case Module::kDualTable:
      machine.chain =
          xyzab_tdr_chain(geometry.rotation_point(), geometry["x-offset"], geometry["z-offset"]);
      return;
    case Module::kBridge:
      machine.chain = bridge_5axis_chain(geometry["pivot-length"]);
      machine.uvw_by_xyz = true;
      return;
    case Module::kMax:
      machine.chain = max_chain(geometry["pivot-length"]);
      machine.uvw_by_xyz = true;
      return;
    case Module::kScara:
      machine.chain = scara_chain({geometry["D1"], geometry["D2"], geometry["D3"], geometry["D4"],
                                   geometry["D5"], geometry["D6"]});
      machine.arm_turns = "C";
      return;
    case Module::kPuma:
    case Module::kGenser: {
      Arm arm = module == Module::kGenser ? genser_arm(geometry)
                                          : arm_chain(puma_joints(geometry["A2"], geometry["A3"],
                                                                  geometry["D3"], geometry["D4"]),
                                                      geometry["D6"]);
      machine.chain = std::move(arm.chain);
      machine.flange_at_rest = arm.flange_at_rest;
      machine.nose_from_tip = {0.0, 0.0, -1.0};
      return;
    }
  }
}

std::vector<KinematicsType> types_of(const ModuleSpec& spec, bool identity_first) {
  const KinematicsType own{
      std::string(spec.name), spec.mode, {0, 1, 2, 3, 4, 5, 6, 7, 8}, {1, 1, 1, 1, 1, 1, 1, 1, 1}};
  KinematicsType identity;
  identity.name = "identity";
  KinematicsType user;
  user.name = "userk";
  switch (spec.switching) {
    case Switching::kNone:
      break;
    case Switching::kModuleFirst:
      if (identity_first) return {identity, own, user};
      return {own, identity, user};
    case Switching::kIdentityFirst:
      return {identity, own};
    case Switching::kOwn: {
      KinematicsType mill = own;
      mill.name = "mill";
      KinematicsType lathe = own;
      lathe.name = "turn";
      lathe.source = {2, 1, 0, 3, 4, 5, 6, 7, 8};
      lathe.sign[1] = -1;
      return {mill, lathe};
    }
  }
  return {own};
}

std::size_t axis_of(char letter) {
  return static_cast<std::size_t>(std::find(kAxisLetters.begin(), kAxisLetters.end(), letter) -
                                  kAxisLetters.begin());
}

/// Roll, pitch, yaw of Rz(c) Ry(b) Rx(a), degrees.
std::array<double, 3> roll_pitch_yaw(const glm::dmat3& r) {
  return {portable::atan2(r[1][2], r[2][2]) * kDegPerRad,
          portable::atan2(-r[0][2], portable::hypot(r[0][0], r[0][1])) * kDegPerRad,
          portable::atan2(r[0][1], r[0][0]) * kDegPerRad};
}

/// Where the module takes the tip of a tool of `tool_mm` for, X Y Z of its own.
Vec3 controlled_point(const MachineKinematics& machine, const MachinePosition& position,
                      double tool_mm) {
  const Pose pose = machine.chain.workpiece_from_tool(position);
  return pose.point(-tool_mm * machine.nose_from_tip) + tool_mm * machine.nose_from_tip;
}

/// X, Y, Z that put the controlled point there; everything else is in `position`. Whatever turns,
/// the point is an affine function of the slides.
bool solve_slides(const MachineKinematics& machine, const Vec3& target, double tool_mm,
                  MachinePosition& position) {
  for (std::size_t i = 0; i < 3; ++i) position.axes[i] = 0;
  const Vec3 at_zero = controlled_point(machine, position, tool_mm);
  glm::dmat3 ways(0.0);
  for (int i = 0; i < 3; ++i) {
    position.axes[static_cast<std::size_t>(i)] = 1;
    ways[i] = controlled_point(machine, position, tool_mm) - at_zero;
    position.axes[static_cast<std::size_t>(i)] = 0;
  }
  if (!(std::abs(glm::determinant(ways)) > kLeastSpan)) return false;
  const Vec3 solved = glm::inverse(ways) * (target - at_zero);
  for (int i = 0; i < 3; ++i) position.axes[static_cast<std::size_t>(i)] = solved[i];
  return true;
}

AxisValues joints_from(const MachineKinematics& machine, const AxisValues& axes) {
  AxisValues joints = joints_of(axes, machine.joint_letters);
  if (machine.belts) {
    joints[0] = axes[0] + axes[1];
    joints[1] = axes[0] - axes[1];
  }
  return joints;
}

AxisValues machine_axes_from(const MachineKinematics& machine, const AxisValues& joints) {
  AxisValues axes{};
  // Of several joints on one axis the first counts, as trivkins has it.
  for (std::size_t joint = std::min(machine.joint_letters.size(), kAxisCount); joint-- > 0;) {
    const std::size_t axis = axis_of(machine.joint_letters[joint]);
    if (axis < kAxisCount) axes[axis] = joints[joint];
  }
  if (machine.belts) {
    axes[0] = 0.5 * (joints[0] + joints[1]);
    axes[1] = 0.5 * (joints[0] - joints[1]);
  }
  return axes;
}

}  // namespace

std::vector<std::string> known_modules() {
  std::vector<std::string> names;
  for (const ModuleSpec& spec : kModules) names.emplace_back(spec.name);
  return names;
}

std::vector<GeometryPin> geometry_pins(std::string_view module) {
  const ModuleSpec* const spec = find_module(module);
  if (spec == nullptr) return {};
  const std::vector<GeometryPin> table{
      {"x-rot-point", 0}, {"y-rot-point", 0}, {"z-rot-point", 0}, {"z-offset", 0}};
  const auto table_with = [&](const char* side) {
    std::vector<GeometryPin> pins = table;
    pins.push_back({side, 0});
    return pins;
  };
  switch (spec->module) {
    case Module::kTiltA:
      return table_with("y-offset");
    case Module::kTiltB:
    case Module::kDualTable:
      return table_with("x-offset");
    case Module::kBridge:
      return {{"pivot-length", 250}};
    case Module::kMax:
      return {{"pivot-length", 0.666}};
    case Module::kScara:
      return {{"D1", 490}, {"D2", 340}, {"D3", 50}, {"D4", 250}, {"D5", 50}, {"D6", 50}};
    case Module::kPuma:
      return {{"A2", 300}, {"A3", 50}, {"D3", 70}, {"D4", 400}, {"D6", 70}};
    case Module::kGenser: {
      std::vector<GeometryPin> pins;
      const std::array<ArmJoint, 6> puma = puma_joints(300, 50, 70, 400);
      for (std::size_t i = 0; i < puma.size(); ++i) {
        pins.push_back({fmt::format("A-{}", i), puma[i].a_mm});
        pins.push_back({fmt::format("ALPHA-{}", i), puma[i].alpha_deg / kDegPerRad});
        pins.push_back({fmt::format("D-{}", i), puma[i].d_mm});
      }
      return pins;
    }
    case Module::kStraight:
    case Module::kCorexy:
    case Module::kRotate:
    case Module::kMillTurn:
      break;
  }
  return {};
}

const KinematicsType& MachineKinematics::type(int number) const {
  const auto index = static_cast<std::size_t>(std::max(number, 0));
  return types[index < types.size() ? index : 0];
}

int MachineKinematics::type_of(const Motion& motion) const {
  if (!is_switchable() || switch_output >= TorchState::kAnalogs) return 0;
  const double value = std::nearbyint(double{motion.torch.analog[switch_output]});
  return value > 0 && value < static_cast<double>(types.size()) ? static_cast<int>(value) : 0;
}

bool MachineKinematics::is_arm() const {
  return std::any_of(types.begin(), types.end(),
                     [](const KinematicsType& t) { return t.mode == KinematicsMode::kArm; });
}

bool MachineKinematics::turns_joint(std::size_t joint) const {
  for (const ChainLink& link : chain.links()) {
    if (link.joint == JointKind::kFixed || !link.by_joint || link.input != joint) continue;
    return link.joint == JointKind::kRotary;
  }
  return joint < joint_letters.size() && is_rotary_axis(axis_of(joint_letters[joint]));
}

bool MachineKinematics::turns() const {
  if (is_arm()) return true;
  return chain.is_driven_by(3) || chain.is_driven_by(4) || chain.is_driven_by(5);
}

bool MachineKinematics::slides_uvw() const {
  return !is_arm() && (chain.is_driven_by(6) || chain.is_driven_by(7) || chain.is_driven_by(8));
}

MachineKinematics MachineKinematics::standing() const {
  MachineKinematics still = *this;
  std::vector<ChainLink> links = chain.links();
  for (ChainLink& link : links) {
    if (link.joint == JointKind::kRotary) link.joint = JointKind::kFixed;
  }
  const std::string workpiece = links[chain.workpiece_link()].name;
  const std::string tool = links[chain.tool_link()].name;
  still.chain = std::move(KinematicChain::create(std::move(links), workpiece, tool).value());
  return still;
}

AxisValues MachineKinematics::axes_of(const AxisValues& joints, int type_number,
                                      double tool_mm) const {
  const KinematicsType& now = type(type_number);
  AxisValues axes = machine_axes_from(*this, joints);
  if (now.mode == KinematicsMode::kAxes) {
    AxisValues program{};
    for (std::size_t i = 0; i < kAxisCount; ++i) program[now.source[i]] = now.sign[i] * axes[i];
    return program;
  }
  const MachinePosition position{axes, joints};
  const Vec3 point = now.mode == KinematicsMode::kArm
                         ? chain.workpiece_from_tool(position).origin_mm
                         : controlled_point(*this, position, told_tool(tool_mm));
  for (int i = 0; i < 3; ++i) axes[static_cast<std::size_t>(i)] = point[i];
  if (now.mode == KinematicsMode::kArm) {
    const auto turned =
        roll_pitch_yaw(chain.workpiece_from_tool(position).rotation * flange_at_rest);
    for (std::size_t i = 0; i < 3; ++i) axes[3 + i] = turned[i];
  }
  return axes;
}

std::optional<MachinePosition> MachineKinematics::position_of(const AxisValues& axes,
                                                              int type_number,
                                                              double tool_mm) const {
  const KinematicsType& now = type(type_number);
  MachinePosition position;
  switch (now.mode) {
    case KinematicsMode::kAxes:
      for (std::size_t i = 0; i < kAxisCount; ++i) {
        position.axes[i] = now.sign[i] * axes[now.source[i]];
      }
      break;
    case KinematicsMode::kTip:
      position.axes = axes;
      if (!solve_slides(*this, {axes[0], axes[1], axes[2]}, told_tool(tool_mm), position)) {
        return std::nullopt;
      }
      break;
    case KinematicsMode::kArm:
      return std::nullopt;
  }
  position.joints = joints_from(*this, position.axes);
  return position;
}

Result<MachineKinematics> known_machine(std::string_view kinematics, std::string_view joint_letters,
                                        const KinematicsGeometry& geometry,
                                        const RotaryPlacement& placement) {
  const std::size_t end = std::min(kinematics.find_first_of(" \t"), kinematics.size());
  const std::string_view name = kinematics.substr(0, end);
  const std::string_view words = kinematics.substr(end);
  const ModuleSpec* const spec = find_module(name.empty() ? "trivkins" : name);
  if (spec == nullptr) {
    std::string known;
    for (const ModuleSpec& one : kModules) {
      known += (known.empty() ? "" : ", ") + std::string(one.name);
    }
    return Error{trf("{} is no chain of links that kerf knows; there are {}", name, known)};
  }
  MachineKinematics machine;
  machine.module = spec->name;
  const std::string coordinates = to_upper(word_of(words, "coordinates="));
  machine.joint_letters = !coordinates.empty()     ? coordinates
                          : !spec->letters.empty() ? std::string(spec->letters)
                                                   : to_upper(joint_letters);
  const Geometry numbers(spec->name, geometry);
  machine.pivot_length_mm = numbers["pivot-length"];
  set_chain(machine, spec->module, numbers, placement);
  machine.types = types_of(*spec, word_of(words, "sparm=") == "identityfirst");
  if (machine.is_switchable() && machine.types.back().name == "userk") {
    machine.notes.push_back(tr("userk, the third of its kinematics, is taken for identity"));
  }
  return machine;
}

}  // namespace kerf
