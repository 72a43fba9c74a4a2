#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <array>
#include <string>
#include <utility>
#include <vector>

#include "base/translate.h"
#include "viewer/window/letters.h"
#include "viewer/window/panels.h"

namespace kerf {
namespace {

constexpr double kMegabyte = 1024.0 * 1024.0;
constexpr int kMostLine = 99'999'999;
constexpr std::array kObjects{Text::kWorkpiece,    Text::kCutter,  Text::kHolder,
                              Text::kTraverses,    Text::kFeeds,   Text::kPlanned,
                              Text::kBlank,        Text::kFrames,  Text::kFindings,
                              Text::kMachineParts, Text::kFixtures};
static_assert(kObjects.size() == kSceneObjectCount);
constexpr std::array kColorNames{
    Text::kColorPlain,     Text::kColorHeight,       Text::kColorTool,  Text::kColorRemovalRate,
    Text::kColorFeed,      Text::kColorFeedPerTooth, Text::kColorAngle, Text::kColorChip,
    Text::kColorForce,     Text::kColorTorque,       Text::kColorPower, Text::kColorBend,
    Text::kColorLineRange, Text::kColorDeviation};
static_assert(kColorNames.size() == kColorModes);

constexpr std::array kCurves{
    Text::kCurveNone, Text::kCurveRate,  Text::kFeed,        Text::kFeedPerTooth, Text::kCurveAngle,
    Text::kCurveChip, Text::kCurveForce, Text::kCurveTorque, Text::kCurvePower,   Text::kCurveBend};
static_assert(kCurves.size() == kCurveChoices);

constexpr std::array kColorTargets{Text::kColorOnSurface, Text::kColorOnBoth, Text::kColorOnPath};

constexpr std::array kDrawModes{Text::kDrawMesh, Text::kDrawRaycast, Text::kDrawCsg};

bool header(const PanelContext& context, Text title, bool is_open) {
  return ImGui::CollapsingHeader(
      fmt::format("{}###{}", context.word(title), static_cast<int>(title)).c_str(),
      is_open ? ImGuiTreeNodeFlags_DefaultOpen : 0);
}

void draw_objects(const PanelContext& context) {
  if (!header(context, Text::kObjects, true)) return;
  if (!ImGui::BeginTable("objects", 2)) return;
  ImGui::TableSetupColumn("", ImGuiTableColumnFlags_WidthStretch, 1.7f);
  ImGui::TableSetupColumn("", ImGuiTableColumnFlags_WidthStretch, 1.0f);
  ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, {4.0f * context.scale, 0.0f});
  for (std::size_t object = 0; object < kSceneObjectCount; ++object) {
    ObjectLook& look = context.settings->drawing.looks[object];
    ImGui::PushID(static_cast<int>(object));
    ImGui::TableNextColumn();
    ImGui::Checkbox(context.word(kObjects[object]), &look.is_visible);
    ImGui::TableNextColumn();
    ImGui::SetNextItemWidth(-1.0f);
    auto percent = static_cast<int>(look.opacity * 100.0f + 0.5f);
    if (ImGui::SliderInt("##opacity", &percent, 5, 100, "%d %%", ImGuiSliderFlags_AlwaysClamp)) {
      look.opacity = 0.01f * static_cast<float>(percent);
    }
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", context.word(Text::kOpacity));
    ImGui::PopID();
  }
  ImGui::PopStyleVar();
  ImGui::EndTable();
  bool is_tail = context.settings->drawing.path_tail > 0;
  if (ImGui::Checkbox(context.word(Text::kPathTail), &is_tail)) {
    context.settings->drawing.path_tail = is_tail ? kTailMoves : 0;
  }
}

ImU32 opaque(const ColorLegendEntry& entry) { return entry.color | 0xff000000u; }

void draw_legend(const PanelContext& context) {
  const float side = ImGui::GetTextLineHeight();
  for (const ColorLegendEntry& entry : context.legend) {
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const float unit = context.scale;
    ImGui::GetWindowDrawList()->AddRectFilled(
        {at.x + 4.0f * unit, at.y + 2.0f * unit},
        {at.x + 4.0f * unit + 1.4f * side, at.y + side - unit}, opaque(entry), 2.0f * unit);
    ImGui::SetCursorPosX(ImGui::GetCursorPosX() + 2.0f * side);
    ImGui::TextUnformatted(entry.text.c_str());
  }
}

void draw_line_range(const PanelContext& context) {
  const auto& files = context.shown.program->files;
  // A machine may say its line where nobody has given the program.
  const int most = files.empty() ? kMostLine : files.front().line_count();
  PanelState& state = *context.state;
  bool is_changed = false;
  const auto field = [&](Text label, int* line) {
    ImGui::SetNextItemWidth(120.0f * context.scale);
    if (ImGui::InputInt(context.word(label), line, 1, 100)) {
      *line = std::clamp(*line, 1, most);
      is_changed = true;
    }
  };
  field(Text::kFirstLine, &state.first_line);
  field(Text::kLastLine, &state.last_line);
  if (is_changed) context.commands->push(color_command(*context.settings, *context.state));
}

/// Of a machine that is watched the path has no colours.
void draw_color_targets(const PanelContext& context) {
  DrawOptions& drawing = context.settings->drawing;
  if (!is_by_move(drawing.color_by) || !context.shown.timeline->has_curves) return;
  for (std::size_t i = 0; i < kColorTargets.size(); ++i) {
    if (i > 0) ImGui::SameLine();
    const auto target = static_cast<ColorTarget>(i);
    // The last one in a narrow panel, where words are long, is on a line of its own.
    const float width = ImGui::GetFrameHeight() + ImGui::GetStyle().ItemInnerSpacing.x +
                        ImGui::CalcTextSize(context.word(kColorTargets[i])).x;
    if (i > 0 && ImGui::GetContentRegionAvail().x < width) ImGui::NewLine();
    if (ImGui::RadioButton(context.word(kColorTargets[i]), target == drawing.color_on))
      drawing.color_on = target;
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s  [V]", context.word(Text::kColorOn));
  }
}

Text why_no_colors(const PanelContext& context) {
  const ColorBy mode = context.settings->drawing.color_by;
  const auto load = load_of(mode);
  if (!load || is_offered(mode, *context.shown.timeline, *context.shown.setup))
    return Text::kNoColorsYet;
  return needs_material(*load) ? Text::kNeedsMaterial : Text::kNeedsEngagement;
}

void draw_colors(const PanelContext& context) {
  if (!header(context, Text::kColors, true)) return;
  DrawOptions& drawing = context.settings->drawing;
  ImGui::SetNextItemWidth(-1.0f);
  const auto mode = static_cast<std::size_t>(drawing.color_by);
  if (ImGui::BeginCombo("##colors", context.word(kColorNames[mode]))) {
    for (std::size_t i = 0; i < kColorNames.size(); ++i) {
      if (!is_offered(static_cast<ColorBy>(i), *context.shown.timeline, *context.shown.setup))
        continue;
      if (!ImGui::Selectable(context.word(kColorNames[i]), i == mode) || i == mode) continue;
      drawing.color_by = static_cast<ColorBy>(i);
      context.commands->push(color_command(*context.settings, *context.state));
    }
    ImGui::EndCombo();
  }
  if (drawing.color_by == ColorBy::kLineRange) draw_line_range(context);
  if (drawing.color_by == ColorBy::kDeviation) {
    ImGui::SetNextItemWidth(120.0f * context.scale);
    const Measures& measures = context.measures;
    double value = drawing.tolerance_mm / measures.mm_per_unit();
    const std::string label =
        fmt::format("{} ({})###tolerance", context.word(Text::kTolerance), measures.name());
    const double step = measures.unit() == LengthUnit::kInch ? 0.0002 : 0.005;
    const std::string format = fmt::format("%.{}f", measures.digits());
    if (ImGui::InputDouble(label.c_str(), &value, step, 10.0 * step, format.c_str())) {
      drawing.tolerance_mm =
          std::clamp(value * measures.mm_per_unit(), kMinTolerance_mm, kMaxTolerance_mm);
    }
  }
  draw_color_targets(context);
  if (drawing.color_by != ColorBy::kPlain && context.legend.empty()) {
    ImGui::TextColored(theme::kDim, "%s", context.word(why_no_colors(context)));
  }
  draw_legend(context);
}

void draw_curve_choice(const PanelContext& context) {
  if (!context.shown.timeline->has_curves) return;
  CurveChoice& chosen = context.settings->curve;
  ImGui::SetNextItemWidth(150.0f * context.scale);
  if (!ImGui::BeginCombo(context.word(Text::kCurve),
                         context.word(kCurves[static_cast<std::size_t>(chosen)]))) {
    return;
  }
  for (std::size_t i = 0; i < kCurves.size(); ++i) {
    const auto curve = static_cast<CurveChoice>(i);
    if (!is_offered(curve, *context.shown.timeline)) continue;
    if (ImGui::Selectable(context.word(kCurves[i]), curve == chosen)) chosen = curve;
  }
  ImGui::EndCombo();
}

void draw_section(const PanelContext& context) {
  if (!header(context, Text::kSection, true)) return;
  SectionChoice& section = context.settings->section;
  const Box& bounds = context.bounds_mm;
  ImGui::Checkbox(context.word(Text::kSection), &section.is_on);
  for (int axis = 0; axis < 3; ++axis) {
    ImGui::SameLine();
    const char name[] = {"XYZ"[axis], '\0'};
    if (ImGui::RadioButton(name, section.axis == axis) && section.axis != axis) {
      section.axis = axis;
      if (!bounds.empty()) section.offset_mm = 0.5 * (bounds.min[axis] + bounds.max[axis]);
    }
  }
  if (bounds.empty()) return;
  const Measures& measures = context.measures;
  const double mm = measures.mm_per_unit();
  const double low = bounds.min[section.axis] / mm, high = bounds.max[section.axis] / mm;
  double offset = section.offset_mm / mm;
  const std::string format = fmt::format("%.{}f {}", measures.digits() - 1, measures.name());
  ImGui::SetNextItemWidth(-1.0f);
  if (ImGui::SliderScalar("##offset", ImGuiDataType_Double, &offset, &low, &high, format.c_str(),
                          ImGuiSliderFlags_AlwaysClamp)) {
    section.offset_mm = offset * mm;
    section.is_on = true;
  }
  ImGui::Checkbox(context.word(Text::kSectionFlip), &section.is_flipped);
  ImGui::SameLine();
  ImGui::Checkbox(context.word(Text::kSectionQuarter), &section.is_quarter);
}

void draw_modes(const PanelContext& context) {
  DrawMode& draw_mode = context.settings->drawing.draw_mode;
  for (std::size_t i = 0; i < kDrawModes.size(); ++i) {
    if (i > 0) ImGui::SameLine();
    const auto candidate = static_cast<DrawMode>(i);
    if (!ImGui::RadioButton(context.word(kDrawModes[i]), candidate == draw_mode) ||
        candidate == draw_mode) {
      continue;
    }
    draw_mode = candidate;
    context.commands->push(DrawModeCommand{draw_mode});
  }
  if (const std::string note = draw_note(context); !note.empty()) {
    ImGui::PushTextWrapPos(0.0f);
    ImGui::TextColored(theme::kDim, "%s", note.c_str());
    ImGui::PopTextWrapPos();
  }
}

void draw_drawing(const PanelContext& context) {
  if (!header(context, Text::kDrawing, false)) return;
  ViewSettings* settings = context.settings;
  draw_modes(context);
  ImGui::Checkbox(context.word(Text::kLocalDrawing), &settings->drawing.is_local);
  ImGui::BeginDisabled(context.is_light);
  ImGui::Checkbox(context.word(Text::kDarkBackground), &settings->drawing.is_dark);
  ImGui::EndDisabled();
  const DrawCounters& counters = context.counters;
  const auto line = [](const std::string& text) {
    ImGui::TextColored(theme::kDim, "%s", text.c_str());
  };
  line(fmt::format("{:.0f} {}", context.state->frames_per_s, context.word(Text::kFramesPerSecond)));
  const auto kind = [&](Text name, const DrawCounters::Kind& counted) {
    const auto frames = static_cast<double>(std::max<std::uint64_t>(1, counted.frames));
    line(fmt::format("{} {}: {:.2f} MP, {:.2f} ms", context.word(name), counted.frames,
                     static_cast<double>(counted.pixels) / frames * 1e-6, counted.ms / frames));
  };
  kind(Text::kFull, counters.full);
  kind(Text::kLocal, counters.local);
  kind(Text::kStill, counters.still);
  line(fmt::format("{} {:.1f} MB", context.word(Text::kGpuMemory),
                   static_cast<double>(counters.gpu_bytes) / kMegabyte));
  line(fmt::format("{} {:.1f} MB, {} {:.1f} MB", context.word(Text::kUploaded),
                   static_cast<double>(counters.uploaded_bytes) / kMegabyte,
                   context.word(Text::kWaiting),
                   static_cast<double>(counters.waiting_bytes) / kMegabyte));
}

void draw_theme(const PanelContext& context) {
  constexpr std::array kThemes{Text::kThemeDark, Text::kThemeLight, Text::kThemeSystem};
  ThemeChoice& theme = context.settings->theme;
  ImGui::SetNextItemWidth(150.0f * context.scale);
  const std::string label = fmt::format("{}###theme", context.word(Text::kTheme));
  if (!ImGui::BeginCombo(label.c_str(), context.word(kThemes[static_cast<std::size_t>(theme)]))) {
    return;
  }
  for (std::size_t i = 0; i < kThemes.size(); ++i) {
    const auto candidate = static_cast<ThemeChoice>(i);
    if (ImGui::Selectable(context.word(kThemes[i]), candidate == theme)) theme = candidate;
  }
  ImGui::EndCombo();
}

void draw_units(const PanelContext& context) {
  LengthUnit& units = context.settings->units;
  for (const LengthUnit candidate : {LengthUnit::kMm, LengthUnit::kInch}) {
    if (candidate != LengthUnit::kMm) ImGui::SameLine();
    if (ImGui::RadioButton(Measures(candidate).name(), candidate == units)) units = candidate;
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s  [U]", context.word(Text::kUnits));
  }
}

/// What each language calls itself; its code where the letters of the name are missing.
std::vector<std::pair<std::string, std::string>> names_of_languages() {
  std::vector<std::pair<std::string, std::string>> all;
  for (const std::string& code : languages()) {
    const std::string name = name_of_language(code);
    const bool is_readable = !has_east_asian(letters_in(name)) || east_asian_font();
    all.emplace_back(code, is_readable ? name : code);
  }
  return all;
}

void choose_language(const PanelContext& context, const std::string& code) {
  if (!can_show(code)) {
    context.state->notice = missing_letters_text(code);
    return;
  }
  if (!use_language(code)) return;
  context.settings->language = code;
  context.state->notice.clear();
  context.commands->push(ReadAgainCommand{});
}

void draw_language(const PanelContext& context) {
  static const std::vector<std::pair<std::string, std::string>> kLanguages = names_of_languages();
  const std::string spoken = language();
  const auto shown = std::find_if(kLanguages.begin(), kLanguages.end(),
                                  [&](const auto& entry) { return entry.first == spoken; });
  ImGui::SetNextItemWidth(150.0f * context.scale);
  const std::string label = fmt::format("{}###language", context.word(Text::kLanguage));
  if (!ImGui::BeginCombo(label.c_str(),
                         shown == kLanguages.end() ? spoken.c_str() : shown->second.c_str())) {
    return;
  }
  for (const auto& [code, name] : kLanguages) {
    if (ImGui::Selectable(name.c_str(), code == spoken)) choose_language(context, code);
  }
  ImGui::EndCombo();
}

void draw_text_size(const PanelContext& context) {
  ViewSettings* settings = context.settings;
  ImGui::SetNextItemWidth(150.0f * context.scale);
  constexpr std::array kScales{0.85, 1.0, 1.25, 1.5, 2.0, 3.0};
  if (ImGui::BeginCombo(context.word(Text::kTextSize),
                        fmt::format("{:.0f} %", 100.0 * settings->text_scale).c_str())) {
    for (const double scale : kScales) {
      if (ImGui::Selectable(fmt::format("{:.0f} %", 100.0 * scale).c_str(),
                            scale == settings->text_scale)) {
        settings->text_scale = scale;
      }
    }
    ImGui::EndCombo();
  }
}

}  // namespace

