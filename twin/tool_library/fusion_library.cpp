#include "twin/tool_library/fusion_library.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string_view>

#include "base/portable_math.h"
#include "base/text_scan.h"
#include "base/translate.h"
#include "base/units.h"
#include "stock/cutter/shape_limits.h"
#include "twin/tool_library/fusion_turning.h"
#include "twin/tool_library/library_number.h"
#include "twin/tool_library/tool_geometry.h"

namespace kerf {
namespace {

constexpr double kFlatDrill_deg = 180;
constexpr double kUsualPoint_deg = 118;
/// A side that leans less is upright: SHAPE has no such cone.
constexpr double kLeastTaper_deg = 1;
constexpr double kSameNeck_mm = 0.02;

/// Holders have a unit of their own: often millimetres at tools in inches.
double mm_of(const Json& object) {
  const std::string unit = to_lower(text_of(member(object, "unit")));
  return unit.starts_with("inch") ? kMmPerInch : 1;
}

/// Sections of a holder as the array has them: from the nose up.
struct HolderReading {
  std::vector<HolderSection> sections;
  double gauge_mm = 0;  ///< from the nose to the gauge line; 0: not known
  std::string fault;
};

/// What lies above the gauge line is in the spindle.
void cut_at_gauge(HolderReading& holder) {
  double z = 0;
  for (std::size_t i = 0; i < holder.sections.size(); ++i) {
    HolderSection& section = holder.sections[i];
    const double left = holder.gauge_mm - z;
    if (section.length_mm <= left + 1e-6) {
      z += section.length_mm;
      continue;
    }
    section.upper_mm =
        section.lower_mm + (section.upper_mm - section.lower_mm) * left / section.length_mm;
    section.length_mm = left;
    holder.sections.resize(left > 1e-6 ? i + 1 : i);
    return;
  }
}

HolderReading read_holder(const Json* holder) {
  HolderReading out;
  const Json* const segments = holder ? member(*holder, "segments") : nullptr;
  if (segments == nullptr || !segments->is_array()) return out;
  const double mm = mm_of(*holder);
  double total_mm = 0;
  for (const Json& segment : *segments) {
    JsonFields fields(&segment, "holder.segments.", mm);
    const auto height = fields.length_mm("height");
    const auto lower = fields.length_mm("lower-diameter");
    const auto upper = fields.length_mm("upper-diameter");
    if (height && *height == 0) continue;
    if (!height || !lower || !upper || !(*height > 0) || !(*lower > 0) || !(*upper > 0)) {
      out.fault = fields.faults().empty()
                      ? tr("a section of its holder has no height or no diameters above 0")
                      : fields.faults().front();
      out.sections.clear();
      return out;
    }
    out.sections.push_back({*lower, *upper, *height});
    total_mm += *height;
  }
  JsonFields fields(holder, "holder.", mm);
  out.gauge_mm = fields.positive_mm("gaugeLength").value_or(total_mm);
  cut_at_gauge(out);
  return out;
}

class Tool {
 public:
  Tool(const Json& tool, LibraryTool& out)
      : tool_(tool), out_(out), fields_(member(tool, "geometry"), "geometry.", mm_of(tool)) {}

  /// False: no such kind is known.
  bool make(std::string_view type) {
    for (const Maker& row : kMakers) {
      if (row.type != type) continue;
      add_body();
      (this->*row.make)();
      finish();
      return true;
    }
    return false;
  }

 private:
  struct Maker {
    std::string_view type;
    void (Tool::*make)();
  };
  static const std::array<Maker, 23> kMakers;

  void trouble(std::string text) {
    if (out_.trouble.empty()) out_.trouble = std::move(text);
  }
  void remark(std::string text) { out_.remarks.push_back(std::move(text)); }
  std::optional<double> length(const char* name) { return fields_.positive_mm(name); }
  double angle(const char* name) { return fields_.angle_deg(name).value_or(0); }

