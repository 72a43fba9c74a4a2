#include "twin/machine/kinematics/known_kinematics.h"

#include <fmt/format.h>

#include <string>
#include <utility>

namespace kerf {
namespace {

enum Input : std::uint8_t { kX, kY, kZ, kA, kB, kC, kU, kV, kW };

constexpr Vec3 kAlongX{1.0, 0.0, 0.0};
constexpr Vec3 kAlongY{0.0, 1.0, 0.0};
constexpr Vec3 kAlongZ{0.0, 0.0, 1.0};

ChainLink slide(std::string name, std::string parent, Input input, const Vec3& direction) {
  return {std::move(name), std::move(parent), JointKind::kPrismatic, input, false,
          direction,       Vec3(0.0)};
}

ChainLink pivot(std::string name, std::string parent, Input input, const Vec3& axis,
                const Vec3& origin_mm) {
  return {std::move(name), std::move(parent), JointKind::kRotary, input, false, axis, origin_mm};
}

ChainLink rigid(std::string name, std::string parent, const Vec3& origin_mm) {
  return {std::move(name), std::move(parent), JointKind::kFixed, 0, false, kAlongZ, origin_mm};
}

/// The chains below are complete, so there is no error.
KinematicChain built(std::vector<ChainLink> links, std::string_view workpiece,
                     std::string_view tool) {
  Result<KinematicChain> chain = KinematicChain::create(std::move(links), workpiece, tool);
  return std::move(chain.value());
}

KinematicChain tilting_table(Input tilt, const Vec3& tilt_axis, const Vec3& rotation_point_mm,
                             const Vec3& offset_mm) {
  // "workpiece" undoes the shift to the rotation point: at rest it coincides with the machine's
  // own frame, as the modules have it.
  return built({slide("saddle", "", kY, -kAlongY), slide("table", "saddle", kX, -kAlongX),
                pivot("cradle", "table", tilt, tilt_axis, rotation_point_mm + offset_mm),
                pivot("platter", "cradle", kC, kAlongZ, -offset_mm),
                rigid("workpiece", "platter", -rotation_point_mm), slide("head", "", kZ, kAlongZ)},
               "workpiece", "head");
}

}  // namespace

KinematicChain xyzac_trt_chain(const Vec3& rotation_point_mm, double y_offset_mm,
                               double z_offset_mm) {
  return tilting_table(kA, kAlongX, rotation_point_mm, {0.0, y_offset_mm, z_offset_mm});
}

KinematicChain xyzbc_trt_chain(const Vec3& rotation_point_mm, double x_offset_mm,
                               double z_offset_mm) {
  return tilting_table(kB, kAlongY, rotation_point_mm, {x_offset_mm, 0.0, z_offset_mm});
}

KinematicChain straight_chain(std::string_view letters, RotarySide side, const Vec3& center_mm) {
  std::vector<ChainLink> links{rigid("base", "", Vec3(0.0)), slide("bridge", "", kY, kAlongY),
                               slide("carriage", "bridge", kX, kAlongX),
                               slide("ram", "carriage", kZ, kAlongZ)};
  std::string workpiece = "base";
  std::string tool = "ram";
  const bool table = side == RotarySide::kTable;
  std::string& end = table ? workpiece : tool;
  Vec3 origin_mm = center_mm;
  for (const char letter : table ? std::string_view("ABC") : std::string_view("CBA")) {
    if (letters.find(letter) == letters.npos) continue;
    Vec3 direction(0.0);
    direction[letter - 'A'] = table ? -1.0 : 1.0;
    std::string name = fmt::format("rotary_{:c}", letter - 'A' + 'a');
    links.push_back(pivot(name, end, static_cast<Input>(kA + letter - 'A'), direction, origin_mm));
    end = std::move(name);
    origin_mm = Vec3(0.0);
  }
  if (origin_mm != center_mm) {  // at rest the frames are those of the machine
    std::string name = table ? "workpiece" : "nose";
    links.push_back(rigid(name, end, -center_mm));
    end = std::move(name);
  }
  if (letters.find('W') != letters.npos) {
    links.push_back(slide("quill", tool, kW, kAlongZ));
    tool = "quill";
  }
  return built(std::move(links), workpiece, tool);
}

KinematicChain lathe_chain() {
  return built({rigid("base", "", Vec3(0.0)), slide("bridge", "", kY, kAlongY),
                slide("carriage", "bridge", kX, kAlongX), slide("ram", "carriage", kZ, kAlongZ),
                pivot("rotary_a", "base", kA, -kAlongZ, Vec3(0.0)),
                pivot("rotary_c", "rotary_a", kC, -kAlongZ, Vec3(0.0))},
               "rotary_c", "ram");
}

KinematicChain xyzab_tdr_chain(const Vec3& rotation_point_mm, double x_offset_mm,
                               double z_offset_mm) {
  const Vec3 offset(x_offset_mm, 0.0, z_offset_mm);
  return built({slide("bridge", "", kY, kAlongY), slide("carriage", "bridge", kX, kAlongX),
                slide("head", "carriage", kZ, kAlongZ),
                pivot("rotary_b", "", kB, -kAlongY, rotation_point_mm),
                pivot("rotary_a", "rotary_b", kA, -kAlongX, offset),
                rigid("workpiece", "rotary_a", -rotation_point_mm - offset)},
               "workpiece", "head");
}

KinematicChain rotate_chain() {
  return built({pivot("platter", "", kC, kAlongZ, Vec3(0.0)), slide("bridge", "", kY, kAlongY),
                slide("carriage", "bridge", kX, kAlongX), slide("head", "carriage", kZ, kAlongZ)},
               "platter", "head");
}

KinematicChain max_chain(double pivot_length_mm) {
  return built({slide("saddle", "", kY, -kAlongY),
                slide("table", "saddle", kX, -kAlongX),
                pivot("platter", "table", kC, -kAlongZ, Vec3(0.0)),
                slide("head", "", kZ, kAlongZ),
                slide("cross", "head", kV, -kAlongY),
                pivot("swivel", "cross", kB, -kAlongY, {0.0, 0.0, pivot_length_mm}),
                slide("facing", "swivel", kU, -kAlongX),
                {"quill", "facing", JointKind::kPrismatic, kW, false, -kAlongZ,
                 Vec3(0.0, 0.0, -pivot_length_mm)}},
               "platter", "quill");
}

KinematicChain scara_chain(const std::array<double, 6>& d_mm) {
  const auto by_joint = [](ChainLink link) {
    link.by_joint = true;
    return link;
  };
  const auto joint = [](int number) { return static_cast<Input>(number); };
  return built(
      {rigid("base", "", Vec3(0.0)),
       by_joint(pivot("inner_arm", "base", joint(0), kAlongZ, {0.0, 0.0, d_mm[0]})),
       by_joint(pivot("outer_arm", "inner_arm", joint(1), kAlongZ, {d_mm[1], 0.0, d_mm[2]})),
       by_joint({"quill", "outer_arm", JointKind::kPrismatic, joint(2), false, -kAlongZ,
                 Vec3(d_mm[3], 0.0, 0.0)}),
       by_joint(pivot("turn", "quill", joint(3), kAlongZ, Vec3(0.0))),
       rigid("wrist", "turn", {d_mm[5], 0.0, -d_mm[4]})},
      "base", "wrist");
}

std::array<ArmJoint, 6> puma_joints(double a2_mm, double a3_mm, double d3_mm, double d4_mm) {
  return {ArmJoint{}, {0, -90, 0}, {a2_mm, 0, d3_mm}, {a3_mm, -90, d4_mm}, {0, 90, 0}, {0, -90, 0}};
}

Arm arm_chain(std::span<const ArmJoint> joints, double flange_mm) {
  std::vector<ChainLink> links{rigid("base", "", Vec3(0.0))};
  std::string before = "base";
  // Frames of links are parallel to their parents' at rest, those of Denavit and Hartenberg are
  // not: every axis is given in the frame of the arm at rest.
  Pose at_rest;
  Vec3 from(0.0);
  for (std::size_t i = 0; i < joints.size(); ++i) {
    const ArmJoint& one = joints[i];
    at_rest = at_rest * turn(kAlongX, one.alpha_deg);
    at_rest.origin_mm += at_rest.direction({one.a_mm, 0.0, one.d_mm});
    ChainLink link = pivot(fmt::format("arm_{}", i), before, static_cast<Input>(i),
                           at_rest.direction(kAlongZ), at_rest.origin_mm - from);
    link.by_joint = true;
    before = link.name;
    from = at_rest.origin_mm;
    links.push_back(std::move(link));
  }
  links.push_back(rigid("flange", before, at_rest.direction({0.0, 0.0, flange_mm})));
  return {built(std::move(links), "base", "flange"), at_rest.rotation};
}

KinematicChain bridge_5axis_chain(double pivot_length_mm) {
  return built({rigid("table", "", Vec3(0.0)),
                slide("bridge", "", kY, kAlongY),
                slide("carriage", "bridge", kX, kAlongX),
                slide("ram", "carriage", kZ, kAlongZ),
                pivot("fork", "ram", kC, kAlongZ, {0.0, 0.0, pivot_length_mm}),
                pivot("spindle", "fork", kB, -kAlongY, Vec3(0.0)),
                {"quill", "spindle", JointKind::kPrismatic, kW, false, -kAlongZ,
                 Vec3(0.0, 0.0, -pivot_length_mm)}},
               "table", "quill");
}

}  // namespace kerf
