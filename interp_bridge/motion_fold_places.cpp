// What MotionFold knows of where the axes stand: of X, Y and Z, as bits 0, 1, 2.
#include <cmath>
#include <utility>

#include "base/portable_math.h"
#include "base/units.h"
#include "interp_bridge/held_feed.h"
#include "interp_bridge/motion_fold.h"
#include "interp_bridge/motion_fold_math.h"

namespace kerf {
namespace {

using Place = BlockWords::Place;
using Speed = BlockWords::Speed;

constexpr std::uint8_t kX = 1;
constexpr std::uint8_t kXy = 3;
constexpr std::uint8_t kXyz = 7;
constexpr std::uint8_t kZ = 4;

/// Of one place, said twice by rs274 under different offsets.
constexpr double kSamePlace_mm = 6e-4;
/// A touch plate is thicker, and a workpiece's top so near to Z0 is there.
constexpr double kLeastPlate_mm = 0.5;
constexpr double kSameTop_mm = 0.05;

std::uint8_t without(std::uint8_t axes, std::uint8_t others) {
  return static_cast<std::uint8_t>(axes & ~others & kXyz);
}

/// Whether a motion of this kind can be that of a block that says G0, or G1.
bool agrees(Speed said, MotionKind kind) {
  return said == Speed::kUnsaid || (said == Speed::kRapid) == (kind == MotionKind::kTraverse);
}

}  // namespace

void MotionFold::start_unknown(const std::array<double, 9>& machine_position, std::uint8_t axes,
                               std::uint8_t zero_known, std::uint8_t matters) {
  stands_at_ = machine_position;
  follows_places_ = true;
  matters_ = matters;
  placed_ = without(kXyz, axes);
  zero_known_ = zero_known;
  for (std::size_t i = 0; i < 3; ++i) {
    if ((axes & kX << i) != 0) place_[i] = unsaid(false);
    machine_place_[i] = unsaid(false);
  }
  settle();
}

void MotionFold::lose(std::uint8_t axes) {
  if (!follows_places_) {
    follows_places_ = true;
    placed_ = placed_before_probe_ = zero_known_ = kXyz;
  }
  placed_ &= placed_before_probe_ | ~axes;
  probed_ |= axes;
  lose_place(axes);
  lengths_.take_stated_as_measured();
}

/// `held_before`: held_axes_ ahead of it.
void MotionFold::hold_back(const Motion& feed, std::uint8_t held_before) {
  if (!is_held_back(feed)) return;
  const bool joined = feed.halts == 0 && feed.chain_end == ChainEnd::kNone;
  if (joined && feed.merge_tolerance_mm > 0) held_axes_ = held_before;
  for (int i = 0; i < 3; ++i) {
    const bool turns = feed.kind == MotionKind::kArc && i < 2;
    const bool moved = turns || feed.from_mm[i] != feed.to_mm[i];
    if (moved) held_axes_ = static_cast<std::uint8_t>(held_axes_ | kX << i);
  }
  if (feed.source == numbered_at_ && feed.source.line != 0) lose_held_feed(held_axes_);
}

/// M61 or G10 L0 has come: the feed is forgotten, and the program is read on from where the machine
/// stands. How far it has come is not known here, since feeds may have been merged.
void MotionFold::lose_held_feed(std::uint8_t axes) {
  if (axes == 0) return;
  if (!follows_places_) {
    follows_places_ = true;
    placed_ = placed_before_probe_ = zero_known_ = kXyz;
  }
  for (std::size_t i = 0; i < 3; ++i) {
    if ((axes & kX << i) != 0) place_[i] = unsaid(false);
  }
  settle();
}

/// It is somewhere else, and what is there has nothing to do with the workpiece.
void MotionFold::lose_place(std::uint8_t axes) {
  if (axes == 0) return;
  for (std::size_t i = 0; i < 3; ++i) {
    if ((axes & kX << i) != 0) place_[i] = unsaid(true);
  }
  settle();
}

/// After any change of places or offsets.
void MotionFold::settle() {
  const System& system = system_in_force();
  unknown_ = unrelated_ = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto bit = static_cast<std::uint8_t>(kX << i);
    in_force_[i] = system.place[i];
    if (shifted_) in_force_[i] = in_force_[i] + shift_[i];
    const bool placed = (placed_ & bit) != 0;
    if (!placed || place_[i] != work_place_[i]) unknown_ |= bit;
    if (placed && in_force_[i] != work_place_[i]) unrelated_ |= bit;
  }
  unknown_ &= matters_;
  unrelated_ &= matters_;
}

