// Mills whose head tilts: the bridge mill (fork and spindle), and the mill that swivels its spindle
// over a table that turns.
#include <algorithm>
#include <cmath>

#include "base/portable_math.h"
#include "twin/machines/builtin_gantry.h"
#include "twin/machines/builtin_parts.h"

namespace kerf {
namespace {

/// Where nobody says how far the pivot is from the nose; and a head needs a body.
constexpr double kUsualPivot_mm = 120;
constexpr double kLeastPivot_mm = 60;

/// All of a head is measured by the radius of its spindle.
struct HeadSizes {
  double pivot = 0;  // z of the pivot over the nose
  double r = 0;
};

HeadSizes head_sizes(const MachineRoom& room) {
  HeadSizes s;
  const double pivot = room.head_pivot_mm.value_or(kUsualPivot_mm);
  s.pivot = std::max(pivot, kLeastPivot_mm);
  s.r = std::clamp(0.22 * s.pivot, 14.0, 60.0);
  return s;
}

ChainLink turning(std::string name, std::string parent, std::size_t axis, const Vec3& direction,
                  const Vec3& origin_mm) {
  return {std::move(name), std::move(parent), JointKind::kRotary, static_cast<std::uint8_t>(axis),
          false,           direction,         origin_mm};
}

/// From the nose up past the pivot. Frame: nose at 0.
MeshBuilder tilting_spindle(const HeadSizes& s) {
  const double r = s.r;
  MeshBuilder spindle;
  add_spindle_nose(spindle, Vec3(0.0), 0.5 * r, 0.6 * r);
  const double top = s.pivot + 0.8 * r;
  const std::array<Vec2, 7> body{Vec2(0, 0.6 * r),    Vec2(0.6 * r, 0.6 * r),
                                 Vec2(0.85 * r, r),   Vec2(0.85 * r, top - 0.15 * r),
                                 Vec2(0.75 * r, top), Vec2(0.2 * r, top),
                                 Vec2(0, top)};
  spindle.turned(Vec3(0.0), 2, body);
  return spindle;
}

/// Hangs the spindle on a link whose origin is the pivot.
void add_spindle(MachineAssembly& machine, const HeadSizes& s, const std::string& parent) {
  ChainLink spindle;
  spindle.name = "spindle";
  spindle.parent = parent;
  spindle.origin_mm = {0, 0, -s.pivot};
  machine.add(std::move(spindle), tilting_spindle(s).take(), paint::kSteel);
}

/// As the gantry, but wide and high enough for a head that lies down.
GantrySizes bridge_sizes(const FittedRoom& room, const HeadSizes& head) {
  GantrySizes s;
  const Vec3 travel = room.travel();
  s.top = room.blank_mm.min.z;
  s.unit = std::clamp(0.1 * std::max(travel.x, travel.y), 40.0, 160.0);
  const double u = s.unit;
  s.body = head.r;
  s.half_carriage = 1.3 * head.r + 0.35 * u;
  const double aside = head.pivot + s.half_carriage + 15;
  s.inner_min = std::min(room.nose_min_mm.x, room.blank_mm.min.x) - aside;
  s.inner_max = std::max(room.nose_max_mm.x, room.blank_mm.max.x) + aside;
  s.side = 0.3 * u;
  s.plate = 1.3 * head.r + 0.05 * u;
  s.beam_y = s.plate + 0.6 * u;
  s.beam_depth = 1.1 * u;
  s.table_min_y = std::min(room.nose_min_mm.y, room.blank_mm.min.y) - 0.5 * u - 25;
  s.table_max_y = std::max(room.nose_max_mm.y, room.blank_mm.max.y) + 0.5 * u;
  s.rail = s.top - 0.5 * u;
  s.beam_low = std::max(room.blank_mm.max.z + 25, room.nose_max_mm.z + head.pivot + 2.35 * head.r);
  s.beam_high = s.beam_low + 1.4 * u;
  return s;
}

/// What goes up and down and holds the fork. Frame: nose at 0.
MeshBuilder bridge_ram(const GantrySizes& s, const HeadSizes& head, const FittedRoom& room) {
  const double r = head.r;
  const double low = head.pivot + 2.15 * r;
  const double high = s.beam_high + 0.05 * s.unit - room.nose_min_mm.z;
  MeshBuilder ram;
  ram.block({-1.3 * r, -1.3 * r, low}, {1.3 * r, s.plate, high}, 2, 0.25 * r);
  ram.block({-0.9 * s.half_carriage, s.plate, low + 0.3 * r},
            {0.9 * s.half_carriage, s.plate + 0.15 * s.unit, high}, 1, 0.06 * s.unit);
  return ram;
}

/// Turns under the ram, and holds the spindle between its cheeks. Frame: pivot at 0.
MeshBuilder bridge_fork(const HeadSizes& head) {
  const double r = head.r;
  MeshBuilder fork;
  // High enough for a spindle that points up by 30 degrees.
  fork.cylinder({0, 0, 1.85 * r}, 2, 1.2 * r, 0.3 * r);
  fork.block({-0.8 * r, -1.5 * r, 1.5 * r}, {0.8 * r, 1.5 * r, 1.9 * r}, 1, 0.1 * r);
  for (const double side : {-1.0, 1.0}) {
    const double inner = side * 1.15 * r;
    fork.box({-0.7 * r, inner, 0}, {0.7 * r, side * 1.5 * r, 1.55 * r});
    fork.cylinder({0, inner, 0}, 1, 0.7 * r, side * 0.35 * r);
    fork.cylinder({0, side * 1.5 * r, 0}, 1, 0.4 * r, side * 0.1 * r);
  }
  return fork;
}

}  // namespace

MachineModel build_bridge_mill(const MachineRoom& room) {
  const Vec3 up(0, 0, 1);
  const FittedRoom fitted = fit(room, up);
  const HeadSizes head = head_sizes(room);
  const GantrySizes s = bridge_sizes(fitted, head);
  const double u = s.unit;
  MeshBuilder table;
  add_slotted_table(table, {{s.inner_min + 2, s.table_min_y, s.top - 0.35 * u},
                            {s.inner_max - 2, s.table_max_y, s.top}});
  MeshBuilder frame;
  add_gantry_frame(frame, s, s.rail - 1.0 * u, s.rail);
  MachineAssembly machine;
  machine.fixed("frame", std::move(frame), paint::kCasting);
  machine.fixed("table", std::move(table), paint::kIron, "frame");
  machine.slide("bridge", "frame", 1, {0, 1, 0}, gantry_bridge(s), paint::kCasting);
  machine.slide("carriage", "bridge", 0, {1, 0, 0}, gantry_carriage(s), paint::kDarkSteel);
  machine.slide("ram", "carriage", 2, up, bridge_ram(s, head, fitted), paint::kCastingDark);
  machine.add(turning("fork", "ram", 5, up, {0, 0, head.pivot}), bridge_fork(head).take(),
              paint::kBlue);
  MeshBuilder pin;
  pin.cylinder({0, -1.14 * head.r, 0}, 1, 0.35 * head.r, 2.28 * head.r);
  machine.add(turning("swivel", "fork", 4, {0, -1, 0}, Vec3(0.0)), pin.take(), paint::kDarkSteel);
  add_spindle(machine, head, "swivel");
  return machine.finish("bridge mill", "table", "spindle", room.machine_from_workpiece, up);
}

namespace {

/// Machine coordinates at rest, nose at 0.
struct SwivelSizes {
  HeadSizes head;
  double platter_radius = 0;
  double platter_thick = 0;
  double unit = 0;
  Box table;
  double saddle_bottom = 0;
  double face = 0;  // of the column, y
};

SwivelSizes swivel_sizes(const MachineRoom& room, const FittedRoom& fitted) {
  SwivelSizes s;
  s.head = head_sizes(room);
  const Box& blank = fitted.blank_mm;
  double reach = 0;  // from the axis of C, which goes through X0 Y0
  for (const double x : {blank.min.x, blank.max.x}) {
    for (const double y : {blank.min.y, blank.max.y})
      reach = std::max(reach, portable::hypot(x, y));
  }
  s.platter_radius = std::max(1.08 * reach + 8, 50.0);
  s.platter_thick = std::min(0.25 * s.platter_radius, 40.0);
  s.table = table_around(fitted, 2.3 * s.platter_radius, 2.3 * s.platter_radius);
  const Vec3 half(1.15 * s.platter_radius, 1.15 * s.platter_radius, 0);
  s.table.extend({-half, half});
  s.table.max.z = blank.min.z - 2.2 * s.platter_thick;
  s.table.min.z = s.table.max.z - 1.2 * s.platter_thick;
  s.unit = std::max(s.table.size().y, 0.6 * s.table.size().x);
  s.saddle_bottom = s.table.min.z - 0.14 * s.unit;
  s.face = std::max(s.table.max.y - fitted.nose_min_mm.y + kGapBehindTable_mm, 4 * s.head.r);
  return s;
}

MeshBuilder swivel_column(const SwivelSizes& s, const FittedRoom& room) {
  const double u = s.unit;
  const double depth = 0.4 * u;
  const double top = room.nose_max_mm.z + s.head.pivot + 2.5 * s.head.r;
  const double half = std::max(0.3 * u, 2 * s.head.r);
  MeshBuilder column;
  const double front = s.table.min.y - room.nose_max_mm.y - 0.1 * u;
  column.block({-0.42 * u, front, s.saddle_bottom - 0.3 * u},
               {0.42 * u, s.face + depth, s.saddle_bottom}, 1, 0.05 * u);
  column.block({-half, s.face, s.saddle_bottom - 1}, {half, s.face + depth, top}, 2, 0.05 * u);
  for (const double x : {-0.6 * half, 0.6 * half}) {
    column.box({x - 0.1 * half, s.face - 0.04 * u, s.saddle_bottom + 0.1 * u},
               {x + 0.1 * half, s.face + 1, top - 0.02 * u});
  }
  return column;
}

/// From the column to the drum that swivels. Frame: nose at 0.
MeshBuilder swivel_head(const SwivelSizes& s) {
  const double r = s.head.r;
  const double z = s.head.pivot;
  MeshBuilder head;
  head.block({-1.3 * r, 2.1 * r, z - 1.3 * r}, {1.3 * r, s.face - 0.05 * s.unit, z + 1.3 * r}, 1,
             0.3 * r);
  const double half = std::max(0.28 * s.unit, 1.8 * r);
  head.box({-half, s.face - 0.1 * s.unit, z - 1.6 * r},
           {half, s.face - 0.045 * s.unit, z + 2.0 * r});
  head.cylinder({0, 1.95 * r, z}, 1, 1.35 * r, 0.2 * r);
  return head;
}

/// The drum, and what holds the spindle in front of it. Frame: pivot at 0.
MeshBuilder swivel_drum(const HeadSizes& head) {
  const double r = head.r;
  MeshBuilder drum;
  drum.cylinder({0, 1.3 * r, 0}, 1, 1.2 * r, 0.62 * r);
  drum.block({-0.9 * r, 0.3 * r, -0.9 * r}, {0.9 * r, 1.32 * r, 0.6 * r}, 1, 0.15 * r);
  return drum;
}

}  // namespace

MachineModel build_swivel_mill(const MachineRoom& room) {
  const Vec3 up(0, 0, 1);
  const FittedRoom fitted = fit(room, up);
  const SwivelSizes s = swivel_sizes(room, fitted);
  const double top = fitted.blank_mm.min.z;
  MachineAssembly machine;
  machine.fixed("column", swivel_column(s, fitted), paint::kCasting);
  MeshBuilder saddle;
  saddle.block({-0.34 * s.unit, s.table.min.y + 10, s.saddle_bottom + 1},
               {0.34 * s.unit, s.table.max.y, s.table.min.z - 1}, 0, 0.03 * s.unit);
  machine.slide("saddle", "column", 1, {0, -1, 0}, std::move(saddle), paint::kCastingDark);
  MeshBuilder table;
  add_slotted_table(table, s.table);
  table.cylinder({0, 0, s.table.max.z}, 2, 1.05 * s.platter_radius, 1.2 * s.platter_thick - 2);
  table.block(
      {0.7 * s.platter_radius, -0.3 * s.platter_radius, s.table.max.z},
      {1.14 * s.platter_radius, 0.3 * s.platter_radius, s.table.max.z + 1.1 * s.platter_thick}, 2,
      0.05 * s.platter_radius);
  machine.slide("table", "saddle", 0, {-1, 0, 0}, std::move(table), paint::kIron);
  MeshBuilder platter;
  platter.cylinder({0, 0, top - s.platter_thick}, 2, s.platter_radius, s.platter_thick);
  // So that it is seen to turn.
  platter.box({0.97 * s.platter_radius, -0.06 * s.platter_radius, top - 0.8 * s.platter_thick},
              {1.03 * s.platter_radius, 0.06 * s.platter_radius, top - 0.2 * s.platter_thick});
  machine.add(turning("platter", "table", 5, -up, Vec3(0.0)), platter.take(), paint::kSteel);
  machine.slide("head", "column", 2, up, swivel_head(s), paint::kAccent);
  machine.add(turning("swivel", "head", 4, {0, -1, 0}, {0, 0, s.head.pivot}),
              swivel_drum(s.head).take(), paint::kBlue);
  add_spindle(machine, s.head, "swivel");
  return machine.finish("swivel-head mill", "platter", "spindle", room.machine_from_workpiece, up);
}

}  // namespace kerf
