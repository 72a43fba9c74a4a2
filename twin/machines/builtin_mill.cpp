// The knee mill.
#include <algorithm>

#include "twin/machines/builtin_parts.h"

namespace kerf {
namespace {

/// A dovetail along X, its upper face at z.
void add_dovetail(MeshBuilder& mesh, double middle_y, double half, double half_x, double z,
                  double height) {
  const double low = 0.78 * half;
  const std::vector<Vec2> outline{{middle_y - low, z - height},
                                  {middle_y + low, z - height},
                                  {middle_y + half, z},
                                  {middle_y - half, z}};
  mesh.prism(outline, 0, -half_x, half_x);
}

/// Heights of a knee mill, machine coordinates at rest, and how far it reaches.
struct KneeMillSizes {
  Box table;
  double unit = 0;        // what the rest is measured by: the depth of the table
  double saddle_top = 0;  // = underside of the table
  double knee_top = 0;
  double knee_bottom = 0;
  double knee_front = 0;   // y
  double column_face = 0;  // y
  double floor = 0;
  double ram = 0;  // z of its underside
};

KneeMillSizes knee_mill_sizes(const FittedRoom& room) {
  KneeMillSizes s;
  s.table = table_around(room, 300, 140);
  s.unit = std::max(s.table.size().y, 0.35 * s.table.size().x);
  const double top = room.blank_mm.min.z;
  s.saddle_top = top - std::clamp(0.22 * s.unit, 30.0, 110.0);
  s.knee_top = s.saddle_top - std::clamp(0.16 * s.unit, 22.0, 90.0);
  s.knee_bottom = s.knee_top - 0.75 * s.unit;
  s.table.max.z = top;
  s.table.min.z = s.saddle_top;
  s.column_face = s.table.max.y - room.nose_min_mm.y + kGapBehindTable_mm;
  s.knee_front = s.table.min.y - room.nose_max_mm.y - 0.08 * s.unit;
  s.floor = s.knee_bottom - room.nose_max_mm.z - 0.25 * s.unit;
  s.ram = 1.25 * s.unit;
  return s;
}

MeshBuilder knee_mill_column(const KneeMillSizes& s) {
  const double front = s.knee_front;
  const double u = s.unit;
  const double face = s.column_face;
  const double depth = 0.8 * u;
  MeshBuilder column;
  column.block({-0.66 * u, front - 0.1 * u, s.floor - 0.16 * u}, {0.66 * u, face + depth, s.floor},
               2, 0.1 * u);
  // Column: straight in front for the knee, narrower at the top behind.
  const std::vector<Vec2> side{{face, s.floor},
                               {face + depth, s.floor},
                               {face + 0.85 * depth, s.ram - 0.25 * u},
                               {face + 0.85 * depth, s.ram},
                               {face, s.ram}};
  column.prism(side, 0, -0.44 * u, 0.44 * u);
  column.box({-0.26 * u, face - 0.05 * u, s.floor + 0.1 * u}, {0.26 * u, face, s.ram - 0.2 * u});
  // Turret and ram, which reaches out over the table.
  column.cylinder({0, face + 0.42 * depth, s.ram}, 2, 0.36 * u, 0.1 * u);
  const double low = s.ram + 0.1 * u;
  column.block({-0.2 * u, -0.28 * u, low}, {0.2 * u, face + 0.95 * depth, low + 0.34 * u}, 1,
               0.05 * u);
  return column;
}

MeshBuilder knee_mill_head(const KneeMillSizes& s) {
  const double u = s.unit;
  const double quill = 0.45 * u;  // how far the nose hangs out of the head
  MeshBuilder head;
  add_spindle_nose(head, Vec3(0.0), 0.1 * u, 0.22 * u);
  head.cylinder({0, 0, 0.22 * u}, 2, 0.115 * u, quill - 0.22 * u);
  head.block({-0.24 * u, -0.24 * u, quill}, {0.24 * u, 0.26 * u, s.ram + 0.36 * u}, 2, 0.07 * u);
  head.cylinder({0, 0, s.ram + 0.36 * u}, 2, 0.2 * u, 0.08 * u);
  head.cylinder({0, 0, s.ram + 0.44 * u}, 2, 0.17 * u, 0.42 * u);
  head.cylinder({0, 0, s.ram + 0.86 * u}, 2, 0.1 * u, 0.05 * u);
  // Quill lever and depth stop.
  head.cylinder({0.24 * u, -0.08 * u, quill + 0.25 * u}, 0, 0.035 * u, 0.1 * u);
  head.cylinder({0.32 * u, -0.08 * u, quill + 0.25 * u}, 1, 0.018 * u, -0.32 * u);
  head.cylinder({-0.12 * u, -0.27 * u, quill + 0.05 * u}, 2, 0.02 * u, 0.5 * u);
  return head;
}

MeshBuilder knee_mill_knee(const KneeMillSizes& s) {
  const double u = s.unit;
  const double front = s.knee_front;
  MeshBuilder knee;
  const double back = s.column_face - 0.055 * u;
  const double waist = s.knee_top - 0.3 * u;
  const std::vector<Vec2> side{{front, waist},
                               {front + 0.1 * u, waist - 0.08 * u},
                               {back, s.knee_bottom},
                               {back, s.knee_top},
                               {front, s.knee_top}};
  knee.prism(side, 0, -0.3 * u, 0.3 * u);
  // Gibs that hold it on the column.
  knee.box({-0.33 * u, back - 0.1 * u, s.knee_bottom}, {-0.27 * u, back + 0.05 * u, s.knee_top});
  knee.box({0.27 * u, back - 0.1 * u, s.knee_bottom}, {0.33 * u, back + 0.05 * u, s.knee_top});
  add_handwheel(knee, {0, front, s.knee_top - 0.16 * u}, 1, 0.13 * u, -0.12 * u);
  return knee;
}

}  // namespace

MachineModel build_knee_mill(const MachineRoom& room) {
  const Vec3 up(0, 0, 1);
  const FittedRoom fitted = fit(room, up);
  const KneeMillSizes s = knee_mill_sizes(fitted);
  const double u = s.unit;
  MachineAssembly machine;
  machine.fixed("column", knee_mill_column(s), paint::kCasting);
  machine.fixed("head", knee_mill_head(s), paint::kAccent, "column");
  machine.slide("knee", "column", 2, -up, knee_mill_knee(s), paint::kCasting);

  MeshBuilder saddle;
  const double half_x = std::min(0.42 * u, 0.4 * s.table.size().x);
  const double wide = 0.5 * (s.saddle_top - s.knee_top);
  saddle.box({-half_x, s.table.min.y + 0.04 * u, s.knee_top + 1},
             {half_x, s.table.max.y, s.knee_top + wide});
  add_dovetail(saddle, 0.5 * (s.table.min.y + s.table.max.y), 0.4 * s.table.size().y, half_x,
               s.saddle_top, wide);
  machine.slide("saddle", "knee", 1, {0, -1, 0}, std::move(saddle), paint::kCastingDark);

  MeshBuilder table;
  add_slotted_table(table, s.table);
  // Below the table's top, also with their rims.
  const double axis_z = s.table.max.z - 0.14 * u;
  const double axis_y = 0.5 * (s.table.min.y + s.table.max.y);
  for (const double side : {-1.0, 1.0}) {
    const double end = side < 0 ? s.table.min.x : s.table.max.x;
    table.block({end, axis_y - 0.12 * u, s.table.min.z + 4},
                {end + side * 0.07 * u, axis_y + 0.12 * u, s.table.max.z - 4}, 0, 0.03 * u);
    add_handwheel(table, {end + side * 0.07 * u, axis_y, axis_z}, 0, 0.12 * u, side * 0.08 * u);
  }
  machine.slide("table", "saddle", 0, {-1, 0, 0}, std::move(table), paint::kIron);
  return machine.finish("knee mill", "table", "head", room.machine_from_workpiece, up);
}

}  // namespace kerf
