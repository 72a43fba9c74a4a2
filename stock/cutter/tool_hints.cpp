#include "stock/cutter/tool_hints.h"

#include <algorithm>
#include <cmath>

#include "base/text_scan.h"
#include "base/units.h"
#include "stock/cutter/free_text.h"
#include "stock/cutter/tool_number.h"

namespace kerf {
namespace {

/// More tools than any magazine holds, and few enough to compare each with all.
constexpr std::size_t kMostHints = 10000;
/// A drill's point: what is blunter than this is no chamfer and no taper, whatever language names
/// it.
constexpr double kLeastDrillAngle_deg = 100;
/// CamBam wants a diameter of every tool, and who has none to give says 0 or a thousandth of an
/// inch.
constexpr double kPlaceholder_mm = 0.03;

/// "KEY=number": value after the first such key that stands by itself.
std::optional<double> field(std::string_view lower, std::string_view key) {
  for (std::size_t at = lower.find(key); at != std::string_view::npos;
       at = lower.find(key, at + 1)) {
    if (at > 0 && lower[at - 1] != ' ' && lower[at - 1] != '\t' && lower[at - 1] != ',') continue;
    std::string_view rest = without_leading(lower.substr(at + key.size()), " \t");
    if (!rest.starts_with('=')) continue;
    rest = without_leading(rest.substr(1), " \t");
    if (rest.starts_with('+')) rest.remove_prefix(1);
    const std::size_t end = std::min(rest.find_first_not_of("0123456789.-"), rest.size());
    return parse_decimal(rest.substr(0, end));
  }
  return std::nullopt;
}

/// What F-Engrave's settings say of the tool, as far as they have been read.
struct FEngrave {
  std::uint32_t line = 0;
  bool near = false;
  bool inches = false;
  std::string shape, cut;
  std::optional<double> angle_deg, diameter;
};

class HintFinder {
 public:
  explicit HintFinder(std::span<const CommentText> comments) : comments_(comments) {}

  std::vector<ToolHint> find() {
    for (index_ = 0; index_ < comments_.size() && hints_.size() < kMostHints; ++index_) {
      const std::string_view text = trim(comments_[index_].text);
      if (text.empty() || text.size() > kLongestComment) continue;
      lower_ = to_lower(text);
      read_comment();
    }
    finish_pycam();
    finish_fengrave();
    return std::move(hints_);
  }

 private:
  const CommentText& comment() const { return comments_[index_]; }
  double unit_mm() const { return comment().inches ? kMmPerInch : 1; }

  /// Each reader says whether the comment was of its dialect; the first that says so ends the
  /// search.
  void read_comment() {
    if (read_pycam() || read_fengrave()) return;
    if (index_ + 1 < comments_.size() &&
        to_lower(trim(comments_[index_ + 1].text)) == "begin toolchange") {
      return;  // read_freecad() reads it
    }
    if (read_mastercam() || read_kiri()) return;
    if (read_cutviewer()) return;
    if (read_numbered()) return;
    if (read_turret()) return;
    if (read_sheetcam()) return;
    if (read_pcb2gcode()) return;
    if (read_flatcam()) return;
    if (read_freecad()) return;
    if (read_numbered_line() || read_tool_line()) return;
    if (read_vectric()) return;
    if (read_at_block()) return;
    read_prose();
  }

  /// Of a comment that names no tool (-1) it is that of its own block.
  void add(int tool, std::string_view dialect, const CutterFacts& facts) {
    if (tool < 0) tool = comment().block_tool;
    add_at(comment().line, tool, dialect, facts, !comment().at_change);
  }

  /// A list that repeats a tool adds it once; a hint without a number counts for the place where it
  /// stands.
  void add_at(std::uint32_t line, int tool, std::string_view dialect, const CutterFacts& facts,
              bool near = false) {
    const std::optional<ShapeText> text = shape_from_facts(facts);
    if (!text) return;
    const auto same = [&](const ToolHint& hint) {
      return hint.tool == tool && hint.shape == text->shape;
    };
    if (tool >= 0 && std::any_of(hints_.begin(), hints_.end(), same)) return;
    hints_.push_back({tool, line, std::string(dialect), text->shape, text->guessed, text->guess,
                      near && tool < 0});
  }

