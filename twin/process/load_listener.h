// twin/process/load_listener.h - what the cuts of milling tools are like, place by place: for who
// shows it over time, along the path and over the workpiece, or holds a machine against it.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "cutting/material.h"
#include "interp_bridge/motion.h"

namespace kerf {

/// Where teeth are known from kChip on, of a known material from kForce on, where the stick-out is
/// known as well kBend.
enum class LoadKind : std::uint8_t {
  kAngle,   ///< of the tool's edge that is in material, degrees: EngagementLook::angle_rad
  kChip,    ///< greatest thickness, mm
  kForce,   ///< the greatest of a revolution, across the axis, N
  kTorque,  ///< the mean of a revolution, Nm: what the spindle has to have (over-torque)
  kPower,   ///< at the edges, kW
  kBend,    ///< of the tool's tip, mm
};
inline constexpr std::size_t kLoadKinds = 6;

/// Of a part of a feed move.
struct CutLoad {
  double start_s = 0;  ///< program time
  double seconds = 0;
  int tool = 0;
  SourceRef source;
  double rpm = 0;           ///< 0: the spindle stands, or nobody knows
  bool is_engaged = false;  ///< false: the tool is in the air, and all values are 0
  bool is_measured = true;  ///< false: nobody knows how it is engaged
  /// The nominal one is 0: not known. What has no range is the same thrice.
  std::array<ValueRange, kLoadKinds> values{};

  void set(LoadKind kind, const ValueRange& range) {
    values[static_cast<std::size_t>(kind)] = range;
  }
  void set(LoadKind kind, double value) { set(kind, {value, value, value}); }
  const ValueRange& of(LoadKind kind) const { return values[static_cast<std::size_t>(kind)]; }
  /// What it asks of the spindle could be worked out. Not of tools without teeth=N.
  bool has_forces() const { return of(LoadKind::kPower).nominal > 0; }
};

class LoadListener {
 public:
  virtual ~LoadListener() = default;
  /// In program order, some motions late: when what they remove is known.
  virtual void on_load(const CutLoad& load) = 0;
  /// All of it is cut once more: what was told does not count.
  virtual void restart() {}
};

}  // namespace kerf
