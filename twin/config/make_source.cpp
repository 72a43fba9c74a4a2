#include "twin/config/make_source.h"

#include <fmt/format.h>

#include <utility>

#include "base/translate.h"
#include "machine_io/modbus/modbus_source.h"
#include "machine_io/mtconnect/mtconnect_source.h"
#include "twin/config/key_table.h"

namespace kerf {
namespace {

/// The joints that count degrees.
std::uint16_t rotary_joints(const ConfigMachine& machine) {
  if (machine.turning_joints) return *machine.turning_joints;
  const std::string_view letters =
      machine.joints.empty() ? kAllAxes : std::string_view(machine.joints);
  std::uint16_t mask = 0;
  for (std::size_t i = 0; i < letters.size() && i < kMaxPositions; ++i) {
    if (letters[i] >= 'A' && letters[i] <= 'C') {
      mask = static_cast<std::uint16_t>(mask | 1U << i);
    }
  }
  return mask;
}

Diagnostic general(std::string message, std::string hint = {}) {
  return {Severity::kError, {}, 0, 0, std::move(message), {}, std::move(hint)};
}

/// Makes each kind, and reports what only a look at the world can tell.
struct Maker {
  const LiveConfig& config;
  Diagnostics& diagnostics;

  std::unique_ptr<PositionSource> operator()(const std::monostate&) const {
    diagnostics.push_back(general(tr("the configuration has no source"),
                                  tr("`kerf config schema` lists the keys of `source:`")));
    return nullptr;
  }
  std::unique_ptr<PositionSource> operator()(const ModbusSettings& settings) const {
    return std::make_unique<ModbusSource>(settings);
  }
  std::unique_ptr<PositionSource> operator()(const CanSourceOptions& options) const {
    return std::make_unique<CanSource>(options);
  }
  std::unique_ptr<PositionSource> operator()(const MtconnectSettings& settings) const {
    return std::make_unique<MtconnectSource>(settings);
  }
  std::unique_ptr<PositionSource> operator()(HalSettings settings) const {
    settings.rotary_joints = rotary_joints(config.machine);
    const std::vector<std::string> faults = validate(settings);
    for (const std::string& fault : faults) diagnostics.push_back(general(fault));
    if (!faults.empty()) return nullptr;
    return std::make_unique<HalSource>(settings);
  }
  std::unique_ptr<PositionSource> operator()(LogSettings settings) const {
    settings.rotary_joints = rotary_joints(config.machine);
    std::unique_ptr<LogSource> log = LogSource::open(std::move(settings), diagnostics);
    if (log == nullptr) return nullptr;
    const std::optional<CoordinateKind> columns = log->contents().kind;
    const std::optional<CoordinateKind> wanted = config.common.coordinates;
    if (columns && wanted && *columns != *wanted) {
      const bool joints = *columns == CoordinateKind::kJoints;
      diagnostics.push_back(
          general(trf("source.coordinates: {}, but the columns of {} are {}",
                      joints ? "axes" : "joints", log->describe(), joints ? "joints" : "axes"),
                  tr("leave the key away: the columns say it themselves")));
      return nullptr;
    }
    return log;
  }
};

}  // namespace

std::unique_ptr<PositionSource> make_source(const LiveConfig& config, Diagnostics& diagnostics) {
  return std::visit(Maker{config, diagnostics}, config.source);
}

CoordinateKind coordinates_of(const LiveConfig& config, const PositionSource& source) {
  if (dynamic_cast<const HalSource*>(&source) != nullptr) return CoordinateKind::kJoints;
  if (const auto* const log = dynamic_cast<const LogSource*>(&source)) {
    if (log->contents().kind) return *log->contents().kind;
  }
  return config.common.coordinates.value_or(CoordinateKind::kAxes);
}

std::optional<LoadUnit> load_unit_of(const LiveConfig& config, const PositionSource& source) {
  if (const auto* const log = dynamic_cast<const LogSource*>(&source)) return log->contents().load;
  const auto unit_if = [](const auto& load, LoadUnit unit) {
    return load ? std::optional(unit) : std::nullopt;
  };
  if (const auto* modbus = std::get_if<ModbusSettings>(&config.source))
    return unit_if(modbus->load, modbus->load_unit);
  if (const auto* can = std::get_if<CanSourceOptions>(&config.source))
    return unit_if(can->map.load, can->map.load_unit);
  if (const auto* agent = std::get_if<MtconnectSettings>(&config.source))
    return unit_if(agent->load, agent->load_unit);
  const auto* const hal = std::get_if<HalSettings>(&config.source);
  return hal && hal->load ? std::optional(hal->load->unit) : std::nullopt;
}

LiveFrameOptions frame_for(const LiveConfig& config, const PositionSource& source) {
  LiveFrameOptions frame;
  if (coordinates_of(config, source) == CoordinateKind::kJoints && !config.machine.joints.empty()) {
    frame.axis.fill(-1);
    for (std::size_t i = 0; i < config.machine.joints.size(); ++i) {
      frame.axis[i] = static_cast<int>(kAllAxes.find(config.machine.joints[i]));
    }
  }
  CoordinateFrame measured = CoordinateFrame::kMachine;
  if (const auto* const log = dynamic_cast<const LogSource*>(&source)) {
    if (log->contents().recording) measured = log->contents().recording->frame;
  }
  frame.workpiece_frame = config.common.frame.value_or(measured) == CoordinateFrame::kWorkpiece;
  if (config.machine.work_offset) frame.work = *config.machine.work_offset;
  frame.tool_length = config.machine.tool_length;
  frame.tool = config.machine.tool.value_or(-1);
  return frame;
}

}  // namespace kerf
