#include "cutting/milling_force.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace kerf {
namespace {

/// Places of a tooth's pitch that are looked at, beside those where a peak is to be expected.
constexpr int kTurns = 16, kTurnsOfRings = 32;
/// Places of the wall that are looked at, from the tip up.
constexpr int kAtWallPlaces = 4;
/// What is not a cylinder is taken as so many rings, each with one lag.
constexpr int kRings = 8;
constexpr double kNoAngle = 1e-9;

struct Ring {
  double push_mm = 0, inward_mm = 0, turn_mm2 = 0;
  double lag_rad = 0, lag_to_rad = 0;  ///< at its lower and its upper end
};

/// Integrals, per radian of lag or of one place.
ChipIntegrals::Sum mean_over(const ChipIntegrals& integrals, double from, double to, double low,
                             double high) {
  if (to - from < kNoAngle) {
    const double middle = 0.5 * (from + to);
    if (middle < low || middle > high) return {};
    const double power = ChipIntegrals::chip_power(middle, integrals.mc());
    return {power, power * std::cos(middle), power * std::sin(middle)};
  }
  const double a = std::max(from, low), b = std::min(to, high);
  if (b <= a) return {};
  const ChipIntegrals::Sum first = integrals.to(a), last = integrals.to(b);
  const double each = 1 / (to - from);
  return {(last.plain - first.plain) * each, (last.cosine - first.cosine) * each,
          (last.sine - first.sine) * each};
}

int rings_of(const EdgeProfile& profile, const MillingEdges& edges, double deep_mm,
             std::array<Ring, kRings + 1>& rings) {
  const double lag_each = std::tan(edges.helix_rad) / profile.radius_mm();
  const double nose_mm = std::min(deep_mm, profile.side_from_mm());
  int count = 0;
  const auto add = [&](double from_mm, double to_mm) {
    const EdgeProfile::Sum sum = profile.sum_to(to_mm) - profile.sum_to(from_mm);
    rings[static_cast<std::size_t>(count++)] = {sum.push_mm, sum.inward_mm, sum.turn_mm2,
                                                from_mm * lag_each, to_mm * lag_each};
  };
  if (nose_mm > 0) {
    // Where all of it lags by next to nothing one ring is as good as many.
    const int parts = nose_mm * lag_each < 0.01 ? 1 : kRings;
    for (int k = 0; k < parts; ++k) add(nose_mm * k / parts, nose_mm * (k + 1) / parts);
  }
  if (deep_mm > nose_mm) add(nose_mm, deep_mm);
  return count;
}

/// Rotations at which some edge passes `phi_rad` at some height: turned by less than the lag of the
/// highest place, mod a pitch.
bool passes(double phi_rad, double turn_rad, double most_lag_rad, double pitch_rad) {
  const double beyond = turn_rad - phi_rad;
  const double since = beyond - std::floor(beyond / pitch_rad) * pitch_rad;
  return since <= most_lag_rad + 4 * kNoAngle || pitch_rad - since <= 4 * kNoAngle;
}

/// `values`: by the low, nominal and high share; signs may differ.
ValueRange range_of(const ValueRange& kc11, const std::array<double, 3>& values) {
  const auto [least, most] = std::minmax_element(values.begin(), values.end());
  return {*least * (*least < 0 ? kc11.high : kc11.low), kc11.nominal * values[1],
          *most * (*most < 0 ? kc11.low : kc11.high)};
}

/// Rotations that are looked at: where the tip of a tooth is.
struct Turns {
  std::array<double, kTurnsOfRings + 2 + 2 * (kAtWallPlaces + 1)> tips{};
  std::size_t count = 0;
  void add(double tip) { tips[count++] = tip; }
};

Turns turns_of(const MillingCut& cut, double most_lag, double pitch, int count) {
  Turns turns;
  for (int k = 0; k < count; ++k) turns.add(cut.exit_rad - pitch * k / count);
  // Of chips that grow on their way the last, of such that shrink the first full one, of both
  // the one in the middle.
  turns.add(std::min(cut.exit_rad, cut.entry_rad + most_lag + kNoAngle));
  turns.add(std::clamp(kPi / 2 + most_lag / 2, cut.entry_rad + kNoAngle, cut.exit_rad + most_lag));
  for (int k = 0; k <= kAtWallPlaces; ++k) {
    const double lag = most_lag * k / kAtWallPlaces;
    turns.add(cut.exit_rad - kNoAngle + lag);
    turns.add(cut.entry_rad + kNoAngle + lag);
  }
  return turns;
}

}  // namespace

