// tests/twin/machine/kinematics/recorded_places.h - joints and axes as LinuxCNC's kinematics
// modules have them: the files of tests/live/kinematics/record_kinematics.
#pragma once

#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "twin/machine/kinematics/machine_kinematics.h"

namespace kerf {

struct RecordedPlace {
  int type = 0;
  AxisValues axes{};
  AxisValues joints{};
};

struct RecordedMachine {
  std::string kinematics;  ///< [KINS]KINEMATICS
  std::string letters;     ///< what TRAJ.COORDINATES would say; of trivkins from coordinates=
  KinematicsGeometry geometry;
  double tool_mm = 0;  ///< pin "tool-offset", "tool-offset-z"
  std::vector<RecordedPlace> places;
};

inline RecordedMachine read_recorded(const std::string& path) {
  RecordedMachine machine;
  std::ifstream file(path);
  for (std::string line; std::getline(file, line);) {
    if (line.rfind("type", 0) == 0) continue;
    if (line[0] == '#') {
      const std::size_t colon = line.find(": ");
      if (colon != line.npos) {
        machine.kinematics = line.substr(colon + 2);
        continue;
      }
      const std::size_t blank = line.rfind(' ');
      const std::size_t dot = line.find('.');
      const std::string pin = line.substr(dot + 1, blank - dot - 1);
      const double value = std::stod(line.substr(blank));
      (pin.rfind("tool-offset", 0) == 0 ? machine.tool_mm : machine.geometry[pin]) = value;
      continue;
    }
    std::istringstream cells(line);
    RecordedPlace place;
    std::string cell;
    for (std::size_t column = 0; std::getline(cells, cell, ','); ++column) {
      if (column == 0) {
        place.type = std::stoi(cell);
      } else if (column <= kAxisCount) {
        place.axes[column - 1] = std::stod(cell);
      } else {
        place.joints[column - 1 - kAxisCount] = std::stod(cell);
      }
    }
    machine.places.push_back(place);
  }
  return machine;
}

/// How far the model is from what LinuxCNC has: mm and degrees, in both directions.
struct KinematicsErrors {
  double axes = 0;    ///< forward
  double joints = 0;  ///< inverse, where there is one
};

inline KinematicsErrors errors_of(const RecordedMachine& recorded,
                                  const MachineKinematics& machine) {
  KinematicsErrors errors;
  const bool scara = machine.module == "scarakins";
  for (const RecordedPlace& place : recorded.places) {
    const KinematicsMode mode = machine.type(place.type).mode;
    const AxisValues axes = machine.axes_of(place.joints, place.type, recorded.tool_mm);
    for (std::size_t i = 0; i < kAxisCount; ++i) {
      // Tilts of a table that the chain does not have.
      if (scara && mode == KinematicsMode::kArm && (i == 3 || i == 4)) continue;
      double off = axes[i] - place.axes[i];
      if (mode == KinematicsMode::kArm && i >= 3) off = std::remainder(off, 360.0);
      errors.axes = std::max(errors.axes, std::abs(off));
    }
    const auto position = machine.position_of(place.axes, place.type, recorded.tool_mm);
    if (!position) continue;
    for (std::size_t i = 0; i < kAxisCount; ++i) {
      errors.joints = std::max(errors.joints, std::abs(position->joints[i] - place.joints[i]));
    }
  }
  return errors;
}

}  // namespace kerf