void draw_view_tab(const PanelContext& context) {
  draw_objects(context);
  draw_colors(context);
  draw_curve_choice(context);
  draw_section(context);
  draw_drawing(context);
  ImGui::Separator();
  draw_theme(context);
  draw_units(context);
  draw_language(context);
  draw_text_size(context);
}

ColorCommand color_command(const ViewSettings& settings, const PanelState& state) {
  return {settings.drawing.color_by, state.first_line, state.last_line};
}

std::string draw_note(const PanelContext& context) {
  const DrawOptions& drawing = context.settings->drawing;
  const DrawAnswer* const answer = context.shown.draw_mode.get();
  if (drawing.draw_mode == DrawMode::kMesh || answer == nullptr ||
      answer->draw_mode != drawing.draw_mode) {
    return {};
  }
  const auto about = [&](Text sentence, const auto& what) {
    return fmt::format(fmt::runtime(context.word(sentence)), what);
  };
  switch (answer->limit) {
    case DrawLimit::kNone:
      break;
    case DrawLimit::kNoHeights:
      return about(Text::kDrawNoHeights, answer->detail);
    case DrawLimit::kCompared:
      return context.word(Text::kDrawCompared);
    case DrawLimit::kNoBox:
      return about(Text::kDrawNoBox, answer->detail);
    case DrawLimit::kTilted:
      return context.word(Text::kDrawTilted);
    case DrawLimit::kTool:
      return about(Text::kDrawTool, answer->detail);
    case DrawLimit::kWatched:
      return context.word(Text::kDrawWatched);
    case DrawLimit::kNewest:
      return about(Text::kDrawNewest, answer->line);
  }
  const bool is_missed = drawing.color_by != ColorBy::kPlain || context.settings->section.is_on;
  if (context.drawn_mode == DrawMode::kMesh || !is_missed) return {};
  return fmt::format("{}: {}",
                     context.word(kDrawModes[static_cast<std::size_t>(context.drawn_mode)]),
                     context.word(Text::kDrawIsPlain));
}

