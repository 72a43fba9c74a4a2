#include "stock/cutter/turning_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "base/text_scan.h"
#include "base/translate.h"
#include "base/units.h"
#include "stock/cutter/iso_code.h"
#include "stock/cutter/shape_spec.h"
#include "stock/cutter/turning_flanks.h"
#include "stock/cutter/turning_shape.h"

namespace kerf {
namespace {

/// Of blades whose width nobody says: the commonest insert.
constexpr double kUsualBlade_mm = 3;
constexpr double kUsualThread_deg = 60;
/// Longest designation with blanks: "CNMG 12 04 08".
constexpr std::size_t kLongestCode = 20;
/// As near as an angle of the table and one of an insert are the same.
constexpr double kSameAngle_deg = 0.5;

bool is_internal(std::string_view lower) {
  return contains_any(lower, {"internal", "boring", "innen", "inside"}) ||
         contains_word(lower, "bore") || contains_word(lower, "id") || contains_word(lower, "int");
}

std::optional<ShapeText> sure(std::string shape) { return ShapeText{std::move(shape), false, {}}; }

std::string oriented(int orientation) { return fmt::format(":orient={}", orientation); }

// ---- a SHAPE itself ----

/// The word that is one, up to a blank or a comma.
std::optional<ShapeText> written_shape(std::string_view text) {
  std::size_t at = 0;
  while (at < text.size()) {
    const std::size_t end = std::min(text.find_first_of(" \t,;", at), text.size());
    const std::string_view word = text.substr(at, end - at);
    const std::size_t colon = word.find(':');
    // A comment names no file to be read.
    const bool names_file = contains(to_lower(word), "profile:");
    if (colon != std::string_view::npos && colon + 1 < word.size() && !names_file) {
      const std::string name = to_lower(word.substr(0, colon));
      const bool has_value = is_digit(word[colon + 1]) || word[colon + 1] == '.' || name == "iso";
      if (has_value && is_turning_form(name)) return sure(std::string(word));
      if (has_value && parse_shape(word)) return sure(std::string(word));
    }
    at = end + 1;
  }
  return std::nullopt;
}

// ---- designations ----

std::optional<IsoCode> designation_in(std::string_view text) {
  for (std::size_t at = 0; at + 4 < text.size(); ++at) {
    if (at > 0 && (is_letter(text[at - 1]) || is_digit(text[at - 1]))) continue;
    const std::string_view rest = text.substr(at);
    if (!std::all_of(rest.begin(), rest.begin() + 4, is_letter)) continue;
    const std::size_t figure = rest.find_first_not_of(" \t", 4);
    if (figure == std::string_view::npos || !is_digit(rest[figure])) continue;
    // The longest text that is one: what follows may be a size of something else.
    for (std::size_t length = std::min(rest.size(), kLongestCode); length > figure; --length) {
      const bool goes_on =
          length < rest.size() && (is_letter(rest[length]) || is_digit(rest[length]));
      if (goes_on && (is_digit(rest[length]) || !is_digit(rest[length - 1]))) continue;
      if (const Result<IsoCode> code = parse_iso_code(rest.substr(0, length))) return *code;
    }
  }
  return std::nullopt;
}

/// Of an insert, by what its row says of its flanks; none: it says nothing that fits.
std::optional<double> kappa_in_row(const TurningFacts& facts, Hand hand) {
  if (!facts.has_flanks() || hand == Hand::kNeutral) return std::nullopt;
  const bool points_up = facts.orientation == 3 || facts.orientation == 4;
  double front = points_up ? -facts.front_deg : facts.front_deg;
  front -= 360 * std::floor(front / 360);
  return hand == Hand::kRight ? 180 - front : front;
}

ShapeText insert_of(const IsoCode& code, std::string_view lower, const TurningFacts& facts) {
  Hand hand = Hand::kRight;
  if (facts.orientation > 0) {
    hand = hand_of_orientation(facts.orientation);
  } else if (contains_word(lower, "left") || contains_word(lower, "lh") ||
             contains_word(lower, "links")) {
    hand = Hand::kLeft;
  } else if (contains_word(lower, "neutral")) {
    hand = Hand::kNeutral;
  }
  ShapeText out{"iso:" + code.text, false, {}};
  const int orientation =
      facts.orientation > 0 ? facts.orientation : usual_orientation(hand, is_internal(lower));
  const std::optional<double> usual = iso_angle_deg(code.shape);
  const std::optional<double> kappa = kappa_in_row(facts, hand);
  std::string plain = out.shape + fmt::format(":{}", static_cast<char>(hand));
  const std::string at = orientation == usual_orientation(hand, false) ? "" : oriented(orientation);
  out.shape = plain + at;
  if (!usual || !kappa || std::abs(*kappa - *usual) < kSameAngle_deg) return out;
  const std::string turned = fmt::format("{}:{}{}", plain, number_text(*kappa), at);
  if (parse_shape(turned)) {
    out.shape = turned;
  } else {
    out.guessed = true;
    out.guess =
        trf("its front angle of {:g} degrees does not fit such an insert, {:g} degrees of "
            "its holder are assumed",
            facts.front_deg, *usual);
  }
  return out;
}

/// The commonest size of a shape, with and without a clearance.
struct UsualSize {
  char shape;
  const char* positive;
  const char* negative;
};
constexpr std::array kUsualSizes{
    UsualSize{'C', "09T304", "120408"}, UsualSize{'D', "11T304", "150608"},
    UsualSize{'S', "09T308", "120408"}, UsualSize{'T', "16T304", "160408"},
    UsualSize{'V', "160404", "160408"}, UsualSize{'W', nullptr, "080408"}};

/// Of a word that ISO 1832 makes and no language does; nullptr: it is none.
const char* usual_size(std::string_view letters) {
  const auto row = std::find_if(kUsualSizes.begin(), kUsualSizes.end(),
                                [&](const UsualSize& usual) { return usual.shape == letters[0]; });
  const bool insert = row != kUsualSizes.end() &&
                      std::string_view("MGU").find(letters[2]) != std::string_view::npos &&
                      std::string_view("AGHMTW").find(letters[3]) != std::string_view::npos;
  if (!insert) return nullptr;
  if (letters[1] == 'N') return row->negative;
  return std::string_view("BCDP").find(letters[1]) != std::string_view::npos ? row->positive
                                                                             : nullptr;
}

/// "T1: DCMT": the letters of a designation alone.
std::optional<IsoCode> unsized_in(std::string_view text) {
  constexpr std::size_t kLetters = 4;
  std::size_t end = 0;
  for (std::size_t at = 0; at < text.size(); at = end + 1) {
    end = at;
    while (end < text.size() && (is_letter(text[end]) || is_digit(text[end]))) ++end;
    if (end - at != kLetters) continue;
    std::string letters;
    for (const char c : text.substr(at, kLetters)) letters += to_upper(c);
    const char* const size = usual_size(letters);
    if (size == nullptr) continue;
    // A size that there is not is no reason to take another.
    const std::size_t next = text.find_first_not_of(" \t", end);
    if (next != std::string_view::npos && is_digit(text[next])) continue;
    if (const Result<IsoCode> code = parse_iso_code(letters + size)) return *code;
  }
  return std::nullopt;
}

ShapeText unsized_insert(const IsoCode& code, std::string_view lower, const TurningFacts& facts) {
  ShapeText out = insert_of(code, lower, facts);
  out.guessed = true;
  out.guess = trf("its size is not given, {} is assumed", code.text);
  return out;
}

// ---- words ----

/// Of the row's orientation if it is one of these, else the first of them.
int orientation_among(std::initializer_list<int> allowed, int orientation) {
  return std::find(allowed.begin(), allowed.end(), orientation) != allowed.end() ? orientation
                                                                                 : *allowed.begin();
}

std::optional<ShapeText> thread_in(std::string_view lower, const CutterFacts& read,
                                   const TurningFacts& facts) {
  if (!contains_any(lower, {"thread", "gewinde"}) ||
      contains_any(lower, {"mill", "fr\xc3\xa4s", "bohrer", "tap"})) {
    return std::nullopt;
  }
  ShapeText out;
  double angle = read.angle_deg.value_or(0);
  if (angle == 0) {
    for (const char* const bare : {"60", "55", "30", "29"})
      if (angle == 0 && contains_word(lower, bare)) angle = *parse_decimal(bare);
  }
  if (angle == 0 && contains_any(lower, {"whitworth", "bsp", "bsw"})) angle = 55;
  if (angle == 0 && contains(lower, "acme")) angle = 29;
  if (angle == 0 && contains(lower, "trapez")) angle = 30;
  if (angle == 0) {
    angle = kUsualThread_deg;
    out.guessed = true;
    out.guess = trf("its angle is not given, {:g} degrees are assumed", angle);
  }
  const bool inside = facts.orientation == 0 ? is_internal(lower)
                                             : facts.orientation == 3 || facts.orientation == 4 ||
                                                   facts.orientation == 8;
  out.shape = "thread:" + number_text(angle) + (inside ? oriented(8) : "");
  return out;
}

std::optional<ShapeText> blade_in(std::string_view lower, const CutterFacts& read,
                                  const TurningFacts& facts) {
  const bool parts = contains_any(lower, {"parting", "part off", "part-off", "partoff", "cutoff",
                                          "cut-off", "cut off", "abstech"}) ||
                     lower == "part" || lower.starts_with("part ");
  const bool grooves = contains_any(lower, {"groov", "einstech", "einstich", "stechstahl"});
  if (!parts && !grooves) return std::nullopt;
  const bool axial = !parts && (contains_any(lower, {"face groov", "facegroov", "axial"}) ||
                                facts.orientation == 5 || facts.orientation == 7);
  ShapeText out;
  double width = read.diameter_mm.value_or(0);
  if (width <= 0) {
    width = kUsualBlade_mm;
    out.guessed = true;
    out.guess = trf("its width is not given, {:g} mm are assumed", width);
  }
  const double corner = read.corner_mm.value_or(facts.nose_diameter_mm / 2);
  out.shape = fmt::format("{}:{}",
                          parts   ? "part"
                          : axial ? "facegroove"
                                  : "groove",
                          number_text(std::round(width * 1e6) / 1e6));
  if (corner > 0 && corner <= width / 2) out.shape += ":" + number_text(corner);
  const int orientation = axial ? orientation_among({2, 1, 3, 4, 5, 7}, facts.orientation)
                                : orientation_among({2, 1, 3, 4, 6, 8}, facts.orientation);
  if (orientation != 2) out.shape += oriented(orientation);
  return out;
}

std::optional<ShapeText> bar_in(std::string_view lower, const CutterFacts& read,
                                const TurningFacts& facts) {
  if (!contains_any(lower, {"boring bar", "boringbar", "bohrstange", "innendreh"})) {
    return std::nullopt;
  }
  const int orientation = orientation_among({3, 1, 2, 4}, facts.orientation);
  const std::string nose = number_text(facts.nose_diameter_mm / 2);
  const FlankAngles usual = usual_flanks(orientation);
  const std::string flanks =
      facts.has_flanks()
          ? fmt::format("{}:{}", number_text(facts.front_deg), number_text(facts.back_deg))
          : fmt::format("{}:{}", number_text(usual.front_deg), number_text(usual.back_deg));
  const double bar = read.diameter_mm.value_or(0);
  ShapeText out;
  if (bar > 0) {
    out.shape = fmt::format("bore:{}:{}", nose, number_text(std::round(bar * 1e6) / 1e6));
    if (facts.has_flanks()) out.shape += "::" + flanks;
    if (orientation != 3) out.shape += oriented(orientation);
    return out;
  }
  out.shape = fmt::format("turn:{}:{}:{}", nose, orientation, flanks);
  if (facts.orientation == 0 || !facts.has_flanks()) {
    out.guessed = true;
    out.guess =
        trf("its remark names a boring bar; orientation {}, front and back angle {} are "
            "assumed",
            orientation, flanks);
  }
  return out;
}

/// Drills, reamers and taps; mills stand on the axis, too.
std::optional<ShapeText> axial_in(std::string_view lower, bool inches, const TurningFacts& facts) {
  CutterFacts read = read_free_text(lower, inches);
  const bool is_drill = read.kind == CutterKind::kDrill;
  const bool is_other =
      contains_any(lower, {"reamer", "reibahle", "mill", "fr\xc3\xa4s", "gewindebohr"}) ||
      contains_word(lower, "tap");
  if (!is_drill && !is_other) return std::nullopt;
  if (read.kind == CutterKind::kUnnamed || read.kind == CutterKind::kNotCutter) {
    read.kind = CutterKind::kFlat;
  }
  // LinuxCNC's table has a nose's diameter in D, or nothing at all: it counts for want of another.
  if (!read.diameter_mm && facts.nose_diameter_mm > 0) read.diameter_mm = facts.nose_diameter_mm;
  return shape_from_facts(read);
}

}  // namespace

std::optional<ShapeText> turning_shape_in_text(std::string_view text, bool inches,
                                               const TurningFacts& facts) {
  if (std::optional<ShapeText> written = written_shape(text)) return written;
  const std::string lower(trim(to_lower(text)));
  if (const std::optional<IsoCode> code = designation_in(text)) {
    return insert_of(*code, lower, facts);
  }
  // What the table says of nose and flanks is more than a guess.
  const bool is_bare = facts.nose_diameter_mm <= 0 && !facts.has_flanks();
  if (const std::optional<IsoCode> code = unsized_in(text); code && is_bare) {
    return unsized_insert(*code, lower, facts);
  }
  const CutterFacts read = read_free_text(lower, inches);
  std::optional<ShapeText> found = thread_in(lower, read, facts);
  if (!found) found = blade_in(lower, read, facts);
  if (!found) found = bar_in(lower, read, facts);
  if (!found) found = axial_in(lower, inches, facts);
  if (!found) return std::nullopt;
  const Result<Cutter> cutter = parse_shape(found->shape);
  if (!cutter) return std::nullopt;
  found->shape = cutter->spec();
  return found;
}

}  // namespace kerf
