#include "stock/cutter/iso_code.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "base/text_scan.h"
#include "base/translate.h"
#include "stock/cutter/insert_shape.h"

namespace kerf {
namespace {

// ISO 1832, clauses on symbols 2 to 4.
constexpr std::string_view kClearances = "ABCDEFGNPO";
constexpr std::string_view kTolerances = "ACEFGHJKLMNU";
constexpr std::string_view kTypes = "ABCFGHJMNQRTUWX";
constexpr std::size_t kIsoLetters = 4;
/// Discs that are measured in mm, ISO 1832: M0 in place of the corner radius.
constexpr std::array kMetricDiscs_mm{5, 6, 8, 10, 12, 16, 20, 25, 32};
/// Larger corners are discs.
constexpr int kMostRadius_tenths = 40;
constexpr double kRadiusPer64th_mm = 0.4;

/// Circles of ANSI B212.4 by their number, eighths of an inch as they are written.
struct AnsiCircle {
  double number;
  double mm;
};
constexpr std::array kAnsiCircles{
    AnsiCircle{1.2, 3.97}, AnsiCircle{1.5, 4.76}, AnsiCircle{1.8, 5.56}, AnsiCircle{2, 6.35},
    AnsiCircle{2.5, 7.94}, AnsiCircle{3, 9.525},  AnsiCircle{4, 12.7},   AnsiCircle{5, 15.875},
    AnsiCircle{6, 19.05},  AnsiCircle{8, 25.4}};

std::string iso_letters_text() {
  std::string text;
  for (const IsoShape& shape : iso_shapes())
    text += fmt::format("{}{}", text.empty() ? "" : " ", shape.letter);
  return text;
}

/// Sizes of a shape that there are, "06, 09, 12".
std::string iso_sizes_text(char shape) {
  std::string text;
  for (const IsoSize& size : iso_sizes(shape))
    text += fmt::format("{}{:02}", text.empty() ? "" : ", ", size.size);
  return text;
}

Error not_a_code(std::string_view code) {
  return Error{
      trf("'{}' is no insert of ISO 1832; write for example CNMG120408 (shape, clearance, "
          "tolerance, type, size, thickness, corner radius), or CNMG432",
          shown(code))};
}

int figures(std::string_view two) { return 10 * (two[0] - '0') + (two[1] - '0'); }
bool are_figures(std::string_view two) {
  return two.size() == 2 && is_digit(two[0]) && is_digit(two[1]);
}

/// "4", "1.5": one figure, and perhaps one decimal. Moves `text` behind it.
std::optional<double> take_ansi_number(std::string_view& text) {
  if (text.empty() || !is_digit(text[0])) return std::nullopt;
  double value = text[0] - '0';
  text.remove_prefix(1);
  if (text.size() > 1 && text[0] == '.' && is_digit(text[1])) {
    value += 0.1 * (text[1] - '0');
    text.remove_prefix(2);
  }
  return value;
}

Result<IsoCode> read_metric(IsoCode code, std::string_view digits) {
  const int size = figures(digits.substr(0, 2));
  const std::string_view radius = digits.substr(4, 2);
  code.text += digits.substr(0, 6);
  const bool is_metric_disc = radius[0] == 'M';
  if (is_metric_disc) {
    code.text.back() = '0';  // some write the letter O
    if (code.shape != 'R') return Error{tr("corner radius: M0 is for round inserts (R) alone")};
    if (std::find(kMetricDiscs_mm.begin(), kMetricDiscs_mm.end(), size) == kMetricDiscs_mm.end()) {
      return Error{trf("size: there is no round insert of {} mm with M0; sizes are {}", size,
                       fmt::join(kMetricDiscs_mm, ", "))};
    }
    code.circle_mm = size;
  } else {
    const std::optional<double> circle = iso_circle_mm(code.shape, size);
    if (!circle) {
      return Error{trf("size: there is no insert {} of size {}; sizes are {}", code.shape,
                       digits.substr(0, 2), iso_sizes_text(code.shape))};
    }
    code.circle_mm = *circle;
  }
  const int tenths = is_metric_disc ? 0 : figures(radius);
  if (tenths > kMostRadius_tenths) {
    return Error{trf("corner radius: {} is not allowed; must be from 00 to {} (tenths of a mm)",
                     radius, kMostRadius_tenths)};
  }
  code.radius_mm = code.shape == 'R' ? code.circle_mm / 2 : tenths / 10.0;
  return code;
}

Result<IsoCode> read_ansi(IsoCode code, std::string_view digits, std::string_view whole) {
  const std::string_view all = digits;
  const std::optional<double> circle = take_ansi_number(digits);
  const std::optional<double> thickness = take_ansi_number(digits);
  std::optional<double> radius = take_ansi_number(digits);
  if (!radius && code.shape == 'R') radius = 0;  // a disc may leave it out: RNMG43
  const bool ends = digits.empty() || !(is_digit(digits[0]) || digits[0] == '.');
  if (!circle || !thickness || !radius || !ends) return not_a_code(whole);
  code.text += all.substr(0, all.size() - digits.size());
  const auto row = std::find_if(
      kAnsiCircles.begin(), kAnsiCircles.end(),
      [&](const AnsiCircle& known) { return std::abs(known.number - *circle) < 0.01; });
  if (row == kAnsiCircles.end() || code.shape == 'K') {
    return Error{
        trf("size: {:g} is not allowed; must be 1.2, 1.5, 1.8, 2, 2.5, 3, 4, 5, 6 or 8 "
            "(eighths of an inch), and K is not known by it",
            *circle)};
  }
  code.circle_mm = row->mm;
  code.radius_mm = code.shape == 'R' ? code.circle_mm / 2 : *radius * kRadiusPer64th_mm;
  return code;
}

}  // namespace

Result<IsoCode> parse_iso_code(std::string_view text) {
  std::string packed;
  for (const char c : text) {
    if (!is_blank(c)) packed += to_upper(c);
  }
  if (packed.size() < kIsoLetters + 2) return not_a_code(text);
  IsoCode code;
  code.shape = packed[0];
  const auto shapes = iso_shapes();
  const bool known = std::any_of(shapes.begin(), shapes.end(),
                                 [&](const IsoShape& row) { return row.letter == code.shape; });
  if (!std::all_of(packed.begin(), packed.begin() + kIsoLetters, is_letter))
    return not_a_code(text);
  if (!known) {
    return Error{trf("shape {} of {} is not known; shapes are {}", code.shape, shown(text),
                     iso_letters_text())};
  }
  struct Symbol {
    std::string_view name, allowed;
  };
  const std::array symbols{Symbol{tr("clearance"), kClearances},
                           Symbol{tr("tolerance"), kTolerances}, Symbol{tr("type"), kTypes}};
  for (std::size_t i = 0; i < symbols.size(); ++i) {
    if (symbols[i].allowed.find(packed[i + 1]) != std::string_view::npos) continue;
    return Error{trf("{}: the letter {} of {} is not allowed; must be one of {}", symbols[i].name,
                     packed[i + 1], shown(text), symbols[i].allowed)};
  }
  code.text = packed.substr(0, kIsoLetters);
  const std::string_view digits = std::string_view(packed).substr(kIsoLetters);
  const auto is_thickness = [](std::string_view two) {
    return (is_digit(two[0]) || two[0] == 'T') && is_digit(two[1]);
  };
  const bool is_metric = digits.size() >= 6 && are_figures(digits.substr(0, 2)) &&
                         is_thickness(digits.substr(2, 2)) &&
                         (are_figures(digits.substr(4, 2)) || digits.substr(4, 2) == "M0" ||
                          digits.substr(4, 2) == "MO") &&
                         (digits.size() == 6 || !(is_digit(digits[6]) || digits[6] == '.'));
  return is_metric ? read_metric(std::move(code), digits)
                   : read_ansi(std::move(code), digits, text);
}

}  // namespace kerf