/// The axis stands at such a place now. The first one of which something is known is what the
/// workpiece lies in.
void MotionFold::place_in(const UnknownSum& place, int axis) {
  const auto bit = static_cast<std::uint8_t>(kX << axis);
  const auto i = static_cast<std::size_t>(axis);
  place_[i] = place;
  if ((placed_ & bit) != 0 || place.is_doubtful() || place != in_force_[i]) return;
  work_place_[i] = place;
  placed_ |= bit;
}

std::uint8_t MotionFold::changed_axes(const Vec3& to_mm) const {
  std::uint8_t changed = 0;
  for (int i = 0; i < 3; ++i) {
    if (std::abs(to_mm[i] - position_mm_[i]) <= kSamePlace_mm) continue;
    changed = static_cast<std::uint8_t>(changed | kX << i);
  }
  return changed;
}

/// The motion goes where its block's numbers, or none, are of the machine. A motion that cutter
/// compensation has held back comes with the words of a later block, and is told by its kind.
bool MotionFold::is_at_machine_place(const Motion& motion) {
  switch (block_->place) {
    case Place::kProgram:
      return false;
    case Place::kMachine:
      return agrees(block_->speed, motion.kind);
    case Place::kReference:
      if (motion.kind != MotionKind::kTraverse) return false;
      // Two each: to the place that the block names, and from there.
      if (!(motion.source == reference_) || reference_moves_ == 2) reference_moves_ = 0;
      reference_ = motion.source;
      return ++reference_moves_ == 2;
    case Place::kToolChange:
      return true;
  }
  return false;
}

std::uint8_t MotionFold::unknown_after(Motion& motion, Vec3& to_mm) {
  const std::uint8_t changed = changed_axes(to_mm);
  if (motion.kind == MotionKind::kProbe) placed_before_probe_ = placed_;
  const bool has_block = block_ != nullptr;
  const std::uint8_t doubtful = has_block ? block_->computed & probed_ : 0;
  std::uint8_t named = 0;
  std::uint8_t to_machine = 0;
  Place place = Place::kProgram;
  if (has_block) {
    named = agrees(block_->speed, motion.kind) ? block_->named : std::uint8_t{0};
    place = block_->place;
  }
  if (has_block && is_at_machine_place(motion)) {
    to_machine = changed;
    if (place == Place::kMachine) to_machine |= named;
    if (place == Place::kReference) to_machine |= named != 0 ? named : kXyz;
    if (place == Place::kToolChange) {
      to_machine = without(changed, named);
    } else {
      named = 0;
    }
  }
  if (to_machine != 0) {
    if (place == Place::kReference) {
      go_to_stored(to_machine, to_mm);
    } else {
      go_to_machine(to_machine);
    }
    settle();
    motion.to_machine_place = (to_machine & unknown_) != 0;
  }
  if (!has_block || !incremental_ || place == Place::kMachine) {
    // An axis that moves without being named is one that a block before has placed (cycles), or
    // that compensation has held back. Or rs274 has found out that its probe has backed off.
    std::uint8_t moved = changed;
    for (std::size_t i = 0; has_block && i < 3; ++i) {
      if (place_[i].is_doubtful()) moved = without(moved, static_cast<std::uint8_t>(kX << i));
    }
    const std::uint8_t said = without(named | moved, to_machine | doubtful);
    for (int i = 0; i < 3; ++i) {
      if ((said & kX << i) != 0) place_in(in_force_[static_cast<std::size_t>(i)], i);
    }
  }
  for (std::size_t i = 0; i < 3; ++i) {
    if ((doubtful & kX << i) != 0) place_[i] = unsaid(true);
  }
  settle();
  return unknown_;
}

