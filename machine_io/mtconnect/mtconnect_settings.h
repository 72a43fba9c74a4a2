// machine_io/mtconnect/mtconnect_settings.h - which agent, which of its devices, and what of it.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "machine_io/position_source.h"

namespace kerf {

/// A data item that the configuration names, instead of the one that /probe leads to.
struct ChosenItem {
  std::string item;  ///< its id, or its name
  double scale = 1;  ///< beside the units that /probe says; not 0
  double offset = 0;
};

/// Everything about one agent. Defaults are what most agents have.
struct MtconnectSettings {
  std::string url;     ///< "http://192.168.1.7:5000"; https too
  std::string device;  ///< name or uuid; empty: the only one that the agent has
  /// Positions that the machine is told to take, instead of those that it measures.
  bool commanded = false;
  /// Positions in the coordinates of the workpiece, instead of the machine's.
  bool workpiece = false;
  int interval_ms = 50;    ///< between two looks of the agent for something new; 0..10000
  int heartbeat_ms = 200;  ///< where nothing is new, a sign of life so often; 10..60000
  double gather_ms = 2;    ///< what is stamped within this time is one sample; 0..1000

  /// Where any is given, these are all that the machine has.
  std::array<std::optional<ChosenItem>, kMaxPositions> axes;
  std::optional<ChosenItem> tool, line, spindle, tool_offset_z;
  std::optional<ChosenItem> load;  ///< of the spindle, in load_unit; without it none is told
  LoadUnit load_unit = LoadUnit::kPercentOfPower;

  bool chooses_axes() const;
};

/// Every fault in the settings, one text each: key, value found, what is allowed. Empty: they can
/// be used.
std::vector<std::string> validate(const MtconnectSettings& settings);

}  // namespace kerf
