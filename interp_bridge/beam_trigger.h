// interp_bridge/beam_trigger.h - when the beam (arc, flame, jet) of a cutting head is on, in the
// words of the machine's programs.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.h"
#include "interp_bridge/motion.h"

namespace kerf {

/// A condition on a step, all terms of which must hold:
///
///     m3        a spindle is on (M3 or M4)          m3:1     spindle 1 is (M3 $1)
///     m4        the spindle is on by M4             s        the S word is above 0
///     m7        mist                                m8       flood
///     m62:0     digital output 0 is set (by M62     m67:0    analog output 0 is above 0 (by M67 or
///               or M64); 0 to 63                             M68 E0); 0 to 3
///     feed      the step is no rapid (G0)           z<-0.5   both ends of it lie at or below Z, mm
///
/// joined by '+'; '!' before a term means its opposite. Two have names:
///
///     plasmac = m3:0+!m62:3     QtPlasmaC: the torch, which M62 P3 puts out
///     laser   = m3+s+feed       power by the S word, rapids dark
///
/// Cutters by how their posts say it: SheetCam, Fusion and gcodetools for plasma, oxy-fuel and
/// water jets m3 (some jets m8); lasers laser, m62:N or m67:N; engravers and routers m3+z<0.
/// Source: the programs of LinuxCNC, and of these posts.
class BeamTrigger {
 public:
  enum class Kind : std::uint8_t {
    kSpindle,
    kCounterclockwise,
    kSpeed,
    kMist,
    kFlood,
    kOutput,
    kAnalog,
    kFeed,
    kBelow
  };
  struct Term {
    Kind kind = Kind::kSpindle;
    bool inverted = false;
    int index = kAny;     ///< of spindle or output
    double level_mm = 0;  ///< kBelow
    bool operator==(const Term&) const = default;
  };
  static constexpr int kAny = -1;
  static constexpr std::size_t kMaxTerms = 16;

  /// m3.
  BeamTrigger() : terms_(1) {}

  /// Any bytes are accepted; letters may be capitals, blanks do not count. Error: "beam trigger
  /// 'm99': ..", with what is allowed.
  static Result<BeamTrigger> parse(std::string_view text);

  /// True if the beam is on during the step. The first step with it on begins where the sheet is
  /// pierced: at its from_mm. The piercing lasts for the dwells (G4) between M3 and the first step
  /// that moves, and on a QtPlasmaC machine for TorchMaterial::pierce_delay_s of
  /// TorchState::material, during which that machine holds the motion itself.
  bool on(const Motion& motion) const;

  const std::vector<Term>& terms() const { return terms_; }

 private:
  std::vector<Term> terms_;
};

}  // namespace kerf