  bool read_numbered() {
    const std::optional<NumberedText> numbered = split_tool_number(lower_);
    if (!numbered) return false;
    const std::optional<double> diameter = field(numbered->rest, "d");
    if (diameter) return read_fusion(*numbered, *diameter);
    // CamBam's list gives the bare diameter.
    const std::optional<double> bare = parse_decimal(numbered->rest);
    if (bare && numbered->separator == ':') {
      CutterFacts facts;
      const double diameter_mm = *bare * unit_mm();
      facts.diameter_mm = diameter_mm < kPlaceholder_mm ? 0 : diameter_mm;
      add(numbered->tool, "cambam", facts);
      return true;
    }
    if (numbered->separator == ' ' &&
        (numbered->rest.empty() || !starts_with_number(numbered->rest))) {
      return false;
    }
    const CutterFacts facts =
        read_free_text(without_registers(numbered->rest, numbered->separator), comment().inches);
    const bool listed = numbered->separator == '|' && facts.diameter_is_explicit;
    const bool labelled = contains(numbered->rest, "dia");
    if (facts.kind == CutterKind::kUnnamed && !listed && !labelled) return false;
    add(numbered->tool, "list", facts);
    return true;
  }

  /// Mastercam's "T17|DRILL - 0.16|H17|D17|TOOL DIA. - .16": H17 and D17 are offsets, no sizes.
  static std::string without_registers(std::string_view text, char separator) {
    if (separator != '|') return std::string(text);
    std::string kept;
    for (const std::string_view part : split(text, '|')) {
      const std::string_view word = trim(part);
      const bool offset = word.size() > 1 && (word[0] == 'h' || word[0] == 'd') &&
                          word.find_first_not_of("0123456789", 1) == std::string_view::npos;
      if (!offset) kept.append(kept.empty() ? "" : " | ").append(part);
    }
    return kept;
  }

  /// 1/8 CHAMFER MILL TOOL - 14 DIA. OFF. - 14 LEN. - 14 TOOL DIA. - .125
  bool read_mastercam() {
    constexpr std::string_view kSize = "tool dia. -";
    const std::size_t number = lower_.find("tool - ");
    const std::size_t size = lower_.find(kSize);
    if (number == std::string::npos || size == std::string::npos || size < number) return false;
    std::string_view rest = without_leading(std::string_view(lower_).substr(number + 7), " ");
    const std::optional<int> tool = take_integer(rest);
    const std::string_view written = trim(std::string_view(lower_).substr(size + kSize.size()));
    const std::optional<double> diameter = parse_decimal(written);
    if (!tool || !diameter) return false;
    CutterFacts facts =
        read_free_text(std::string_view(lower_).substr(0, number), comment().inches);
    facts.diameter_mm = *diameter * unit_mm();
    add(*tool, "mastercam", facts);
    return true;
  }

  /// tool#=1 flute=6 len=20 unit=metric
  bool read_kiri() {
    if (!lower_.starts_with("tool#=")) return false;
    const std::string_view text = lower_;
    const std::optional<double> tool = field(text, "tool#");
    const std::optional<double> diameter = field(text, "flute");
    if (!tool || !diameter || *tool < 0 || *tool > 1e6) return true;
    CutterFacts facts;
    facts.diameter_mm = *diameter * (contains(text, "unit=imperial") ? kMmPerInch : 1);
    add(static_cast<int>(*tool), "kirimoto", facts);
    return true;
  }

  /// Names of Vectric's tools have their size in braces: "5 = End Mill {0.25 inch}" in the list,
  /// "V-Bit {60 deg 0.5"}" at the change.
  bool read_vectric() {
    const std::size_t brace = lower_.find('{');
    if (brace == std::string::npos || lower_.find('}', brace) == std::string::npos) return false;
    std::string_view rest = lower_;
    int tool = -1;
    if (const std::optional<int> number = take_integer(rest)) {
      const std::string_view name = without_leading(rest, " \t");
      if (!name.starts_with('=')) return false;
      tool = *number;
      rest = name.substr(1);
    }
    const CutterFacts facts = read_free_text(rest, comment().inches);
    const bool sized = facts.diameter_is_explicit || facts.angle_deg;
    if (facts.kind == CutterKind::kUnnamed || !sized) return false;
    add(tool, "vectric", facts);
    return true;
  }