  void add_body() {
    const std::optional<double> given = fields_.length_mm("DC");
    if (given) d_ = *given;
    geometry_.flute_mm = length("LCF");
    geometry_.shank_mm = length("SFDM");
    geometry_.neck_mm = length("shoulder-diameter");
    geometry_.neck_top_mm = length("shoulder-length");
    // Cutters without a shoulder of their own are as wide there as they cut.
    if (!geometry_.neck_mm && geometry_.neck_top_mm && d_ > 0) geometry_.neck_mm = d_;
    const std::optional<double> flutes = fields_.number("NOF");
    if (flutes && *flutes >= 1 && *flutes <= kMaxTeeth && *flutes == std::floor(*flutes)) {
      geometry_.teeth = static_cast<int>(*flutes);
    }
    HolderReading holder = read_holder(member(tool_, "holder"));
    if (!holder.fault.empty()) remark(trf("its holder is left out: {}", holder.fault));
    geometry_.holder = std::move(holder.sections);
    geometry_.stickout_mm = length("LB");
    const std::optional<double> whole_mm = length("assemblyGaugeLength");
    if (!geometry_.stickout_mm && whole_mm && *whole_mm > holder.gauge_mm) {
      geometry_.stickout_mm = *whole_mm - holder.gauge_mm;
    }
  }

  void flat() { geometry_.shape = shape_text("flat", {d_}); }
  void ball() { geometry_.shape = shape_text("ball", {d_}); }
  void bull() { geometry_.shape = shape_text("bull", {d_, length("RE").value_or(0)}); }
  /// TA is the angle of one side; tip-diameter the flat at the tip.
  void chamfer() {
    geometry_.shape = shape_text("vee", {d_, 2 * angle("TA"), length("tip-diameter").value_or(0)});
    sharp_corner();
  }
  void counter_sink() {
    geometry_.shape = shape_text("vee", {d_, angle("SIG"), length("tip-diameter").value_or(0)});
  }
  /// DC is its diameter at the tip.
  void tapered() {
    double corner = length("RE").value_or(0);
    const bool is_ball = contains(text_of(member(tool_, "tapered-type")), "ball");
    if (is_ball && corner == 0) corner = d_ / 2;
    if (std::abs(angle("TA")) < kLeastTaper_deg) {
      geometry_.shape = shape_text("bull", {d_, corner});
    } else {
      geometry_.shape = shape_text("taper", {d_, angle("TA"), std::min(corner, d_ / 2)});
      geometry_.neck_mm.reset();
    }
  }
  void lollipop() { geometry_.shape = shape_text("lollipop", {d_, neck()}); }
  /// TA is measured from the axis, SHAPE's angle from the bottom.
  void dovetail() {
    const double lean = angle("TA");
    const double top = d_ - 2 * geometry_.flute_mm.value_or(0) * portable::tan(lean * kRadPerDeg);
    // Of both, what is written counts, if they say the same.
    const bool is_same = std::abs(top - neck()) < kSameNeck_mm;
    geometry_.shape = shape_text("dovetail", {d_, 90 - lean, top > 0 && !is_same ? top : neck()});
    sharp_corner();
  }
  void slot() {
    if (!geometry_.flute_mm) return trouble(tr("it has no LCF, the length of its flutes"));
    if (neck() >= d_) return flat();
    geometry_.shape = shape_text("tslot", {d_, *geometry_.flute_mm, neck()});
    sharp_corner();
  }
  void drill() {
    double point = angle("SIG");
    if (!(point > 0)) {
      point = kUsualPoint_deg;
      remark(trf("it has no SIG, the angle of its point: {} degrees are taken", point));
    }
    geometry_.shape = shape_text("drill", {d_, point});
  }
  void hole() { geometry_.shape = shape_text("drill", {d_, kFlatDrill_deg}); }
  void tap() {
    hole();
    remark(tr("a tap is taken for a plain cylinder, without its thread"));
  }
  void beam() {
    const std::optional<double> width = length("CW");
    if (!width) return trouble(tr("it has no CW, the width of its kerf"));
    geometry_ = {};
    d_ = *width;
    geometry_.shape = shape_text("kerf", {d_});
  }

