// twin/job/work_holding.h - what holds a workpiece that turns: a chuck with its jaws, a tailstock.
//
//        r ^          jaws
//          |  .-------.__.            The chuck's face is at face_mm; jaws stand out from it by
//          |  | chuck |  |____.___    their length, about the blank. The tailstock's centre points
//          |  |_______|__|____|   `.--._____   to -z, its point is at point_mm in the blank's end.
//          |    '-----------' blank  `-.____ tailstock
//          +----------|-----------------|----------> z
//                   face_mm          point_mm
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/diagnostic.h"
#include "base/length_unit.h"
#include "base/result.h"
#include "stock/stock_model.h"
#include "stock/turning/turned_part.h"
#include "twin/job/fixtures.h"

namespace kerf {

/// Rings that jaws sweep: the chuck turns.
struct JawSpec {
  double diameter_mm = 0;  ///< outside
  double length_mm = 0;    ///< they stand out from the chuck's face
};

/// As --chuck describes it.
struct ChuckSpec {
  double diameter_mm = 0, length_mm = 0;  ///< of the body behind its face
  std::optional<JawSpec> jaws;
  std::optional<double> bore_mm;  ///< else a quarter of its diameter
  std::optional<double> face_mm;  ///< z; else where the blank ends towards -z
  std::string text;               ///< as it was given
};

/// As --tailstock describes it.
struct TailstockSpec {
  double diameter_mm = 0;          ///< of its quill, as thick as the cone ends
  double angle_deg = 60;           ///< of its point, whole
  std::optional<double> point_mm;  ///< z; else so that the blank's end has the cone a third as
                                   ///< thick as itself, at most half as thick as the quill
  std::string text;
};

/// D:L[:JAW_D:JAW_L][:bore=D][:at=Z]. Numbers are in `unit`. Errors say what was found and what is
/// allowed.
Result<ChuckSpec> parse_chuck(std::string_view text, LengthUnit unit = LengthUnit::kMm);
/// D[:ANGLE][:at=Z]
Result<TailstockSpec> parse_tailstock(std::string_view text, LengthUnit unit = LengthUnit::kMm);

/// Values.
struct WorkHolding {
  std::optional<ChuckSpec> chuck;
  std::optional<TailstockSpec> tailstock;
  bool any() const { return chuck || tailstock; }
};

/// One of its bodies.
struct HoldingBody {
  enum class Kind { kChuck, kJaws, kTailstock };
  Kind kind = Kind::kChuck;
  TurnedPart ring;  ///< what it sweeps as it turns, less where the blank is
};
/// "chuck", "jaws", "tailstock": as reports have it, in no language.
const char* to_string(HoldingBody::Kind kind);
std::vector<std::string> names_of(const WorkHolding& holding);

/// About this workpiece, as it is before the program. Error: they do not fit it.
Result<std::vector<HoldingBody>> holding_bodies(const WorkHolding& holding,
                                                const TurnedProfile& blank);

using HoldingList = std::shared_ptr<const std::vector<HoldingBody>>;
/// About a workpiece before its program. Chuck and tailstock are for one that turns. Fixtures
/// beside such a one stand still: on no link, and beside what it sweeps as it turns, its bores
/// filled
/// (`blank_given`: it is no guess, and that is looked at). False with errors; `out` is null where
/// nothing holds it. Who uses the bodies takes copies: TurnedPart is for one thread.
bool hold_workpiece(const WorkHolding& holding, const FixtureList& fixtures,
                    const StockModel& stock, bool blank_given, HoldingList& out,
                    Diagnostics& diagnostics);

}  // namespace kerf
