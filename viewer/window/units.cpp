#include "viewer/window/units.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace kerf {
namespace {

constexpr double kMmPerInch = mm_of(LengthUnit::kInch);
constexpr double kMm3PerInch3 = kMmPerInch * kMmPerInch * kMmPerInch;
constexpr double kMm3PerCm3 = 1000.0;

/// "-0.000" is a zero that somebody will ask about.
std::string without_lonely_sign(std::string figure) {
  if (figure.find_first_of("123456789") != std::string::npos) return figure;
  if (!figure.empty() && (figure.front() == '-' || figure.front() == '+')) figure.erase(0, 1);
  return figure;
}

std::string fixed(double value, int digits) {
  return without_lonely_sign(fmt::format("{:.{}f}", value, digits));
}

}  // namespace

int Measures::digits_for(double step_mm) const {
  const double step = std::max(step_mm / mm_per_unit(), 1e-9);
  return std::clamp(1 - static_cast<int>(std::floor(std::log10(step))), 0, 6);
}

std::string Measures::position(double mm) const { return fixed(mm / mm_per_unit(), digits()); }

std::string Measures::length(double mm, int digits) const {
  return fmt::format("{} {}", fixed(mm / mm_per_unit(), digits), name());
}

std::string Measures::signed_length(double mm, int digits) const {
  const std::string figure = fmt::format("{:+.{}f}", mm / mm_per_unit(), digits);
  return fmt::format("{} {}", without_lonely_sign(figure), name());
}

std::string Measures::feed_figure(double mm_per_min) const {
  return fixed(mm_per_min / mm_per_unit(), is_inch() ? 1 : 0);
}

std::string Measures::feed(double mm_per_min) const {
  return fmt::format("{} {}/min", feed_figure(mm_per_min), name());
}

std::string Measures::feeds(double actual_mm_per_min, double wanted_mm_per_min) const {
  return fmt::format("{} / {}", feed_figure(actual_mm_per_min), feed(wanted_mm_per_min));
}

std::string Measures::volume(double mm3) const {
  return is_inch() ? fmt::format("{} in³", fixed(mm3 / kMm3PerInch3, 3))
                   : fmt::format("{} cm³", fixed(mm3 / kMm3PerCm3, 1));
}

std::string Measures::rate(double mm3_per_s) const {
  return is_inch() ? fmt::format("{:.3g} in³/s", mm3_per_s / kMm3PerInch3)
                   : fmt::format("{:.3g} mm³/s", mm3_per_s);
}

std::string Measures::rate_up_to(double mm3_per_s) const { return "<= " + rate(mm3_per_s); }

std::pair<double, std::string> Measures::unit_of(ColorBy mode) const {
  switch (mode) {
    case ColorBy::kRemovalRate:
      return is_inch() ? std::pair(1 / kMm3PerInch3, std::string("in³/s"))
                       : std::pair(1.0, std::string("mm³/s"));
    case ColorBy::kFeed:
      return {1 / mm_per_unit(), fmt::format("{}/min", name())};
    case ColorBy::kFeedPerTooth:
    case ColorBy::kChip:
    case ColorBy::kBend:
      return {1 / mm_per_unit(), name()};
    case ColorBy::kAngle:
      return {1.0, "°"};
    case ColorBy::kForce:
      return {1.0, "N"};
    case ColorBy::kTorque:
      return {1.0, "Nm"};
    case ColorBy::kPower:
      return {1.0, "kW"};
    default:
      return {1.0, {}};
  }
}

/// Three digits; no exponents, which 10 km/min would have.
std::string Measures::value(ColorBy mode, double value) const {
  const auto [factor, unit] = unit_of(mode);
  const double shown = value * factor;
  const int digits =
      shown > 0 ? std::clamp(2 - static_cast<int>(std::floor(std::log10(shown))), 0, 6) : 0;
  std::string figure = fixed(shown, digits);
  if (digits > 0) {
    figure.erase(figure.find_last_not_of('0') + 1);
    if (figure.back() == '.') figure.pop_back();
  }
  return unit == "°" ? figure + unit : fmt::format("{} {}", figure, unit);
}

std::string Measures::values(ColorBy mode, double from, double to) const {
  const std::string low = value(mode, from);
  const std::string figure = low.substr(0, low.size() - unit_of(mode).second.size());
  return fmt::format("{}.. {}", figure.ends_with(' ') ? figure : figure + " ", value(mode, to));
}

}  // namespace kerf