  double neck() const {
    if (geometry_.neck_mm && *geometry_.neck_mm < d_) return *geometry_.neck_mm;
    return geometry_.shank_mm.value_or(d_);
  }
  void sharp_corner() {
    if (const auto corner = length("RE")) {
      remark(trf("its corner radius RE, {:.4g} mm, is left out", *corner));
    }
  }

  void finish() {
    if (!fields_.faults().empty()) trouble(fields_.faults().front());
    if (!(d_ > 0)) trouble(tr("it has no DC, its diameter, above 0"));
    if (!out_.trouble.empty()) return;
    Result<Cutter> cutter = cutter_of(geometry_, out_.remarks);
    if (cutter) {
      out_.cutter = std::move(cutter.value());
    } else {
      trouble(cutter.error());
    }
  }

  const Json& tool_;
  LibraryTool& out_;
  JsonFields fields_;
  ToolGeometry geometry_;
  double d_ = 0;
};

const std::array<Tool::Maker, 23> Tool::kMakers{{
    {"flat end mill", &Tool::flat},
    {"ball end mill", &Tool::ball},
    {"bull nose end mill", &Tool::bull},
    {"face mill", &Tool::tapered},
    {"chamfer mill", &Tool::chamfer},
    {"tapered mill", &Tool::tapered},
    {"lollipop mill", &Tool::lollipop},
    {"dovetail mill", &Tool::dovetail},
    {"slot mill", &Tool::slot},
    {"drill", &Tool::drill},
    {"spot drill", &Tool::drill},
    {"counter sink", &Tool::counter_sink},
    {"counter bore", &Tool::hole},
    {"reamer", &Tool::hole},
    {"boring bar", &Tool::hole},
    {"boring head", &Tool::hole},
    {"tap", &Tool::tap},
    {"tap right hand", &Tool::tap},
    {"tap left hand", &Tool::tap},
    {"probe", &Tool::ball},
    {"laser cutter", &Tool::beam},
    {"plasma cutter", &Tool::beam},
    {"waterjet", &Tool::beam},
}};

bool make_turned(const Json& tool, std::string_view type, LibraryTool& out) {
  const Json* const holder = member(tool, "holder");
  const bool has_unit = holder && member(*holder, "unit");
  return make_fusion_turning_tool(tool, type, mm_of(tool), mm_of(has_unit ? *holder : tool), out);
}

LibraryTool fusion_tool(const Json& tool, const std::string& type) {
  LibraryTool out;
  out.kind = type;
  out.name = text_of(member(tool, "description"));
  if (out.name.empty()) out.name = text_of(member(tool, "product-id"));
  if (type.empty()) {
    out.trouble = tr("it has no type");
  } else if (!Tool(tool, out).make(type) && !make_turned(tool, type, out)) {
    out.trouble = trf("its kind '{}' is not known", shown(type));
  }
  const Json* const post = member(tool, "post-process");
  take_number(post ? member(*post, "number") : nullptr, out);
  return out;
}

}  // namespace

bool is_fusion_library(const Json& root) {
  const Json* const data = member(root, "data");
  if (data != nullptr) return data->is_array();
  return root.is_array() && std::any_of(root.begin(), root.end(), [](const Json& tool) {
           return member(tool, "geometry") != nullptr;
         });
}

std::vector<LibraryTool> fusion_tools(const Json& root) {
  std::vector<LibraryTool> tools;
  for (const Json& tool : root.is_array() ? root : *member(root, "data")) {
    const std::string type = to_lower(text_of(member(tool, "type")));
    if (type != "holder") tools.push_back(fusion_tool(tool, type));
  }
  return tools;
}

}  // namespace kerf
