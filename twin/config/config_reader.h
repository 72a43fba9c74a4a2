// twin/config/config_reader.h - from a checked tree to values: what a value means together with
// others. Parts of read_config().
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/units.h"
#include "twin/config/config_tree.h"
#include "twin/config/key_check.h"
#include "twin/config/live_config.h"

namespace kerf {

/// Values of one group. A key that is absent, or faulty and thereby reported, leaves what was
/// there.
class GroupReader {
 public:
  /// `group` may be null: it is not in the file.
  GroupReader(ConfigNode* group, ConfigFaults& faults) : group_(group), faults_(faults) {}

  bool is_there() const { return group_ != nullptr; }
  ConfigNode* node() const { return group_; }
  ConfigFaults& faults() const { return faults_; }
  /// Null if it is absent or faulty.
  ConfigNode* find(std::string_view key) const;
  /// Faulty or not.
  bool has(std::string_view key) const;
  GroupReader group(std::string_view key) const;

  template <class Value>
  void number(std::string_view key, Value& out) const {
    if (const ConfigNode* node = find(key)) out = static_cast<Value>(node->number);
  }
  template <class Value>
  void number(std::string_view key, std::optional<Value>& out) const {
    if (const ConfigNode* node = find(key)) out = static_cast<Value>(node->number);
  }
  /// Milliseconds into seconds.
  void seconds(std::string_view key, double& out_s) const;
  std::optional<std::string> text(std::string_view key) const;
  /// With the file's folder in front, if it is relative and from the file.
  std::optional<std::string> path(std::string_view key) const;
  /// Position among the words of the key table; -1: absent.
  int word(std::string_view key) const;
  /// "source.rtu: device is missing; must be ...", unless it is there or the group is not.
  void missing(std::string_view key, const std::string& what, std::string hint = {}) const;

 private:
  ConfigNode* group_;
  ConfigFaults& faults_;
};

/// `path` as it is meant in `node`.
std::string resolved_path(const ConfigNode& node, const std::string& path,
                          const ConfigFaults& faults);

/// A note, once a configuration, if the mesh `file` that `node` names lies outside of its folder.
void note_mesh_outside(const ConfigNode& node, const std::string& file, ConfigFaults& faults);

/// A SHAPE or --stock text in which the file after `prefix` ("profile:") is resolved_path().
std::string resolved_spec(const ConfigNode& node, std::string_view prefix,
                          const ConfigFaults& faults);

/// The groups machine, tools, stock, beam and follow, units and turret.
/// A SHAPE text in which the files of profile: and holder=profile: are resolved_path().
std::string resolved_shape(const ConfigNode& node, const ConfigFaults& faults);

void read_workshop(const GroupReader& root, LiveConfig& config);

/// machine.model, machine.links and what belongs to them.
void read_drawn_machine(const GroupReader& machine, MachineChoice& out);

/// machine.kinematics and what belongs to it, after the joints and the links.
void read_kinematics(const GroupReader& machine, ConfigMachine& out);

/// "x,y,z" of a key; what was there if it is absent or faulty.
void read_vector(const GroupReader& group, std::string_view key, Vec3& out);

/// The group source, after machine.
void read_source(const GroupReader& source, LiveConfig& config);

/// The parts of it.
struct MapReading {
  CoordinateKind kind = CoordinateKind::kAxes;
  bool inch = false;
  std::string joints;  ///< the axis of each joint

  /// False: an angle.
  bool is_length(std::size_t index) const;
  /// 25.4 where the position `index` is a length and the file is in inches, else 1.
  double mm_per_unit(std::size_t index) const;
  /// X or J0 to its index; nothing for the other kind.
  std::optional<std::size_t> index_of(const std::string& item) const;
};
void read_modbus(const GroupReader& source, const MapReading& reading, ModbusSettings& settings);
void read_can(const GroupReader& source, const MapReading& reading, CanSourceOptions& options);
/// map, dbc and gather_ms.
void read_can_map(const GroupReader& source, const MapReading& reading, CanMap& map);
void read_hal(const GroupReader& source, const ConfigSourceCommon& common, bool inch,
              HalSettings& settings);
void read_mtconnect(const GroupReader& source, const ConfigSourceCommon& common,
                    const MapReading& reading, MtconnectSettings& settings);
void read_log(const GroupReader& source, const MapReading& reading, LogSettings& settings);

/// Faults that a source found in its settings ("map.X.scale: 0 is not allowed"), each at the value
/// it is about. What has been reported already is not reported again.
void report_faults(const std::vector<std::string>& texts, const GroupReader& source,
                   const MapReading& reading);

/// What a map names, with the index of a position, nothing for tool, line, .. . Axes where joints
/// are meant, and the reverse, are reported.
/// `unit` of the map's load, which has to be there.
LoadUnit read_load_unit(const GroupReader& item);

struct MapItem {
  GroupReader group;
  std::string name;
  std::optional<std::size_t> position;
};
std::vector<MapItem> items_of(const GroupReader& map, const MapReading& reading);

}  // namespace kerf
