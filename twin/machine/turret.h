// twin/machine/turret.h - a punch press as its user describes it: stations, what makes it strike,
// clamps.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/geometry.h"
#include "base/result.h"
#include "interp_bridge/beam_trigger.h"
#include "interp_bridge/motion.h"
#include "stock/cutter/cutter.h"

namespace kerf {

/// A place in the turret, with what is in it.
struct TurretStation {
  int number = 0;  ///< as the T word has it
  std::string name;
  std::string shape;  ///< as written, "square:10"
  Cutter punch;       ///< punch_cutter(); its spec is "punch:" and the shape
  double angle_deg = 0;
  bool turns = false;   ///< an index station: what TurretIndex says comes on top of angle_deg
  double pitch_mm = 0;  ///< of nibbling; 0: Turret::nibble_pitch_mm
};

/// What turns the punch of an index station: A, B or C of the program, in degrees, or an analog
/// output (M67, M68) that holds the angle.
struct TurretIndex {
  int axis = 2;                 ///< 0, 1, 2: A, B, C
  std::optional<int> analog{};  ///< instead of an axis
};

/// What makes the punch strike.
///
///     m3, m62:0, z<-1, ..   conditions as BeamTrigger has them: when all of them come to hold
///     m100 .. m199          a user M-code, each time
///     g81                   the bottom of a feed straight down, as drilling cycles have it
class PunchTrigger {
 public:
  enum class Kind : std::uint8_t { kState, kUserCode, kPlunge };

  PunchTrigger() = default;
  /// Any bytes are accepted. Error: what was found, and what is allowed.
  static Result<PunchTrigger> parse(std::string_view text);

  Kind kind() const { return kind_; }
  int user_code() const { return user_code_; }
  const BeamTrigger& state() const { return state_; }

 private:
  Kind kind_ = Kind::kState;
  int user_code_ = 0;
  BeamTrigger state_;
};

/// A clamp that holds the sheet, in the sheet's frame as it is before the first re-gripping.
struct SheetClamp {
  Vec2 min_mm{0}, max_mm{0};
  double clearance_mm = 0;  ///< around it, where the punch's holder does not fit either
};

/// The clamps let go, move by `shift_mm` along the sheet, and grip it again: at a user M-code, each
/// time, or once before the first step of a line of the program.
struct Regrip {
  int user_code = 0;
  std::uint32_t line = 0;
  Vec2 shift_mm{0};
};

/// How long a press takes for what its program has no words for, s. 0: no time.
struct PunchTimes {
  double stroke_s = 0;  ///< the punch down and up again, while the sheet stands
  /// Of nibbling: from stroke to stroke at least, by the pitch in mm.
  std::map<double, double> period_by_pitch_s;
  int places = 0;       ///< round the turret, numbered as the stations: it goes the shorter way. 0:
                        ///< it turns back, from its last station to its first
  double step_s = 0;    ///< the turret from a place to the next one
  double lock_s = 0;    ///< beside that, for each change of station
  double regrip_s = 0;  ///< each re-gripping

  bool any() const {
    return stroke_s > 0 || !period_by_pitch_s.empty() || step_s > 0 || lock_s > 0 || regrip_s > 0;
  }
  /// From stroke to stroke at least. Straight between two pitches; beyond the first and the last as
  /// at these.
  double period_s(double pitch_mm) const;
  /// A change of station; `from` 0: it is not known where the turret stood, and its way is not
  /// counted.
  double change_s(int from, int to) const;
};

/// Values; shared by all that look at the program.
struct Turret {
  std::string path;  ///< of the file, for messages
  std::map<int, TurretStation> stations;
  TurretIndex index;
  PunchTrigger trigger;
  /// While a condition holds the punch strikes at the end of every move, too.
  bool strikes_at_ends = false;
  double nibble_pitch_mm = 0;          ///< 0: feeds do not nibble
  std::optional<BeamTrigger> nibbles;  ///< while it holds; absent: while the trigger does
  std::vector<SheetClamp> clamps;
  std::vector<Regrip> regrips;
  bool sheet_moves = true;  ///< else the head
  PunchTimes times;

  const TurretStation* station(int tool) const {
    const auto found = stations.find(tool);
    return found == stations.end() ? nullptr : &found->second;
  }
  /// Of nibbling with a tool; 0: its feeds do not nibble.
  double pitch_mm(int tool) const {
    const TurretStation* const in = station(tool);
    return in != nullptr && in->pitch_mm > 0 ? in->pitch_mm : nibble_pitch_mm;
  }
  /// The M-codes that it knows.
  std::vector<int> user_codes() const;
};
using TurretPointer = std::shared_ptr<const Turret>;

}  // namespace kerf
