// machine_io/mtconnect/device_model.h - what an agent's /probe says of its machines.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.h"
#include "machine_io/mtconnect/agent_time.h"
#include "machine_io/mtconnect/mtconnect_settings.h"
#include "machine_io/mtconnect/xml_tree.h"

namespace kerf {

/// The head of every answer.
struct AgentHeader {
  std::uint64_t instance = 0;  ///< another one: the agent has begun anew
  AgentTime created;
  std::uint64_t buffer = 0;           ///< observations that it keeps
  std::uint64_t first = 0, next = 0;  ///< of streams: the oldest that it has; the one to come
  std::string sender;
};

/// Error: "the answer has no Header", or which attribute is none.
Result<AgentHeader> read_agent_header(const XmlElement& root, bool with_sequences);

/// The agent's own words, where the answer is an MTConnectError: "OUT_OF_RANGE: from is too old".
std::optional<std::string> agent_error_of(const XmlElement& root);

struct DataItem {
  std::string id, name;
  std::string type;           ///< "POSITION"
  std::string sub_type;       ///< "ACTUAL", "COMMANDED", ..
  std::string units;          ///< of the values that are told; native ones have become these
  std::string coordinates;    ///< "MACHINE", "WORK"; empty: the type's own
  bool is_plain = true;       ///< false: a data set, a table, a time series
  std::size_t component = 0;  ///< in DeviceModel::components
};

struct DeviceComponent {
  std::string kind;  ///< "Linear", "Rotary", "Path", ..
  std::string name, native_name;
  std::optional<double> least, most;  ///< mm or degrees, of its travel
};

/// LinuxCNC's own words (x:Kinematics): what the standard has no place for.
struct LinuxcncKinematics {
  std::string module;  ///< "xyzac-trt-kins"
  std::string params;  ///< "coordinates=XYZAC"
};

struct DeviceModel {
  std::string name, uuid;
  std::vector<DeviceComponent> components;
  std::vector<DataItem> items;
  std::optional<LinuxcncKinematics> kinematics;
};

struct DevicesAnswer {
  AgentHeader header;
  std::vector<DeviceModel> devices;  ///< machines; the agent's entry for itself is left out
};

/// Error: not XML, not an answer to /probe, or the agent's own error.
Result<DevicesAnswer> parse_probe(std::string_view text);

/// The device that the settings name; the only one if they name none. Error: which there are.
Result<const DeviceModel*> choose_device(const DevicesAnswer& probe, const std::string& wanted);

/// What is taken of a data item: value * scale + offset, in mm, degrees or rpm.
struct TakenItem {
  std::string id;
  double scale = 1;
  double offset = 0;
};

/// Which data items mean what.
struct ItemPlan {
  std::array<std::optional<TakenItem>, kMaxPositions> axes;
  std::optional<TakenItem> path_position;  ///< X Y Z as one, where the axes have none of their own
  std::optional<TakenItem> spindle, load, tool_offset_z, tool, line;
  std::string execution, mode, availability, direction;  ///< ids; empty: it has none
  std::string tool_offsets;  ///< id of LinuxCNC's table of the offset that is applied
  /// Of the axes' travel, mm or degrees; what /probe does not say is nothing.
  std::array<std::optional<double>, kMaxPositions> least, most;

  /// "X Y Z C"
  std::string letters() const;
};

/// Error: no position at all (with what there is instead), two axes of one letter, a unit that is
/// not known, a data item that does not exist.
Result<ItemPlan> plan_items(const DeviceModel& device, const MtconnectSettings& settings);

}  // namespace kerf
