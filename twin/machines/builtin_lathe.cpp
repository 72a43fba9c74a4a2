// The lathe: spindle along Z, turret at +X, Y up.
#include <algorithm>
#include <cmath>

#include "base/portable_math.h"
#include "twin/machines/builtin_parts.h"

namespace kerf {
namespace {

constexpr int kStations = 8;
/// What stands in one place is drawn so far apart, and does not flicker: the blank's end and the
/// chuck, the chuck and the rings that it sweeps.
constexpr double kApart_mm = 0.5;

struct LatheSizes {
  double radius = 0;      // of the blank
  double chuck = 0;       // radius of the chuck
  double chuck_face = 0;  // z
  double chuck_deep = 0;
  double rim = 0;          // radius of the chuck's body
  double jaw_length = 0;   // before the face
  double jaw_radius = 0;   // outside
  double turret = 0;       // radius of its disc
  double turret_near = 0;  // z of the disc from the nose
  double turret_far = 0;
  double ways = 0;   // y: upper face of the bed's ways
  double slide = 0;  // y: upper face of the carriage
  double min_x = 0;  // of the bed
  double max_x = 0;
};

LatheSizes lathe_sizes(const FittedRoom& room) {
  LatheSizes s;
  const Box& blank = room.blank_mm;
  s.radius = std::max({std::abs(blank.min.x), std::abs(blank.max.x), std::abs(blank.min.y),
                       std::abs(blank.max.y), 5.0});
  s.chuck = std::max(1.9 * s.radius, 70.0);
  s.chuck_face = blank.min.z;
  s.chuck_deep = 0.7 * s.chuck;
  s.rim = s.chuck;
  if (room.chuck) {
    s.chuck = std::max(room.chuck->diameter_mm / 2, s.radius + 1);
    s.chuck_face = room.chuck->face_z_mm;
    s.chuck_deep = room.chuck->length_mm;
    s.rim = s.chuck - kApart_mm;
  }
  s.jaw_length = std::min(0.3 * blank.size().z, 0.4 * s.chuck);
  s.jaw_radius = 0.97 * s.chuck;
  if (room.chuck && room.chuck->jaw_diameter_mm > 0) {
    s.jaw_length = room.chuck->jaw_length_mm - kApart_mm;
    s.jaw_radius = room.chuck->jaw_diameter_mm / 2 - kApart_mm;
  }
  s.turret = std::max(0.9 * s.chuck, 1.1 * room.tool_length_mm);
  s.turret_near = -0.16 * s.turret;
  s.turret_far = 0.3 * s.turret;
  s.ways = -std::max(s.chuck, s.turret) - 0.75 * s.chuck;
  s.slide = s.ways + 0.25 * s.chuck;
  s.min_x = -1.3 * s.chuck;
  s.max_x = room.nose_max_mm.x + 2.2 * s.turret;
  return s;
}

MeshBuilder lathe_bed(const LatheSizes& s, const FittedRoom& room) {
  const double c = s.chuck;
  const double back = s.chuck_face - s.chuck_deep;  // z, where the headstock ends
  const double left = back - 2.2 * c;
  const double right = room.nose_max_mm.z + 1.8 * s.turret;
  const double floor = s.ways - 2.0 * c;
  MeshBuilder bed;
  // Side view across Z: a base that widens to the floor; (u, v) = (x, y).
  const std::vector<Vec2> section{{s.min_x - 0.1 * c, floor},  {s.max_x + 0.1 * c, floor},
                                  {s.max_x, s.ways - 0.6 * c}, {s.max_x, s.ways - 0.1 * c},
                                  {s.min_x, s.ways - 0.1 * c}, {s.min_x, s.ways - 0.6 * c}};
  bed.prism(section, 2, left, right);
  for (const double x : {s.min_x + 0.12 * c, s.max_x - 0.42 * c}) {
    bed.box({x, s.ways - 0.1 * c, back + 0.02 * c}, {x + 0.3 * c, s.ways, right - 0.02 * c});
  }
  return bed;
}

MeshBuilder lathe_headstock(const LatheSizes& s) {
  const double c = s.chuck;
  const double back = s.chuck_face - s.chuck_deep;
  MeshBuilder head;
  head.block({-1.15 * c, s.ways - 0.1 * c, back - 2.1 * c}, {1.15 * c, 1.1 * c, back - 0.12 * c}, 2,
             0.18 * c);
  head.cylinder({0, 0, back - 0.12 * c}, 2, 0.62 * c, 0.1 * c);
  head.cylinder({0, 0, back - 2.1 * c}, 2, 0.4 * c, -0.3 * c);
  return head;
}

MeshBuilder lathe_chuck(const LatheSizes& s) {
  const double c = s.chuck;
  const double face = s.chuck_face - kApart_mm;
  MeshBuilder chuck;
  const double deep = s.chuck_deep - kApart_mm;
  const std::array<Vec2, 8> body{Vec2(0, -deep),
                                 Vec2(0.6 * c, -deep),
                                 Vec2(0.6 * c, -0.9 * deep),
                                 Vec2(s.rim, -0.88 * deep),
                                 Vec2(s.rim, -0.05 * c),
                                 Vec2(0.95 * c, 0),
                                 Vec2(0.2 * c, 0),
                                 Vec2(0, 0)};
  chuck.turned({0, 0, face}, 2, body);
  // Three jaws, stepped, outside of the blank.
  const double grip = s.jaw_length;
  const double in = s.radius + 0.3, out = std::max(s.jaw_radius, in + 1);
  const std::vector<Vec2> jaw{{face, in},
                              {face + grip, in},
                              {face + grip, in + 0.15 * (out - in)},
                              {face + 0.6 * grip, in + 0.5 * (out - in)},
                              {face + 0.6 * grip, out},
                              {face, out}};
  MeshBuilder one;
  one.prism(jaw, 1, -0.13 * c, 0.13 * c);  // (u, v) = (z, x)
  for (const double angle : {90.0, 210.0, 330.0}) chuck.add(one.mesh(), turn({0, 0, 1}, angle));
  return chuck;
}

MeshBuilder lathe_carriage(const LatheSizes& s) {
  const double c = s.chuck;
  MeshBuilder carriage;
  const double from = s.turret_near + 0.1 * c;
  const double to = s.turret_far + 1.2 * s.turret;
  carriage.block({s.min_x + 0.05 * c, s.ways + 1, from}, {s.max_x - 0.05 * c, s.slide, to}, 0,
                 0.08 * c);
  for (const double z : {from + 0.2 * c, to - 0.4 * c}) {
    carriage.box({s.min_x + 0.3 * c, s.slide, z},
                 {s.max_x - 0.1 * c, s.slide + 0.1 * c, z + 0.2 * c});
  }
  return carriage;
}

MeshBuilder lathe_turret(const LatheSizes& s) {
  const double c = s.chuck;
  const double t = s.turret;
  MeshBuilder turret;
  // The nose is the outer face of the station that points at the work, -X of the disc's middle.
  const double holder = 0.2 * t;
  const double rim = t - holder;
  std::vector<Vec2> disc;
  for (int i = 0; i < kStations; ++i) {
    const double angle = 2 * kPi * (i + 0.5) / kStations;
    const double corner = rim / portable::cos(kPi / kStations);
    disc.emplace_back(t + corner * portable::cos(angle), corner * portable::sin(angle));
  }
  turret.prism(disc, 2, s.turret_near, s.turret_far);
  MeshBuilder station;
  station.block({0, -0.13 * t, s.turret_near + 0.03 * t},
                {holder + 1, 0.13 * t, s.turret_far - 0.06 * t}, 0, 0.04 * t);
  for (int i = 0; i < kStations; ++i) {
    const Pose around =
        shift({t, 0, 0}) * turn({0, 0, 1}, 360.0 * i / kStations) * shift({-t, 0, 0});
    turret.add(station.mesh(), around);
  }
  turret.cylinder({t, 0, s.turret_near}, 2, 0.35 * t, -0.05 * t);
  // Drive behind the disc, and the slide that it stands on.
  turret.cylinder({t, 0, s.turret_far}, 2, 0.7 * t, 0.15 * t);
  const double low = s.slide + 0.12 * c;
  turret.block({0.3 * t, low, s.turret_far + 0.15 * t}, {1.7 * t, 0.6 * t, s.turret_far + 1.0 * t},
               2, 0.12 * t);
  turret.box({0.1 * t, s.slide + 0.11 * c, s.turret_near + 0.2 * t},
             {1.9 * t, low + 0.18 * c, s.turret_far + 1.1 * t});
  return turret;
}

}  // namespace

MachineModel build_lathe(const MachineRoom& room) {
  const Vec3 outwards(1, 0, 0);
  const FittedRoom fitted = fit(room, outwards);
  const LatheSizes s = lathe_sizes(fitted);
  MachineAssembly machine;
  machine.fixed("bed", lathe_bed(s, fitted), paint::kCasting);
  machine.fixed("headstock", lathe_headstock(s), paint::kCastingDark, "bed");
  ChainLink chuck;
  chuck.name = "chuck";
  chuck.parent = "headstock";
  chuck.joint = room.has_c_axis ? JointKind::kRotary : JointKind::kFixed;
  chuck.input = 5;
  machine.add(std::move(chuck), lathe_chuck(s).take(), paint::kSteel);
  machine.slide("carriage", "bed", 2, {0, 0, 1}, lathe_carriage(s), paint::kBlue);
  machine.slide("turret", "carriage", 0, outwards, lathe_turret(s), paint::kAccent);
  return machine.finish("lathe", "chuck", "turret", room.machine_from_workpiece, outwards);
}

}  // namespace kerf
