#include "twin/page/page_curve.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "twin/report/finding_lists.h"

namespace kerf {
namespace {

constexpr double kWidth = 1000, kHeight = 110, kLeft = 8, kTop = 22, kBottom = 20;

/// 1, 2 or 5 times a power of ten, so that there are at most `most` steps up to `end`.
double round_step(double end, double most) {
  const double least = end / most;
  const double power = std::pow(10, std::floor(std::log10(least)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * power >= least) return factor * power;
  }
  return 10 * power;
}

std::string time_text(double seconds) {
  const auto whole = static_cast<long long>(std::llround(seconds));
  if (whole < 60) return fmt::format("{:g} s", seconds);
  if (whole < 3600) return fmt::format("{}:{:02}", whole / 60, whole % 60);
  return fmt::format("{}:{:02}:{:02}", whole / 3600, whole / 60 % 60, whole % 60);
}

}  // namespace

std::string curve_svg(const PageCurve& curve) {
  const double greatest =
      curve.values.empty() ? 0 : *std::max_element(curve.values.begin(), curve.values.end());
  const double end_s = curve.step_s * static_cast<double>(curve.values.size());
  if (!(greatest > 0) || !(end_s > 0)) return {};
  const double floor_y = kHeight - kBottom, high = floor_y - kTop;
  const double wide = (kWidth - 2 * kLeft) / static_cast<double>(curve.values.size());
  std::string path = fmt::format("M{:g} {:g}", kLeft, floor_y);
  double before = -1;
  for (std::size_t i = 0; i < curve.values.size(); ++i) {
    const double y = floor_y - high * curve.values[i] / greatest;
    if (std::abs(y - before) < 0.05) continue;
    path += fmt::format("H{:.1f}V{:.1f}", kLeft + wide * static_cast<double>(i), y);
    before = y;
  }
  path += fmt::format("H{:.1f}V{:g}Z", kWidth - kLeft, floor_y);
  std::string ticks;
  const double step = round_step(end_s, 8);
  for (double t = 0; t <= end_s; t += step) {
    const double x = kLeft + (kWidth - 2 * kLeft) * t / end_s;
    ticks += fmt::format(
        R"(<path d="M{0:.1f} {1:g}v4" stroke="#8a949c"/><text x="{0:.1f}" y="{2:g}">{3}</text>)", x,
        floor_y, kHeight - 4, time_text(t));
  }
  return fmt::format(
      R"(<svg class="curve" viewBox="0 0 {0:g} {1:g}" role="img" aria-label="{2}">)"
      R"(<text x="{3:g}" y="14">{2}, {4:.4g} {5}</text>)"
      R"(<path d="{6}" fill="{7}" fill-opacity=".35" stroke="{7}" stroke-width="1"/>{8}</svg>)",
      kWidth, kHeight, xml_text(curve.title), kLeft, greatest, xml_text(curve.unit), path,
      curve.color, ticks);
}

}  // namespace kerf
