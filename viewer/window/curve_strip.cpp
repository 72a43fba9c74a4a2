// The curve below the time slider: what the program does when.
#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "base/curve_scale.h"
#include "viewer/window/panels.h"

namespace kerf {
namespace {

constexpr ImU32 kLimit = IM_COL32(235, 165, 50, 255), kPeak = IM_COL32(240, 90, 110, 255);
/// Of the range's end above the nominal value.
constexpr ImU32 kBandAlpha = 0x58000000u;

struct Curve {
  const std::vector<float>* values = nullptr;
  const std::vector<float>* high = nullptr;  ///< null: they have no range
  double limit = 0.0;                        ///< 0: none is known
  Text name = Text::kCurveRate;
  Text why_none = Text::kNoTeeth;  ///< where there are no values
};

Text name_of(CutLoadKind kind) {
  switch (kind) {
    case CutLoadKind::kAngle:
      return Text::kCurveAngle;
    case CutLoadKind::kChip:
      return Text::kCurveChip;
    case CutLoadKind::kForce:
      return Text::kCurveForce;
    case CutLoadKind::kTorque:
      return Text::kCurveTorque;
    case CutLoadKind::kPower:
      return Text::kCurvePower;
    case CutLoadKind::kBend:
      break;
  }
  return Text::kCurveBend;
}

Curve load_curve(const PanelContext& context, CutLoadKind kind) {
  const SceneLoadCurve& load = context.shown.curves->loads[static_cast<std::size_t>(kind)];
  Curve curve{&load.nominal, nullptr, load.limit, name_of(kind), Text::kNoTeeth};
  if (needs_material(kind)) curve.high = &load.high;
  if (!is_offered(context.settings->curve, *context.shown.timeline))
    curve.why_none = needs_material(kind) ? Text::kNeedsMaterial : Text::kNeedsEngagement;
  else if (kind == CutLoadKind::kBend)
    curve.why_none = Text::kNoStickout;
  else if (kind == CutLoadKind::kAngle)
    curve.why_none = Text::kNothingYet;
  return curve;
}

Curve chosen_curve(const PanelContext& context) {
  const ProgramCurves& curves = *context.shown.curves;
  if (const auto load = load_of(context.settings->curve)) return load_curve(context, *load);
  switch (context.settings->curve) {
    case CurveChoice::kFeed:
      return {&curves.feed_mm_per_min, nullptr, 0.0, Text::kFeed, Text::kNoTeeth};
    case CurveChoice::kFeedPerTooth:
      return {&curves.feed_per_tooth_mm, nullptr, 0.0, Text::kFeedPerTooth, Text::kNoTeeth};
    default:
      return {&curves.mm3_per_s, nullptr, 0.0, Text::kCurveRate, Text::kNoTeeth};
  }
}

std::string figure(const PanelContext& context, double value) {
  switch (context.settings->curve) {
    case CurveChoice::kRate:
      return context.measures.rate(value);
    case CurveChoice::kFeed:
      return context.measures.feed(value);
    case CurveChoice::kFeedPerTooth:
      return context.measures.length(value, context.measures.digits() + 1);
    default:
      return context.measures.value(color_of(context.settings->curve), value);
  }
}

/// The greatest of the columns that share a pixel stands for them, in its colour.
void draw_columns(const ProgramCurves& curves, const Curve& curve, const CurveScale& scale,
                  double duration_s, ImVec2 low, ImVec2 high) {
  ImDrawList* const list = ImGui::GetWindowDrawList();
  const std::vector<float>& values = *curve.values;
  const double seconds_a_pixel = duration_s / static_cast<double>(high.x - low.x);
  const auto columns = static_cast<double>(values.size());
  const auto height_of = [&](float value) {
    const double share = std::min(1.0, static_cast<double>(value) / scale.top);
    return std::max(1.0f, std::round(static_cast<float>(share) * (high.y - low.y)));
  };
  for (float x = low.x; x < high.x; x += 1.0f) {
    const double begin_s = static_cast<double>(x - low.x) * seconds_a_pixel;
    const auto first = static_cast<std::size_t>(std::min(columns, begin_s / curves.step_s));
    const auto last = static_cast<std::size_t>(
        std::min(columns - 1, (begin_s + seconds_a_pixel) / curves.step_s));
    std::size_t at = first;
    for (std::size_t i = first; i <= last && i < values.size(); ++i) {
      if (values[i] > values[at]) at = i;
    }
    if (at >= values.size() || !(values[at] > 0.0f)) continue;
    const std::uint32_t rgb = at < curves.color.size() ? curves.color[at] & 0xffffffu : 0xa0a0a0u;
    const float top = high.y - height_of(values[at]);
    list->AddRectFilled({x, top}, {x + 1.0f, high.y}, rgb | 0xff000000u);
    float most = values[at];
    if (curve.high != nullptr && at < curve.high->size()) {
      most = std::max(most, (*curve.high)[at]);
      list->AddRectFilled({x, high.y - height_of(most)}, {x + 1.0f, top}, rgb | kBandAlpha);
    }
    if (static_cast<double>(values[at]) > scale.top)
      list->AddRectFilled({x, low.y}, {x + 1.0f, low.y + 2.0f}, kPeak);
  }
}

void draw_tip(const PanelContext& context, const Curve& curve, double time_s) {
  const ProgramCurves& curves = *context.shown.curves;
  std::string tip = clock_text(time_s);
  const auto column = static_cast<std::size_t>(time_s / curves.step_s);
  if (column < curve.values->size()) {
    tip += fmt::format("\n{} {}", context.word(curve.name),
                       figure(context, static_cast<double>((*curve.values)[column])));
    const double high = curve.high != nullptr ? static_cast<double>((*curve.high)[column]) : 0.0;
    if (high > 0.0)
      tip +=
          ", " + fmt::format(fmt::runtime(context.word(Text::kCurveHigh)), figure(context, high));
  }
  ImGui::SetTooltip("%s", tip.c_str());
}

/// Behind its name: the greatest, where the scale ends before that, the limit.
std::string scale_text(const PanelContext& context, const Curve& curve, const CurveScale& scale) {
  const auto words = [&](Text which, double value) {
    return fmt::format(fmt::runtime(context.word(which)), figure(context, value));
  };
  std::string out = fmt::format("  <= {}", figure(context, scale.most));
  if (curve.high != nullptr && scale.most_high > scale.most)
    out += fmt::format(" ({})", words(Text::kCurveHigh, scale.most_high));
  if (scale.is_clipped) out += ", " + words(Text::kCurvePeaks, scale.top);
  if (curve.limit > 0.0) out += ", " + words(Text::kCurveLimit, curve.limit);
  return out;
}

}  // namespace

ColorBy color_of(CurveChoice curve) {
  if (curve == CurveChoice::kNone) return ColorBy::kPlain;
  return static_cast<ColorBy>(static_cast<int>(ColorBy::kRemovalRate) + static_cast<int>(curve) -
                              static_cast<int>(CurveChoice::kRate));
}

bool is_offered(CurveChoice curve, const ProgramTimeline& timeline) {
  const auto load = load_of(curve);
  return !load || (needs_material(*load) ? timeline.has_forces : timeline.has_loads);
}

bool is_offered(ColorBy mode, const ProgramTimeline& timeline, const SceneSetup& setup) {
  if (mode == ColorBy::kDeviation) return setup.tolerance_mm.has_value();
  if (mode == ColorBy::kFeed || mode == ColorBy::kFeedPerTooth) return timeline.has_curves;
  const auto load = load_of(mode);
  return !load || (needs_material(*load) ? timeline.has_forces : timeline.has_loads);
}

void draw_curve(const PanelContext& context) {
  const double duration_s = context.shown.timeline->duration_s;
  if (context.settings->curve == CurveChoice::kNone || !context.shown.timeline->has_curves) return;
  const float gap = ImGui::GetStyle().ItemSpacing.y;
  const float height = std::round(kCurveHeight_px * context.scale - gap);
  const float width = std::max(20.0f, ImGui::GetContentRegionAvail().x);
  const ImVec2 low = ImGui::GetCursorScreenPos(), high(low.x + width, low.y + height);
  ImGui::InvisibleButton("curve", {width, height});
  ImDrawList* const list = ImGui::GetWindowDrawList();
  list->AddRectFilled({low.x, high.y}, {high.x, high.y + 1.0f}, theme::kTrack);
  const double time_s = time_under_mouse(low.x, high.x, duration_s);
  seek_with_mouse(context, time_s);
  if (context.shown.curves == nullptr) return;
  const ProgramCurves& curves = *context.shown.curves;
  const Curve curve = chosen_curve(context);
  std::string label = context.word(curve.name);
  if (curve.values->empty()) {
    label += fmt::format(": {}", context.word(curve.why_none));
  } else {
    const std::span<const float> ends =
        curve.high != nullptr ? std::span<const float>(*curve.high) : std::span<const float>();
    const CurveScale scale = scale_of(*curve.values, ends, curve.limit);
    if (scale.top > 0.0) {
      draw_columns(curves, curve, scale, duration_s, low, high);
      label += scale_text(context, curve, scale);
    }
    if (curve.limit > 0.0 && curve.limit <= scale.top) {
      const auto share = static_cast<float>(curve.limit / scale.top);
      const float y = std::round(high.y - share * (high.y - low.y));
      list->AddRectFilled({low.x, y}, {high.x, y + 1.0f}, kLimit);
    }
    const double shown = std::clamp(context.shown.moment->time_s / duration_s, 0.0, 1.0);
    const float head_x = std::round(low.x + static_cast<float>(shown) * width);
    list->AddRectFilled({head_x, low.y}, {head_x + 1.0f, high.y}, theme::kHead);
    if (ImGui::IsItemHovered() || ImGui::IsItemActive()) draw_tip(context, curve, time_s);
  }
  const ImVec2 at(low.x + 2.0f * context.scale, low.y - 1.0f),
      size = ImGui::CalcTextSize(label.c_str());
  list->AddRectFilled(at, {at.x + size.x, at.y + size.y},
                      ImGui::GetColorU32(ImGuiCol_WindowBg, 0.75f));
  list->AddText(at, ImGui::ColorConvertFloat4ToU32(theme::kDim), label.c_str());
}

}  // namespace kerf
