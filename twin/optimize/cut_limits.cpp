#include "twin/optimize/cut_limits.h"

#include <algorithm>
#include <cmath>

#include "cutting/drilling_force.h"
#include "cutting/tool_bending.h"
#include "stock/cutter/cutting_edge.h"

namespace kerf {
namespace {

/// Of the diameter: how far apart the places are at which a look straight down is taken.
constexpr double kDiscStep = 1.0 / 24;

MillingCut cut_of(const EngagementLook& look, double rpm) {
  return {1, std::clamp(look.entry_rad, 0.0, kPi), std::clamp(look.exit_rad, 0.0, kPi),
          look.deep_mm, rpm};
}

bool grows_with_power(CutLimit limit) {
  return limit != CutLimit::kChip && limit != CutLimit::kRate;
}

}  // namespace

const char* key_of(CutLimit limit) {
  switch (limit) {
    case CutLimit::kChip:
      return "chip_mm";
    case CutLimit::kRate:
      return "rate_mm3_s";
    case CutLimit::kForce:
      return "force_n";
    case CutLimit::kPower:
      return "power_kw";
    case CutLimit::kDeflection:
      return "deflection_mm";
  }
  return "";
}

CutLimits::CutLimits(const Cutter& cutter, const std::optional<Material>& material)
    : teeth_(cutter.teeth().value_or(0)),
      radius_mm_(cutter.radius_mm()),
      shank_mm_(cutter.shank_diameter_mm().value_or(2 * cutter.radius_mm())),
      point_deg_(point_deg(cutter)),
      flute_mm_(cutter.flute_length_mm()),
      rake_deg_(cutter.edge_traits().rake_deg),
      profile_(edge_points(cutter), material ? material->mc : 0),
      material_(material) {
  is_rounded_ = !cutter.spec().starts_with("flat");
  if (!cutter.holder().empty()) stickout_mm_ = cutter.holder().front().from_z_mm;
  if (!material_ || teeth_ == 0) return;
  const double helix_deg = cutter.edge_traits().helix_deg.value_or(kUsualHelix_deg);
  const MillingEdges edges{teeth_, helix_deg * kPi / 180};
  model_.emplace(*material_, profile_, edges, rake_deg_);
}

double CutLimits::outline_mm2(const EngagementLook& look) const {
  const MillingCut cut = cut_of(look, 0);
  return profile_.sum_to(cut.deep_mm).half_mm2 * (std::cos(cut.entry_rad) - std::cos(cut.exit_rad));
}

double CutLimits::section_mm2(const EngagementLook& look) const {
  // No more is cut than as wide and as high as that, and of what is not flat no more than the
  // outline has between the angles.
  const double all_mm2 = (look.wide_mm + look.gaps_mm) * look.deep_mm;
  if (!look.is_plunge && is_rounded_) return std::min(all_mm2, outline_mm2(look));
  if (!look.is_plunge) return all_mm2;
  const double wide_mm = std::min(2 * radius_mm_, look.wide_mm + kDiscStep * 2 * radius_mm_);
  return kPi / 4 * wide_mm * wide_mm;
}

CutLimits::Place CutLimits::place(const EngagementLook& look, double rpm) const {
  Place place;
  place.at_1mm[CutLimit::kRate] = section_mm2(look) / 60;
  if (teeth_ == 0 || rpm <= 0) return place;
  place.teeth_per_min = teeth_ * rpm;
  place.rpm = rpm;
  const double share = look.is_plunge ? std::sin(point_deg_ / 2 * kPi / 180)
                                      : chip_of(profile_, cut_of(look, rpm)).most_mm;
  place.at_1mm[CutLimit::kChip] = std::max(kLeastShare, share);
  if (model_) add_forces(look, rpm, place);
  return place;
}

void CutLimits::add_forces(const EngagementLook& look, double rpm, Place& place) const {
  place.exponent = model_->feed_exponent();
  double force_n = 0, power_w = 0;
  if (look.is_plunge) {
    const DrillingLoad load =
        drilling_load(*material_, {look.wide_mm, teeth_, point_deg_, 1.0 * teeth_, rpm}, rake_deg_);
    force_n = load.thrust_n.high;
    power_w = load.power_w.high;
  } else {
    const MillingCut cut = cut_of(look, rpm);
    const MillingLoad load = model_->load_of(cut);
    const double all_mm2 = outline_mm2(look);
    const double share = all_mm2 > 0 ? std::min(1.0, section_mm2(look) / all_mm2) : 1;
    force_n = share * load.force_n.high;
    power_w = share * load.power_w.high;
  }
  place.at_1mm[CutLimit::kForce] = force_n;
  place.at_1mm[CutLimit::kPower] = power_w / 1000;
  if (look.is_plunge || !stickout_mm_) return;  // thrust bends nothing
  const ToolRods rods{2 * radius_mm_, shank_mm_, flute_mm_.value_or(*stickout_mm_), *stickout_mm_,
                      kCarbideModulus};
  place.at_1mm[CutLimit::kDeflection] = force_n * tip_bends_mm_per_n(rods, look.deep_mm / 2);
}

double CutLimits::most_feed(const FeedAims& aims, const Place& place) {
  double most = std::numeric_limits<double>::infinity();
  for (const CutLimit limit : kCutLimits) {
    std::optional<double> allowed = aims.most[limit];
    if (limit == CutLimit::kPower && aims.spindle_torque_nm > 0) {
      const double most_kw = aims.spindle_torque_nm * 2 * kPi * place.rpm / 60 / 1000;
      allowed = std::min(allowed.value_or(most_kw), most_kw);
    }
    if (!allowed || place.at_1mm[limit] <= 0) continue;
    const double times = *allowed / place.at_1mm[limit];
    if (limit == CutLimit::kRate) {
      most = std::min(most, times);
    } else {
      const double exponent = grows_with_power(limit) ? place.exponent : 1;
      most = std::min(most, place.teeth_per_min * std::pow(times, 1 / exponent));
    }
  }
  return most;
}

PerLimit<double> CutLimits::loads(const Place& place, double mm_per_min) {
  PerLimit<double> out;
  const double feed_mm = place.teeth_per_min > 0 ? mm_per_min / place.teeth_per_min : 0;
  for (const CutLimit limit : kCutLimits) {
    const double factor = limit == CutLimit::kRate  ? mm_per_min
                          : grows_with_power(limit) ? std::pow(feed_mm, place.exponent)
                                                    : feed_mm;
    out[limit] = place.at_1mm[limit] * factor;
  }
  return out;
}

}  // namespace kerf
