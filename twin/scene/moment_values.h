// twin/scene/moment_values.h - values of the viewer from those of kerf.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "base/geometry.h"
#include "interp_bridge/motion.h"
#include "twin/findings/finding.h"
#include "viewer/scene.h"

namespace kerf {

/// What the program wants of a motion that is under way.
void set_feed(const Motion& motion, Moment* moment);

/// Machine coordinates of a point of the workpiece frame, as the machine's own display shows them:
/// those of the tip plus the tool offset in force.
Vec3 machine_position(const WorkpieceFrame& frame, const Vec3& work_mm, const Vec3& tool_offset_mm);

/// Where U, V, W stand.
struct SlidePlace {
  Vec3 machine_mm{0};
  Vec3 work_mm{0};
};

/// X, Y, Z; with `rotary` A, B, C as well, with `slides` U, V, W.
std::vector<AxisReadout> axis_readouts(const Vec3& machine_mm, const Vec3& work_mm,
                                       const std::array<double, 3>* rotary_deg,
                                       const SlidePlace* slides = nullptr);

/// As the figures of a diameter, which X is where G7 holds.
void show_diameter(AxisReadout& axis);

/// Machine zero as it lies in the workpiece frame, and the work offset, which is its origin.
std::vector<SceneFrame> scene_frames(const WorkpieceFrame& frame, const std::string& work_offset);

/// "mist", "flood", "mist flood", "".
std::string coolant_text(bool mist, bool flood);

std::shared_ptr<const FindingList> finding_list(const std::vector<Finding>& findings,
                                                const std::vector<std::string>& files);

}  // namespace kerf
