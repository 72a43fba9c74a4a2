#include "stock/cutter/free_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
#include <vector>

#include "base/text_scan.h"
#include "base/translate.h"
#include "base/units.h"
#include "stock/cutter/shape_spec.h"

namespace kerf {
namespace {

constexpr double kDrillAngle_deg = 118;
constexpr double kVeeAngle_deg = 90;
/// Of V-bits whose text has an angle only. Engraving uses the tip.
constexpr double kVeeDiameter_mm = 12.7;
/// A bare number in a V-bit's text from here up is an angle, below it a size.
constexpr double kLeastBareAngle_deg = 20;
constexpr double kMostBareAngle_deg = 170;
/// A corner radius this close to half the diameter is a ball written with few decimals.
constexpr double kBallFraction = 0.995;

enum class Unit { kNone, kMm, kInch, kDegree };
enum class Label { kNone, kDiameter, kCorner, kAngle, kTip, kIgnored };

struct Quantity {
  double value = 0;
  Unit unit = Unit::kNone;
  bool fraction = false;
  bool whole = false;
  Label label = Label::kNone;
};

/// Picks the numbers of a text with their units and labels.
class QuantityScanner {
 public:
  explicit QuantityScanner(std::string_view lower) : text_(lower) {}

  std::vector<Quantity> scan() {
    while (at_ < text_.size()) {
      if (starts_number()) {
        read_number();
      } else {
        ++at_;
      }
    }
    return std::move(quantities_);
  }

 private:
  char peek(std::size_t index) const { return index < text_.size() ? text_[index] : '\0'; }

  bool starts_number() const {
    return is_digit(peek(at_)) || (peek(at_) == '.' && is_digit(peek(at_ + 1)));
  }

  std::size_t skip_digits(std::size_t from, bool point) const {
    while (is_digit(peek(from)) || (point && peek(from) == '.')) ++from;
    return from;
  }

  std::size_t skip_blanks(std::size_t from) const {
    while (peek(from) == ' ' || peek(from) == '\t') ++from;
    return from;
  }

  double number(std::size_t from, std::size_t to) const {
    // More than one point ("1.2.3") is no size.
    return parse_decimal(text_.substr(from, to - from)).value_or(0);
  }

  /// The number before or behind says how long something is, how thick the shank, or where it is
  /// kept.
  static bool is_length(std::string_view word) {
    constexpr std::array<std::string_view, 10> kWords = {
        "loc", "oal", "lof", "len", "length", "reach", "shank", "shk", "depth", "offset"};
    return std::find(kWords.begin(), kWords.end(), word) != kWords.end();
  }

  /// Label by the word before the number, across ":", "=", ".", "-" and blanks.
  Label label_before(std::size_t begin) const {
    std::size_t end = begin;
    bool equals = false;
    while (end > 0 && std::string_view(" \t:=.-+").find(text_[end - 1]) != std::string_view::npos) {
      equals = equals || text_[end - 1] == '=';
      --end;
    }
    std::size_t first = end;
    while (first > 0 && is_letter(text_[first - 1])) --first;
    const std::string_view word = text_.substr(first, end - first);
    const bool touches = end == begin;
    if (word == "d" || word == "dia" || word == "diam" || word == "diameter") {
      return word != "d" || touches || equals ? Label::kDiameter : Label::kNone;
    }
    if (word == "cr" || word == "corner" || word == "radius") return Label::kCorner;
    if (word == "r" && (touches || equals)) return Label::kCorner;
    if (word == "angle") return Label::kAngle;
    if (word == "td" || word == "tip") return Label::kTip;
    if (is_length(word)) return Label::kIgnored;
    // "endmill001", "h0", "zmin=-5": part of a name, or the value of something else.
    if (!word.empty() && (touches || equals)) return Label::kIgnored;
    return begin > 0 && text_[begin - 1] == '#' ? Label::kIgnored : Label::kNone;
  }

