#include "twin/process/milling/length_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/translate.h"
#include "interp_bridge/tool_lengths.h"
#include "twin/motion/motion_geometry.h"

namespace kerf {
namespace {

/// A program that mounts and sets without end is told this much.
constexpr std::size_t kMostEvents = FindingLog::kMaxKept;

std::string number(double mm) {
  const double rounded = std::round(mm * 1e3) / 1e3;
  return fmt::format("{:g}", rounded == 0 ? 0.0 : rounded);
}

/// "75 mm", or where more than Z matters "X5 Z75 mm".
std::string length_of(const Vec3& length_mm, const Vec3& other_mm) {
  const auto differ = [&](int axis) {
    return std::abs(length_mm[axis] - other_mm[axis]) > kSameLength_mm;
  };
  if (!differ(0) && !differ(1)) return number(length_mm.z) + " mm";
  std::string text;
  for (int axis = 0; axis < 3; ++axis) {
    if (!differ(axis)) continue;
    text += fmt::format("{}{}{}", text.empty() ? "" : " ", "XYZ"[axis], number(length_mm[axis]));
  }
  return text + " mm";
}

/// "U2 W-10", of what is not nothing.
std::string axes_text(const Vec3& v, const char* letters) {
  std::string text;
  for (int axis = 0; axis < 3; ++axis) {
    if (std::abs(v[axis]) <= kSameLength_mm) continue;
    text += fmt::format("{}{}{}", text.empty() ? "" : " ", letters[axis], number(v[axis]));
  }
  return text;
}

/// Axes other than X Y Z: "its tip is W-10 mm off, and it is turned A5 degrees from its place".
std::string others_text(const ToolLengthState& state) {
  std::string text;
  const std::string slides = axes_text(state.uvw_off_mm, "UVW");
  if (!slides.empty()) {
    text = trf("its tip is {} mm off{}", slides, state.displaces ? "" : tr(" (cut as programmed)"));
  }
  const std::string turns = axes_text(state.abc_off_deg, "ABC");
  if (turns.empty()) return text;
  return trf("{}{}{} degrees are missing or too much, which is not cut", text,
             text.empty() ? "" : tr(", and "), turns);
}

bool differs_in_xyz(const ToolLengthState& state) {
  return !axes_text(state.applied_mm - state.real_mm, "XYZ").empty();
}

std::string offset_text(const ToolLengthState& state) {
  const std::string applied = length_of(state.applied_mm, state.real_mm);
  const bool now = state.set_at.line != 0;
  if (state.offset_tool >= 0) {
    return now ? trf("G43 H{} applies {}", state.offset_tool, applied)
               : trf("the offset of tool {} ({}) is still in force", state.offset_tool, applied);
  }
  if (state.applied_mm == Vec3{0}) return tr("no tool length offset is in force (G43)");
  return trf("an offset of {} is in force", applied);
}

std::string result_text(const ToolLengthState& state) {
  const Vec3 off_mm = state.applied_mm - state.real_mm;
  if (state.tip_shift_mm == Vec3{0})
    return tr("cut as programmed, since the controller turns the tool");
  const bool in_z_alone =
      std::abs(off_mm.x) <= kSameLength_mm && std::abs(off_mm.y) <= kSameLength_mm;
  if (!in_z_alone) return trf("its tip is {} off", length_of(off_mm, Vec3{0}));
  return trf("its tip is {} mm {} than programmed", number(std::abs(off_mm.z)),
             off_mm.z < 0 ? tr("lower") : tr("higher"));
}

/// X Y Z are as the tool table has them.
std::string other_axes_text(const Motion& motion, const std::string& others) {
  const ToolLengthState& state = motion.length;
  if (state.verdict == ToolLengthState::Verdict::kStated) {
    return trf(
        "the program gives tool {} another offset itself (G43.1, G43.2) than the tool table: "
        "{}{}{}; positions are taken as programmed",
        motion.tool, axes_text(state.uvw_off_mm, "UVW"),
        axes_text(state.uvw_off_mm, "UVW").empty() ? "" : " ", axes_text(state.abc_off_deg, "ABC"));
  }
  const bool now = state.set_at.line != 0;
  const std::string applied =
      state.offset_tool < 0 ? std::string(tr("no tool length offset is in force (G43)"))
      : now                 ? trf("G43 H{} is in force", state.offset_tool)
                            : trf("the offset of tool {} is still in force", state.offset_tool);
  return trf("{}, and tool {} in the spindle has another one: {}", applied, motion.tool, others);
}

std::int64_t micrometres(double mm) { return std::llround(std::clamp(mm, -1e9, 1e9) * 1e3); }

}  // namespace

std::string length_text(const Motion& motion) {
  const ToolLengthState& state = motion.length;
  const std::string others = others_text(state);
  if (!differs_in_xyz(state)) return other_axes_text(motion, others);
  const std::string real = length_of(state.real_mm, state.applied_mm);
  if (state.verdict == ToolLengthState::Verdict::kStated) {
    return trf(
        "the program gives tool {} a length of {} itself (G43.1, G43.2), the tool table says {}; "
        "positions are taken as programmed",
        motion.tool, length_of(state.applied_mm, state.real_mm), real);
  }
  return trf("{}, and tool {} in the spindle is {} long: {}{}{}", offset_text(state), motion.tool,
             real, result_text(state), others.empty() ? "" : "; ", others);
}

bool LengthCheck::comes_near(const Motion& m, const Vec3& shift_mm, double radius_mm) const {
  Box way = bounds_of(m);
  way.min -= shift_mm;
  way.max -= shift_mm;
  const double reach_mm = radius_mm + kNearBlank_mm;
  return way.min.z < blank_mm_.max.z + kNearBlank_mm && way.min.x - reach_mm < blank_mm_.max.x &&
         way.max.x + reach_mm > blank_mm_.min.x && way.min.y - reach_mm < blank_mm_.max.y &&
         way.max.y + reach_mm > blank_mm_.min.y;
}

bool LengthCheck::matters(const Motion& m, double radius_mm, bool upright, bool touches) const {
  const bool works = is_feed(m);
  if (!works && !is_traverse(m)) return false;
  if (!works && touches) return true;
  if (!works && !m.start_known) return false;
  if (!works && m.to_mm.z > m.from_mm.z) return false;
  if (!upright) return works;
  return comes_near(m, Vec3{0}, radius_mm) ||
         (works && comes_near(m, m.length.tip_shift_mm, radius_mm));
}

void LengthCheck::check(const Motion& m, const TimedStep& step, double radius_mm, bool upright,
                        bool touches) {
  const ToolLengthState& state = m.length;
  if (state.verdict == ToolLengthState::Verdict::kSound) return;
  if (!matters(m, radius_mm, upright, touches)) return;
  const bool of_a_line = state.set_at.line != 0;
  const Vec3 off_mm = state.applied_mm - state.real_mm;
  Event event{m.tool, of_a_line ? state.set_at.file : 0, state.set_at.line, state.offset_tool};
  std::size_t at = 4;
  for (const Vec3& off : {off_mm, state.abc_off_deg, state.uvw_off_mm}) {
    for (int axis = 0; axis < 3; ++axis) event[at++] = micrometres(off[axis]);
  }
  if (told_.size() >= kMostEvents || !told_.insert(event).second) return;
  Finding finding;
  finding.id = FindingId::kToolLength;
  if (state.verdict == ToolLengthState::Verdict::kStated) finding.severity = Severity::kWarning;
  finding.source = of_a_line ? state.set_at : m.source;
  finding.time_s = step.start_s;
  finding.tool = m.tool;
  finding.text = length_text(m);
  finding.hint = state.verdict == ToolLengthState::Verdict::kStated
                     ? tr("within 1 mm it would be taken for wear")
                     : tr("G43 behind M6 takes the length of the tool in the spindle");
  log_.add(std::move(finding));
}

}  // namespace kerf