void MotionFold::go_to_machine(std::uint8_t axes) {
  for (int i = 0; i < 3; ++i) {
    if ((axes & kX << i) == 0) continue;
    const bool known = (zero_known_ & kX << i) != 0;
    place_in(known ? UnknownSum() : machine_place_[static_cast<std::size_t>(i)], i);
  }
}

void MotionFold::store(const BlockWords& block) {
  if (block.store != BlockWords::Store::kNone) {
    store_reference(block.store == BlockWords::Store::kSecond);
  } else {
    store_system(block);
  }
}

void MotionFold::store_reference(bool second) {
  StoredPlace& stored = stored_places_[second ? 1 : 0];
  stored = {true, place_, lengths_.applied_mm(), length_call_};
  const bool turned = work_.rotation_deg != 0 || frame_.rotation_deg != 0;
  if (!turned || (unknown_ & kXy) == 0) return;
  stored.place[0] = unsaid(false);
  stored.place[1] = unsaid(false);
}

/// G28 or G30: where the program has stored the place it is the one at which the machine stood. The
/// interpreter knows it by its own coordinates of the machine.
void MotionFold::go_to_stored(std::uint8_t axes, Vec3& to_mm) {
  const StoredPlace& stored = stored_places_[block_->second_reference ? 1 : 0];
  if (!stored.is_stored) {
    go_to_machine(axes);
    return;
  }
  for (int i = 0; i < 3; ++i) {
    if ((axes & kX << i) != 0) place_in(stored.place[static_cast<std::size_t>(i)], i);
  }
  if ((axes & kZ) == 0) return;
  // Another tool's tip is elsewhere there. By how much is not known without a tool table.
  if (!lengths_.checks() && stored.length_call != length_call_) place_[2] = unsaid(false);
  if (lengths_.checks() && lengths_.is_hidden()) {
    const Vec3 shift_mm = along_work(stored.applied_mm - lengths_.applied_mm());
    if (shift_mm != Vec3{0}) held_z_mm_ = program_from_work(to_mm).z;
    to_mm += shift_mm;
  }
}

/// As look_for_plate(), of a system that is not in force: what the program says in the present one
/// stays where it is.
void MotionFold::store_plate(const BlockWords& block) {
  if (block.system < 0 || (block.named & kZ) == 0) return;
  double& plate_mm = systems_[static_cast<std::size_t>(block.system)].plate_mm;
  plate_mm = 0;
  if (!on_workpiece_ || block.offset != BlockWords::Offset::kTouchOff || (block.computed & kZ) != 0)
    return;
  const double said_mm = block.z * unit_mm_;
  if (std::abs(position_mm_.z) > kSameTop_mm || said_mm < kLeastPlate_mm) return;
  plate_mm = plate_mm_ = said_mm;
  has_plate_ = true;
}

