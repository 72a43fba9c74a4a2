#include "twin/guess/beam_guess.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/translate.h"
#include "twin/motion/motion_geometry.h"

namespace kerf {
namespace {

constexpr double kLaserKerf_mm = 0.2;
constexpr double kPlasmaKerf_mm = 1.5;  ///< of 3 mm steel at 45 A, as QtPlasmaC's samples have it
constexpr std::size_t kMostSpeeds = 8;
/// Of the way: single moves that a post has put before or behind its switching do not count.
constexpr double kMost = 0.9;

}  // namespace

void BeamWatch::Switched::add(bool on, bool feed, double mm) {
  if (on && !was_on && feed) ++starts;
  was_on = on;
  (feed ? (on ? fed_on_mm : fed_off_mm) : (on ? travelled_on_mm : travelled_off_mm)) += mm;
}

bool BeamWatch::Switched::is_beam() const {
  const double fed = fed_on_mm + fed_off_mm, travelled = travelled_on_mm + travelled_off_mm;
  return starts > 0 && fed_on_mm > kMost * fed && travelled > 0 &&
         travelled_off_mm > kMost * travelled;
}

void BeamWatch::add(const Motion& m) {
  if (m.kind == MotionKind::kDwell && m.spindle != SpindleState::kStopped) dwells_lit_ = true;
  turns_ = turns_ || m.from_abc_deg != m.to_abc_deg;
  const bool feed = is_feed(m);
  if ((!feed && !is_traverse(m)) || (m.unknown_to & 3) != 0) return;
  const Box way = bounds_of(m);
  const double mm = m.start_known ? std::hypot(way.size().x, way.size().y) : 0;
  const double down = m.start_known ? m.from_mm.z - m.to_mm.z : 0;
  z_moves_ = z_moves_ || down != 0;
  if (feed) {
    feeds_mm_.extend(way);
    fed_mm_ += mm;
    if (mm > 0 && down != 0) slanted_mm_ += mm;
    if (mm == 0 && down > 0) plunged_mm_ += down;
    if (speeds_.size() < kMostSpeeds && m.spindle_rpm > 0) speeds_.insert(m.spindle_rpm);
    for (unsigned n = 0; n < TorchState::kAnalogs; ++n) {
      const float power = m.torch.analog[n];
      if (powers_[n].size() < kMostSpeeds && power > 0) powers_[n].insert(power);
    }
  }
  if (mm == 0) return;
  const bool turns = m.spindle != SpindleState::kStopped;
  spindle_.add(turns, feed, mm);
  speed_.add(turns && m.spindle_rpm > 0, feed, mm);
  outputs_seen_ |= m.torch.outputs;
  for (unsigned n = 0; n < TorchState::kOutputs; ++n) {
    if ((outputs_seen_ >> n & 1) != 0) output_[n].add(m.torch.output(n), feed, mm);
  }
  for (unsigned n = 0; n < TorchState::kAnalogs; ++n) {
    analog_[n].add(m.torch.analog[n] > 0, feed, mm);
  }
}

std::optional<BeamGuess> BeamWatch::guess(bool is_qtplasmac) const {
  if (feeds_mm_.empty() || turns_) return std::nullopt;
  if (is_qtplasmac) return BeamGuess{"", 0, tr("it is for QtPlasmaC")};
  if (!(fed_mm_ > 0)) return std::nullopt;
  // One start is that of a spindle, unless Z never moves: a tool that turns must come down.
  const std::uint64_t least = z_moves_ ? 2 : 1;
  if (slanted_mm_ > (1 - kMost) * fed_mm_) return std::nullopt;
  for (unsigned n = 0; n < TorchState::kOutputs; ++n) {
    if (!output_[n].is_beam() || output_[n].starts < least) continue;
    return BeamGuess{fmt::format("m62:{}", n), kLaserKerf_mm,
                     trf("output {} is on where it feeds, off where it travels", n)};
  }
  // A valve or a load may go with the cuts of a mill, which plunges.
  for (unsigned n = 0; n < TorchState::kAnalogs && !(plunged_mm_ > 0); ++n) {
    if (!analog_[n].is_beam() || analog_[n].starts < least) continue;
    return BeamGuess{fmt::format("m67:{}", n), kLaserKerf_mm,
                     trf("analog output {} is above 0 where it feeds, 0 where it travels", n)};
  }
  if (spindle_.is_beam() && spindle_.starts >= least) {
    return BeamGuess{"m3", dwells_lit_ ? kPlasmaKerf_mm : kLaserKerf_mm,
                     tr("the spindle is on where it feeds, off where it travels")};
  }
  if (z_moves_) return std::nullopt;
  // Whether it is dark along rapids the program does not say: such machines see to it themselves.
  for (unsigned n = 0; n < TorchState::kAnalogs; ++n) {
    const bool varies = powers_[n].size() >= 2 || analog_[n].fed_off_mm > 0;
    if (!(analog_[n].fed_on_mm > 0) || !varies) continue;
    return BeamGuess{fmt::format("m67:{}+feed", n), kLaserKerf_mm,
                     trf("Z never moves, and analog output {} says how strong", n)};
  }
  const double share = spindle_.fed_on_mm / fed_mm_;
  if (share > kMost && (speeds_.size() >= 2 || speed_.fed_off_mm > 0)) {
    return BeamGuess{"laser", kLaserKerf_mm, tr("Z never moves, and S says how strong")};
  }
  if (share > 0 && spindle_.fed_off_mm > 0) {
    return BeamGuess{"m3", kLaserKerf_mm,
                     tr("Z never moves, and the spindle comes on and goes off")};
  }
  return BeamGuess{"feed", kLaserKerf_mm, tr("Z never moves")};
}

}  // namespace kerf
