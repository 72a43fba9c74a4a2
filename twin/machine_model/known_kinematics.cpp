#include "twin/machine_model/known_kinematics.h"

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