ChipIntegrals::ChipIntegrals(double mc) : mc_(mc) {
  // sin^(1-mc) is steep at both ends: between two rows by Simpson's rule in the root of phi.
  const auto add = [mc](double from, double to, Sum& sum) {
    constexpr int kParts = 8;
    const double r0 = std::sqrt(from), r1 = std::sqrt(to);
    for (int k = 0; k <= kParts; ++k) {
      const double root = r0 + (r1 - r0) * k / kParts, phi = root * root;
      const double weight = (k == 0 || k == kParts ? 1
                             : k % 2 == 1          ? 4
                                                   : 2) *
                            (r1 - r0) / (3.0 * kParts) * 2 * root * chip_power(phi, mc);
      sum.plain += weight;
      sum.cosine += weight * std::cos(phi);
      sum.sine += weight * std::sin(phi);
    }
  };
  std::array<Sum, kSteps / 2 + 1> half{};
  for (std::size_t k = 1; k < half.size(); ++k) {
    half[k] = half[k - 1];
    add(kPi * static_cast<double>(k - 1) / kSteps, kPi * static_cast<double>(k) / kSteps, half[k]);
  }
  // The other half is the mirror image.
  const Sum& middle = half.back();
  for (std::size_t k = 0; k < sums_.size(); ++k) {
    const bool is_first = k < half.size();
    const Sum& other = half[is_first ? k : kSteps - k];
    sums_[k] =
        is_first ? other
                 : Sum{2 * middle.plain - other.plain, other.cosine, 2 * middle.sine - other.sine};
  }
}

double ChipIntegrals::chip_power(double phi_rad, double mc) {
  const double sine = std::sin(phi_rad);
  return sine > 0 ? std::pow(sine, 1 - mc) : 0;
}

ChipIntegrals::Sum ChipIntegrals::to(double phi_rad) const {
  const double scaled = std::clamp(phi_rad / kPi, 0.0, 1.0) * kSteps;
  const auto k = static_cast<std::size_t>(std::min(scaled, kSteps - 1.0));
  const double part = scaled - static_cast<double>(k);
  const Sum &low = sums_[k], &high = sums_[k + 1];
  return {low.plain + part * (high.plain - low.plain),
          low.cosine + part * (high.cosine - low.cosine), low.sine + part * (high.sine - low.sine)};
}

Chip chip_of(const EdgeProfile& profile, const MillingCut& cut) {
  Chip chip;
  const double arc = cut.exit_rad - cut.entry_rad;
  if (arc <= 0 || cut.deep_mm <= 0) return chip;
  const double steepest = cut.entry_rad <= kPi / 2 && cut.exit_rad >= kPi / 2
                              ? 1
                              : std::max(std::sin(cut.entry_rad), std::sin(cut.exit_rad));
  chip.most_mm = cut.feed_per_tooth_mm * steepest * profile.steepest_to(cut.deep_mm);
  const double width = (std::cos(cut.entry_rad) - std::cos(cut.exit_rad)) / arc;
  const double length_mm = profile.sum_to(cut.deep_mm).length_mm;
  chip.mean_mm = cut.feed_per_tooth_mm * width * (length_mm > 0 ? cut.deep_mm / length_mm : 1);
  return chip;
}

double cutting_speed_m_per_min(const EdgeProfile& profile, const MillingCut& cut) {
  return 2 * kPi * profile.radius_to(cut.deep_mm) * cut.rpm / 1000;
}