  /// "M6 T2 (2" Facemill)": what stands in the block of a T word is about that tool, unless it
  /// names another one.
  bool read_at_block() {
    const int tool = comment().block_tool;
    if (tool < 0) return false;
    if (const std::optional<double> diameter = diameter_alone()) {
      CutterFacts facts;
      facts.diameter_mm = *diameter * unit_mm();
      add(tool, "block", facts);
      return true;
    }
    const int named = tool_named_in(lower_);
    if ((named != -1 && named != tool) || contains(lower_, "next")) return true;
    const CutterFacts facts = read_free_text(lower_, comment().inches);
    const bool sized = facts.diameter_is_explicit || facts.angle_deg || starts_with_number(lower_);
    if (facts.kind == CutterKind::kUnnamed || !sized) return false;
    add(tool, "block", facts);
    return true;
  }

  /// "T1M6(D26)". Behind T6, D6 may as well be the number of its offset.
  std::optional<double> diameter_alone() const {
    std::string_view text = lower_;
    bool sign = false;
    for (const std::string_view diameter : {"d", "\xc3\xb8", "\xc3\x98"}) {
      if (sign || !text.starts_with(diameter)) continue;
      sign = true;
      text.remove_prefix(diameter.size());
    }
    if (text.ends_with("mm") && !comment().inches) text = trim(text.substr(0, text.size() - 2));
    if (!sign || text.empty() || !starts_with_number(text)) return std::nullopt;
    const std::optional<double> value = parse_decimal(text);
    if (!value || *value <= 0 || *value == comment().block_tool) return std::nullopt;
    return value;
  }

  static bool starts_with_number(std::string_view text) {
    return is_digit(text.front()) || (text.size() > 1 && text.front() == '.' && is_digit(text[1]));
  }

  /// T1 [description] D=6. CR=3. TAPER=45deg - ZMIN=-5. - ball end mill
  bool read_fusion(const NumberedText& numbered, double diameter) {
    CutterFacts facts;
    facts.diameter_mm = diameter * unit_mm();
    const std::string_view text = numbered.rest;
    const std::size_t dash = text.rfind(" - ");
    facts.kind = kind_in(dash == std::string_view::npos ? text : text.substr(dash));
    if (const auto corner = field(text, "cr")) facts.corner_mm = *corner * unit_mm();
    if (const auto tip = field(text, "td")) facts.tip_mm = *tip * unit_mm();
    facts.angle_deg = field(text, "taper");
    facts.angle_is_half = facts.kind == CutterKind::kVee;
    facts.tapered = contains(text, "taper") && facts.kind == CutterKind::kBall;
    const bool blunt = facts.angle_deg.value_or(0) >= kLeastDrillAngle_deg;
    if (facts.kind == CutterKind::kUnnamed && blunt) facts.kind = CutterKind::kDrill;
    add(numbered.tool, "fusion", facts);
    return true;
  }

  /// TOOL/MILL,diameter,corner radius,height,taper angle | TOOL/DRILL,diameter,point angle,height
  /// TOOL/CHAMFER,diameter,point angle,height
  bool read_cutviewer() {
    if (!lower_.starts_with("tool/")) return false;
    const std::vector<std::string_view> fields = split(std::string_view(lower_).substr(5), ',');
    const auto value = [&](std::size_t index) {
      return index < fields.size() ? parse_decimal(trim(fields[index])) : std::nullopt;
    };
    const std::string_view kind = trim(fields[0]);
    const std::optional<double> diameter = value(1);
    if (!diameter) return true;
    CutterFacts facts;
    facts.diameter_mm = *diameter * unit_mm();
    if (kind == "mill") {
      facts.kind = CutterKind::kFlat;
      if (const auto corner = value(2)) facts.corner_mm = *corner * unit_mm();
      if (const auto taper = value(4); taper && *taper > 0) {
        // A V-bit has its tip's diameter, and half its angle: TOOL/MILL,0.03,0,10,45.
        facts.kind = CutterKind::kTaper;
        facts.angle_deg = *taper;
        facts.cone_mm = value(3).value_or(0) * unit_mm();
      }
    } else if (kind == "drill" || kind == "centerdrill" || kind == "chamfer") {
      facts.kind = kind == "chamfer" ? CutterKind::kVee : CutterKind::kDrill;
      facts.angle_deg = value(2);
    } else {
      return true;
    }
    add(-1, "cutviewer", facts);
    return true;
  }

