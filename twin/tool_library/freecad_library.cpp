#include "twin/tool_library/freecad_library.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <optional>
#include <string_view>

#include "base/portable_math.h"
#include "base/text_scan.h"
#include "base/translate.h"
#include "base/units.h"
#include "stock/cutter/shape_limits.h"
#include "twin/tool_library/library_number.h"
#include "twin/tool_library/tool_geometry.h"

namespace kerf {
namespace {

/// How far the height of a dovetail may be off what its angle makes of it.
constexpr double kHeightTolerance = 0.1;

/// A shape's name without folder, ending and what joins its words: "Tools/Shape/v-bit.fcstd".
std::string bare_name(std::string_view text) {
  text = text.substr(text.find_last_of("/\\") + 1);
  text = text.substr(0, text.find('.'));
  std::string name;
  for (const char c : text) {
    if (is_letter(c) || is_digit(c)) name += to_lower(c);
  }
  return name;
}

/// One tool bit, field by field.
class Bit {
 public:
  Bit(const Json& bit, LibraryTool& out)
      : out_(out), fields_(member(bit, "parameter"), "parameter.", 1) {
    diameter_mm_ = fields_.positive_mm("Diameter");
    if (!diameter_mm_ && fields_.length_mm("Diameter")) is_not_positive_ = true;
  }

  /// False: no such kind is known.
  bool make(const std::string& kind) {
    const auto row = std::find_if(kMakers.begin(), kMakers.end(),
                                  [&](const Maker& maker) { return maker.kind == kind; });
    if (row == kMakers.end()) return false;
    add_body();
    if (!fields_.faults().empty()) {
      trouble(fields_.faults().front());
    } else if (!diameter_mm_) {
      trouble(is_not_positive_ ? tr("its Diameter is not above 0") : tr("it has no Diameter"));
    } else {
      (this->*row->make)();
    }
    finish();
    return true;
  }

 private:
  struct Maker {
    std::string_view kind;
    void (Bit::*make)();
  };
  static const std::array<Maker, 17> kMakers;

  void trouble(std::string text) {
    if (out_.trouble.empty()) out_.trouble = std::move(text);
  }
  double d() const { return *diameter_mm_; }

  void add_body() {
    tool_.flute_mm = fields_.positive_mm("CuttingEdgeHeight");
    if (!tool_.flute_mm) tool_.flute_mm = fields_.positive_mm("CuttingEdgeLength");
    tool_.shank_mm = fields_.positive_mm("ShankDiameter");
    const std::optional<double> flutes = fields_.number("Flutes");
    if (flutes && *flutes >= 1 && *flutes <= kMaxTeeth && *flutes == std::floor(*flutes)) {
      tool_.teeth = static_cast<int>(*flutes);
    }
  }

  void flat() { tool_.shape = shape_text("flat", {d()}); }
  void ball() { tool_.shape = shape_text("ball", {d()}); }
  /// Older ones say how wide the flat bottom is instead of the corner.
  void bull() {
    std::optional<double> corner = fields_.length_mm("CornerRadius");
    if (!corner) corner = fields_.length_mm("TorusRadius");
    const std::optional<double> flat_radius = fields_.length_mm("FlatRadius");
    if (!corner && flat_radius) corner = d() / 2 - *flat_radius;
    if (!corner) return trouble(tr("it has no CornerRadius"));
    tool_.shape = shape_text("bull", {d(), *corner});
  }
  /// CuttingEdgeAngle is the whole angle; CuttingEdgeHeight is that of a rim above the cone, not of
  /// what cuts.
  void vee() {
    std::optional<double> angle = fields_.angle_deg("CuttingEdgeAngle");
    if (!angle) angle = fields_.angle_deg("TipAngle");
    if (!angle) return trouble(tr("it has no CuttingEdgeAngle"));
    tool_.flute_mm.reset();
    tool_.shape = shape_text("vee", {d(), *angle, fields_.positive_mm("TipDiameter").value_or(0)});
  }
  void drill() {
    const std::optional<double> angle = fields_.angle_deg("TipAngle");
    if (!angle) return trouble(tr("it has no TipAngle"));
    tool_.shape = shape_text("drill", {d(), *angle});
  }
  void hole() { tool_.shape = shape_text("drill", {d(), 180}); }
  void tap() {
    hole();
    out_.remarks.push_back(tr("a tap is taken for a plain cylinder, without its thread"));
  }
  void dovetail() {
    const std::optional<double> angle = fields_.angle_deg("CuttingEdgeAngle");
    const std::optional<double> neck = fields_.positive_mm("NeckDiameter");
    if (!angle || !neck) return trouble(tr("it has no CuttingEdgeAngle or no NeckDiameter"));
    tool_.shape = shape_text("dovetail", {d(), *angle, *neck});
    const double height_mm = (d() - *neck) / 2 * portable::tan(*angle * kRadPerDeg);
    if (tool_.flute_mm &&
        std::abs(height_mm - *tool_.flute_mm) > kHeightTolerance * *tool_.flute_mm) {
      out_.remarks.push_back(
          trf("its CuttingEdgeHeight is {:.4g} mm, its diameters and its angle make {:.4g} mm: the "
              "angle counts",
              *tool_.flute_mm, height_mm));
    }
    tool_.neck_mm = neck;
    if (const auto length = fields_.positive_mm("NeckHeight")) {
      tool_.neck_top_mm = height_mm + *length;
    }
  }
  void saw() {
    const std::optional<double> blade = fields_.positive_mm("BladeThickness");
    std::optional<double> shaft = tool_.shank_mm;
    if (!shaft) shaft = fields_.positive_mm("CapDiameter");
    if (!blade || !shaft) return trouble(tr("it has no BladeThickness or no ShankDiameter"));
    tool_.shape = shape_text("tslot", {d(), *blade, *shaft});
    if (fields_.positive_mm("CapHeight")) {
      out_.remarks.push_back(tr("its cap is left out: the underside of its blade is the tip"));
    }
  }
  void tapered_ball() {
    const std::optional<double> angle = fields_.angle_deg("TaperAngle");
    if (!angle) return trouble(tr("it has no TaperAngle"));
    tool_.shape = shape_text("taper", {d(), *angle / 2, d() / 2});
  }

