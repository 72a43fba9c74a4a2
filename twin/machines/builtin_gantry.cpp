// The gantry router, and the plasma table that is built like it.
#include "twin/machines/builtin_gantry.h"

#include <algorithm>
#include <cmath>

#include "twin/machines/builtin_parts.h"

namespace kerf {
namespace {

GantrySizes gantry_sizes(const FittedRoom& room, bool torch) {
  GantrySizes s;
  const Vec3 travel = room.travel();
  s.top = room.blank_mm.min.z;
  s.unit = std::clamp(0.1 * std::max(travel.x, travel.y), 40.0, 160.0);
  s.body = torch ? 0.22 * s.unit : std::clamp(0.45 * s.unit, 26.0, 60.0);
  s.half_carriage = std::max(s.body, 0.45 * s.unit) + 0.2 * s.unit;
  s.inner_min = std::min(room.nose_min_mm.x - s.half_carriage - 15, room.blank_mm.min.x - 25);
  s.inner_max = std::max(room.nose_max_mm.x + s.half_carriage + 15, room.blank_mm.max.x + 25);
  s.side = 0.3 * s.unit;
  s.plate = s.body + 0.12 * s.unit;
  s.beam_y = s.plate + 0.6 * s.unit;
  s.beam_depth = (torch ? 0.8 : 1.1) * s.unit;
  s.table_min_y = std::min(room.nose_min_mm.y - 0.5 * s.unit, room.blank_mm.min.y - 25);
  s.table_max_y = std::max(room.nose_max_mm.y, room.blank_mm.max.y) + 0.5 * s.unit;
  s.rail = s.top - (torch ? 0.35 : 0.5) * s.unit;
  const double height = (torch ? 0.9 : 1.4) * s.unit;
  // Over the blank, and so that the carriage holds the Z plate at its highest.
  s.beam_low = std::max(room.blank_mm.max.z + 25, room.nose_max_mm.z - 0.3 * height);
  s.beam_high = s.beam_low + height;
  return s;
}

/// The plate that goes up and down behind spindle or torch. Frame: nose at 0. Its rails stay in the
/// carriage wherever the nose is.
void add_z_plate(MeshBuilder& mesh, const GantrySizes& s, const FittedRoom& room) {
  const double u = s.unit;
  const double low = std::min(0.3 * u, s.beam_low + 0.3 * u - room.nose_max_mm.z);
  const double high = s.beam_high + 0.05 * u - room.nose_min_mm.z;
  mesh.block({-0.9 * s.half_carriage, s.plate, std::max(low, 0.15 * u)},
             {0.9 * s.half_carriage, s.plate + 0.15 * u, high}, 1, 0.06 * u);
}

MeshBuilder router_spindle(const GantrySizes& s, const FittedRoom& room) {
  const double r = s.body;
  MeshBuilder spindle;
  const std::array<Vec2, 9> body{Vec2(0, 0),
                                 Vec2(0.38 * r, 0),
                                 Vec2(0.42 * r, 0.1 * r),
                                 Vec2(0.42 * r, 0.6 * r),
                                 Vec2(0.8 * r, 0.75 * r),
                                 Vec2(r, r),
                                 Vec2(r, 5.4 * r),
                                 Vec2(0.85 * r, 5.7 * r),
                                 Vec2(0, 5.7 * r)};
  spindle.turned(Vec3(0.0), 2, body);
  for (const double z : {1.5 * r, 3.6 * r}) {
    spindle.block({-1.2 * r, -0.25 * r, z}, {1.2 * r, s.plate, z + 0.9 * r}, 2, 0.2 * r);
    spindle.turned({0, 0, z}, 2,
                   std::array<Vec2, 4>{Vec2(0, 0), Vec2(1.18 * r, 0), Vec2(1.18 * r, 0.9 * r),
                                       Vec2(0, 0.9 * r)});
  }
  spindle.cylinder({0, 0, 5.7 * r}, 2, 0.18 * r, 0.5 * r);
  add_z_plate(spindle, s, room);
  return spindle;
}

MeshBuilder plasma_torch(const GantrySizes& s, const FittedRoom& room) {
  const double r = s.body;
  MeshBuilder torch;
  const std::array<Vec2, 9> body{
      Vec2(0, 0),           Vec2(0.6 * r, 0),       Vec2(0.9 * r, 0.9 * r),
      Vec2(r, r),           Vec2(r, 3.2 * r),       Vec2(0.8 * r, 3.4 * r),
      Vec2(0.8 * r, 8 * r), Vec2(0.5 * r, 8.6 * r), Vec2(0, 8.6 * r)};
  torch.turned(Vec3(0.0), 2, body);
  // The holder that breaks away, and the float switch's block.
  torch.block({-1.6 * r, -1.5 * r, 3.8 * r}, {1.6 * r, s.plate, 5.6 * r}, 2, 0.5 * r);
  torch.cylinder({0, 0, 8.6 * r}, 2, 0.3 * r, 5 * r);
  add_z_plate(torch, s, room);
  return torch;
}

MachineModel assembled(const char* name, const char* tool, const MachineRoom& room,
                       const GantrySizes& s, std::pair<MeshBuilder, std::uint32_t> table,
                       MeshBuilder frame, MeshBuilder head) {
  const Vec3 up(0, 0, 1);
  MachineAssembly machine;
  machine.fixed("frame", std::move(frame), paint::kCasting);
  machine.fixed("table", std::move(table.first), table.second, "frame");
  machine.slide("gantry", "frame", 1, {0, 1, 0}, gantry_bridge(s), paint::kBlue);
  machine.slide("carriage", "gantry", 0, {1, 0, 0}, gantry_carriage(s), paint::kDarkSteel);
  machine.slide(tool, "carriage", 2, up, std::move(head), paint::kAccent);
  return machine.finish(name, "table", tool, room.machine_from_workpiece, up);
}

}  // namespace

void add_gantry_frame(MeshBuilder& mesh, const GantrySizes& s, double low, double high) {
  const double u = s.unit;
  const double back = s.table_max_y + s.beam_y + s.beam_depth;
  for (const double x : {s.inner_min - s.side, s.inner_max}) {
    mesh.block({x, s.table_min_y - 0.4 * u, low}, {x + s.side, back, high}, 1, 0.04 * u);
    // The rail itself, on which the gantry's shoes run.
    mesh.box({x + 0.3 * s.side, s.table_min_y - 0.38 * u, high},
             {x + 0.7 * s.side, back - 0.02 * u, high + 0.12 * u});
  }
  for (const double y : {s.table_min_y - 0.3 * u, back - 0.3 * u}) {
    mesh.box({s.inner_min, y, low + 0.02 * u}, {s.inner_max, y + 0.2 * u, high - 0.3 * u});
  }
  const double floor = low - 4.0 * u;
  for (const double x : {s.inner_min - s.side, s.inner_max}) {
    for (const double y : {s.table_min_y - 0.3 * u, back - 0.4 * u}) {
      mesh.box({x + 0.1 * s.side, y, floor}, {x + 0.9 * s.side, y + 0.3 * u, low});
      mesh.cylinder({x + 0.5 * s.side, y + 0.15 * u, floor - 0.1 * u}, 2, 0.2 * u, 0.1 * u);
    }
  }
}

MeshBuilder gantry_bridge(const GantrySizes& s) {
  const double u = s.unit;
  MeshBuilder bridge;
  const double low = s.rail + 0.14 * u;
  for (const double side : {-1.0, 1.0}) {
    const double inner = side < 0 ? s.inner_min : s.inner_max;
    const double outer = inner + side * s.side;
    // A foot on the rail, a cheek that leans back to the beam; (u, v) = (y, z).
    const double back = s.beam_y + s.beam_depth;
    const std::vector<Vec2> cheek{{s.beam_y - 0.5 * u, low},
                                  {back + 0.3 * u, low},
                                  {back + 0.3 * u, low + 0.4 * u},
                                  {back, low + 0.7 * u},
                                  {back, s.beam_high},
                                  {s.beam_y, s.beam_high},
                                  {s.beam_y, low + 0.9 * u},
                                  {s.beam_y - 0.5 * u, low + 0.4 * u}};
    bridge.prism(cheek, 0, std::min(inner, outer), std::max(inner, outer));
  }
  bridge.block({s.inner_min - 1, s.beam_y + 2, s.beam_low},
               {s.inner_max + 1, s.beam_y + s.beam_depth - 2, s.beam_high}, 0, 0.08 * u);
  const double height = s.beam_high - s.beam_low;
  for (const double part : {0.15, 0.75}) {
    bridge.box({s.inner_min, s.beam_y - 0.1 * u, s.beam_low + part * height},
               {s.inner_max, s.beam_y + 3, s.beam_low + (part + 0.1) * height});
  }
  return bridge;
}

MeshBuilder gantry_carriage(const GantrySizes& s) {
  const double u = s.unit;
  MeshBuilder carriage;
  carriage.block({-s.half_carriage, s.beam_y - 0.32 * u, s.beam_low - 0.05 * u},
                 {s.half_carriage, s.beam_y - 0.11 * u, s.beam_high + 0.05 * u}, 1, 0.1 * u);
  for (const double side : {-1.0, 1.0}) {
    const double x = side * 0.7 * s.half_carriage;
    carriage.box({x - 0.07 * u, s.plate + 0.16 * u, s.beam_low},
                 {x + 0.07 * u, s.beam_y - 0.32 * u, s.beam_high});
  }
  // Motor of Z, on a bracket above everything that rises.
  carriage.box({-0.3 * u, s.beam_y - 0.3 * u, s.beam_high + 0.05 * u},
               {0.3 * u, s.beam_y - 0.11 * u, s.beam_high + 0.5 * u});
  return carriage;
}

MachineModel build_gantry(const MachineRoom& room) {
  const FittedRoom fitted = fit(room, {0, 0, 1});
  const GantrySizes s = gantry_sizes(fitted, false);
  const double u = s.unit;
  MeshBuilder table;
  add_slotted_table(table, {{s.inner_min + 2, s.table_min_y, s.top - 0.35 * u},
                            {s.inner_max - 2, s.table_max_y, s.top}});
  MeshBuilder frame;
  add_gantry_frame(frame, s, s.rail - 1.0 * u, s.rail);
  const int members = 4;
  for (int i = 0; i < members; ++i) {
    const double y = s.table_min_y + (i + 0.5) / members * (s.table_max_y - s.table_min_y);
    frame.box({s.inner_min, y - 0.15 * u, s.top - 0.9 * u},
              {s.inner_max, y + 0.15 * u, s.top - 0.36 * u});
  }
  return assembled("gantry router", "spindle", room, s, {std::move(table), paint::kAluminium},
                   std::move(frame), router_spindle(s, fitted));
}

MachineModel build_plasma(const MachineRoom& room) {
  constexpr int kMostSlats = 60;
  constexpr double kSlatPitch_mm = 50;
  const FittedRoom fitted = fit(room, {0, 0, 1});
  const GantrySizes s = gantry_sizes(fitted, true);
  const double u = s.unit;
  const double width_y = s.table_max_y - s.table_min_y;
  const int slats = std::clamp(static_cast<int>(width_y / kSlatPitch_mm), 6, kMostSlats);
  MeshBuilder table;
  const double deep = s.top - 0.8 * u;
  for (int i = 0; i < slats; ++i) {
    const double y = s.table_min_y + (i + 0.5) * width_y / slats;
    table.box({s.inner_min + 8, y - 2, deep}, {s.inner_max - 8, y + 2, s.top});
  }
  // A tray under the slats, with a rim that stays below the sheet.
  table.box({s.inner_min + 1, s.table_min_y - 6, s.top - 1.3 * u},
            {s.inner_max - 1, s.table_max_y + 6, s.top - 1.25 * u});
  for (const double x : {s.inner_min + 1, s.inner_max - 7}) {
    table.box({x, s.table_min_y - 6, s.top - 1.25 * u}, {x + 6, s.table_max_y + 6, s.top - 8});
  }
  for (const double y : {s.table_min_y - 6, s.table_max_y}) {
    table.box({s.inner_min + 7, y, s.top - 1.25 * u}, {s.inner_max - 7, y + 6, s.top - 8});
  }
  MeshBuilder frame;
  add_gantry_frame(frame, s, s.rail - 1.2 * u, s.rail);
  return assembled("plasma table", "torch", room, s, {std::move(table), paint::kDarkSteel},
                   std::move(frame), plasma_torch(s, fitted));
}

}  // namespace kerf