  /// Turret No. : 0 Diameter :6.350 MM BALLNOSE
  bool read_turret() {
    if (!lower_.starts_with("turret no")) return false;
    std::string_view rest = without_leading(std::string_view(lower_).substr(9), " .:");
    const std::optional<int> tool = take_integer(rest);
    if (tool) add(*tool, "turret", read_free_text(rest, comment().inches));
    return true;
  }

  /// QtPlasmaC materials "o=0, na=.., kw=1.5" and SheetCam "Operation: .., T4: Plasma, 1.5 mm
  /// kerf": the jet is a flat cutter as wide as the kerf.
  bool read_sheetcam() {
    CutterFacts facts;
    facts.kind = CutterKind::kFlat;
    if (lower_.starts_with("o=")) {
      const std::optional<double> kerf = field(lower_, "kw");
      if (!kerf) return false;
      facts.diameter_mm = *kerf * unit_mm();
      add(-1, "sheetcam", facts);
      return true;
    }
    if (!lower_.starts_with("operation:")) return false;
    const std::size_t comma = lower_.find(", t");
    if (comma == std::string::npos) return false;
    const std::optional<NumberedText> numbered =
        split_tool_number(std::string_view(lower_).substr(comma + 2));
    if (!numbered) return false;
    const bool kerf = contains(numbered->rest, "kerf");
    const CutterFacts read = read_free_text(numbered->rest, comment().inches);
    if (kerf) facts.diameter_mm = read.diameter_mm;
    add(numbered->tool, "sheetcam", kerf ? facts : read);
    return true;
  }

  /// MSG, Change tool bit to mill diameter 0.20000mm | MSG, Change tool bit to drill size 0.8mm
  bool read_pcb2gcode() {
    constexpr std::string_view kPhrase = "change tool bit to ";
    const std::size_t at = lower_.find(kPhrase);
    if (at == std::string::npos) return false;
    CutterFacts facts =
        read_free_text(std::string_view(lower_).substr(at + kPhrase.size()), comment().inches);
    // "mill" and "cutter" say what it does to the board, not which shape it has.
    if (facts.kind != CutterKind::kDrill) facts.kind = CutterKind::kUnnamed;
    add(-1, "pcb2gcode", facts);
    return true;
  }

  /// Tool-Diameter: 2.5mm (viaConstructor) | TOOL DIAMETER: 0.1 mm | MSG, Change to Tool Dia =
  /// 0.1000 [||| Total drills for tool T1 = 10]
  bool read_flatcam() {
    if (lower_.starts_with("tool-diameter:")) {
      add(-1, "viaconstructor", read_free_text(lower_, comment().inches));
      return true;
    }
    const std::size_t at = lower_.find("tool dia");
    if (at == std::string::npos) return false;
    const bool line = at == 0 || std::string_view(lower_).starts_with("msg, change to tool dia");
    if (!line) return false;
    const std::string_view rest = std::string_view(lower_).substr(at + 5);
    CutterFacts facts = read_free_text(rest.substr(0, rest.find("|||")), comment().inches);
    facts.kind = contains(rest, "drill") ? CutterKind::kDrill : CutterKind::kUnnamed;
    if (facts.diameter_is_explicit) add(-1, "flatcam", facts);
    return true;
  }

  /// FreeCAD names the tool controller in the comment before "Begin toolchange"; some posts add "M6
  /// T2" as a comment.
  bool read_freecad() {
    if (lower_ != "begin toolchange") return false;
    if (index_ == 0) return true;
    const CutterFacts facts =
        read_free_text(comments_[index_ - 1].text.substr(0, kLongestComment), comment().inches);
    if (facts.kind == CutterKind::kUnnamed || !facts.diameter_is_explicit) return true;
    int tool = -1;
    if (index_ + 1 < comments_.size()) {
      const std::string next = to_lower(trim(comments_[index_ + 1].text));
      std::string_view rest = next;
      if (rest.starts_with("m6 t")) {
        rest.remove_prefix(4);
        tool = take_integer(rest).value_or(-1);
      }
    }
    add(tool, "freecad", facts);
    return true;
  }

