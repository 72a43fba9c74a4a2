// The mill with a tilting and turning table.
#include <algorithm>
#include <cmath>

#include "base/portable_math.h"
#include "twin/machines/builtin_parts.h"

namespace kerf {
namespace {

/// The tilting table, frame of the cradle: its axis along X through the origin.
struct CradleSizes {
  double platter_radius = 0;
  double platter_thick = 0;
  double platter_top = 0;  // z
  double bottom = 0;       // of the cradle
  double arm = 0;          // inner face of the arms, x
  double arm_thick = 0;
  double half_depth = 0;  // y
  double sweep = 0;       // nothing of cradle and platter goes farther from the axis
  double bearing = 0;     // outer face of the supports, x
};

CradleSizes cradle_sizes(const Box& blank, const Vec3& rotation_point, const Vec3& offset) {
  CradleSizes s;
  double reach = 0;
  for (const double x : {blank.min.x, blank.max.x}) {
    for (const double y : {blank.min.y, blank.max.y}) {
      reach = std::max(reach, portable::hypot(x - rotation_point.x, y - rotation_point.y));
    }
  }
  s.platter_radius = std::max(1.08 * reach + 8, 60.0);
  s.platter_thick = 0.2 * s.platter_radius;
  s.platter_top = blank.min.z - rotation_point.z - offset.z;
  const double under = s.platter_top - s.platter_thick - 2;
  s.bottom = under - 0.22 * s.platter_radius;
  s.arm = s.platter_radius + 8;
  s.arm_thick = 0.2 * s.platter_radius;
  const double aside = std::abs(offset.x) + std::abs(offset.y);
  s.half_depth = 0.7 * s.platter_radius + aside;
  const double side = s.platter_radius + aside;
  s.sweep = std::max(portable::hypot(side, std::max(std::abs(s.platter_top), std::abs(under))),
                     portable::hypot(s.half_depth, s.bottom));
  s.bearing = s.arm + s.arm_thick + 6 + 0.32 * s.platter_radius;
  return s;
}

MeshBuilder cradle_mesh(const CradleSizes& s) {
  MeshBuilder mesh;
  const double r = s.platter_radius;
  const double hub = 0.3 * r;
  mesh.block({-s.arm - s.arm_thick, -s.half_depth, s.bottom},
             {s.arm + s.arm_thick, s.half_depth, s.bottom + 0.22 * r}, 0, 0.06 * r);
  for (const double side : {-1.0, 1.0}) {
    // An arm that narrows towards the trunnion; (u, v) = (y, z).
    const double d = s.half_depth;
    const double top = std::max(hub, s.bottom + 0.3 * r);
    const std::vector<Vec2> arm{{-d, s.bottom}, {d, s.bottom}, {hub, top}, {-hub, top}};
    const double inner = s.arm;
    const double outer = s.arm + s.arm_thick;
    mesh.prism(arm, 0, side < 0 ? -outer : inner, side < 0 ? -inner : outer);
    mesh.cylinder({side * outer, 0, 0}, 0, 0.2 * r, side * 8);
  }
  return mesh;
}

MeshBuilder platter_mesh(double radius, double thick) {
  MeshBuilder mesh;
  const std::array<Vec2, 8> outline{Vec2(0, -thick),
                                    Vec2(0.9 * radius, -thick),
                                    Vec2(0.9 * radius, -0.65 * thick),
                                    Vec2(radius, -0.6 * thick),
                                    Vec2(radius, -0.05 * thick),
                                    Vec2(0.98 * radius, 0),
                                    Vec2(0.12 * radius, 0),
                                    Vec2(0, 0)};
  mesh.turned(Vec3(0.0), 2, outline);
  return mesh;
}

/// Supports of the trunnions, on a table whose upper face is at `table_top` (cradle's frame).
void add_supports(MeshBuilder& mesh, const CradleSizes& s, double table_top) {
  const double r = s.platter_radius;
  const double inner = s.arm + s.arm_thick + 6;
  for (const double side : {-1.0, 1.0}) {
    const std::vector<Vec2> shape{{-0.5 * r, table_top},
                                  {0.5 * r, table_top},
                                  {0.5 * r, table_top + 0.12 * r},
                                  {0.34 * r, table_top + 0.3 * r},
                                  {0.34 * r, 0.2 * r},
                                  {0.2 * r, 0.34 * r},
                                  {-0.2 * r, 0.34 * r},
                                  {-0.34 * r, 0.2 * r},
                                  {-0.34 * r, table_top + 0.3 * r},
                                  {-0.5 * r, table_top + 0.12 * r}};
    mesh.prism(shape, 0, side < 0 ? -s.bearing : inner, side < 0 ? -inner : s.bearing);
    mesh.cylinder({side * s.bearing, 0, 0}, 0, 0.24 * r, side * 0.12 * r);
  }
}

struct TrunnionFrame {
  double table_bottom = 0;
  double saddle_bottom = 0;
  double face = 0;  // of the column, y
  double unit = 0;
};

MeshBuilder trunnion_column(const Box& table, const TrunnionFrame& f, const FittedRoom& room) {
  const double u = f.unit;
  const double depth = 0.55 * u;
  const double low = f.saddle_bottom - 0.35 * u;
  const double top = room.nose_max_mm.z + 1.0 * u;
  MeshBuilder base;
  const double front = table.min.y - room.nose_max_mm.y - 0.1 * u;
  base.block({-0.5 * u, front, low}, {0.5 * u, f.face + depth, f.saddle_bottom}, 1, 0.06 * u);
  const std::vector<Vec2> side{{f.face, f.saddle_bottom},
                               {f.face + depth, f.saddle_bottom},
                               {f.face + 0.75 * depth, top},
                               {f.face, top}};
  base.prism(side, 0, -0.4 * u, 0.4 * u);
  for (const double x : {-0.24 * u, 0.24 * u}) {
    base.box({x - 0.05 * u, f.face - 0.05 * u, f.saddle_bottom + 0.2 * u},
             {x + 0.05 * u, f.face, top - 0.02 * u});
  }
  return base;
}

MeshBuilder trunnion_head(const TrunnionFrame& f) {
  const double u = f.unit;
  MeshBuilder head;
  add_spindle_nose(head, Vec3(0.0), 0.08 * u, 0.16 * u);
  head.cylinder({0, 0, 0.16 * u}, 2, 0.12 * u, 0.06 * u);
  head.block({-0.17 * u, -0.2 * u, 0.22 * u}, {0.17 * u, 0.2 * u, 0.85 * u}, 2, 0.06 * u);
  head.block({-0.15 * u, 0.1 * u, 0.3 * u}, {0.15 * u, f.face - 0.06 * u, 0.8 * u}, 1, 0.04 * u);
  head.box({-0.31 * u, f.face - 0.12 * u, 0.25 * u}, {0.31 * u, f.face - 0.055 * u, 0.85 * u});
  head.cylinder({0, 0, 0.85 * u}, 2, 0.13 * u, 0.3 * u);
  return head;
}

ChainLink rotary(std::string name, std::string parent, std::size_t axis, const Vec3& direction,
                 const Vec3& origin_mm) {
  return {std::move(name), std::move(parent), JointKind::kRotary, static_cast<std::uint8_t>(axis),
          false,           direction,         origin_mm};
}

}  // namespace

MachineModel build_trunnion(const MachineRoom& room) {
  const Vec3 up(0, 0, 1);
  const FittedRoom fitted = fit(room, up);
  const Box& blank = fitted.blank_mm;
  const TrunnionGeometry& given = room.trunnion;
  const Vec3 middle = fitted.blank_middle();
  const Vec3 point = given.rotation_point_mm.value_or(Vec3(middle.x, middle.y, blank.min.z));
  const Vec3 offset = given.tilts_about_y ? Vec3(given.side_offset_mm, 0, given.z_offset_mm)
                                          : Vec3(0, given.side_offset_mm, given.z_offset_mm);
  const CradleSizes s = cradle_sizes(blank, point, offset);
  const Vec3 pivot = point + offset;
  // A cradle that tilts about Y is the other one turned by a quarter.
  const Pose quarter = given.tilts_about_y ? turn(up, 90) : Pose{};

  const double table_top = -s.sweep - 12;  // in the cradle's frame
  const double half_x = given.tilts_about_y ? s.sweep : s.bearing + 0.2 * s.platter_radius;
  const double half_y = given.tilts_about_y ? s.bearing + 0.2 * s.platter_radius : s.sweep;
  Box table = table_around(fitted, 2 * half_x, 2 * half_y);
  table.extend({pivot - Vec3(half_x, half_y, 0), pivot + Vec3(half_x, half_y, 0)});
  table.max.z = pivot.z + table_top;
  table.min.z = table.max.z - 0.3 * s.platter_radius;
  TrunnionFrame f;
  f.unit = std::max(table.size().y, 0.6 * table.size().x);
  f.table_bottom = table.min.z;
  f.saddle_bottom = table.min.z - 0.14 * f.unit;
  f.face = table.max.y - fitted.nose_min_mm.y + kGapBehindTable_mm;

  MachineAssembly machine;
  machine.fixed("base", trunnion_column(table, f, fitted), paint::kCasting);
  MeshBuilder saddle;
  const double half_saddle = 0.36 * f.unit;
  saddle.block({-half_saddle, table.min.y + 10, f.saddle_bottom + 1},
               {half_saddle, table.max.y, f.table_bottom - 1}, 0, 0.03 * f.unit);
  machine.slide("saddle", "base", 1, {0, -1, 0}, std::move(saddle), paint::kCastingDark);

  MeshBuilder table_mesh;
  add_slotted_table(table_mesh, table);
  MeshBuilder supports;
  add_supports(supports, s, table_top);
  table_mesh.add(supports.mesh(), shift(pivot) * quarter);
  machine.slide("table", "saddle", 0, {-1, 0, 0}, std::move(table_mesh), paint::kIron);

  MeshBuilder cradle;
  cradle.add(cradle_mesh(s).mesh(), quarter);
  machine.add(rotary("cradle", "table", given.tilts_about_y ? 4 : 3,
                     given.tilts_about_y ? Vec3(0, 1, 0) : Vec3(1, 0, 0), pivot),
              cradle.take(), paint::kBlue);
  MeshBuilder platter;
  platter.add(platter_mesh(s.platter_radius, s.platter_thick).mesh(),
              shift({0, 0, blank.min.z - point.z}));
  machine.add(rotary("platter", "cradle", 5, up, -offset), platter.take(), paint::kSteel);
  machine.slide("head", "base", 2, up, trunnion_head(f), paint::kAccent);
  return machine.finish("trunnion", "platter", "head", room.machine_from_workpiece, up);
}

}  // namespace kerf
