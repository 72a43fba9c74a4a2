// twin/config/make_source.h - from a configuration to a source of positions.
#pragma once

#include <memory>
#include <optional>

#include "base/diagnostic.h"
#include "machine_io/position_source.h"
#include "twin/config/live_config.h"
#include "twin/live/live_frame.h"

namespace kerf {

/// The source that `config.source` describes. Modbus, CAN and HAL connect when they are first
/// asked; a log is opened here, and read as far as its first sample. Null, with diagnostics: there
/// is no source in the configuration, the log cannot be read, or its columns are joints where the
/// configuration says axes (or the reverse).
std::unique_ptr<PositionSource> make_source(const LiveConfig& config, Diagnostics& diagnostics);

/// Joints or axes, as far as source and configuration tell; a log says it itself.
CoordinateKind coordinates_of(const LiveConfig& config, const PositionSource& source);

/// Of the spindle's load; nothing where the source has none.
std::optional<LoadUnit> load_unit_of(const LiveConfig& config, const PositionSource& source);

/// How the samples of `source` (which make_source() made of `config`) are to be read. All of
/// LiveFrameOptions but the lengths of the tool table. Joints are the axes of machine.joints,
/// XYZABCUVW where that is not given.
LiveFrameOptions frame_for(const LiveConfig& config, const PositionSource& source);

}  // namespace kerf