  void finish() {
    if (!fields_.faults().empty()) trouble(fields_.faults().front());
    if (!out_.trouble.empty()) return;
    Result<Cutter> cutter = cutter_of(tool_, out_.remarks);
    if (cutter) {
      out_.cutter = std::move(cutter.value());
    } else {
      trouble(cutter.error());
    }
  }

  LibraryTool& out_;
  JsonFields fields_;
  ToolGeometry tool_;
  std::optional<double> diameter_mm_;
  bool is_not_positive_ = false;
};

const std::array<Bit::Maker, 17> Bit::kMakers{{
    {"endmill", &Bit::flat},
    {"ballend", &Bit::ball},
    {"bullnose", &Bit::bull},
    {"torus", &Bit::bull},
    {"vbit", &Bit::vee},
    {"chamfer", &Bit::vee},
    {"engraver", &Bit::vee},
    {"drill", &Bit::drill},
    {"reamer", &Bit::hole},
    {"tap", &Bit::tap},
    {"dovetail", &Bit::dovetail},
    {"slittingsaw", &Bit::saw},
    {"taperedballnose", &Bit::tapered_ball},
    {"probe", &Bit::ball},
    {"ball", &Bit::ball},
    {"bull", &Bit::bull},
    {"flat", &Bit::flat},
}};

}  // namespace

bool is_freecad_bit(const Json& root) {
  const Json* const parameter = member(root, "parameter");
  return parameter != nullptr && parameter->is_object();
}

bool is_freecad_library(const Json& root) {
  const Json* const tools = member(root, "tools");
  if (tools == nullptr || !tools->is_array()) return false;
  for (const Json& tool : *tools) {
    if (member(tool, "nr") != nullptr || member(tool, "path") != nullptr) return true;
  }
  return false;
}

LibraryTool freecad_tool(const Json& bit) {
  LibraryTool out;
  out.name = text_of(member(bit, "name"));
  const std::string type = text_of(member(bit, "shape-type")),
                    shape = text_of(member(bit, "shape"));
  out.kind = bare_name(shape.empty() ? type : shape);
  if (!is_freecad_bit(bit)) {
    out.trouble = tr("it is no tool bit of FreeCAD: it has no parameter");
    return out;
  }
  // A shape of one's own may be of a known type.
  for (const std::string& kind : {out.kind, bare_name(type)}) {
    if (!kind.empty() && Bit(bit, out).make(kind)) return out;
  }
  out.trouble = trf("its kind '{}' is not known", shown(shape.empty() ? type : shape));
  return out;
}

std::vector<LibraryTool> freecad_tools(const Json& library, const BitReader& read) {
  std::vector<LibraryTool> tools;
  for (const Json& entry : *member(library, "tools")) {
    LibraryTool tool;
    const std::string path = text_of(member(entry, "path"));
    if (path.empty()) {
      tool.trouble = tr("it has no path of a tool bit");
    } else if (const Result<std::string> text = read(path); !text) {
      tool.trouble = text.error();
    } else {
      Diagnostics said;
      const std::optional<Json> bit = parse_json(*text, path, said);
      if (bit) tool = freecad_tool(*bit);
      if (!bit) tool.trouble = fmt::format("{}: {}", shown(path), said.front().message);
    }
    if (tool.name.empty()) tool.name = path.substr(path.find_last_of("/\\") + 1);
    take_number(member(entry, "nr"), tool);
    tools.push_back(std::move(tool));
  }
  return tools;
}

}  // namespace kerf
