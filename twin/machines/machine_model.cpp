#include "twin/machines/machine_model.h"

#include <glm/geometric.hpp>

namespace kerf {
namespace {

/// Slides whose directions span less than this (the determinant of their unit vectors' products;
/// 1: at right angles) are taken for parallel.
constexpr double kLeastSpan = 1e-9;

Vec3 tip_of(const MachineModel& model, const MachinePosition& position, double tool_length_mm) {
  const Pose pose = model.link_from_workpiece.inverse() * model.chain.workpiece_from_tool(position);
  return pose.point(-tool_length_mm * model.nose_from_tip);
}

/// Machine coordinates of a point of the program: what the axes would be if nothing turned.
AxisValues machine_axes(const MachineModel& model, const AxisValues& program) {
  AxisValues axes = program;
  const Pose machine_from_workpiece =
      model.chain.workpiece_from_tool({}).inverse() * model.link_from_workpiece;
  const Vec3 machine = machine_from_workpiece.point({program[0], program[1], program[2]});
  for (int i = 0; i < 3; ++i) axes[static_cast<std::size_t>(i)] = machine[i];
  return axes;
}

}  // namespace

Pose link_from_workpiece_of(const KinematicChain& chain, const Pose& machine_from_workpiece) {
  return chain.workpiece_from_tool({}) * machine_from_workpiece;
}

void link_poses(const MachineModel& model, const MachinePosition& position,
                std::vector<glm::mat4>& out) {
  // A machine has a handful of links: no need for memory that outlives the call.
  std::vector<Pose> base_from_link(model.chain.links().size());
  model.chain.forward(position, base_from_link);
  const Pose workpiece_from_base =
      (base_from_link[model.chain.workpiece_link()] * model.link_from_workpiece).inverse();
  out.clear();
  for (const Pose& pose : base_from_link) out.push_back(to_mat4(workpiece_from_base * pose));
}

ToolStand tool_stand(const MachineModel& model, const MachinePosition& position,
                     double tool_length_mm) {
  const Pose pose = model.link_from_workpiece.inverse() * model.chain.workpiece_from_tool(position);
  return {tip_of(model, position, tool_length_mm), pose.direction(model.nose_from_tip)};
}

MachinePosition position_of_axes(const MachineModel& model, const AxisValues& program,
                                 double tool_length_mm) {
  MachinePosition position{machine_axes(model, program), {}};
  for (int i = 0; i < 3; ++i) {
    position.axes[static_cast<std::size_t>(i)] += tool_length_mm * model.nose_from_tip[i];
  }
  return position;
}

std::optional<MachinePosition> position_of_tip(const MachineModel& model, const AxisValues& program,
                                               double tool_length_mm) {
  MachinePosition position{program, {}};
  for (std::size_t i = 0; i < 3; ++i) position.axes[i] = 0.0;
  const Vec3 target(program[0], program[1], program[2]);
  // Whatever turns, the tip is an affine function of the slides.
  const Vec3 at_zero = tip_of(model, position, tool_length_mm);
  std::array<Vec3, 3> ways{};
  glm::dmat3 normal(1.0);
  for (std::size_t i = 0; i < 3; ++i) {
    if (!model.chain.is_driven_by(i)) continue;
    position.axes[i] = 1.0;
    ways[i] = tip_of(model, position, tool_length_mm) - at_zero;
    position.axes[i] = 0.0;
  }
  if (ways == std::array<Vec3, 3>{}) return std::nullopt;
  Vec3 right(0.0);
  for (int i = 0; i < 3; ++i) {
    const Vec3& way = ways[static_cast<std::size_t>(i)];
    if (way == Vec3(0.0)) continue;  // no such slide: its row of `normal` stays that of the unit
    for (int k = 0; k < 3; ++k) normal[i][k] = glm::dot(way, ways[static_cast<std::size_t>(k)]);
    right[i] = glm::dot(way, target - at_zero);
  }
  if (!(glm::determinant(normal) > kLeastSpan)) return std::nullopt;
  const Vec3 solved = glm::inverse(normal) * right;
  for (int i = 0; i < 3; ++i) position.axes[static_cast<std::size_t>(i)] = solved[i];
  return position;
}

}  // namespace kerf
