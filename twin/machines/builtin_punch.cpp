// The turret punch press: the sheet moves under a frame that stands.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/portable_math.h"
#include "twin/machines/builtin_parts.h"

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

/// From the turret's axis to the stations.
double station_ring(const PunchSizes& s) { return s.turret - 0.2 * s.unit; }

/// Of station i of n about the turret's axis; clockwise, so that turning forward brings the next
/// one to the ram.
Vec3 station_place(const PunchSizes& s, std::size_t i, std::size_t n) {
  const double angle = -2 * kPi * static_cast<double>(i) / static_cast<double>(n) - kPi / 2;
  return station_ring(s) * Vec3(portable::cos(angle), portable::sin(angle), 0);
}

/// Both discs of the turret about its axis, with the stations around.
MeshBuilder punch_turret(const PunchSizes& s, const Turret* stations) {
  const double u = s.unit;
  const double r = s.turret;
  const double ring = station_ring(s);
  MeshBuilder turret;
  const Vec3 middle(0, 0, 0);
  turret.cylinder(middle + Vec3(0, 0, s.stroke_top), 2, r, 0.35 * u);
  turret.cylinder(middle + Vec3(0, 0, s.stroke_top + 0.35 * u), 2, 0.35 * u, 0.38 * u);
  turret.cylinder(middle + Vec3(0, 0, s.under - 2 - 0.3 * u), 2, r, 0.3 * u);
  turret.cylinder(middle + Vec3(0, 0, s.under - 2 - 0.3 * u), 2, 0.35 * u, -0.56 * u);
  std::vector<double> sizes;
  if (stations != nullptr) {
    const double most = 0.8 * kPi * ring / static_cast<double>(stations->stations.size());
    for (const auto& [number, station] : stations->stations) {
      sizes.push_back(
          std::min(std::clamp(1.3 * station.punch.radius_mm(), 0.04 * u, 0.18 * u), most));
    }
  } else {
    for (int i = 0; i < kPunches; ++i) {
      // The first is where the ram is.
      sizes.push_back((i == 0 ? 0.0 : i % 3 == 0 ? 0.15 : i % 3 == 1 ? 0.09 : 0.12) * u);
    }
  }
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    if (sizes[i] <= 0) continue;
    turret.cylinder(station_place(s, i, sizes.size()) + Vec3(0, 0, s.stroke_top + 0.34 * u), 2,
                    sizes[i], 0.22 * u);
  }
  return turret;
}

/// What grips the sheet: two jaws a clamp.
MeshBuilder turret_clamps(const PunchSizes& s, const MachineRoom& room) {
  const double thick = 0.08 * s.unit;
  const double over = room.blank_mm.max.z + 0.3, under = room.blank_mm.min.z - 0.3;
  MeshBuilder jaws;
  for (const SheetClamp& clamp : room.turret->clamps) {
    const Vec2 &low = clamp.min_mm, &high = clamp.max_mm;
    jaws.box(Vec3(low, over), Vec3(high, over + thick));
    jaws.box(Vec3(low, under - thick), Vec3(high, under));
  }
  MeshBuilder placed;
  placed.add(jaws.mesh(), room.machine_from_workpiece);
  return placed;
}

/// The punch itself, its tip at 0. Holes in it are not drawn.
MeshBuilder punch_body(const Cutter& punch) {
  // Ear clipping takes its time.
  constexpr std::size_t kMostCorners = 120;
  MeshBuilder body;
  for (const std::vector<Vec2>& ring : *punch.footprint()) {
    double twice = 0;
    for (std::size_t i = 0, j = ring.size() - 1; i < ring.size(); j = i++) {
      twice += ring[j].x * ring[i].y - ring[i].x * ring[j].y;
    }
    if (twice <= 0) continue;
    std::vector<Vec2> outline;
    const std::size_t step = (ring.size() + kMostCorners - 1) / kMostCorners;
    for (std::size_t i = 0; i < ring.size(); i += step) outline.push_back(ring[i]);
    body.prism(outline, 2, 0, punch.flute_length_mm().value_or(2 * punch.radius_mm()));
  }
  return body;
}

