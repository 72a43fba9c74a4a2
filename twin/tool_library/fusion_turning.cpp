#include "twin/tool_library/fusion_turning.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>

#include "base/text_scan.h"
#include "base/translate.h"
#include "base/units.h"
#include "stock/cutter/insert_shape.h"
#include "stock/cutter/shape_spec.h"
#include "twin/tool_library/tool_geometry.h"

namespace kerf {
namespace {

/// What the figures of ISO 1832 stand for, as edges and inch sizes are rounded.
constexpr double kSameCircle_mm = 0.06, kSameThickness_mm = 0.06, kSameCorner_mm = 0.02;

struct IsoThickness {
  const char* code;
  double mm;
};
constexpr std::array kThicknesses{IsoThickness{"01", 1.59}, IsoThickness{"T1", 1.98},
                                  IsoThickness{"02", 2.38}, IsoThickness{"03", 3.18},
                                  IsoThickness{"T3", 3.97}, IsoThickness{"04", 4.76},
                                  IsoThickness{"05", 5.56}, IsoThickness{"06", 6.35},
                                  IsoThickness{"07", 7.94}, IsoThickness{"09", 9.52}};

struct Clearance {
  char letter;
  double degrees;
};
constexpr std::array kClearancesOf{Clearance{'N', 0},  Clearance{'A', 3},  Clearance{'B', 5},
                                   Clearance{'C', 7},  Clearance{'P', 11}, Clearance{'D', 15},
                                   Clearance{'E', 20}, Clearance{'F', 25}, Clearance{'G', 30}};

struct HolderStyle {
  char letter;
  double kappa_deg;
};
/// ISO 5608, those whose edge leads along Z. Others face, and their angle is another one.
constexpr std::array kStyles{HolderStyle{'a', 90}, HolderStyle{'b', 75},    HolderStyle{'d', 45},
                             HolderStyle{'e', 60}, HolderStyle{'g', 90},    HolderStyle{'j', 93},
                             HolderStyle{'l', 95}, HolderStyle{'m', 50},    HolderStyle{'n', 63},
                             HolderStyle{'r', 75}, HolderStyle{'h', 107.5}, HolderStyle{'p', 117.5},
                             HolderStyle{'s', 45}, HolderStyle{'t', 60},    HolderStyle{'v', 72.5}};
/// ISO 6261: bars, whose edge leads along Z.
constexpr std::array kBarStyles{
    HolderStyle{'f', 90}, HolderStyle{'k', 75},    HolderStyle{'l', 95},
    HolderStyle{'s', 45}, HolderStyle{'p', 117.5}, HolderStyle{'u', 93},
    HolderStyle{'w', 60}, HolderStyle{'q', 107.5}, HolderStyle{'j', 93}};
constexpr std::string_view kBarPrefix = "boring bar ";

const IsoShape* shape_of(std::string_view letter) {
  if (letter.size() != 1) return nullptr;
  for (const IsoShape& shape : iso_shapes()) {
    if (shape.letter == to_upper(letter)[0]) return &shape;
  }
  return nullptr;
}

class FusionInsert {
 public:
  FusionInsert(const Json& tool, double mm, double holder_mm, LibraryTool& out)
      : geometry_json_(member(tool, "geometry")),
        holder_json_(member(tool, "holder")),
        geometry_(geometry_json_, "geometry.", mm),
        holder_(holder_json_, "holder.", holder_mm),
        out_(out) {}

  bool make(std::string_view kind) {
    if (kind == "turning general") {
      insert(false);
    } else if (kind == "turning boring") {
      insert(true);
    } else if (kind == "turning grooving") {
      groove();
    } else if (kind == "turning threading") {
      thread();
    } else {
      return false;
    }
    finish();
    return true;
  }

