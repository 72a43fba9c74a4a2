// The turret punch press: the sheet moves under a frame that stands.
#include <algorithm>
#include <cmath>

#include "twin/machine_model/builtin_parts.h"

namespace kerf {
namespace {

constexpr int kPunches = 16;  // drawn around the turret

struct PunchSizes {
  double under = 0;  // z of the sheet's underside
  double over = 0;   // z of its upper side
  double unit = 0;
  double table_front = 0;  // y, in the base
  double throat = 0;       // y where the frame closes behind the sheet
  double turret = 0;       // radius
  double half_x = 0;       // of the tables
  double stroke_top = 0;   // z of the upper turret's underside
  double clamp_y = 0;      // in the frame of the sheet: its edge in front
};

PunchSizes punch_sizes(const FittedRoom& room) {
  PunchSizes s;
  const Box& sheet = room.blank_mm;
  s.under = sheet.min.z;
  s.over = sheet.max.z;
  s.unit = std::clamp(0.2 * std::max(sheet.size().x, sheet.size().y), 120.0, 400.0);
  // The turret's middle is behind the punch that works.
  s.turret = 1.2 * s.unit;
  s.clamp_y = sheet.min.y;
  s.throat = std::max(sheet.max.y - room.nose_min_mm.y, 2.2 * s.turret) + 0.3 * s.unit;
  s.table_front = sheet.min.y - room.nose_max_mm.y - 1.1 * s.unit;
  s.half_x = std::max(0.55 * sheet.size().x, 2.0 * s.unit);
  s.stroke_top = std::max(s.over + 0.12 * s.unit, 0.0);
  return s;
}

MeshBuilder punch_frame(const PunchSizes& s) {
  const double u = s.unit;
  MeshBuilder frame;
  const double front = -0.9 * u;
  const double back = s.throat + 1.6 * u;
  const double low = s.under - 3.2 * u;
  const double top = s.stroke_top + 2.6 * u;
  // The C: upper arm, back, lower arm; (u, v) = (y, z).
  const double upper = s.stroke_top + 0.75 * u;
  const double lower = s.under - 0.9 * u;
  const std::vector<Vec2> c{{front, low},           {back, low},
                            {back, top - 0.3 * u},  {back - 0.3 * u, top},
                            {front + 0.2 * u, top}, {front, top - 0.2 * u},
                            {front, upper},         {s.throat, upper},
                            {s.throat, lower},      {front, lower}};
  frame.prism(c, 0, -0.75 * u, 0.75 * u);
  return frame;
}

/// Both discs of the turret, with the stations around.
MeshBuilder punch_turret(const PunchSizes& s) {
  const double u = s.unit;
  const double r = s.turret;
  const double ring = r - 0.2 * u;  // where the stations are: one of them over the origin
  MeshBuilder turret;
  const Vec3 middle(0, ring, 0);
  turret.cylinder(middle + Vec3(0, 0, s.stroke_top), 2, r, 0.35 * u);
  turret.cylinder(middle + Vec3(0, 0, s.stroke_top + 0.35 * u), 2, 0.35 * u, 0.38 * u);
  turret.cylinder(middle + Vec3(0, 0, s.under - 2 - 0.3 * u), 2, r, 0.3 * u);
  turret.cylinder(middle + Vec3(0, 0, s.under - 2 - 0.3 * u), 2, 0.35 * u, -0.56 * u);
  for (int i = 1; i < kPunches; ++i) {
    const double angle = 2 * kPi * i / kPunches - kPi / 2;
    const double size = (i % 3 == 0 ? 0.15 : i % 3 == 1 ? 0.09 : 0.12) * u;
    turret.cylinder(
        middle + Vec3(ring * std::cos(angle), ring * std::sin(angle), s.stroke_top + 0.34 * u), 2,
        size, 0.22 * u);
  }
  return turret;
}

/// Where the sheet lies: in front of the lower turret and at its sides.
MeshBuilder punch_table(const PunchSizes& s) {
  const double u = s.unit;
  const double top = s.under;
  const double deep = 0.05 * u;  // the brushes' length
  const double beside = s.turret + 0.1 * u;
  MeshBuilder table;
  table.box({-s.half_x, s.table_front, top - 0.14 * u}, {s.half_x, -0.3 * u, top - deep});
  table.box({-s.half_x, -0.3 * u, top - 0.14 * u}, {-beside, s.throat - 0.2 * u, top - deep});
  table.box({beside, -0.3 * u, top - 0.14 * u}, {s.half_x, s.throat - 0.2 * u, top - deep});
  // Rows of brushes, on whose tips the sheet slides.
  const int rows = 15;
  for (int i = 0; i < rows; ++i) {
    const double x = s.half_x * (2.0 * (i + 0.5) / rows - 1);
    const bool inner = std::abs(x) < beside + 0.1 * u;
    table.box({x - 0.03 * u, s.table_front + 0.2 * u, top - deep},
              {x + 0.03 * u, inner ? -0.4 * u : s.throat - 0.3 * u, top});
  }
  for (const double x : {-s.half_x + 0.1 * u, s.half_x - 0.3 * u}) {
    for (const double y : {s.table_front + 0.1 * u, s.throat - 0.5 * u}) {
      table.box({x, y, s.under - 3.2 * u}, {x + 0.2 * u, y + 0.2 * u, top - 0.12 * u});
    }
  }
  return table;
}

/// The beam in front, which takes the sheet along Y; its height stays clear of the table.
MeshBuilder punch_carriage(const PunchSizes& s, const FittedRoom& room) {
  const double u = s.unit;
  const double half = s.half_x + 0.5 * room.travel().x;
  MeshBuilder carriage;
  const double y = s.clamp_y - 0.55 * u;
  carriage.block({-half, y - 0.35 * u, s.under + 2}, {half, y, s.under + 0.4 * u}, 0, 0.05 * u);
  carriage.box({-half + 2, y, s.under + 0.1 * u}, {half - 2, y + 0.04 * u, s.under + 0.3 * u});
  return carriage;
}

MeshBuilder punch_clamps(const PunchSizes& s, const FittedRoom& room) {
  const double u = s.unit;
  MeshBuilder clamps;
  const double y = s.clamp_y - 0.5 * u;
  const Box& sheet = room.blank_mm;
  clamps.box({sheet.min.x, y, s.under + 0.12 * u}, {sheet.max.x, y + 0.12 * u, s.under + 0.28 * u});
  for (const double part : {0.2, 0.8}) {
    const double x = sheet.min.x + part * sheet.size().x;
    const double grip = s.clamp_y + 0.12 * u;
    // Jaws above and below the sheet, which lies between them; (u, v) = (y, z).
    const std::vector<Vec2> upper{{y + 0.12 * u, s.over + 0.3},
                                  {grip, s.over + 0.3},
                                  {grip, s.over + 0.05 * u},
                                  {s.clamp_y, s.over + 0.09 * u},
                                  {s.clamp_y - 0.3 * u, s.over + 0.1 * u},
                                  {y + 0.2 * u, s.over + 0.3 * u},
                                  {y + 0.12 * u, s.over + 0.3 * u}};
    clamps.prism(upper, 0, x - 0.15 * u, x + 0.15 * u);
    clamps.box({x - 0.12 * u, y + 0.12 * u, s.under + 0.3},
               {x + 0.12 * u, s.clamp_y - 0.3, s.over});
  }
  return clamps;
}

MeshBuilder punch_ram(const PunchSizes& s, const FittedRoom& room) {
  const double u = s.unit;
  MeshBuilder ram;
  const double top = s.stroke_top + 1.4 * u - room.nose_min_mm.z;
  const std::array<Vec2, 6> body{
      Vec2(0, 0),         Vec2(0.11 * u, 0), Vec2(0.11 * u, 0.6 * u), Vec2(0.2 * u, 0.65 * u),
      Vec2(0.2 * u, top), Vec2(0, top)};
  ram.turned(Vec3(0.0), 2, body);
  return ram;
}

}  // namespace

MachineModel build_punch(const MachineRoom& room) {
  const Vec3 up(0, 0, 1);
  FittedRoom fitted = fit(room, up);
  // No punch comes in from beside the edge that the clamps hold.
  fitted.nose_min_mm.y = std::max(fitted.nose_min_mm.y, fitted.blank_mm.min.y);
  const PunchSizes s = punch_sizes(fitted);
  MachineAssembly machine;
  machine.fixed("frame", punch_frame(s), paint::kGlass);
  machine.fixed("turret", punch_turret(s), paint::kGlass, "frame");
  machine.fixed("table", punch_table(s), paint::kCastingDark, "frame");
  machine.slide("carriage", "frame", 1, {0, -1, 0}, punch_carriage(s, fitted), paint::kBlue);
  machine.slide("clamps", "carriage", 0, {-1, 0, 0}, punch_clamps(s, fitted), paint::kSteel);
  machine.slide("ram", "frame", 2, up, punch_ram(s, fitted), paint::kAccent);
  return machine.finish("punch press", "clamps", "ram", room.machine_from_workpiece, up);
}

}  // namespace kerf
