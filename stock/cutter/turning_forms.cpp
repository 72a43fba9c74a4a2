#include "stock/cutter/turning_forms.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/portable_math.h"
#include "base/text_scan.h"
#include "base/translate.h"
#include "base/units.h"
#include "stock/cutter/insert_shape.h"
#include "stock/cutter/iso_code.h"
#include "stock/cutter/scan.h"
#include "stock/cutter/turning_flanks.h"
#include "stock/cutter/turning_holder.h"

namespace kerf {
namespace {

// What is sold, with room on both sides.
constexpr double kMostNose_mm = 50;
constexpr double kLeastBlade_mm = 0.05, kMostBlade_mm = 100;
constexpr double kLeastPitch_mm = 0.05, kMostPitch_mm = 100;
constexpr double kMostTurn_deg = 360;
constexpr double kLeastKappa_deg = 10;
constexpr double kLeastThread_deg = 10, kMostThread_deg = 120;

constexpr double kEdge_mm = 10;
constexpr double kGrooveBlade_mm = 12, kPartBlade_mm = 30;
constexpr double kThreadDepth_mm = 2;
/// Blades narrow towards their shank by this angle on each side, and never by more than a third.
constexpr double kBladeRelief_deg = 1;
constexpr double kBladeNarrows = 1.0 / 6;
constexpr double kBarLengths = 5;
/// What a boring bar's insert has: C at 95 degrees.
constexpr FlankAngles kBoringFlanks{275, 355};

class TurningValues {
 public:
  TurningValues(const TurningForm& form, std::span<const std::string_view> texts, LengthUnit unit)
      : form_(form), texts_(texts), unit_(unit) {}

  bool has(std::size_t index) const { return index < texts_.size() && !texts_[index].empty(); }
  std::string_view text(std::size_t index) const { return trim(texts_[index]); }
  const char* name(std::size_t index) const { return tr(form_.parameters[index].name); }
  Result<double> length(std::size_t index, double low, double high) const {
    return parse_length(name(index), texts_[index], low, high, unit_);
  }
  Result<double> angle(std::size_t index, double low, double high) const {
    return parse_within(name(index), texts_[index], low, high, tr("degrees"));
  }