void choose_section(const SectionChoice& choice, const Box& bounds_mm, bool turns,
                    DrawOptions* drawing) {
  drawing->section.reset();
  drawing->section_beside.reset();
  if (!choice.is_on) return;
  constexpr int kY = 1;
  const auto plane_across = [&](int axis, double offset_mm, bool hides_positive) {
    SectionPlane plane;
    const double sign = hides_positive ? 1.0 : -1.0;
    plane.normal = Vec3(0.0);
    plane.normal[axis] = sign;
    plane.offset_mm = sign * offset_mm;
    return plane;
  };
  const bool is_seen_from_behind = turns && choice.axis == kY;
  drawing->section =
      plane_across(choice.axis, choice.offset_mm, choice.is_flipped != is_seen_from_behind);
  if (!choice.is_quarter || bounds_mm.empty()) return;
  const int beside = choice.axis == kY ? 0 : kY;
  drawing->section_beside = plane_across(
      beside, 0.5 * (bounds_mm.min[beside] + bounds_mm.max[beside]), beside == 0 || turns);
}

void draw_scene_legend(const PanelContext& context, glm::vec2 corner_px, glm::vec2 size_px) {
  const ColorBy mode = context.settings->drawing.color_by;
  if (!is_by_move(mode) || context.legend.empty()) return;
  const std::string title = context.word(kColorNames[static_cast<std::size_t>(mode)]);
  const float line = ImGui::GetTextLineHeightWithSpacing(), border = 6.0f * context.scale;
  const float swatch = 1.4f * ImGui::GetTextLineHeight();
  float width = ImGui::CalcTextSize(title.c_str()).x;
  for (const ColorLegendEntry& entry : context.legend)
    width = std::max(width, swatch + border + ImGui::CalcTextSize(entry.text.c_str()).x);
  const auto lines = static_cast<float>(context.legend.size() + 1);
  const ImVec2 box(width + 2 * border, lines * line + 2 * border);
  if (box.x + 2 * border > size_px.x || box.y + 2 * border > 0.6f * size_px.y) return;
  const ImVec2 low(corner_px.x + border, corner_px.y + size_px.y - border - box.y);
  ImDrawList* const list = ImGui::GetBackgroundDrawList();
  list->AddRectFilled(low, {low.x + box.x, low.y + box.y}, IM_COL32(20, 24, 30, 205), border);
  ImVec2 at(low.x + border, low.y + border);
  list->AddText(at, IM_COL32_WHITE, title.c_str());
  for (const ColorLegendEntry& entry : context.legend) {
    at.y += line;
    list->AddRectFilled({at.x, at.y + 2 * context.scale},
                        {at.x + swatch, at.y + ImGui::GetTextLineHeight() - context.scale},
                        opaque(entry), 2 * context.scale);
    list->AddText({at.x + swatch + border, at.y}, IM_COL32_WHITE, entry.text.c_str());
  }
}

}  // namespace kerf
