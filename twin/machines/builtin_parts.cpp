#include "twin/machines/builtin_parts.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace kerf {
namespace {

constexpr Box kUsualBlank{{-50.0, -50.0, -50.0}, {50.0, 50.0, 0.0}};
constexpr double kLeastMargin_mm = 20.0;  // beside the blank, for the tool to come in
constexpr double kMarginOfSize = 0.25;

}  // namespace

FittedRoom fit(const MachineRoom& room, const Vec3& nose_from_tip) {
  FittedRoom fitted;
  const Box blank = room.blank_mm.empty() ? kUsualBlank : room.blank_mm;
  fitted.blank_mm = box_around(room.machine_from_workpiece, blank);
  fitted.tool_length_mm = room.tool_length_mm;
  fitted.chuck = room.chuck;
  if (fitted.chuck)
    fitted.chuck->face_z_mm = room.machine_from_workpiece.point({0, 0, room.chuck->face_z_mm}).z;
  // Tips: all over the blank and where the program goes.
  Box tips = fitted.blank_mm;
  tips.extend(box_around(room.machine_from_workpiece, room.reach_mm));
  const Vec3 size = fitted.blank_mm.size();
  for (int axis = 0; axis < 3; ++axis) {
    const double margin = std::max(kLeastMargin_mm, kMarginOfSize * size[axis]);
    const double held = room.tool_length_mm * nose_from_tip[axis];
    const std::optional<AxisTravel>& given = room.travel[static_cast<std::size_t>(axis)];
    // A tool comes in from beside the part, but not from below.
    const double below = held > 0 ? 0.0 : margin;
    fitted.nose_min_mm[axis] = tips.min[axis] + held - (given ? 0.0 : below);
    fitted.nose_max_mm[axis] = tips.max[axis] + held + (given ? 0.0 : margin);
    if (given) {
      fitted.nose_min_mm[axis] = std::min(fitted.nose_min_mm[axis], given->min);
      fitted.nose_max_mm[axis] = std::max(fitted.nose_max_mm[axis], given->max);
    }
  }
  return fitted;
}

void MachineAssembly::fixed(std::string name, MeshBuilder mesh, std::uint32_t color,
                            std::string parent) {
  ChainLink link;
  link.name = std::move(name);
  link.parent = std::move(parent);
  add(std::move(link), mesh.take(), color);
}

void MachineAssembly::slide(std::string name, std::string parent, std::size_t axis,
                            const Vec3& direction, MeshBuilder mesh, std::uint32_t color) {
  ChainLink link;
  link.name = std::move(name);
  link.parent = std::move(parent);
  link.joint = JointKind::kPrismatic;
  link.input = static_cast<std::uint8_t>(axis);
  link.direction = direction;
  add(std::move(link), mesh.take(), color);
}

MachineModel MachineAssembly::finish(std::string name, std::string_view workpiece,
                                     std::string_view tool, const Pose& machine_from_workpiece,
                                     const Vec3& nose_from_tip) {
  Result<KinematicChain> chain = KinematicChain::create(std::move(links_), workpiece, tool);
  assert(chain);
  const Pose link_from_workpiece = link_from_workpiece_of(*chain, machine_from_workpiece);
  return {std::move(name), std::move(chain.value()), std::move(drawn_), link_from_workpiece,
          nose_from_tip};
}

Box table_around(const FittedRoom& room, double least_x_mm, double least_y_mm) {
  const Vec3 middle = 0.5 * (room.nose_min_mm + room.nose_max_mm);
  const Vec3 travel = room.travel();
  const Vec3 half(std::max(0.55 * travel.x, 0.5 * least_x_mm),
                  std::max(0.36 * travel.y, 0.5 * least_y_mm), 0);
  Box table{middle - half, middle + half};
  const Vec3 rim(15, 15, 0);
  table.extend({room.blank_mm.min - rim, room.blank_mm.max + rim});
  return table;
}

void add_slotted_table(MeshBuilder& mesh, const Box& box) {
  const Vec3 size = box.size();
  const int slots = size.y < 180 ? 2 : size.y < 420 ? 3 : 5;
  const double pitch = size.y / (slots + 0.3);
  const double neck = std::min(18.0, 0.16 * pitch);
  const double foot = 1.8 * neck;
  const double depth = std::min(0.5 * size.z, 2.2 * neck);
  std::vector<Vec2> outline{{box.min.y, box.min.z}, {box.max.y, box.min.z}, {box.max.y, box.max.z}};
  for (int i = slots - 1; i >= 0; --i) {
    const double y = 0.5 * (box.min.y + box.max.y) + (i - 0.5 * (slots - 1)) * pitch;
    const double top = box.max.z;
    for (const Vec2& p : {Vec2(y + neck / 2, top), Vec2(y + neck / 2, top - 0.5 * depth),
                          Vec2(y + foot / 2, top - 0.5 * depth), Vec2(y + foot / 2, top - depth),
                          Vec2(y - foot / 2, top - depth), Vec2(y - foot / 2, top - 0.5 * depth),
                          Vec2(y - neck / 2, top - 0.5 * depth), Vec2(y - neck / 2, top)}) {
      outline.push_back(p);
    }
  }
  outline.emplace_back(box.min.y, box.max.z);
  mesh.prism(outline, 0, box.min.x, box.max.x);
}

void add_spindle_nose(MeshBuilder& mesh, const Vec3& nose, double radius_mm, double length_mm) {
  const double r = radius_mm;
  const std::array<Vec2, 8> outline{Vec2(0, 0.02 * length_mm), Vec2(0.62 * r, 0.02 * length_mm),
                                    Vec2(0.66 * r, 0),         Vec2(0.92 * r, 0),
                                    Vec2(r, 0.1 * r),          Vec2(r, 0.45 * length_mm),
                                    Vec2(1.25 * r, length_mm), Vec2(0, length_mm)};
  mesh.turned(nose, 2, outline);
}

void add_handwheel(MeshBuilder& mesh, const Vec3& base, int axis, double radius_mm,
                   double length_mm) {
  const double r = radius_mm;
  const double way = length_mm < 0 ? -1 : 1;
  mesh.cylinder(base, axis, 0.16 * r, length_mm);
  Vec3 at = base;
  at[axis] += length_mm;
  const double half = 0.12 * r;
  const std::array<Vec2, 6> rim{Vec2(0, -0.5 * half),  Vec2(0.8 * r, -0.5 * half),
                                Vec2(0.85 * r, -half), Vec2(r, -half),
                                Vec2(r, half),         Vec2(0, half)};
  mesh.turned(at, axis, rim);
  at[axis] += way * half;
  at[(axis + 1) % 3] += 0.7 * r;
  mesh.cylinder(at, axis, 0.11 * r, way * 0.55 * r);
}

}  // namespace kerf
