// stock/cutter/turning_forms.h - the forms of turning SHAPE texts, and the insert that each makes;
// turning_shape.h reads them.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "base/length_unit.h"
#include "base/result.h"
#include "stock/cutter/cutter.h"
#include "stock/cutter/insert.h"

namespace kerf {

// What is sold, with room on both sides.
inline constexpr double kLeastBar_mm = 0.5, kMostBar_mm = 200;
inline constexpr double kLeastEdge_mm = 0.05, kMostEdge_mm = 200;
inline constexpr double kLeastTurnFeed_mm = 0.001, kMostTurnFeed_mm = 50;
/// ISO 5610: f of square shanks by their width, 10 to 50 mm of 8 to 40.
inline constexpr double kShankF = 1.25;

enum class TurningValue { kLength, kAngle, kOther };
struct TurningParameter {
  const char* name = nullptr;
  TurningValue kind = TurningValue::kOther;
};
struct TurningForm {
  std::string_view name;
  std::string_view text;
  std::size_t required;
  std::array<TurningParameter, 5> parameters;
};

/// Null: there is no such form.
const TurningForm* turning_form(std::string_view name);

/// A width or diameter, and how far from the tip it ends.
struct BarSize {
  double width_mm = 0, length_mm = 0;
};

struct TurningOptions {
  std::optional<int> orientation;
  std::optional<double> edge_mm, f_mm, max_depth_mm, max_feed_mm;
  std::optional<bool> goes_its_path;
  std::optional<BarSize> shank, bar;
  std::string holder_file;
};

/// A tool as it comes of its form, before holders.
struct MadeInsert {
  InsertOutline outline;
  InsertTip tip;
  std::string spec;      ///< without options
  Vec2 shank_way{0, 1};  ///< shank_part(): back, side
  int shank_side = 0;
  double shank_f = kShankF;  ///< its f where nobody says so, in widths
  /// How far the front flank leans back along z, for each millimetre away from the axis' side.
  double lean = 0;
};

/// What a form makes of its values (`texts`; those that are required are there). Takes what the
/// form has a value for out of the options, or puts it there (the bar of bore).
Result<MadeInsert> make_turning_insert(const TurningForm& form,
                                       std::span<const std::string_view> texts, LengthUnit unit,
                                       TurningOptions& options);

Result<int> parse_orientation(std::string_view name, std::string_view text);
Error no_turning_outline();

}  // namespace kerf
