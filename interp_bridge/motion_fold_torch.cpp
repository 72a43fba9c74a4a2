// The torch of MotionFold: outputs, spindles, and what QtPlasmaC's filter adds.
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <string_view>

#include "base/portable_math.h"
#include "base/units.h"
#include "interp_bridge/motion_fold.h"

namespace kerf {
namespace {

/// What the filter has where the program says nothing: up to which diameter a circle is a hole, how
/// far it is run on, how corners are blended; in programs in mm and in inches.
constexpr double kLargestHole_mm = 32;
constexpr double kLargestHole_in = 1.26;
constexpr double kOverburn_mm = 4;
constexpr double kOverburn_in = 0.157;
constexpr float kBlend_mm = 0.1F;
constexpr float kBlendInchMachine_mm = 0.004F * static_cast<float>(kMmPerInch);

/// How a COMMENT of the interpreter about G41, G42 and G40 begins; "on left", "off" follow.
constexpr std::string_view kCompensation = "interpreter: cutter radius compensation ";

constexpr std::uint64_t output_bit(unsigned n) { return std::uint64_t{1} << n; }

void set_bit(std::uint64_t& bits, unsigned n, bool on) {
  bits = on ? bits | output_bit(n) : bits & ~output_bit(n);
}

/// P or E word as an index below `count`; negative and larger ones are on no machine.
bool index_below(const CanonicalCommand& command, unsigned count, unsigned& index) {
  const int number = command.integer(0);
  if (number < 0 || static_cast<unsigned>(number) >= count) return false;
  index = static_cast<unsigned>(number);
  return true;
}

}  // namespace

bool MotionFold::fold_torch(const CanonicalCommand& command) {
  unsigned index = 0;
  switch (command.name) {
    case CanonicalName::kSetMotionOutputBit:
    case CanonicalName::kClearMotionOutputBit:
      if (!index_below(command, TorchState::kOutputs, index)) return true;
      outputs_wait_ = true;
      waiting_mask_ |= output_bit(index);
      set_bit(waiting_outputs_, index, command.name == CanonicalName::kSetMotionOutputBit);
      return true;
    case CanonicalName::kSetAuxOutputBit:
    case CanonicalName::kClearAuxOutputBit:
      if (!index_below(command, TorchState::kOutputs, index)) return true;
      set_bit(torch_.outputs, index, command.name == CanonicalName::kSetAuxOutputBit);
      return true;
    case CanonicalName::kSetMotionOutputValue:
      if (index_below(command, TorchState::kAnalogs, index)) {
        outputs_wait_ = true;
        waiting_analog_[index] = static_cast<float>(command.number(1));
      }
      return true;
    case CanonicalName::kSetAuxOutputValue:
      if (index_below(command, TorchState::kAnalogs, index)) {
        torch_.analog[index] = static_cast<float>(command.number(1));
      }
      return true;
    case CanonicalName::kEnableAdaptiveFeed:
      return torch_.adaptive_feed = true;
    case CanonicalName::kDisableAdaptiveFeed:
      torch_.adaptive_feed = false;
      return true;
    case CanonicalName::kComment:
      // The calls that would say so are never made.
      if (command.text.substr(0, kCompensation.size()) == kCompensation) {
        compensation_ = command.text.substr(kCompensation.size(), 3) != "off";
      }
      note_distance_mode(command.text);
      return true;
    default:
      return false;
  }
}

void MotionFold::take_synchronised_outputs() {
  use_filters_path_mode();
  if (!outputs_wait_) return;
  outputs_wait_ = false;
  torch_.outputs = (torch_.outputs & ~waiting_mask_) | (waiting_outputs_ & waiting_mask_);
  waiting_mask_ = 0;
  for (std::size_t i = 0; i < waiting_analog_.size(); ++i) {
    if (!waiting_analog_[i]) continue;
    torch_.analog[i] = *waiting_analog_[i];
    waiting_analog_[i].reset();
  }
}

/// Before the first move, as the filter does.
void MotionFold::use_filters_path_mode() {
  if (!filter_.on || path_mode_said_) return;
  path_mode_said_ = true;
  path_mode_ = PathMode::kContinuous;
  blend_tolerance_mm_ = filter_.inch_machine ? kBlendInchMachine_mm : kBlend_mm;
  merge_tolerance_mm_ = blend_tolerance_mm_;
}

/// After any M3, M4 or M5.
void MotionFold::note_spindles() {
  const std::uint8_t before = torch_.spindles_on;
  torch_.spindles_on = 0;
  for (std::size_t i = 0; i < kMaxSpindles; ++i) {
    if (spindles_[i].state != SpindleState::kStopped) {
      torch_.spindles_on |= static_cast<std::uint8_t>(1U << i);
    }
  }
  if ((torch_.spindles_on & ~before) != 0) pierced_ = false;
  if ((before & ~torch_.spindles_on) == 0) return;
  // M5: the filter gives the feed and the torch back.
  end_hole();
  if (torch_off_by_filter_) set_bit(torch_.outputs, TorchState::kTorchOff, false);
  torch_off_by_filter_ = false;
}

double MotionFold::hole_limit_mm() const {
  if (modes_.largest_diameter >= 0) return double{modes_.largest_diameter} * unit_mm_;
  return unit_mm_ == kMmPerInch ? kLargestHole_in * kMmPerInch : kLargestHole_mm;
}

void MotionFold::end_hole() {
  if (hole_active_) torch_.analog[TorchState::kReduction] = 0;
  hole_active_ = false;
}

/// Slows the arc that follows if it is a hole. The filter adds half of the kerf to the diameter.
void MotionFold::begin_arc(double diameter_mm, bool full_circle) {
  const bool senses = filter_.on && modes_.holes && !compensation_ && plane_ == CanonicalPlane::kXy;
  const bool small = diameter_mm > 0 && diameter_mm + material_kerf_mm_ / 2 <= hole_limit_mm();
  if (!senses || !small || !(full_circle || modes_.arcs)) return end_hole();
  hole_active_ = true;
  torch_.analog[TorchState::kReduction] = modes_.velocity_percent;
}

/// An arc that follows an overburn begins where the program thinks that the tip is.
void MotionFold::return_from_overburn(SourceRef source, std::vector<Motion>& out) {
  if (!overburn_from_mm_) return;
  const Vec3 end_mm = *overburn_from_mm_;
  overburn_from_mm_.reset();
  Motion& back = append(MotionKind::kFeed, source, out);
  move_to(back, end_mm, abc_deg_, uvw_mm_);
  set_feed(back);
}

void MotionFold::append_overburn(const Motion& hole, std::vector<Motion>& out) {
  const double length_mm = modes_.overburn_length >= 0 ? double{modes_.overburn_length} * unit_mm_
                           : unit_mm_ == kMmPerInch    ? kOverburn_in * kMmPerInch
                                                       : kOverburn_mm;
  Vec3 radius_mm = hole.to_mm - hole.arc.center_mm;
  radius_mm -= glm::dot(radius_mm, hole.arc.axis) * hole.arc.axis;
  // The filter takes the length along the diameter with half of the kerf added, see begin_arc().
  const double radius_of_length_mm = glm::length(radius_mm) + material_kerf_mm_ / 4;
  const double angle_rad = std::copysign(length_mm / radius_of_length_mm, hole.arc.sweep_rad);
  if (angle_rad == 0 || !std::isfinite(angle_rad)) return;
  torch_off_by_filter_ = true;
  set_bit(torch_.outputs, TorchState::kTorchOff, true);
  const Vec3 turned_mm = portable::cos(angle_rad) * radius_mm +
                         portable::sin(angle_rad) * glm::cross(hole.arc.axis, radius_mm);
  Motion& more = append(MotionKind::kArc, hole.source, out);
  more.torch.overburn = true;
  more.arc = {hole.arc.center_mm, hole.arc.axis, angle_rad};
  move_to(more, hole.to_mm - radius_mm + turned_mm, abc_deg_, uvw_mm_);
  set_feed(more);
  position_as_printed_ = false;
  overburn_from_mm_ = hole.to_mm;
}

/// True: the step is none, or is the pierce that has been appended in its place.
bool MotionFold::only_pierces(SourceRef source, std::vector<Motion>& out) {
  if (!filter_.on || !modes_.pierce_only) return false;
  position_as_printed_ = false;
  if (pierced_ || (torch_.spindles_on & 1) == 0) return true;
  pierced_ = true;
  Motion& pierce = append(MotionKind::kFeed, source, out);
  set_feed(pierce);
  return true;
}

}  // namespace kerf
