// stock/cutter/mill_forms.h - the forms of milling cutters and drills: "bull:10:2" into an outline.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/length_unit.h"
#include "base/result.h"
#include "base/translate.h"
#include "stock/cutter/cutter.h"
#include "stock/cutter/shape_options.h"

namespace kerf {

/// A form and its parameters: `required` of them must be there, `optional` more may be.
struct MillForm {
  std::string_view name;
  std::string_view text;
  std::size_t required;
  std::size_t optional;
  std::array<const char*, 3> parameters;
};

inline constexpr std::array<MillForm, 11> kMillForms = {{
    {"flat", "flat:D", 1, 0, {tr_noop("diameter D")}},
    {"ball", "ball:D", 1, 0, {tr_noop("diameter D")}},
    {"bull", "bull:D:R", 2, 0, {tr_noop("diameter D"), tr_noop("corner radius R")}},
    {"vee",
     "vee:D:ANGLE[:TIP]",
     2,
     1,
     {tr_noop("diameter D"), tr_noop("included angle ANGLE"), tr_noop("tip diameter TIP")}},
    {"taper",
     "taper:D:ANGLE[:R]",
     2,
     1,
     {tr_noop("tip diameter D"), tr_noop("half angle ANGLE"), tr_noop("corner radius R")}},
    {"drill", "drill:D:ANGLE", 2, 0, {tr_noop("diameter D"), tr_noop("point angle ANGLE")}},
    {"lollipop",
     "lollipop:D:SHAFT",
     2,
     0,
     {tr_noop("diameter D"), tr_noop("shaft diameter SHAFT")}},
    {"tslot",
     "tslot:D:T:SHAFT",
     3,
     0,
     {tr_noop("diameter D"), tr_noop("thickness T"), tr_noop("shaft diameter SHAFT")}},
    {"dovetail",
     "dovetail:D:ANGLE:SHAFT",
     3,
     0,
     {tr_noop("diameter D"), tr_noop("side angle ANGLE"), tr_noop("shaft diameter SHAFT")}},
    {"kerf", "kerf:W", 1, 0, {tr_noop("kerf width W")}},
    {"profile", "profile:FILE", 1, 0, {tr_noop("file name FILE")}},
}};

/// What a form makes before the options are added.
struct MillBody {
  std::vector<ProfilePiece> pieces;
  std::vector<ProfilePiece> upper_pieces;  ///< of a head with a neck
  std::string spec;
  std::optional<double> flute_mm;  ///< where the flutes end unless flute= says so
  std::optional<double> shank_mm;  ///< diameter above it unless shank= says so
};

/// A straight piece of an outline, mm.
ProfilePiece line_piece(double r0, double z0, double r1, double z1);

/// Of any form but profile. `texts`: its parameters, as many as it requires at least. Error: which
/// one is wrong, what was found and what is allowed.
Result<MillBody> make_mill_body(const MillForm& form, std::span<const std::string_view> texts,
                                const ShapeOptions& options, LengthUnit unit);

}  // namespace kerf