  /// "Tool: 23 YG-1 .375 CoHSS stub drill": the number is the tool's, and a size is what can be
  /// nothing else.
  bool read_numbered_line() {
    const std::optional<NumberedText> numbered = split_bare_number(lower_);
    if (!numbered) return false;
    if (comment().block_tool >= 0 && comment().block_tool != numbered->tool) return true;
    // "Tool: 1 1/4 end mill": who knows which of the two.
    constexpr int kMostInches = 4;
    const std::size_t slash = numbered->rest.find_first_not_of("0123456789");
    const bool mixed = slash != std::string_view::npos && slash > 0 && numbered->rest[slash] == '/';
    if (mixed && numbered->tool <= kMostInches) return true;
    CutterFacts facts = read_free_text(without_makers(numbered->rest), comment().inches);
    if (facts.kind == CutterKind::kUnnamed) return true;
    if (facts.diameter_is_whole) facts.diameter_mm.reset();
    add(numbered->tool, "tool-line", facts);
    return true;
  }

  /// Without "yg-1", or "yg-1 1/2-13 tap" would be one and a half inches.
  static std::string without_makers(std::string_view text) {
    std::string kept;
    for (const std::string_view word : words_of(text)) {
      const std::size_t dash = word.find('-');
      const bool name = dash != std::string_view::npos && dash > 1 && is_letter(word[dash - 1]) &&
                        dash + 1 < word.size() &&
                        word.find_first_not_of("0123456789", dash + 1) == std::string_view::npos;
      if (!name) kept.append(kept.empty() ? "" : " ").append(word);
    }
    return kept;
  }

  /// "Tool: D = 3.0 mm type END flutes 2" (Fabex), "TOOL: V-BIT {90 DEG 0.5\"}" (Vectric), "MSG,
  /// INSERT BALLNOSE ,1/4\""
  bool read_tool_line() {
    std::string_view rest = lower_;
    const bool tool = rest.starts_with("tool:");
    const bool message = rest.starts_with("msg,");
    if (!tool && !message) return false;
    rest = without_leading(rest.substr(tool ? 5 : 4), " \t");
    if (message && !rest.starts_with("insert ") && !rest.starts_with("load ") &&
        !rest.starts_with("change to ")) {
      return false;
    }
    const std::size_t type = rest.find(" type ");
    const bool fabex = tool && rest.starts_with("d") && type != std::string_view::npos;
    CutterFacts facts = read_free_text(rest, comment().inches);
    if (fabex && contains(rest.substr(type), " end")) facts.kind = CutterKind::kFlat;
    if (fabex && contains(rest.substr(type), "ballcone")) facts.tapered = true;
    if (facts.kind == CutterKind::kUnnamed) return tool;
    add(-1, fabex ? "fabex" : tool ? "tool-line" : "message", facts);
    return true;
  }

  /// "Cutter is assumed to be a 10mm ball nose", "Ball cutter D=10.00": words in running text. The
  /// kind must be a milling cutter's and the size must be marked as one, or every remark about the
  /// work would be a tool. What names several tools is about none; what names none is a guess.
  void read_prose() {
    const int named = tool_named_in(lower_);
    if (named == kSeveralTools) return;
    // FreeCAD repeats the tool controller's label as the name of an operation.
    const bool names_operation = contains(lower_, "operation") || lower_.starts_with("path:") ||
                                 lower_.starts_with("block-name:");
    if (names_operation) return;
    const CutterFacts facts = read_free_text(lower_, comment().inches);
    if (facts.kind == CutterKind::kVee && facts.angle_deg && names_vee()) {
      add_at(comment().line, named, "prose", facts, true);
      return;
    }
    const bool names_tool = contains(lower_, "cutter") || contains(lower_, "end mill") ||
                            contains(lower_, "endmill") || contains(lower_, "end_mill");
    const bool milling = facts.kind == CutterKind::kBall || facts.kind == CutterKind::kBull ||
                         facts.kind == CutterKind::kFlat;
    if (names_tool && milling && facts.diameter_is_explicit) {
      add_at(comment().line, named, "prose", facts, true);
    }
  }

  /// "30.0 deg. conical", "60deg. 1/2" V bit"; not "engrave 30 deg lines".
  bool names_vee() const {
    for (const std::string_view name : {"v bit", "v-bit", "vbit", "conical", "v cutter"}) {
      if (contains(lower_, name)) return true;
    }
    return false;
  }

  // ---- F-Engrave ----
  //     fengrave_set units       in
  //     fengrave_set bit_shape   VBIT
  //     fengrave_set v_bit_angle 60
  //     fengrave_set v_bit_dia   0.5

