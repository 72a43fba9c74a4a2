// What MotionFold knows of where the axes stand: of X, Y and Z, as bits 0, 1, 2.
#include <cmath>
#include <utility>

#include "interp_bridge/motion_fold.h"

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

/// About Z, by an angle whose sine and cosine they are.
Vec3 turned_by(const Vec3& p, double cosine, double sine) {
  return {cosine * p.x - sine * p.y, sine * p.x + cosine * p.y, p.z};
}

}  // namespace

void MotionFold::start_unknown(const std::array<double, 9>& machine_position, std::uint8_t axes,
                               std::uint8_t zero_known) {
  stands_at_ = machine_position;
  follows_places_ = true;
  unknown_ = axes;
  placed_ = without(kXyz, axes);
  zero_known_ = zero_known;
}

void MotionFold::lose(std::uint8_t axes) {
  if (!follows_places_) {
    follows_places_ = true;
    placed_ = placed_before_probe_ = zero_known_ = kXyz;
  }
  placed_ &= placed_before_probe_ | ~axes;
  probed_ |= axes;
  unknown_ |= axes;
  lengths_.take_stated_as_measured();
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
  if (block_ == nullptr) {
    placed_ |= changed;
    return without(unknown_, changed);
  }
  const std::uint8_t unrelated = shift_unrelated_ | system_unrelated_;
  const std::uint8_t doubtful = block_->computed & probed_;
  std::uint8_t unknown = unknown_ | doubtful;
  std::uint8_t named = agrees(block_->speed, motion.kind) ? block_->named : std::uint8_t{0};
  const Place place = block_->place;
  std::uint8_t to_machine = 0;
  if (is_at_machine_place(motion)) {
    to_machine = changed;
    if (place == Place::kMachine) to_machine |= named;
    if (place == Place::kReference) to_machine |= named != 0 ? named : kXyz;
    if (place == Place::kToolChange) {
      to_machine = without(changed, named);
    } else {
      named = 0;
    }
  }
  std::uint8_t lost = to_machine & (without(kXyz, zero_known_) | unrelated);
  if (to_machine != 0 && place == Place::kReference) lost = go_to_stored(to_machine, lost, to_mm);
  motion.to_machine_place = lost != 0;
  const std::uint8_t found = without(to_machine, lost | doubtful);
  placed_ |= found;
  unknown = without(unknown, found) | lost;
  if (incremental_ && place != Place::kMachine) return unknown;
  // An axis that moves without being named is one that a block before has placed (cycles), or that
  // compensation has held back.
  const std::uint8_t said = without(named | changed, to_machine | doubtful);
  placed_ |= without(said, unrelated);
  return without(unknown, said) | (said & unrelated);
}

void MotionFold::store(const BlockWords& block) {
  if (block.store != BlockWords::Store::kNone) {
    store_reference(block.store == BlockWords::Store::kSecond);
  } else {
    store_system(block);
  }
}

void MotionFold::store_reference(bool second) {
  StoredPlace& place = stored_places_[second ? 1 : 0];
  place = {true, without(kXyz, unknown_), lengths_.applied_mm(), length_call_};
  const bool turned = work_.rotation_deg != 0 || frame_.rotation_deg != 0;
  if (turned && (place.known & kXy) != kXy) place.known &= kZ;
}

/// Which of `axes` go to an unknown place by G28 or G30; `lost`: where the program has not stored
/// it. The interpreter knows it by its own coordinates of the machine, which hang together with the
/// work as long as the axis is known.
std::uint8_t MotionFold::go_to_stored(std::uint8_t axes, std::uint8_t lost, Vec3& to_mm) {
  const StoredPlace& place = stored_places_[block_->second_reference ? 1 : 0];
  if (!place.is_stored) return lost;
  std::uint8_t known = place.known;
  // Another tool's tip is elsewhere there. By how much is not known without a tool table.
  if (!lengths_.checks() && place.length_call != length_call_) known = without(known, kZ);
  if (lengths_.checks() && lengths_.is_hidden() && (axes & kZ) != 0) {
    const Vec3 shift_mm = along_work(place.applied_mm - lengths_.applied_mm());
    if (shift_mm != Vec3{0}) held_z_mm_ = program_from_work(to_mm).z;
    to_mm += shift_mm;
  }
  return without(axes, known);
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
  const bool touches_off = block.offset == BlockWords::Offset::kTouchOff;
  std::uint8_t unrelated = block.computed & probed_;
  if (touches_off) {
    const bool plate = (block.computed & kZ) == 0 && block.z * unit_mm_ >= kLeastPlate_mm;
    unrelated |= block.named & unknown_ & without(probed_, plate ? kZ : std::uint8_t{0});
  }
  const std::uint8_t floats =
      touches_off ? block.named & without(unknown_, unrelated | probed_) : std::uint8_t{0};
  systems_before_ = systems_;
  for (int system = 1; system < static_cast<int>(kSystems); ++system) {
    if (system == g5x_index_ || (block.system > 0 && system != block.system)) continue;
    StoredSystem& set = systems_[static_cast<std::size_t>(system)];
    // With a computed P it is one of them.
    const std::uint8_t renewed = block.system > 0 ? block.named : std::uint8_t{0};
    set.unrelated = without(set.unrelated, renewed) | unrelated;
    set.floats = without(set.floats, renewed) | floats;
  }
}

