// stock/cutter/free_text.h - what a person or a CAM system says about a cutter in words ("1/4\"
// ball nose", "6 mm flat end mill", "90 deg V-bit"). No grammar stands behind such text: words and
// labelled numbers are picked out, the rest is passed over. Reads English and the German of shipped
// tool tables.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace kerf {

enum class CutterKind {
  kUnnamed,    ///< no kind was named
  kNotCutter,  ///< turning tool, probe, torch, ...: nothing that a milling shape describes
  kBall,
  kBull,
  kTaper,
  kVee,
  kLollipop,
  kDrill,
  kFlat,   ///< end, face and slot mills, taps: a flat cutter models them
  kOther,  ///< a mill whose shape the text does not give: thread mill, dovetail, reamer, ...
};

/// What was read; mm and degrees.
struct CutterFacts {
  CutterKind kind = CutterKind::kUnnamed;
  std::optional<double> diameter_mm;
  bool diameter_is_explicit = false;  ///< it has a unit or a label such as "dia", "D="
  bool diameter_is_whole = false;     ///< a bare whole number: it may count something
  std::optional<double> corner_mm;
  std::optional<double> angle_deg;  ///< as written: included or half depends on kind
  bool angle_is_half = false;
  double tip_mm = 0;
  double cone_mm = 0;    ///< kTaper: height of the cone; 0: not known
  bool tapered = false;  ///< "tapered ball": kBall with this set
};

/// The kind of cutter named in lower-case text. Where several words match, the first of this order
/// wins: what is no milling cutter, lollipop, ball, bull or corner radius, taper, V-bit or chamfer
/// or engraver, kOther, drill or spot, then tap, face, flat and any other mill.
CutterKind kind_in(std::string_view lower_text);

/// Reads all facts. Numbers without a unit are in `inches` or mm; a bare fraction (1/4) is in
/// inches.
CutterFacts read_free_text(std::string_view text, bool inches);

/// A SHAPE text that parse_shape() accepts, nullopt if the facts do not make one. `guessed` is set
/// if the text gives less than the shape needs: no kind (a flat cutter is taken), a V-bit without
/// its angle (90 degrees) or, where it has one, its diameter (12.7 mm), a bull-nose or tapered
/// cutter without its radius or angle (flat). A drill without its angle has 118 degrees and is no
/// guess.
struct ShapeText {
  std::string shape;
  bool guessed = false;
  std::string guess;  ///< what is assumed, a sentence; empty: the kind, or it is no guess
};
std::optional<ShapeText> shape_from_facts(const CutterFacts& facts);

}  // namespace kerf