 private:
  const TurningForm& form_;
  std::span<const std::string_view> texts_;
  LengthUnit unit_;
};

using Made = Result<MadeInsert>;

/// FRONT and BACK, given at `index` and behind; `fallback` where they are not.
Result<FlankAngles> parse_flanks(const TurningValues& values, std::size_t index, int orientation,
                                 const FlankAngles& fallback) {
  if (!values.has(index) && !values.has(index + 1)) return fallback;
  for (const std::size_t i : {index, index + 1}) {
    if (!values.has(i)) return Error{trf("{} is missing; both angles are needed", values.name(i))};
  }
  const Result<double> front = values.angle(index, -kMostTurn_deg, kMostTurn_deg);
  if (!front) return Error{front.error()};
  const Result<double> back = values.angle(index + 1, -kMostTurn_deg, kMostTurn_deg);
  if (!back) return Error{back.error()};
  const FlankAngles given{*front, *back};
  const std::optional<FlankAngles> near = nearest_flanks(given);
  if (!near || near->front_deg == near->back_deg) {
    return Error{
        trf("the front angle {:g} and the back angle {:g} leave no insert between them; "
            "they must be more than 0 and less than 180 degrees apart",
            *front, *back)};
  }
  if (!fits_orientation(*near, orientation)) {
    const FlankAngles usual = usual_flanks(orientation);
    return Error{
        trf("the flanks at {:g} and {:g} degrees do not lie behind a nose of orientation "
            "{}; usual are {:g} and {:g} (0 is +Z, 90 is +X)",
            *front, *back, orientation, usual.front_deg, usual.back_deg)};
  }
  return given;
}

/// 0 of a flank that leans forward, or so far back that the bar is ahead of it anyway.
double lean_of(double front_deg) {
  const double lean = std::abs(portable::tan((front_deg - 90) * kRadPerDeg));
  return portable::cos(front_deg * kRadPerDeg) > 0 && lean < 1 ? lean : 0;
}

/// The insert of a nose and two flanks.
Made flanked(double radius_mm, int orientation, const FlankAngles& angles, double edge_mm) {
  MadeInsert made;
  const FlankAngles near = nearest_flanks(angles).value_or(angles);
  std::optional<InsertOutline> outline = nose_insert(
      {radius_mm, orientation, near.front_deg * kRadPerDeg, near.back_deg * kRadPerDeg, edge_mm});
  if (!outline) return no_turning_outline();
  made.outline = std::move(*outline);
  made.tip = {orientation, radius_mm, std::nullopt, std::nullopt};
  if (orientation != kOrientations) {
    made.tip.front_deg = angles.front_deg;
    made.tip.back_deg = angles.back_deg;
  }
  made.shank_way = shank_direction(orientation);
  if (made.shank_way.x == 0) made.shank_side = static_cast<int>(nose_direction(orientation).x);
  made.lean = lean_of(near.front_deg);
  return made;
}

Made make_turn(const TurningForm& form, const TurningValues& values, TurningOptions& options) {
  if (options.orientation) return Error{tr("orient= is the second value of turn:R:ORIENT")};
  const Result<double> radius = values.length(0, 0, kMostNose_mm);
  if (!radius) return Error{radius.error()};
  const Result<int> orientation = parse_orientation(values.name(1), values.text(1));
  if (!orientation) return Error{orientation.error()};
  const bool is_disc = *orientation == kOrientations;
  if (is_disc && *radius == 0) return Error{tr("a disc (orientation 9) needs a radius above 0")};
  if (is_disc && (values.has(2) || values.has(3) || values.has(4) || options.edge_mm)) {
    return Error{tr("orientation 9 is a disc, which has no flanks; write turn:R:9")};
  }
  if (!is_disc && !values.has(2) && !values.has(3)) {
    return Error{trf("{} is missing; the form is {}", values.name(2), form.text)};
  }
  FlankAngles angles;
  if (!is_disc) {
    const Result<FlankAngles> given = parse_flanks(values, 2, *orientation, angles);
    if (!given) return Error{given.error()};
    angles = *given;
  }
  double edge = options.edge_mm.value_or(kEdge_mm);
  if (values.has(4)) {
    if (options.edge_mm) return Error{tr("the length of the edges is given twice")};
    const Result<double> value = values.length(4, kLeastEdge_mm, kMostEdge_mm);
    if (!value) return Error{value.error()};
    edge = *value;
  }
  Made made = flanked(*radius, *orientation, angles, edge);
  if (!made) return made;
  made->spec = fmt::format("turn:{}:{}", number_text(*radius), *orientation);
  if (!is_disc) {
    made->spec +=
        fmt::format(":{}:{}", number_text(angles.front_deg), number_text(angles.back_deg));
    if (edge != kEdge_mm) made->spec += ":" + number_text(edge);
  }
  options.edge_mm.reset();
  return made;
}

Result<Hand> parse_hand(const TurningValues& values, const TurningOptions& options) {
  if (!values.has(1)) {
    return options.orientation ? hand_of_orientation(*options.orientation) : Hand::kRight;
  }
  const std::string_view text = values.text(1);
  const char letter = text.size() == 1 ? to_upper(text[0]) : '?';
  if (letter != 'R' && letter != 'L' && letter != 'N') {
    return Error{
        trf("{}: '{}' is not allowed; must be R (cuts towards -Z), L (towards +Z) or N "
            "(even-handed)",
            values.name(1), shown(text))};
  }
  const auto hand = static_cast<Hand>(letter);
  if (options.orientation && hand != Hand::kNeutral) {
    const Hand other = hand == Hand::kRight ? Hand::kLeft : Hand::kRight;
    if (hand_of_orientation(*options.orientation) == other) {
      return Error{trf("orient={} has its tip on the other side than hand {}, which takes {}",
                       *options.orientation, letter,
                       hand == Hand::kRight ? "2, 3, 5 .. 9" : "1, 4, 5 .. 9")};
    }
  }
  return hand;
}

Made make_iso(const TurningValues& values, TurningOptions& options) {
  const Result<IsoCode> code = parse_iso_code(values.text(0));
  if (!code) return Error{code.error()};
  if (options.edge_mm) return Error{tr("edge= is not for iso, where the size says it")};
  const Result<Hand> hand = parse_hand(values, options);
  if (!hand) return Error{hand.error()};
  const auto shapes = iso_shapes();
  const IsoShape& shape = *std::find_if(
      shapes.begin(), shapes.end(), [&](const IsoShape& row) { return row.letter == code->shape; });
  const double corner_deg = shape.nose_rad / kRadPerDeg;
  const std::optional<double> usual = iso_angle_deg(code->shape);
  double kappa = usual.value_or(0);
  if (values.has(2)) {
    if (!usual) return Error{tr("a round insert (R) has no angle; write iso:CODE:HAND")};
    if (*hand == Hand::kNeutral) {
      return Error{tr("an even-handed tool (N) has no angle: its flanks lie alike on both sides")};
    }
    const Result<double> angle = values.angle(2, kLeastKappa_deg, 180 - corner_deg);
    if (!angle) return Error{angle.error()};
    kappa = *angle;
  }
  const int orientation =
      options.orientation.value_or(usual_orientation(*hand, options.bar.has_value()));
  const FlankAngles angles = flanks_of_hand(*hand, orientation, kappa, corner_deg);
  IsoInsert insert;
  insert.shape = code->shape;
  insert.circle_mm = code->circle_mm;
  insert.radius_mm = code->radius_mm;
  insert.orientation = orientation;
  insert.front_rad =
      (angles.front_deg > 180 ? angles.front_deg - 360 : angles.front_deg) * kRadPerDeg;
  insert.back_is_ahead = angles.back_deg > angles.front_deg;
  std::optional<InsertOutline> outline = iso_insert(insert);
  if (!outline) {
    return Error{trf("corners of {:g} mm do not fit an insert of {:g} mm", code->radius_mm,
                     code->circle_mm)};
  }
  MadeInsert made;
  made.outline = std::move(*outline);
  made.tip = {orientation, code->radius_mm, std::nullopt, std::nullopt};
  made.shank_way = shank_direction(orientation);
  made.shank_side = *hand == Hand::kRight ? 1 : *hand == Hand::kLeft ? -1 : 0;
  if (usual) {
    made.tip.front_deg = angles.front_deg;
    made.tip.back_deg = angles.back_deg;
    made.lean = lean_of(angles.front_deg);
  }
  made.spec = "iso:" + code->text;
  if (values.has(1) || values.has(2)) made.spec += fmt::format(":{}", static_cast<char>(*hand));
  if (values.has(2)) made.spec += ":" + number_text(kappa);
  return made;
}

Made make_blade(const TurningForm& form, const TurningValues& values,
                const TurningOptions& options) {
  const bool axial = form.name == "facegroove";
  const Result<double> width = values.length(0, kLeastBlade_mm, kMostBlade_mm);
  if (!width) return Error{width.error()};
  double corner = 0;
  if (values.has(1)) {
    const Result<double> value = values.length(1, 0, *width / 2);
    if (!value) return Error{value.error()};
    corner = *value;
  }
  const int orientation = options.orientation.value_or(axial || !options.bar ? 2 : 3);
  const Vec2 sides = nose_direction(orientation);
  if ((axial ? sides.x : sides.y) == 0) {
    return Error{trf("orient={} is not allowed; must be {}", orientation,
                     axial ? tr("1 to 4, 5 or 7: the blade lies along Z")
                           : tr("1 to 4, 6 or 8: the blade lies along X"))};
  }
  GrooveInsert blade;
  blade.width_mm = *width;
  blade.corner_mm = corner;
  blade.length_mm = options.edge_mm.value_or(form.name == "part" ? kPartBlade_mm : kGrooveBlade_mm);
  blade.orientation = orientation;
  blade.axial = axial;
  blade.relief_rad = std::min(kBladeRelief_deg * kRadPerDeg,
                              portable::atan(kBladeNarrows * *width / blade.length_mm));
  std::optional<InsertOutline> outline = groove_insert(blade);
  if (!outline) return no_turning_outline();
  MadeInsert made;
  made.outline = std::move(*outline);
  made.tip = {orientation, corner, std::nullopt, std::nullopt};
  made.shank_way = axial ? Vec2(sides.x, 0) : Vec2(0, sides.y);
  made.shank_side = static_cast<int>(axial ? sides.y : sides.x);
  made.shank_f = 1;  // level with the blade's side: it goes beside the chuck
  made.spec = fmt::format("{}:{}", form.name, number_text(*width));
  if (corner > 0) made.spec += ":" + number_text(corner);
  return made;
}

/// What a thread leaves at the tool's tip, in pitches.
struct ThreadTip {
  double angle_deg;
  double flat;
  double radius;
};
constexpr std::array kThreadTips{ThreadTip{60, 0.125, 0}, ThreadTip{55, 0, 0.137329},
                                 ThreadTip{30, 0.366, 0}, ThreadTip{29, 0.3707, 0}};

Made make_thread(const TurningValues& values, const TurningOptions& options) {
  const Result<double> angle = values.angle(0, kLeastThread_deg, kMostThread_deg);
  if (!angle) return Error{angle.error()};
  double pitch = 0;
  ThreadTip tip{*angle, 0, 0};
  if (values.has(1)) {
    const Result<double> value = values.length(1, kLeastPitch_mm, kMostPitch_mm);
    if (!value) return Error{value.error()};
    pitch = *value;
    const auto row =
        std::find_if(kThreadTips.begin(), kThreadTips.end(),
                     [&](const ThreadTip& known) { return known.angle_deg == *angle; });
    if (row == kThreadTips.end()) {
      return Error{
          trf("the tip of a thread of {:g} degrees is not known, only of 60, 55, 30 and "
              "29; leave PITCH out for a sharp one",
              *angle)};
    }
    tip = *row;
  }
  const int orientation = options.orientation.value_or(options.bar ? 8 : 6);
  if (orientation != 6 && orientation != 8) {
    return Error{
        trf("orient={} is not allowed; must be 6 (points to -X) or 8 (to +X): the "
            "controlled point is in the middle of a thread",
            orientation)};
  }
  const double depth = options.edge_mm.value_or(std::max(kThreadDepth_mm, pitch));
  const bool up = orientation == 6;
  const FlankAngles angles{up ? 90 + *angle / 2 : 270 - *angle / 2,
                           up ? 90 - *angle / 2 : 270 + *angle / 2};
  MadeInsert made;
  if (tip.radius > 0) {
    const double radius = tip.radius * pitch;
    // A sharp profile of this depth would begin r / sin - r lower.
    const double half = *angle / 2 * kRadPerDeg;
    const double straight = (depth - radius * (1 - portable::sin(half))) / portable::cos(half);
    if (!(straight > kLeastEdge_mm)) {
      return Error{trf("edge={:g} ends within the tip's radius of {:.4g} mm", depth, radius)};
    }
    Made round = flanked(radius, orientation, angles, straight);
    if (!round) return round;
    made = std::move(*round);
  } else {
    std::optional<InsertOutline> outline =
        thread_insert({*angle * kRadPerDeg, tip.flat * pitch, depth, orientation});
    if (!outline) return no_turning_outline();
    made.outline = std::move(*outline);
    made.tip = {orientation, 0, angles.front_deg, angles.back_deg};
    made.shank_way = shank_direction(orientation);
  }
  made.lean = 0;
  made.spec = fmt::format("thread:{}", number_text(*angle));
  if (pitch > 0) made.spec += ":" + number_text(pitch);
  return made;
}

Made make_bore(const TurningValues& values, TurningOptions& options) {
  if (options.bar || options.shank || !options.holder_file.empty()) {
    return Error{tr("bore has its bar as its second value; holder= and bar= are for other tools")};
  }
  const Result<double> radius = values.length(0, 0, kMostNose_mm);
  if (!radius) return Error{radius.error()};
  const Result<double> bar = values.length(1, kLeastBar_mm, kMostBar_mm);
  if (!bar) return Error{bar.error()};
  double length = std::min(kBarLengths * *bar, kMaxInsertReach_mm - *bar);
  if (values.has(2)) {
    const Result<double> value = values.length(2, kLeastBar_mm, kMaxInsertReach_mm);
    if (!value) return Error{value.error()};
    length = *value;
  }
  const int orientation = options.orientation.value_or(3);
  const Vec2 sides = nose_direction(orientation);
  if (sides.x == 0 || sides.y == 0) {
    return Error{trf("orient={} is not allowed; must be 1 to 4", orientation)};
  }
  FlankAngles usual = kBoringFlanks;
  if (sides.y > 0) usual = {360 - usual.front_deg, 360 - usual.back_deg};
  if (sides.x < 0)
    usual = {(sides.y > 0 ? 180 : 540) - usual.front_deg,
             (sides.y > 0 ? 180 : 540) - usual.back_deg};
  const Result<FlankAngles> angles = parse_flanks(values, 3, orientation, usual);
  if (!angles) return Error{angles.error()};
  // An insert as long as the bar is thick would be its other side.
  const double edge = options.edge_mm.value_or(std::min(kEdge_mm, *bar / 2));
  Made made = flanked(*radius, orientation, *angles, edge);
  if (!made) return made;
  made->spec = fmt::format("bore:{}:{}", number_text(*radius), number_text(*bar));
  if (values.has(2)) made->spec += ":" + number_text(length);
  if (values.has(3)) {
    if (!values.has(2)) made->spec += ":";
    made->spec +=
        fmt::format(":{}:{}", number_text(angles->front_deg), number_text(angles->back_deg));
  }
  options.bar = BarSize{*bar, length};
  return made;
}

}  // namespace

Result<MadeInsert> make_turning_insert(const TurningForm& form,
                                       std::span<const std::string_view> texts, LengthUnit unit,
                                       TurningOptions& options) {
  const TurningValues values(form, texts, unit);
  if (form.name == "turn") return make_turn(form, values, options);
  if (form.name == "iso") return make_iso(values, options);
  if (form.name == "thread") return make_thread(values, options);
  if (form.name == "bore") return make_bore(values, options);
  return make_blade(form, values, options);
}

Result<int> parse_orientation(std::string_view name, std::string_view text) {
  int orientation = 0;
  if (read_number(text, orientation) && orientation >= 1 && orientation <= kOrientations) {
    return orientation;
  }
  return Error{
      trf("{}: '{}' is not allowed; must be a whole number from 1 to {}, as LinuxCNC's "
          "tool table has it (Q)",
          name, shown(text), kOrientations)};
}

Error no_turning_outline() {
  return Error{
      trf("no tool has these sizes together: it would cross itself, have no width, or "
          "reach farther than {:g} mm from the controlled point",
          kMaxInsertReach_mm)};
}

}  // namespace kerf