/// Of the system in force follow_offset() takes care.
void MotionFold::store_system(const BlockWords& block) {
  if (block.system == 0 || block.system == g5x_index_) return;
  if (block.system >= static_cast<int>(kSystems)) return;
  store_plate(block);
  if (!follows_places_) return;
  systems_before_ = systems_;
  const bool touches_off = block.offset == BlockWords::Offset::kTouchOff;
  const std::uint8_t doubtful = block.computed & probed_;
  const bool plate = (block.computed & kZ) == 0 && block.z * unit_mm_ >= kLeastPlate_mm;
  if (touches_off) stand_on_plate(without(block.named, doubtful), plate);
  for (std::size_t i = 0; i < 3; ++i) {
    if ((block.named & kX << i) == 0) continue;
    UnknownSum place = touches_off ? place_[i] : UnknownSum();
    if (touches_off && shifted_) place = place - shift_[i];
    if ((doubtful & kX << i) != 0) place = unsaid(true);
    for (int system = 1; system < static_cast<int>(kSystems); ++system) {
      if (system == g5x_index_ || (block.system > 0 && system != block.system)) continue;
      UnknownSum& of_system = systems_[static_cast<std::size_t>(system)].place[i];
      // With a computed P it is one of them.
      const bool sure = block.system > 0 || of_system == place;
      of_system = sure ? place : unsaid(true);
    }
  }
}

/// What a probe has met that nobody knows says nothing. But where the program calls it by the
/// height of a touch plate that lies on the workpiece.
void MotionFold::stand_on_plate(std::uint8_t axes, bool plate) {
  if (plate && (axes & kZ) != 0 && place_[2].is_doubtful()) place_[2] = unsaid(false);
}

/// Where the tip stands, in the numbers of the offsets that have just been set.
double MotionFold::said_height_mm() const {
  return position_mm_.z + work_.g5x_mm.z + work_.g92_mm.z - frame_.g5x_mm.z - frame_.g92_mm.z;
}

/// The model knows of no touch plate: the probe has come down to the workpiece. If that is at Z0 of
/// the blank, and the program calls the place by more, it reckons with a plate: the tip stands so
/// much higher, and Z0 is the workpiece's top as before.
void MotionFold::look_for_plate(bool is_shift) {
  if (!std::exchange(on_workpiece_, false) || block_ == nullptr || (block_->named & kZ) == 0) {
    return;
  }
  const BlockWords::Offset how = block_->offset;
  const bool by_probe = how == BlockWords::Offset::kMachine && (block_->computed & kZ) != 0;
  if (is_shift ? how != BlockWords::Offset::kShift
               : how != BlockWords::Offset::kTouchOff && !by_probe) {
    return;
  }
  const double said_mm = said_height_mm();
  if (std::abs(position_mm_.z) > kSameTop_mm || said_mm < kLeastPlate_mm) return;
  plate_mm_ = said_mm;
  work_.g5x_mm.z -= said_mm;
  position_mm_.z += said_mm;
}

/// An offset of the program has just changed.
void MotionFold::follow_offset(CanonicalName name, int system) {
  const bool is_shift = name == CanonicalName::kSetG92Offset;
  if (!is_shift && has_plate_ && system > 0 && system < static_cast<int>(kSystems)) {
    // What the interpreter says of the system hangs on where it takes the tool to be.
    double& plate_mm = systems_[static_cast<std::size_t>(system)].plate_mm;
    const bool by_numbers = block_ != nullptr && block_->offset == BlockWords::Offset::kMachine &&
                            (block_->named & kZ) != 0;
    if (by_numbers) plate_mm = 0;
    frame_.g5x_mm.z += plate_mm;
  }
  look_for_plate(is_shift);
  if (!follows_places_) return;
  if (!is_shift && system != g5x_index_) {
    g5x_index_ = system;
    zero_known_ = without(zero_known_, zero_by_program_);
    zero_by_program_ = 0;
  }
  if (block_ != nullptr) follow_offset_words(is_shift);
  settle();
}