void MotionFold::enter_system(int system) {
  const auto index = [](int number) {
    return number >= 0 && number < static_cast<int>(kSystems) ? static_cast<std::size_t>(number)
                                                              : std::size_t{0};
  };
  StoredSystem& left = systems_[index(g5x_index_)];
  left.unrelated = system_unrelated_;
  left.floats = 0;
  const StoredSystem& entered = systems_[index(system)];
  system_unrelated_ = entered.unrelated | (entered.floats & placed_);
  g5x_index_ = system;
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
    enter_system(system);
    zero_known_ = without(zero_known_, zero_by_program_);
    zero_by_program_ = 0;
  }
  if (block_ == nullptr) return;
  // A G10 whose P is computed has set the system in force.
  if (!is_shift && block_->system < 0) systems_ = systems_before_;
  const std::uint8_t named = block_->named;
  // What is not known of a probe: whatever the program computes, and a place that it has touched
  // itself. Only by a plate's height it says where the tool is.
  std::uint8_t doubtful = block_->computed & probed_;
  if (block_->offset != BlockWords::Offset::kMachine) {
    const std::uint8_t plate = said_height_mm() >= kLeastPlate_mm ? kZ : std::uint8_t{0};
    doubtful |= named & unknown_ & without(probed_, plate);
  }
  switch (block_->offset) {
    case BlockWords::Offset::kNone:
      return;
    case BlockWords::Offset::kShift:
      if (!is_shift) return;
      shifted_ = true;
      // Where the axis is known the new numbers hang together with those of the workpiece frame.
      shift_floats_ = without(shift_floats_, named) | (named & (unknown_ | work_floats_));
      system_unrelated_ |= doubtful;
      take_as_known_here(without(named & unknown_, doubtful), true);
      return relate_shift();
    case BlockWords::Offset::kUnshift:
      shifted_ = false;
      return relate_shift();
    case BlockWords::Offset::kReshift:
      shifted_ = true;
      return relate_shift();
    case BlockWords::Offset::kTouchOff:
      if (is_shift) return;
      system_unrelated_ |= doubtful;
      take_as_known_here(without(named & unknown_, doubtful), false);
      return;
    case BlockWords::Offset::kMachine:
      if (is_shift) return;
      if (probed_ != 0) system_unrelated_ = without(system_unrelated_, named) | doubtful;
      zero_by_program_ |= without(named, placed_ | zero_known_);
      zero_known_ |= zero_by_program_;
      return;
  }
}

/// The program has given numbers to a place that is not known in the machine: from here on they are
/// what is known. If the axis had others before, the two have nothing to do with each other.
void MotionFold::take_as_known_here(std::uint8_t axes, bool by_g92) {
  if (axes == 0) return;
  if (work_fixed_) adopt_frame();
  const std::uint8_t fresh = without(axes, placed_);
  if (by_g92) work_floats_ |= fresh;
  if (!by_g92) system_unrelated_ |= axes & placed_;
  placed_ |= fresh;
  unknown_ = without(unknown_, fresh);
  zero_known_ = without(zero_known_, fresh);
}

void MotionFold::relate_shift() {
  const std::uint8_t floats = shifted_ ? shift_floats_ : std::uint8_t{0};
  // A second G92 at an unknown place is another one than that of the workpiece frame.
  const std::uint8_t lost = shifted_ ? floats & unknown_ : std::uint8_t{0};
  shift_unrelated_ = placed_ & ((floats ^ work_floats_) | lost);
}

/// The workpiece frame is that in which the program first writes: of an axis that no block has
/// placed yet it follows the offsets.
void MotionFold::adopt_frame() {
  const bool turned = work_.rotation_deg != 0 || frame_.rotation_deg != 0;
  std::uint8_t free = without(kXyz, placed_);
  if (turned && (free & kXy) != kXy) free &= kZ;
  if (free == 0) return;
  const auto cosine = [](double degrees) { return std::cos(degrees * (kPi / 180)); };
  const auto sine = [](double degrees) { return std::sin(degrees * (kPi / 180)); };
  double degrees = work_.rotation_deg;
  const Vec3 machine_mm =
      turned_by(position_mm_ + work_.g92_mm, cosine(degrees), sine(degrees)) + work_.g5x_mm;
  for (int i = 0; i < 3; ++i) {
    if ((free & kX << i) == 0) continue;
    work_.g5x_mm[i] = frame_.g5x_mm[i];
    work_.g92_mm[i] = frame_.g92_mm[i];
  }
  if ((free & kXy) == kXy) work_.rotation_deg = frame_.rotation_deg;
  degrees = work_.rotation_deg;
  const Vec3 here_mm =
      turned_by(machine_mm - work_.g5x_mm, cosine(degrees), -sine(degrees)) - work_.g92_mm;
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