  /// Value at at_: decimal, fraction or mixed fraction. Moves on. "45/60" is two numbers: its
  /// second part stays.
  Quantity read_value() {
    Quantity q;
    const std::size_t end = skip_digits(at_, true);
    q.value = number(at_, end);
    q.whole = text_.substr(at_, end - at_).find('.') == std::string_view::npos;
    at_ = end;
    if (!q.whole) return q;
    if (peek(end) == '/') {
      read_denominator(q, end, 0);
    } else if ((peek(end) == '-' || peek(end) == ' ') && is_digit(peek(end + 1))) {
      const std::size_t slash = skip_digits(end + 1, false);
      if (peek(slash) == '/') {
        const double units = q.value;
        Quantity part;
        part.value = number(end + 1, slash);
        read_denominator(part, slash, units);
        if (part.fraction) q = part;
      }
    }
    return q;
  }

  /// Inch fractions: halves to 128ths, less than one.
  void read_denominator(Quantity& q, std::size_t slash, double units) {
    const std::size_t end = skip_digits(slash + 1, false);
    const double denominator = number(slash + 1, end);
    for (double power = 2; power <= 128; power *= 2) {
      if (denominator == power && q.value < denominator) {
        q.value = units + q.value / denominator;
        q.fraction = true;
        q.whole = false;
        at_ = end;
      }
    }
  }

  /// Unit after the number; false if what follows shows that it is no size ("2 flute", "500mm/min",
  /// "3d").
  bool read_unit(Quantity& q) {
    const std::size_t begin = skip_blanks(at_);
    const std::string_view rest = text_.substr(begin);
    const auto take = [&](Unit unit, std::size_t bytes) {
      q.unit = unit;
      at_ = begin + bytes;
      return peek(at_) != '/';
    };
    for (const std::string_view sign : {"\"", "''", "\xe2\x80\x9d", "\xe2\x80\xb3"}) {
      if (rest.starts_with(sign)) return take(Unit::kInch, sign.size());
    }
    for (const std::string_view sign : {"*", "\xc2\xb0", "\xb0"}) {
      if (rest.starts_with(sign)) return take(Unit::kDegree, sign.size());
    }
    std::size_t length = 0;
    while (length < rest.size() && is_letter(rest[length])) ++length;
    const std::string_view word = rest.substr(0, length);
    if (word == "mm") return take(Unit::kMm, 2);
    if (word == "in" || word == "inch" || word == "inches") return take(Unit::kInch, length);
    if (word.starts_with("deg")) return take(Unit::kDegree, length);
    if (word == "fl" || word.starts_with("flute") || word == "z" || word == "rpm") return false;
    if (begin == at_ && !word.empty() && word != "th" && word != "er") return false;
    return peek(at_) != '%';
  }

  /// Label by the word after number and unit.
  Label label_after() const {
    std::size_t begin = at_;
    while (peek(begin) == ' ' || peek(begin) == '.') ++begin;
    const std::string_view rest = text_.substr(begin);
    if (rest.starts_with("dia")) return Label::kDiameter;
    if (rest.starts_with("point angle") || rest.starts_with("angle")) return Label::kAngle;
    if (rest.starts_with("rad") || rest.starts_with("corner")) return Label::kCorner;
    std::size_t length = 0;
    while (length < rest.size() && is_letter(rest[length])) ++length;
    const std::string_view word = rest.substr(0, length);
    if (is_length(word) || word == "long" || word == "deep") return Label::kIgnored;
    if (rest.starts_with("tip")) return contains(rest, "tip rad") ? Label::kCorner : Label::kTip;
    return Label::kNone;
  }

  void read_number() {
    const std::size_t begin = at_;
    Quantity q = read_value();
    q.label = label_before(begin);
    const bool size = read_unit(q);
    if (q.label == Label::kNone) q.label = label_after();
    // "03-0086", "1/4-20": a part number or a thread follows.
    bool part_number = false;
    while (peek(at_) == '-' && is_digit(peek(at_ + 1))) {
      part_number = !q.fraction;
      at_ = skip_digits(at_ + 1, true);
    }
    if (q.unit == Unit::kDegree) q.label = Label::kAngle;
    if (size && !part_number && q.label != Label::kIgnored) quantities_.push_back(q);
  }