 private:
  void trouble(std::string text) {
    if (out_.trouble.empty()) out_.trouble = std::move(text);
  }
  void remark(std::string text) { out_.remarks.push_back(std::move(text)); }
  std::string text(const Json* object, const char* name) const {
    return object ? to_lower(text_of(member(*object, name))) : std::string();
  }
  char hand() {
    const std::string said = text(holder_json_, "HAND");
    if (said == "l" || said == "n") return said == "l" ? 'L' : 'N';
    if (said != "r") remark(tr("its holder has no HAND: a right-hand one is taken"));
    return 'R';
  }
  /// 0: the usual one is to be taken, which is said.
  double kappa_deg(bool is_bar) {
    std::string style = text(holder_json_, "THSC");
    if (style.starts_with(kBarPrefix)) style.erase(0, kBarPrefix.size());
    const auto find = [&](const auto& styles) -> double {
      for (const HolderStyle& row : styles) {
        if (style.size() == 1 && style[0] == row.letter) return row.kappa_deg;
      }
      return 0;
    };
    const double found = is_bar ? find(kBarStyles) : find(kStyles);
    if (found == 0) {
      remark(style.empty()
                 ? std::string(tr("its holder has no style THSC: the usual angle of its edge is "
                                  "taken"))
                 : trf("the angle of its holder's style '{}' is not known: the usual one is taken",
                       shown(style)));
    }
    return found;
  }

  /// Of ISO 1832's series; none: there is no such insert.
  std::optional<std::string> designation(const IsoShape& shape, double size_mm, double corner_mm) {
    const bool is_circle =
        shape.corners == 0 || text(geometry_json_, "SIZE_SPECIFICATION_MODE") == "ic";
    std::optional<int> size;
    for (const IsoSize& row : iso_sizes(shape.letter)) {
      const bool is_it = is_circle ? std::abs(row.circle_mm - size_mm) < kSameCircle_mm
                                   : row.size == static_cast<int>(size_mm);
      if (is_it) size = row.size;
    }
    if (shape.corners == 0) size = static_cast<int>(std::lround(size_mm));
    if (!size) return std::nullopt;
    const double tenths = corner_mm * 10;
    if (std::abs(tenths - std::round(tenths)) > kSameCorner_mm * 10 || tenths > 99)
      return std::nullopt;
    const double thickness_mm = geometry_.positive_mm("S").value_or(0);
    const auto* const thickness =
        std::find_if(kThicknesses.begin(), kThicknesses.end(), [&](const IsoThickness& row) {
          return std::abs(row.mm - thickness_mm) < kSameThickness_mm;
        });
    const double relief_deg = geometry_.angle_deg("RA").value_or(0);
    const auto* const relief =
        std::find_if(kClearancesOf.begin(), kClearancesOf.end(),
                     [&](const Clearance& row) { return row.degrees == relief_deg; });
    const auto letter = [&](const char* name, char fallback) {
      const std::string said = to_upper(text(geometry_json_, name));
      return said.size() == 1 ? said[0] : fallback;
    };
    return fmt::format("{}{}{}{}{:02}{}{}", shape.letter,
                       relief == kClearancesOf.end() ? 'O' : relief->letter, letter("TC", 'M'),
                       letter("SCTY", 'G'), *size,
                       thickness == kThicknesses.end() ? "04" : thickness->code,
                       shape.corners == 0 ? "M0" : fmt::format("{:02}", std::lround(tenths)));
  }

  void insert(bool is_bar) {
    const std::string letter = text(geometry_json_, "SC");
    const IsoShape* const shape = shape_of(letter);
    if (!shape) {
      return trouble(letter.empty()
                         ? std::string(tr("it has no SC, the shape of its insert"))
                         : trf("the shape SC of its insert, '{}', is not known", shown(letter)));
    }
    const std::optional<double> size_mm = geometry_.positive_mm("INSD");
    if (!size_mm) return trouble(tr("it has no INSD, the size of its insert, above 0"));
    const double corner_mm = geometry_.positive_mm("RE").value_or(0);
    const char side = hand();
    const double kappa = shape->corners == 0 ? 0 : kappa_deg(is_bar);
    if (const auto code = designation(*shape, *size_mm, corner_mm)) {
      shape_ = fmt::format("iso:{}:{}", *code, side);
      if (kappa > 0) shape_ += fmt::format(":{:g}", kappa);
    } else if (kappa > 0 && side != 'N' && !is_bar) {
      // The corner alone: where its body ends does not matter much.
      const double front = side == 'R' ? 180 - kappa : kappa;
      const double nose = shape->nose_rad * kDegPerRad;
      shape_ = fmt::format("turn:{:g}:{}:{:g}:{:g}", corner_mm, side == 'R' ? 2 : 1, front,
                           side == 'R' ? front - nose : front + nose);
      remark(tr("there is no such size in ISO 1832: only its corner is taken"));
    } else {
      return trouble(
          trf("there is no insert {} of this size, {:.4g} mm, and corner, {:.4g} mm, in "
              "ISO 1832",
              shape->letter, *size_mm, corner_mm));
    }
    add_shank(is_bar);
  }

