// tests/twin/scene/machine_with_arm.h - a small mill: a table that goes in X, a head with an arm.
#pragma once

#include <memory>
#include <string>
#include <utility>

#include "twin/machine/kinematics/pose.h"
#include "twin/machines/linked_machine.h"
#include "twin/machines/machine_model.h"

namespace kerf::test {

/// Links: frame, table (with the workpiece), head (with the tool).
inline LinkedMachine machine_with_arm() {
  const auto link = [](std::string name, std::string parent, JointKind joint, std::uint8_t input,
                       Vec3 direction, Box box) {
    LinkSpec spec;
    spec.chain = {std::move(name), std::move(parent), joint, input, false, direction};
    spec.bodies.emplace_back().bounds_mm = box;
    return spec;
  };
  LinkedMachine machine;
  machine.workpiece_on = "table";
  machine.tool_on = "head";
  machine.links = {
      link("frame", "", JointKind::kFixed, 0, {0, 0, 1}, {{-80, 150, -400}, {80, 250, 300}}),
      link("table", "frame", JointKind::kPrismatic, 0, {-1, 0, 0},
           {{-200, -80, -229}, {200, 80, -200}}),
      link("head", "frame", JointKind::kPrismatic, 2, {0, 0, 1}, {{60, -20, -80}, {90, 20, 20}})};
  return machine;
}

/// With the work zero there in the machine.
inline std::shared_ptr<const MachineModel> drawn_with_arm(const Vec3& zero_mm) {
  Diagnostics diagnostics;
  auto model = linked_machine(machine_with_arm(), shift(zero_mm), diagnostics);
  return std::make_shared<const MachineModel>(std::move(*model));
}

}  // namespace kerf::test
