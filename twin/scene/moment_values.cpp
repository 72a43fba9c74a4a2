#include "twin/scene/moment_values.h"

#include <array>
#include <cmath>
#include <utility>

#include "base/translate.h"
#include "twin/motion/motion_geometry.h"
#include "twin/report/shown_lengths.h"

namespace kerf {
namespace {

Vec3 turned(const Vec3& v, double angle_deg) {
  const double angle = angle_deg * kPi / 180.0;
  const double c = std::cos(angle), s = std::sin(angle);
  return {c * v.x - s * v.y, s * v.x + c * v.y, v.z};
}

}  // namespace

void set_feed(const Motion& motion, Moment* moment) {
  moment->is_traverse = is_traverse(motion);
  moment->feed_mm_per_min =
      motion.feed_mm_per_min * (motion.feed_per_rev ? motion.spindle_rpm : 1.0);
}

Vec3 machine_position(const WorkpieceFrame& frame, const Vec3& work_mm,
                      const Vec3& tool_offset_mm) {
  return turned(work_mm + frame.g92_mm, frame.rotation_deg) + frame.g5x_mm + tool_offset_mm;
}

std::vector<AxisReadout> axis_readouts(const Vec3& machine_mm, const Vec3& work_mm,
                                       const std::array<double, 3>* rotary_deg,
                                       const SlidePlace* slides) {
  std::vector<AxisReadout> axes;
  for (int i = 0; i < 3; ++i) {
    AxisReadout axis;
    axis.name = "XYZ"[i];
    axis.machine = machine_mm[i];
    axis.work = work_mm[i];
    axes.push_back(axis);
  }
  for (std::size_t i = 0; rotary_deg && i < 3; ++i) {
    AxisReadout axis;
    axis.name = "ABC"[i];
    axis.is_rotary = true;
    axis.machine = axis.work = (*rotary_deg)[i];
    axes.push_back(axis);
  }
  for (int i = 0; slides && i < 3; ++i) {
    AxisReadout axis;
    axis.name = "UVW"[i];
    axis.machine = slides->machine_mm[i];
    axis.work = slides->work_mm[i];
    axes.push_back(axis);
  }
  return axes;
}

void show_diameter(AxisReadout& axis) {
  axis.is_diameter = true;
  axis.machine *= 2;
  axis.work *= 2;
  if (axis.to_go) *axis.to_go *= 2;
}

std::vector<SceneFrame> scene_frames(const WorkpieceFrame& frame, const std::string& work_offset) {
  SceneFrame work;
  work.name = work_offset;
  SceneFrame machine;
  machine.name = "machine";
  machine.origin_mm = turned(-frame.g5x_mm, -frame.rotation_deg) - frame.g92_mm;
  machine.x_axis = turned(Vec3(1, 0, 0), -frame.rotation_deg);
  machine.y_axis = turned(Vec3(0, 1, 0), -frame.rotation_deg);
  if (machine.origin_mm == work.origin_mm && frame.rotation_deg == 0) return {work};
  return {work, machine};
}

std::string coolant_text(bool mist, bool flood) {
  if (mist && flood) return tr("mist flood");
  return mist ? tr("mist") : flood ? tr("flood") : "";
}

std::shared_ptr<const FindingList> finding_list(const std::vector<Finding>& findings,
                                                const std::vector<std::string>& files) {
  auto list = std::make_shared<FindingList>();
  list->findings.reserve(findings.size());
  for (const Finding& finding : findings) {
    SceneFinding shown;
    shown.severity = finding.severity;
    if (finding.source.file < files.size()) shown.file = files[finding.source.file];
    shown.line = static_cast<int>(finding.source.line);
    shown.time_s = finding.time_s.value_or(0.0);
    shown.position_mm = finding.position_mm;
    shown.text = message_of(finding);
    // Numbers of the interpreter's are the program's.
    if (finding.id != FindingId::kInterpreterError &&
        finding.id != FindingId::kInterpreterWarning) {
      shown.inch_text = in_unit(shown.text, LengthUnit::kInch);
    }
    list->findings.push_back(std::move(shown));
  }
  return list;
}

}  // namespace kerf