  void groove() {
    const std::optional<double> given = geometry_.positive_mm("tool_grooveWidth");
    const std::optional<double> width_mm =
        given ? given : geometry_.positive_mm("tool_insertWidth");
    if (!width_mm)
      return trouble(tr("it has no tool_grooveWidth, the width of its blade, above 0"));
    const std::string form = text(geometry_json_, "SC");
    double corner_mm = geometry_.positive_mm("RE").value_or(0);
    if (form == "groove round") {
      corner_mm = *width_mm / 2;
    } else if (form != "groove square") {
      remark(
          trf("the shape SC of its blade, '{}', is not known: a square one is taken", shown(form)));
    }
    shape_ = shape_text("groove", {*width_mm, corner_mm});
    if (const auto length_mm = geometry_.positive_mm("LH"))
      shape_ += fmt::format(":edge={:g}", *length_mm);
    remark(tr("nothing says whether it cuts outside, in a bore or in a face: outside is taken"));
  }

  void thread() {
    double angle_deg = geometry_.angle_deg("thread-profile-angle").value_or(0);
    if (!(angle_deg > 0)) {
      angle_deg = 60;
      remark(tr("it has no thread-profile-angle: 60 degrees are taken"));
    }
    const auto least = geometry_.positive_mm("TPN"), most = geometry_.positive_mm("TPX");
    shape_ = shape_text("thread", {angle_deg});
    if (most && (!least || std::abs(*least - *most) < 1e-6)) {
      shape_ = shape_text("thread", {angle_deg, *most});
    } else {
      remark(tr("it is for more than one pitch, or says none: its tip is taken to be sharp"));
    }
    const Json* const inside =
        geometry_json_ ? member(*geometry_json_, "tool_internalThread") : nullptr;
    if (inside && inside->is_boolean() && inside->get<bool>()) shape_ += ":orient=8";
  }

  void add_shank(bool is_bar) {
    const std::optional<double> width_mm = holder_.positive_mm("W");
    const std::optional<double> head_mm = holder_.positive_mm("LH");
    const std::optional<double> length_mm =
        is_bar && head_mm ? head_mm : holder_.positive_mm("OAL");
    if (!width_mm || !length_mm) {
      if (is_bar) trouble(tr("its holder has no W, the thickness of its bar, or no length LH"));
      return;
    }
    shape_ += fmt::format(":{}={:g}x{:g}", is_bar ? "bar" : "holder", *width_mm, *length_mm);
    const std::optional<double> reach_mm = holder_.positive_mm("CW");
    if (is_bar && reach_mm) shape_ += fmt::format(":f={:g}", *reach_mm);
  }

  void finish() {
    for (const JsonFields* fields : {&geometry_, &holder_})
      if (!fields->faults().empty()) trouble(fields->faults().front());
    if (!out_.trouble.empty()) return;
    Result<Cutter> cutter = parse_shape(shape_);
    if (cutter) {
      out_.cutter = std::move(cutter.value());
    } else {
      trouble(fmt::format("{}: {}", shape_, cutter.error()));
    }
  }

  const Json* geometry_json_;
  const Json* holder_json_;
  JsonFields geometry_, holder_;
  LibraryTool& out_;
  std::string shape_;
};

}  // namespace

bool make_fusion_turning_tool(const Json& tool, std::string_view kind, double mm, double holder_mm,
                              LibraryTool& out) {
  return FusionInsert(tool, mm, holder_mm, out).make(kind);
}

}  // namespace kerf