  bool read_fengrave() {
    constexpr std::string_view kKey = "fengrave_set";
    if (!lower_.starts_with(kKey)) {
      finish_fengrave();
      return false;
    }
    const std::vector<std::string_view> words = words_of(lower_);
    if (words.size() < 3) return true;
    if (!fengrave_) {
      fengrave_.emplace();
      fengrave_->line = comment().line;
      fengrave_->near = !comment().at_change;
    }
    const std::string_view key = words[1], value = words[2];
    if (key == "units") fengrave_->inches = value == "in";
    if (key == "bit_shape") fengrave_->shape = std::string(value);
    if (key == "cut_type") fengrave_->cut = std::string(value);
    if (key == "v_bit_angle") fengrave_->angle_deg = parse_decimal(value);
    if (key == "v_bit_dia") fengrave_->diameter = parse_decimal(value);
    return true;
  }

  /// Without a shape it is a V-bit where it carves by one; of other programs nothing is said.
  void finish_fengrave() {
    if (!fengrave_) return;
    const FEngrave block = *fengrave_;
    fengrave_.reset();
    if (!block.diameter || block.cut == "engrave") return;
    CutterFacts facts;
    facts.diameter_mm = *block.diameter * (block.inches ? kMmPerInch : 1);
    if (block.shape == "ball") {
      facts.kind = CutterKind::kBall;
    } else if (block.shape == "flat") {
      facts.kind = CutterKind::kFlat;
    } else {
      facts.kind = CutterKind::kVee;
      facts.angle_deg = block.angle_deg;
    }
    add_at(block.line, -1, "fengrave", facts, block.near);
  }

  // ---- PyCAM ----
  //     [Tool]
  //     torus_radius = 0.25
  //     shape = ToroidalCutter
  //     tool_radius = 3.0

  bool read_pycam() {
    if (lower_.front() == '[') {
      finish_pycam();
      if (lower_ != "[tool]") return false;
      pycam_ = PyCam{};
      pycam_->line = comment().line;
      pycam_->inches = comment().inches;
      pycam_->near = !comment().at_change;
      return true;
    }
    if (!pycam_) return false;
    const std::size_t equals = lower_.find('=');
    if (equals == std::string::npos) {
      finish_pycam();
      return false;
    }
    const std::string_view key = trim(std::string_view(lower_).substr(0, equals));
    const std::string_view value = trim(std::string_view(lower_).substr(equals + 1));
    if (key == "shape") pycam_->shape = std::string(value);
    if (key == "tool_radius") pycam_->radius = parse_decimal(value);
    if (key == "torus_radius") pycam_->torus = parse_decimal(value);
    return true;
  }

  void finish_pycam() {
    if (!pycam_) return;
    const PyCam block = *pycam_;
    pycam_.reset();
    if (!block.radius) return;
    const double unit = block.inches ? kMmPerInch : 1;
    CutterFacts facts;
    facts.kind = kind_in(block.shape);
    facts.diameter_mm = 2 * *block.radius * unit;
    // The torus radius is written for every shape and counts for one.
    if (facts.kind == CutterKind::kBull && block.torus) facts.corner_mm = *block.torus * unit;
    add_at(block.line, -1, "pycam", facts, block.near);
  }

  struct PyCam {
    std::uint32_t line = 0;
    bool inches = false;
    bool near = false;
    std::string shape;
    std::optional<double> radius, torus;
  };

  std::span<const CommentText> comments_;
  std::size_t index_ = 0;
  std::string lower_;
  std::optional<PyCam> pycam_;
  std::optional<FEngrave> fengrave_;
  std::vector<ToolHint> hints_;
};

}  // namespace

std::vector<ToolHint> find_tool_hints(std::span<const CommentText> comments) {
  return HintFinder(comments).find();
}

std::optional<ToolHint> shape_from_remark(int tool, double diameter_mm, std::string_view remark) {
  CutterFacts facts = read_free_text(remark.substr(0, kLongestComment), false);
  if (facts.kind == CutterKind::kUnnamed) return std::nullopt;
  // The table's diameter counts; the text's only where the table has none.
  if (std::isfinite(diameter_mm) && diameter_mm > 0) facts.diameter_mm = diameter_mm;
  const std::optional<ShapeText> shape = shape_from_facts(facts);
  if (!shape) return std::nullopt;
  return ToolHint{tool, 0, "remark", shape->shape, shape->guessed, shape->guess, false};
}

}  // namespace kerf
