// tests/twin/process/punch_shop.h - sheets punched by motions that are made by hand.
#pragma once

#include <memory>
#include <string>
#include <utility>

#include "stock/sheet/punch_hits.h"
#include "stock/sheet/punch_shape.h"
#include "twin/machine/turret.h"

namespace kerf::test {

inline void add_station(Turret& turret, int number, const std::string& shape, double angle_deg = 0,
                        bool turns = false) {
  Cutter punch = std::move(*punch_cutter("punch:" + shape, *parse_punch_shape(shape, 0.002)));
  turret.stations.emplace(number,
                          TurretStation{number, "", shape, std::move(punch), angle_deg, turns, 0});
}

/// 1: round 10, 2: square 10, 3: slit 30 x 5 that turns, 4: round 4.
inline std::shared_ptr<Turret> turret(const std::string& trigger, double pitch_mm = 0) {
  auto out = std::make_shared<Turret>();
  out->path = "press.yaml";
  add_station(*out, 1, "round:10");
  add_station(*out, 2, "square:10");
  add_station(*out, 3, "rectangle:30:5", 0, true);
  add_station(*out, 4, "round:4");
  out->trigger = std::move(*PunchTrigger::parse(trigger));
  out->nibble_pitch_mm = pitch_mm;
  return out;
}

}  // namespace kerf::test
