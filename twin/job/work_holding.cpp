#include "twin/job/work_holding.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <utility>

#include "base/portable_math.h"
#include "base/suggest.h"
#include "base/text_scan.h"
#include "base/translate.h"
#include "stock/cutter/scan.h"
#include "stock/turning/turning_stock.h"

namespace kerf {
namespace {

constexpr double kLeastHold_mm = 1, kMostHold_mm = 1500;
constexpr double kLeastPoint_deg = 10, kMostPoint_deg = 170;
/// Of chucks in use the through hole is a quarter of the diameter, or more.
constexpr double kUsualBore = 0.25;
/// So far beyond its cone the quill is looked at.
constexpr double kQuill_mm = 300;
/// The chuck and the blank's end may be so far apart, or so far in each other: rounding.
constexpr double kFit_mm = 1e-3;

constexpr const char* kChuckForm = "D:L[:JAW_D:JAW_L][:bore=D][:at=Z]";
constexpr const char* kTailstockForm = "D[:ANGLE][:at=Z]";

/// name=LENGTH among the fields; what stays is by place.
Done take_named(std::vector<std::string_view>& fields, std::string_view name, double low_mm,
                LengthUnit unit, std::optional<double>& out) {
  const auto is_named = [&](std::string_view field) {
    const std::size_t equals = field.find('=');
    return equals != std::string_view::npos && to_lower(trim(field.substr(0, equals))) == name;
  };
  for (const std::string_view field : fields) {
    if (!is_named(field)) continue;
    if (out) return Error{trf("{} is given twice", name)};
    const Result<double> value =
        parse_length(name, trim(field.substr(field.find('=') + 1)), low_mm, kMostHold_mm, unit);
    if (!value) return Error{value.error()};
    out = *value;
  }
  std::erase_if(fields, is_named);
  return std::monostate{};
}

/// What is left of name=.. is none that there is.
Done no_more_names(std::span<const std::string_view> fields,
                   std::span<const std::string_view> known) {
  for (const std::string_view field : fields) {
    const std::size_t equals = field.find('=');
    if (equals == std::string_view::npos) continue;
    const std::string name = to_lower(trim(field.substr(0, equals)));
    return Error{trf("unknown option '{}'{} Options: {}", shown(name), did_you_mean(name, known),
                     fmt::join(known, ", "))};
  }
  return std::monostate{};
}

Done read_lengths(std::span<const std::string_view> fields, std::span<const char* const> names,
                  LengthUnit unit, std::span<double> out) {
  for (std::size_t i = 0; i < fields.size(); ++i) {
    const Result<double> value =
        parse_length(names[i], trim(fields[i]), kLeastHold_mm, kMostHold_mm, unit);
    if (!value) return Error{value.error()};
    out[i] = *value;
  }
  return std::monostate{};
}

Result<ChuckSpec> chuck_of(std::vector<std::string_view> fields, LengthUnit unit) {
  ChuckSpec chuck;
  constexpr std::array<std::string_view, 2> kChuckOptions{"bore", "at"};
  if (const Done bore = take_named(fields, "bore", 0, unit, chuck.bore_mm); !bore)
    return Error{bore.error()};
  if (const Done at = take_named(fields, "at", -kMostHold_mm, unit, chuck.face_mm); !at)
    return Error{at.error()};
  if (const Done rest = no_more_names(fields, kChuckOptions); !rest) return Error{rest.error()};
  constexpr std::array kNames{"D", "L", "JAW_D", "JAW_L"};
  if (fields.size() != 2 && fields.size() != 4) return Error{trf("the form is {}", kChuckForm)};
  std::array<double, 4> values{};
  if (const Done read = read_lengths(fields, kNames, unit, values); !read)
    return Error{read.error()};
  chuck.diameter_mm = values[0];
  chuck.length_mm = values[1];
  if (fields.size() == 4) chuck.jaws = JawSpec{values[2], values[3]};
  if (chuck.bore_mm && *chuck.bore_mm >= chuck.diameter_mm)
    return Error{tr("the bore is as wide as the chuck; must be below D")};
  return chuck;
}

Result<TailstockSpec> tailstock_of(std::vector<std::string_view> fields, LengthUnit unit) {
  TailstockSpec tailstock;
  constexpr std::array<std::string_view, 1> kTailstockOptions{"at"};
  if (const Done at = take_named(fields, "at", -kMostHold_mm, unit, tailstock.point_mm); !at)
    return Error{at.error()};
  if (const Done rest = no_more_names(fields, kTailstockOptions); !rest) return Error{rest.error()};
  if (fields.empty() || fields.size() > 2) return Error{trf("the form is {}", kTailstockForm)};
  constexpr std::array kNames{"D"};
  if (const Done read = read_lengths(std::span(fields).first(1), kNames, unit,
                                     std::span(&tailstock.diameter_mm, 1));
      !read)
    return Error{read.error()};
  if (fields.size() == 1) return tailstock;
  const Result<double> angle =
      parse_within("ANGLE", trim(fields[1]), kLeastPoint_deg, kMostPoint_deg, tr("degrees"));
  if (!angle) return Error{angle.error()};
  tailstock.angle_deg = *angle;
  return tailstock;
}

double low_z(const TurnedProfile& blank) {
  double low = blank[0][0].x;
  for (const auto& ring : blank)
    for (const Vec2& p : ring) low = std::min(low, p.x);
  return low;
}
double high_z(const TurnedProfile& blank) {
  double high = blank[0][0].x;
  for (const auto& ring : blank)
    for (const Vec2& p : ring) high = std::max(high, p.x);
  return high;
}

/// The greatest radius of the profile within low .. high; 0: there is nothing.
double widest_within(const TurnedProfile& profile, double low, double high) {
  double widest = 0;
  for (const std::vector<Vec2>& ring : profile) {
    for (std::size_t i = 0; i < ring.size(); ++i) {
      Vec2 a = ring[i], b = ring[(i + 1) % ring.size()];
      if (a.x > b.x) std::swap(a, b);
      if (b.x < low || a.x > high) continue;
      const auto at = [&](double z) {
        return b.x > a.x ? a.y + (std::clamp(z, a.x, b.x) - a.x) / (b.x - a.x) * (b.y - a.y)
                         : std::max(a.y, b.y);
      };
      widest = std::max({widest, at(low), at(high)});
    }
  }
  return widest;
}

Done add_body(HoldingBody::Kind kind, const TurnedProfile& profile, std::vector<HoldingBody>& out) {
  std::optional<TurnedPart> ring = TurnedPart::create(profile);
  if (!ring) return Error{tr("it reaches farther than the 2 m of a lathe")};
  out.push_back({kind, std::move(*ring)});
  return std::monostate{};
}

TurnedProfile ring_of(double low, double high, double inner, double outer) {
  return {{{low, inner}, {high, inner}, {high, outer}, {low, outer}}};
}

Done add_chuck(const ChuckSpec& chuck, const TurnedProfile& blank, std::vector<HoldingBody>& out) {
  const double end = low_z(blank), face = chuck.face_mm.value_or(end);
  const double reach = face + (chuck.jaws ? chuck.jaws->length_mm : 0);
  if (end > reach + kFit_mm) {
    return Error{
        trf("the blank begins at Z{:g}, and what the chuck holds ends at Z{:g}; must reach "
            "it (at=Z is the chuck's face)",
            end, reach)};
  }
  // What is bored through goes into the hole behind the blank.
  double inner = chuck.bore_mm.value_or(kUsualBore * chuck.diameter_mm) / 2;
  const double behind = widest_within(blank, face - chuck.length_mm, face - kFit_mm);
  inner = std::max(inner, behind);
  if (inner >= chuck.diameter_mm / 2 - kFit_mm) {
    return Error{
        trf("the blank is {:g} mm thick where the chuck, of {:g} mm, stands around it; "
            "must be thinner",
            2 * inner, chuck.diameter_mm)};
  }
  Done added = add_body(HoldingBody::Kind::kChuck,
                        ring_of(face - chuck.length_mm, face, inner, chuck.diameter_mm / 2), out);
  if (!added || !chuck.jaws) return added;
  const double held = widest_within(blank, face + kFit_mm, reach - kFit_mm);
  if (held >= chuck.jaws->diameter_mm / 2 - kFit_mm) {
    return Error{
        trf("jaws of {:g} mm do not reach round the blank, which is {:g} mm thick there; "
            "JAW_D is what they sweep outside",
            chuck.jaws->diameter_mm, 2 * held)};
  }
  return add_body(HoldingBody::Kind::kJaws, ring_of(face, reach, held, chuck.jaws->diameter_mm / 2),
                  out);
}

Done add_tailstock(const TailstockSpec& tailstock, const TurnedProfile& blank,
                   std::vector<HoldingBody>& out) {
  const double end = high_z(blank), radius = tailstock.diameter_mm / 2;
  const double held = widest_within(blank, end - kFit_mm, end);
  const double slope = portable::tan(tailstock.angle_deg / 2 * kPi / 180);
  const double point = tailstock.point_mm.value_or(end - std::min(held / 3, radius / 2) / slope);
  const double full = point + radius / slope;
  if (point > end) {
    return Error{
        trf("its point is at Z{:g}, and the blank ends at Z{:g}; must lie in it", point, end)};
  }
  if (full < end || (end - point) * slope > held + kFit_mm) {
    return Error{
        trf("its point at Z{:g} is so deep in the blank that its end at Z{:g} has the cone "
            "thicker than itself or than the quill",
            point, end)};
  }
  const double last = full + kQuill_mm;
  return add_body(HoldingBody::Kind::kTailstock,
                  {{{point, 0}, {last, 0}, {last, radius}, {full, radius}}}, out);
}

}  // namespace

Result<ChuckSpec> parse_chuck(std::string_view text, LengthUnit unit) {
  Result<ChuckSpec> chuck = chuck_of(split(trim(text), ':'), unit);
  if (!chuck) return Error{fmt::format("{}: {}", shown(trim(text)), chuck.error())};
  chuck->text = std::string(trim(text));
  return chuck;
}

Result<TailstockSpec> parse_tailstock(std::string_view text, LengthUnit unit) {
  Result<TailstockSpec> tailstock = tailstock_of(split(trim(text), ':'), unit);
  if (!tailstock) return Error{fmt::format("{}: {}", shown(trim(text)), tailstock.error())};
  tailstock->text = std::string(trim(text));
  return tailstock;
}

const char* to_string(HoldingBody::Kind kind) {
  switch (kind) {
    case HoldingBody::Kind::kChuck:
      return "chuck";
    case HoldingBody::Kind::kJaws:
      return "jaws";
    case HoldingBody::Kind::kTailstock:
      return "tailstock";
  }
  return "";
}

std::vector<std::string> names_of(const WorkHolding& holding) {
  std::vector<std::string> names;
  if (holding.chuck) names.emplace_back(to_string(HoldingBody::Kind::kChuck));
  if (holding.chuck && holding.chuck->jaws) names.emplace_back(to_string(HoldingBody::Kind::kJaws));
  if (holding.tailstock) names.emplace_back(to_string(HoldingBody::Kind::kTailstock));
  return names;
}

Result<std::vector<HoldingBody>> holding_bodies(const WorkHolding& holding,
                                                const TurnedProfile& blank) {
  std::vector<HoldingBody> bodies;
  if (holding.chuck) {
    if (const Done chuck = add_chuck(*holding.chuck, blank, bodies); !chuck)
      return Error{fmt::format("--chuck {}: {}", holding.chuck->text, chuck.error())};
  }
  if (holding.tailstock) {
    if (const Done tailstock = add_tailstock(*holding.tailstock, blank, bodies); !tailstock)
      return Error{fmt::format("--tailstock {}: {}", holding.tailstock->text, tailstock.error())};
  }
  return bodies;
}

namespace {

void refuse(std::string message, std::string hint, Diagnostics& diagnostics) {
  Diagnostic error;
  error.message = std::move(message);
  error.hint = std::move(hint);
  diagnostics.push_back(std::move(error));
}

/// What the profile sweeps about the axis, all of it from the axis outward.
SolidPointer swept_by(const TurnedProfile& profile) {
  std::vector<std::vector<RoundedDisc>> frustums;
  for (const std::vector<Vec2>& ring : profile) {
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const Vec2 &a = ring[i], &b = ring[(i + 1) % ring.size()];
      if (a.x != b.x) frustums.push_back({{a.y, a.x, 0}, {b.y, b.x, 0}});
    }
  }
  return Solid::of_hulls(frustums);
}

bool stand_beside(const std::vector<Fixture>& fixtures, const TurnedProfile& profile,
                  bool blank_given, Diagnostics& diagnostics) {
  bool all_stand = true;
  for (const Fixture& fixture : fixtures) {
    if (fixture.on.empty()) continue;
    refuse(trf("fixture '{}' is on link '{}': beside a workpiece that turns fixtures stand still",
               fixture.name, fixture.on),
           tr("what turns with the workpiece is --chuck; what stands is placed in the program's "
              "coordinates, without on="),
           diagnostics);
    all_stand = false;
  }
  if (!all_stand) return false;
  return !blank_given || check_fixtures_beside(fixtures, *swept_by(profile), diagnostics);
}

}  // namespace

bool hold_workpiece(const WorkHolding& holding, const FixtureList& fixtures,
                    const StockModel& stock, bool blank_given, HoldingList& out,
                    Diagnostics& diagnostics) {
  out = nullptr;
  const TurningStock* const turned = stock.turned();
  if (!turned) {
    if (!holding.any()) return true;
    refuse(trf("{}: is for a workpiece that turns, and this one is not turned",
               holding.chuck ? "--chuck" : "--tailstock"),
           tr("--model turning; --fixture is what stands around a workpiece that is milled"),
           diagnostics);
    return false;
  }
  const TurnedProfile profile = turned->part().profile();
  if (fixtures && !stand_beside(*fixtures, profile, blank_given, diagnostics)) return false;
  if (!holding.any()) return true;
  auto bodies = holding_bodies(holding, profile);
  if (!bodies) {
    refuse(bodies.error(), {}, diagnostics);
    return false;
  }
  out = std::make_shared<const std::vector<HoldingBody>>(std::move(bodies.value()));
  return true;
}

}  // namespace kerf