/// On which the frame goes over a sheet that lies still.
MeshBuilder punch_rails(const PunchSizes& s) {
  const double u = s.unit;
  MeshBuilder rails;
  const double low = s.under - 3.5 * u;
  for (const double y : {-0.7 * u, s.throat + 1.2 * u}) {
    rails.box({-2 * s.half_x, y, low}, {2 * s.half_x, y + 0.3 * u, low + 0.25 * u});
  }
  return rails;
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

MeshBuilder punch_clamps(const PunchSizes& s, const FittedRoom& room, bool has_jaws) {
  const double u = s.unit;
  MeshBuilder clamps;
  const double y = s.clamp_y - 0.5 * u;
  const Box& sheet = room.blank_mm;
  clamps.box({sheet.min.x, y, s.under + 0.12 * u}, {sheet.max.x, y + 0.12 * u, s.under + 0.28 * u});
  if (!has_jaws) return clamps;
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

/// Each at its station, within the upper disc; where one of them works is the picture's affair.
void add_punches(MachineAssembly& machine, const PunchSizes& s, const Turret& turret) {
  std::size_t i = 0;
  for (const auto& [number, station] : turret.stations) {
    ChainLink link{.name = punch_link(number), .parent = "turret"};
    link.origin_mm = station_place(s, i++, turret.stations.size()) + Vec3(0, 0, s.stroke_top);
    machine.add(std::move(link), punch_body(station.punch).take(), paint::kAluminium);
  }
}

/// They move along the sheet, in both directions.
void add_jaws(MachineAssembly& machine, const PunchSizes& s, const MachineRoom& room) {
  ChainLink along{.name = "grip", .parent = "clamps", .joint = JointKind::kPrismatic};
  along.by_joint = true;
  along.input = kGripX;
  along.direction = room.machine_from_workpiece.direction({1, 0, 0});
  ChainLink across{.name = "jaws", .parent = "grip", .joint = JointKind::kPrismatic};
  across.by_joint = true;
  across.input = kGripY;
  across.direction = room.machine_from_workpiece.direction({0, 1, 0});
  machine.add(std::move(along), {}, paint::kSteel);
  machine.add(std::move(across), turret_clamps(s, room).take(), paint::kDarkSteel);
}

}  // namespace

std::string punch_link(int station) { return fmt::format("punch {}", station); }

MachineModel build_punch(const MachineRoom& room) {
  const Vec3 up(0, 0, 1);
  FittedRoom fitted = fit(room, up);
  // No punch comes in from beside the edge that the clamps hold.
  fitted.nose_min_mm.y = std::max(fitted.nose_min_mm.y, fitted.blank_mm.min.y);
  const PunchSizes s = punch_sizes(fitted);
  MachineAssembly machine;
  const Turret* const turret = room.turret.get();
  const bool head_moves = turret != nullptr && !turret->sheet_moves;
  if (head_moves) {
    machine.slide("rails", "", 1, {0, 1, 0}, punch_rails(s), paint::kDarkSteel);
    machine.slide("frame", "rails", 0, {1, 0, 0}, punch_frame(s), paint::kGlass);
  } else {
    machine.fixed("frame", punch_frame(s), paint::kGlass);
    machine.fixed("table", punch_table(s), paint::kCastingDark, "frame");
  }
  ChainLink disc{.name = "turret", .parent = "frame", .origin_mm = {0, station_ring(s), 0}};
  if (turret != nullptr) {
    disc.joint = JointKind::kRotary;
    disc.by_joint = true;
    disc.input = kTurret;
  }
  machine.add(std::move(disc), punch_turret(s, turret).take(), paint::kGlass);
  if (turret != nullptr) add_punches(machine, s, *turret);
  const bool has_jaws = turret == nullptr;
  if (head_moves) {
    machine.fixed("carriage", punch_carriage(s, fitted), paint::kBlue);
    machine.fixed("clamps", punch_clamps(s, fitted, has_jaws), paint::kSteel, "carriage");
  } else {
    machine.slide("carriage", "frame", 1, {0, -1, 0}, punch_carriage(s, fitted), paint::kBlue);
    machine.slide("clamps", "carriage", 0, {-1, 0, 0}, punch_clamps(s, fitted, has_jaws),
                  paint::kSteel);
  }
  if (turret != nullptr && !turret->clamps.empty()) add_jaws(machine, s, room);
  const char* const ram_on = turret != nullptr ? "stroke" : "frame";
  if (turret != nullptr) {
    ChainLink stroke{.name = "stroke", .parent = "frame"};
    stroke.joint = JointKind::kPrismatic;
    stroke.by_joint = true;
    stroke.input = kStroke;
    machine.add(std::move(stroke), {}, paint::kAccent);
  }
  machine.slide("ram", ram_on, 2, up, punch_ram(s, fitted), paint::kAccent);
  return machine.finish("punch press", "clamps", "ram", room.machine_from_workpiece, up);
}

}  // namespace kerf