  std::string_view text_;
  std::size_t at_ = 0;
  std::vector<Quantity> quantities_;
};

double to_mm(const Quantity& q, bool inches) {
  const bool inch = q.unit == Unit::kInch || (q.unit == Unit::kNone && (q.fraction || inches));
  return inch ? q.value * kMmPerInch : q.value;
}

/// Best candidate: labelled, then with a unit, then a fraction, then any bare number.
const Quantity* find_diameter(const std::vector<Quantity>& quantities) {
  const auto rank = [](const Quantity& q) {
    if (q.value <= 0) return 0;
    if (q.label == Label::kDiameter) return 4;
    if (q.label != Label::kNone) return 0;
    if (q.unit != Unit::kNone) return 3;
    return q.fraction ? 2 : 1;
  };
  const Quantity* best = nullptr;
  for (const Quantity& q : quantities) {
    if (rank(q) > (best == nullptr ? 0 : rank(*best))) best = &q;
  }
  return best;
}

/// A V-bit's angle may stand there without a sign: "60 v-bit". The last such number counts: "45/60
/// v-bit".
void mark_bare_angle(std::vector<Quantity>& quantities) {
  const bool known = std::any_of(quantities.begin(), quantities.end(),
                                 [](const Quantity& q) { return q.label == Label::kAngle; });
  const auto bare = [](const Quantity& q) {
    return q.label == Label::kNone && q.unit == Unit::kNone && !q.fraction &&
           q.value >= kLeastBareAngle_deg && q.value <= kMostBareAngle_deg;
  };
  const auto last = std::find_if(quantities.rbegin(), quantities.rend(), bare);
  if (!known && last != quantities.rend()) {
    last->label = Label::kAngle;
    for (auto other = last + 1; other != quantities.rend(); ++other) {
      if (bare(*other)) other->label = Label::kIgnored;
    }
  }
}

std::string size_text(double value) {
  // Six decimals: 3/16" comes out as 4.7625, not as 4.762499999999999.
  return number_text(std::round(value * 1e6) / 1e6);
}

ShapeText flat_or_bull(double diameter, double corner, bool guessed) {
  if (corner >= kBallFraction * diameter / 2) return {"ball:" + size_text(diameter), guessed, {}};
  if (corner > 0) {
    return {fmt::format("bull:{}:{}", size_text(diameter), size_text(corner)), guessed, {}};
  }
  return {fmt::format("flat:{}", size_text(diameter)), guessed, {}};
}

ShapeText draft_shape(const CutterFacts& facts, double diameter) {
  const double corner = facts.corner_mm.value_or(0);
  const std::string d = size_text(diameter);
  switch (facts.kind) {
    case CutterKind::kBall:
      if (facts.tapered && facts.angle_deg) {
        return {fmt::format("taper:{}:{}:{}", d, number_text(*facts.angle_deg),
                            number_text(std::round(diameter * 1e6) / 2e6)),
                false,
                {}};
      }
      return {fmt::format("ball:{}", d), facts.tapered, "the angle of its taper is not given"};
    case CutterKind::kBull: {
      ShapeText text = flat_or_bull(diameter, corner, corner <= 0);
      text.guess = "its corner radius is not given";
      return text;
    }
    case CutterKind::kTaper:
      if (!facts.angle_deg) {
        ShapeText text = flat_or_bull(diameter, corner, true);
        text.guess = "the angle of its taper is not given";
        return text;
      }
      return {fmt::format("taper:{}:{}{}{}", d, number_text(*facts.angle_deg),
                          corner > 0 ? fmt::format(":{}", size_text(corner)) : "",
                          facts.cone_mm > 0 ? ":flute=" + size_text(facts.cone_mm) : ""),
              false,
              {}};
    case CutterKind::kVee: {
      const double written = facts.angle_deg.value_or(kVeeAngle_deg);
      const double angle = facts.angle_deg && facts.angle_is_half ? 2 * written : written;
      return {fmt::format("vee:{}:{}{}", d, number_text(angle),
                          facts.tip_mm > 0 ? fmt::format(":{}", size_text(facts.tip_mm)) : ""),
              !facts.angle_deg,
              trf("its angle is not given, {:g} degrees are assumed", kVeeAngle_deg)};
    }
    case CutterKind::kLollipop:
      return {fmt::format("lollipop:{}:{}", d, size_text(diameter / 2)), true,
              "the diameter of its neck is not given"};
    case CutterKind::kDrill:
      return {fmt::format("drill:{}:{}", d, number_text(facts.angle_deg.value_or(kDrillAngle_deg))),
              false,
              {}};
    case CutterKind::kFlat:
      return flat_or_bull(diameter, corner, false);
    case CutterKind::kUnnamed:
      return flat_or_bull(diameter, corner, corner <= 0);
    case CutterKind::kOther:
    case CutterKind::kNotCutter:
      break;
  }
  return {fmt::format("flat:{}", d), true, {}};
}

}  // namespace

CutterKind kind_in(std::string_view text) {
  if (contains_any(text, {"turning", "threading tool", "cutoff", "cut-off", "parting",
                          "nose radius", "plasma", "torch", "laser"}) ||
      contains_word(text, "probe")) {
    return CutterKind::kNotCutter;
  }
  if (contains_any(text, {"lollipop"})) return CutterKind::kLollipop;
  if (contains_any(text, {"ball", "spher", "kugelfr"})) return CutterKind::kBall;
  if (contains_any(text, {"bull", "corner r", "toroid", "torus"})) return CutterKind::kBull;
  if (contains_any(text, {"taper"})) return CutterKind::kTaper;
  if (contains_any(text,
                   {"v-bit", "vbit", "v bit", "v-carv", "vcarv", "v-groove", "v cutter", "v-cutter",
                    "chamfer", "engrav", "conic", "countersink", "gravier", "fasenfr"})) {
    return CutterKind::kVee;
  }
  if (contains_any(text, {"dovetail", "thread mill", "threadmill", "reamer", "boring bar",
                          "radius mill", "t-slot", "key cutter", "keyseat"})) {
    return CutterKind::kOther;
  }
  if (contains_any(text, {"drill", "spot", "center bit", "bohrer"})) return CutterKind::kDrill;
  if (contains_word(text, "tap") || contains_word(text, "face") ||
      contains_any(text, {"facing", "flat", "mill", "fr\xc3\xa4s", "fr\xe4s", "fraes", "router",
                          "cylind", "straight", "upcut", "downcut", "compression"})) {
    return CutterKind::kFlat;
  }
  return CutterKind::kUnnamed;
}

CutterFacts read_free_text(std::string_view text, bool inches) {
  const std::string lower = to_lower(text);
  CutterFacts facts;
  facts.kind = kind_in(lower);
  facts.tapered = contains(lower, "taper");
  std::vector<Quantity> quantities = QuantityScanner(lower).scan();
  if (facts.kind == CutterKind::kVee) mark_bare_angle(quantities);
  for (const Quantity& q : quantities) {
    if (q.label == Label::kAngle && !facts.angle_deg && q.value > 0) facts.angle_deg = q.value;
    if (q.label == Label::kCorner && !facts.corner_mm) facts.corner_mm = to_mm(q, inches);
    if (q.label == Label::kTip) facts.tip_mm = to_mm(q, inches);
  }
  // A chamfer mill of 45 degrees is named after the chamfer that it leaves.
  facts.angle_is_half = facts.angle_deg == 45 && contains(lower, "chamfer");
  if (const Quantity* q = find_diameter(quantities)) {
    facts.diameter_mm = to_mm(*q, inches);
    facts.diameter_is_explicit = q->label == Label::kDiameter || q->unit != Unit::kNone;
    facts.diameter_is_whole = q->whole && !facts.diameter_is_explicit;
  }
  return facts;
}

std::optional<ShapeText> shape_from_facts(const CutterFacts& facts) {
  const bool vee = facts.kind == CutterKind::kVee && facts.angle_deg;
  if (facts.kind == CutterKind::kNotCutter || (!facts.diameter_mm && !vee)) return std::nullopt;
  ShapeText text = draft_shape(facts, facts.diameter_mm.value_or(kVeeDiameter_mm));
  if (!facts.diameter_mm) {
    text.guessed = true;
    text.guess = trf("its diameter is not given, {:g} mm are assumed", kVeeDiameter_mm);
  }
  if (!text.guessed) text.guess.clear();
  const Result<Cutter> cutter = parse_shape(text.shape);
  if (!cutter) return std::nullopt;
  text.shape = cutter->spec();
  return text;
}

}  // namespace kerf