/// .. by the words of its block.
void MotionFold::follow_offset_words(bool is_shift) {
  // A G10 whose P is computed has set the system in force.
  if (!is_shift && block_->system < 0) systems_ = systems_before_;
  const std::uint8_t named = block_->named;
  const std::uint8_t doubtful = block_->computed & probed_;
  switch (block_->offset) {
    case BlockWords::Offset::kNone:
      return;
    case BlockWords::Offset::kShift:
      if (!is_shift) return;
      if (!std::exchange(shifted_, true)) shift_ = {};
      return touch_off(named, doubtful, true);
    case BlockWords::Offset::kLocal:
      if (!is_shift) return;
      if (!std::exchange(shifted_, true)) shift_ = {};
      for (std::size_t i = 0; i < 3; ++i) {
        if ((named & kX << i) == 0) continue;
        shift_[i] = (doubtful & kX << i) != 0 ? unsaid(true) : UnknownSum();
      }
      return;
    case BlockWords::Offset::kUnshift:
      shift_ = {};
      shifted_ = false;
      return;
    case BlockWords::Offset::kSuspend:
      shifted_ = false;
      return;
    case BlockWords::Offset::kReshift:
      shifted_ = true;
      return;
    case BlockWords::Offset::kTouchOff:
      if (!is_shift) touch_off(named, doubtful, false);
      return;
    case BlockWords::Offset::kMachine:
      if (is_shift) return;
      for (std::size_t i = 0; i < 3; ++i) {
        if ((named & kX << i) == 0) continue;
        system_in_force().place[i] = (doubtful & kX << i) != 0 ? unsaid(true) : UnknownSum();
      }
      zero_by_program_ |= without(named, placed_ | zero_known_);
      zero_known_ |= zero_by_program_;
      return;
  }
}

/// The program has given numbers to the place where the machine stands: what is known of it is now
/// known of the offset. An axis that nothing has placed before is placed by it.
void MotionFold::touch_off(std::uint8_t axes, std::uint8_t doubtful, bool by_shift) {
  if (work_fixed_) adopt_frame();
  stand_on_plate(without(axes, doubtful), said_height_mm() >= kLeastPlate_mm);
  System& system = system_in_force();
  for (std::size_t i = 0; i < 3; ++i) {
    if ((axes & kX << i) == 0) continue;
    const UnknownSum place = (doubtful & kX << i) != 0 ? unsaid(true) : place_[i];
    if (by_shift) {
      shift_[i] = place - system.place[i];
    } else {
      system.place[i] = shifted_ ? place - shift_[i] : place;
    }
    in_force_[i] = place;
    if ((doubtful & kX << i) == 0) place_in(place, static_cast<int>(i));
  }
}

/// The workpiece frame is that in which the program first writes: of an axis that no block has
/// placed yet it follows the offsets.
void MotionFold::adopt_frame() {
  const bool is_turned = work_.rotation_deg != 0 || frame_.rotation_deg != 0;
  std::uint8_t free = without(kXyz, placed_);
  if (is_turned && (free & kXy) != kXy) free &= kZ;
  if (free == 0) return;
  const auto cosine = [](double degrees) { return portable::cos(degrees * kRadPerDeg); };
  const auto sine = [](double degrees) { return portable::sin(degrees * kRadPerDeg); };
  double degrees = work_.rotation_deg;
  const Vec3 machine_mm =
      turned(position_mm_ + work_.g92_mm, cosine(degrees), sine(degrees)) + work_.g5x_mm;
  for (int i = 0; i < 3; ++i) {
    if ((free & kX << i) == 0) continue;
    work_.g5x_mm[i] = frame_.g5x_mm[i];
    work_.g92_mm[i] = frame_.g92_mm[i];
  }
  if ((free & kXy) == kXy) work_.rotation_deg = frame_.rotation_deg;
  degrees = work_.rotation_deg;
  const Vec3 here_mm =
      turned(machine_mm - work_.g5x_mm, cosine(degrees), -sine(degrees)) - work_.g92_mm;
  for (int i = 0; i < 3; ++i) {
    if ((free & kX << i) != 0) position_mm_[i] = here_mm[i];
  }
}

void MotionFold::note_distance_mode(std::string_view comment) {
  constexpr std::string_view kMode = "interpreter: distance mode changed to ";
  if (comment.substr(0, kMode.size()) != kMode) return;
  incremental_ = comment.substr(kMode.size()) == "incremental";
}

}  // namespace kerf