UnitForces unit_forces(const ChipIntegrals& integrals, const EdgeProfile& profile,
                       const MillingEdges& edges, const MillingCut& cut, const ValueRange& share) {
  UnitForces out;
  const double arc = cut.exit_rad - cut.entry_rad;
  if (arc <= 0 || cut.deep_mm <= 0 || edges.teeth <= 0 || cut.feed_per_tooth_mm <= 0) return out;
  std::array<Ring, kRings + 1> rings;
  const int count = rings_of(profile, edges, cut.deep_mm, rings);
  const double chip = std::pow(cut.feed_per_tooth_mm, 1 - integrals.mc());
  const double pitch = 2 * kPi / edges.teeth;
  const std::array<double, 3> shares{share.low, share.nominal, share.high};

  // Over a revolution each tooth passes the arc once at each height.
  const EdgeProfile::Sum whole = profile.sum_to(cut.deep_mm);
  const ChipIntegrals::Sum in = integrals.to(cut.entry_rad), at = integrals.to(cut.exit_rad);
  const double plain = at.plain - in.plain, cosine = at.cosine - in.cosine;
  const double sine = at.sine - in.sine, each = chip / pitch;
  out.tangential_mean_n = each * whole.push_mm * plain;
  out.torque_mean_nm = each * whole.turn_mm2 * plain / 1000;
  for (std::size_t s = 0; s < shares.size(); ++s) {
    out.sideways[s].feed_mean_n =
        -each * (whole.push_mm * cosine + shares[s] * whole.inward_mm * sine);
    out.sideways[s].normal_mean_n =
        each * (whole.push_mm * sine - shares[s] * whole.inward_mm * cosine);
  }

  const double most_lag = rings[static_cast<std::size_t>(count - 1)].lag_to_rad;
  const bool is_up = cut.entry_rad <= kPi - cut.exit_rad + kNoAngle;
  const bool is_climb = kPi - cut.exit_rad <= cut.entry_rad + kNoAngle;
  constexpr double kAtWall = 0.02;  // an arc that ends about there has a wall
  const bool has_low = is_up && cut.entry_rad < kAtWall;
  const bool has_high = is_climb && kPi - cut.exit_rad < kAtWall;
  const Turns turns = turns_of(cut, most_lag, pitch, count > 1 ? kTurnsOfRings : kTurns);
  for (std::size_t turn = 0; turn < turns.count; ++turn) {
    const double tip = turns.tips[turn];
    double push = 0, torque = 0;
    ChipIntegrals::Sum pushes, inwards;
    const double first = tip - std::ceil((tip - cut.entry_rad) / pitch) * pitch;
    for (double place = first; place - most_lag <= cut.exit_rad; place += pitch) {
      if (place < cut.entry_rad) continue;
      for (int k = 0; k < count; ++k) {
        const Ring& ring = rings[static_cast<std::size_t>(k)];
        const ChipIntegrals::Sum sum = mean_over(integrals, place - ring.lag_to_rad,
                                                 place - ring.lag_rad, cut.entry_rad, cut.exit_rad);
        push += ring.push_mm * sum.plain;
        torque += ring.turn_mm2 * sum.plain;
        pushes.cosine += ring.push_mm * sum.cosine;
        pushes.sine += ring.push_mm * sum.sine;
        inwards.cosine += ring.inward_mm * sum.cosine;
        inwards.sine += ring.inward_mm * sum.sine;
      }
    }
    out.tangential_most_n = std::max(out.tangential_most_n, chip * push);
    out.torque_most_nm = std::max(out.torque_most_nm, chip * torque / 1000);
    const bool at_low = has_low && passes(cut.entry_rad, tip, most_lag, pitch);
    const bool at_high = has_high && passes(cut.exit_rad, tip, most_lag, pitch);
    for (std::size_t s = 0; s < shares.size(); ++s) {
      UnitForces::Sideways& side = out.sideways[s];
      const double along = -chip * (pushes.cosine + shares[s] * inwards.sine);
      const double across = chip * (pushes.sine - shares[s] * inwards.cosine);
      side.most_n = std::max(side.most_n, std::hypot(along, across));
      // y points to the wall of conventional milling.
      if (at_low && std::abs(across) > std::abs(side.at_wall_n)) side.at_wall_n = -across;
      if (at_high && std::abs(across) > std::abs(side.at_wall_n)) side.at_wall_n = across;
    }
  }
  return out;
}

MillingModel::MillingModel(const Material& material, EdgeProfile profile, const MillingEdges& edges,
                           std::optional<double> rake_deg)
    : profile_(std::move(profile)),
      integrals_(material.mc),
      edges_(edges),
      kc11_(kc11_at_rake(material, rake_deg)),
      share_(material.normal_share) {}

MillingLoad MillingModel::load_of(const MillingCut& cut) const {
  MillingLoad load;
  load.chip = chip_of(profile_, cut);
  load.speed_m_per_min = cutting_speed_m_per_min(profile_, cut);
  if (cut.feed_per_tooth_mm <= 0) return load;
  if (cut.entry_rad != last_.entry_rad || cut.exit_rad != last_.exit_rad ||
      cut.deep_mm != last_.deep_mm) {
    last_ = cut;
    last_.feed_per_tooth_mm = 1;
    unit_ = unit_forces(integrals_, profile_, edges_, last_, share_);
  }
  const ValueRange kc = kc11_.times(std::pow(cut.feed_per_tooth_mm, feed_exponent()));
  load.tangential_n = kc.times(unit_.tangential_most_n);
  load.torque_nm = kc.times(unit_.torque_most_nm);
  load.torque_mean_nm = kc.times(unit_.torque_mean_nm);
  load.power_w = load.torque_mean_nm.times(2 * kPi * cut.rpm / 60);
  const auto each = [&](double UnitForces::Sideways::*value) {
    return range_of(kc,
                    {unit_.sideways[0].*value, unit_.sideways[1].*value, unit_.sideways[2].*value});
  };
  load.force_n = each(&UnitForces::Sideways::most_n);
  load.feed_force_n = each(&UnitForces::Sideways::feed_mean_n);
  load.normal_force_n = each(&UnitForces::Sideways::normal_mean_n);
  load.at_wall_n = each(&UnitForces::Sideways::at_wall_n);
  return load;
}

CutArcAngles conventional_arc(double radius_mm, double wide_mm) {
  return {0, std::acos(std::clamp(1 - wide_mm / radius_mm, -1.0, 1.0))};
}

CutArcAngles climb_arc(double radius_mm, double wide_mm) {
  return {kPi - conventional_arc(radius_mm, wide_mm).exit_rad, kPi};
}

}  // namespace kerf
