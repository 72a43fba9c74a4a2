#include "twin/page/page_curve.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "base/curve_scale.h"
#include "base/translate.h"
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

namespace {

std::vector<float> floats_of(std::span<const double> values) {
  return {values.begin(), values.end()};
}

/// Where columns and heights lie in the picture.
struct Frame {
  double top = 1, wide = 1;
  double x(std::size_t column) const { return kLeft + wide * static_cast<double>(column); }
  double y(double value) const {
    constexpr double kHigh = kHeight - kBottom - kTop;
    return kHeight - kBottom - kHigh * std::min(1.0, value / top);
  }
};

/// From `lower` (the axis where that is empty) up to the values.
std::string area_path(const Frame& frame, std::span<const double> values) {
  std::string path = fmt::format("M{:g} {:g}", kLeft, frame.y(0));
  double before = -1;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double y = frame.y(values[i]);
    if (std::abs(y - before) < 0.05) continue;
    path += fmt::format("H{:.1f}V{:.1f}", frame.x(i), y);
    before = y;
  }
  return path + fmt::format("H{:.1f}V{:g}Z", kWidth - kLeft, frame.y(0));
}

/// At the top of columns that go on beyond it.
std::string peak_marks(const Frame& frame, std::span<const double> values) {
  std::string path;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (values[i] > frame.top) path += fmt::format("M{:.1f} {:g}v-4", frame.x(i), kTop);
  }
  return path.empty() ? path
                      : fmt::format(R"(<path d="{}" stroke="#b3261e" stroke-width="2"/>)", path);
}

std::string time_ticks(double end_s) {
  std::string ticks;
  const double step = round_step(end_s, 8), floor_y = kHeight - kBottom;
  for (double t = 0; t <= end_s; t += step) {
    const double x = kLeft + (kWidth - 2 * kLeft) * t / end_s;
    ticks += fmt::format(
        R"(<path d="M{0:.1f} {1:g}v4" stroke="#8a949c"/><text x="{0:.1f}" y="{2:g}">{3}</text>)", x,
        floor_y, kHeight - 4, time_text(t));
  }
  return ticks;
}

std::string limit_line(const Frame& frame, const PageCurve& curve) {
  if (!(curve.limit > 0) || curve.limit > frame.top) return {};
  return fmt::format(
      R"(<path d="M{0:g} {1:.1f}H{2:g}" stroke="#9a5b00" stroke-width="1.5" stroke-dasharray="6 4"/>)",
      kLeft, frame.y(curve.limit), kWidth - kLeft);
}

std::string words_of(const PageCurve& curve, const CurveScale& scale) {
  std::string out = fmt::format("{}, {:.4g} {}", curve.title, scale.most, curve.unit);
  if (scale.most_high > scale.most) out += trf(" (may be {:.4g})", scale.most_high);
  if (scale.is_clipped) out += trf("; peaks beyond {:.4g} are cut off", scale.top);
  if (curve.limit > 0) out += trf("; limit {:g} {}", curve.limit, curve.unit);
  return out;
}

}  // namespace

std::string curve_svg(const PageCurve& curve) {
  const CurveScale scale = scale_of(floats_of(curve.values), floats_of(curve.high), curve.limit);
  const double end_s = curve.step_s * static_cast<double>(curve.values.size());
  if (!(scale.top > 0) || !(end_s > 0)) return {};
  const Frame frame{scale.top, (kWidth - 2 * kLeft) / static_cast<double>(curve.values.size())};
  std::string drawn;
  if (!curve.high.empty()) {
    drawn += fmt::format(R"(<path d="{}" fill="{}" fill-opacity=".18"/>)",
                         area_path(frame, curve.high), curve.color);
  }
  drawn += fmt::format(R"(<path d="{0}" fill="{1}" fill-opacity=".35" stroke="{1}"/>)",
                       area_path(frame, curve.values), curve.color);
  return fmt::format(
      R"(<svg class="curve" viewBox="0 0 {0:g} {1:g}" data-columns="{2}" role="img" aria-label="{3}">)"
      R"(<text x="{4:g}" y="14">{5}</text>{6}{7}{8}{9}<path class="now" d="M0 0"/></svg>)",
      kWidth, kHeight, curve.values.size(), xml_text(curve.title), kLeft,
      xml_text(words_of(curve, scale)), drawn, peak_marks(frame, curve.values),
      limit_line(frame, curve), time_ticks(end_s));
}

}  // namespace kerf
