// twin/process/load_listener.h - what the cuts of milling tools are like, place by place: for who
// shows it over time, along the path and over the workpiece.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

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

/// Of a part of a feed move on which a tool is engaged.
struct CutLoad {
  struct Value {
    double nominal = 0;  ///< 0: not known
    double high = 0;     ///< end of its range; of what has none `nominal`
  };
  double start_s = 0;  ///< program time
  double seconds = 0;
  std::array<Value, kLoadKinds> values{};

  void set(LoadKind kind, double nominal, double high) {
    values[static_cast<std::size_t>(kind)] = {nominal, high};
  }
  const Value& of(LoadKind kind) const { return values[static_cast<std::size_t>(kind)]; }
};

class LoadListener {
 public:
  virtual ~LoadListener() = default;
  /// In program order, some motions late: when what they remove is known.
  virtual void on_load(const CutLoad& load) = 0;
  /// All of it is cut once more: what was told does not count.
  virtual void restart() = 0;
};

}  // namespace kerf
