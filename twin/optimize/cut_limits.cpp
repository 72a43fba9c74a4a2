#include "twin/optimize/cut_limits.h"

#include <algorithm>
#include <cmath>

namespace kerf {
namespace {

/// Below it a chip's share of the feed is no longer what it is by geometry: the edge is round.
constexpr double kLeastShare = 0.05;

/// sin(kappa) of a piece at a height above the tip: 0 where the edge lies flat, 1 where it is
/// upright.
double lead_sine_at(const ProfilePiece& piece, double z_mm) {
  if (piece.kind == ProfilePiece::Kind::kLine) {
    const double length = std::hypot(piece.r1 - piece.r0, piece.z1 - piece.z0);
    return length > 0 ? std::abs(piece.z1 - piece.z0) / length : 0;
  }
  if (piece.radius <= 0) return 0;
  const double up = std::clamp((z_mm - piece.center_z) / piece.radius, -1.0, 1.0);
  return std::sqrt(1 - up * up);
}

}  // namespace

const char* key_of(CutLimit limit) {
  switch (limit) {
    case CutLimit::kChip:
      return "chip_mm";
    case CutLimit::kRate:
      return "rate_mm3_s";
  }
  return "";
}

CutLimits::CutLimits(const Cutter& cutter) : teeth_(cutter.teeth().value_or(0)) {
  const auto pieces = cutter.profile();
  lead_height_mm_ = pieces.back().z1;
  if (lead_height_mm_ <= 0) return;
  double most = 0;
  for (int k = 0; k <= kDepths; ++k) {
    const double z = lead_height_mm_ * k / kDepths;
    for (const ProfilePiece& piece : pieces) {
      if (piece.z0 > z || (piece.z1 <= 0 && piece.z0 <= 0)) continue;
      most = std::max(most, lead_sine_at(piece, std::min(z, piece.z1)));
    }
    lead_[static_cast<std::size_t>(k)] = most;
  }
}

double CutLimits::lead_sine(double deep_mm) const {
  if (deep_mm > lead_height_mm_) return 1;
  const auto k = static_cast<std::size_t>(std::ceil(kDepths * deep_mm / lead_height_mm_));
  return lead_[std::min(k, lead_.size() - 1)];
}

double CutLimits::chip_share(const EngagementLook& look) const {
  const double lead = lead_sine(look.deep_mm);
  const double arc = look.angle_rad >= kPi / 2 ? 1 : std::sin(look.angle_rad);
  return std::max(kLeastShare, look.is_plunge ? lead : arc * lead);
}

double CutLimits::section_mm2(const EngagementLook& look) {
  if (look.is_plunge) return kPi / 4 * look.wide_mm * look.wide_mm;
  return look.wide_mm * look.deep_mm;
}

double CutLimits::most_feed(const FeedAims& aims, const EngagementLook& look, double rpm) const {
  double most = std::numeric_limits<double>::infinity();
  if (const auto& chip_mm = aims.of(CutLimit::kChip); chip_mm && teeth_ > 0 && rpm > 0)
    most = std::min(most, *chip_mm / chip_share(look) * teeth_ * rpm);
  if (const auto& rate = aims.of(CutLimit::kRate); rate && section_mm2(look) > 0)
    most = std::min(most, 60 * *rate / section_mm2(look));
  return most;
}

CutLoads CutLimits::loads(const EngagementLook& look, double rpm, double mm_per_min) const {
  CutLoads out{};
  if (teeth_ > 0 && rpm > 0)
    load_of(out, CutLimit::kChip) = mm_per_min / (teeth_ * rpm) * chip_share(look);
  load_of(out, CutLimit::kRate) = section_mm2(look) * mm_per_min / 60;
  return out;
}

}  // namespace kerf
