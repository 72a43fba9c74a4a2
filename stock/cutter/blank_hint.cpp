#include <fmt/format.h>

#include <cmath>
#include <initializer_list>
#include <map>

#include "base/text_scan.h"
#include "base/units.h"
#include "stock/blank.h"
#include "stock/cutter/tool_hints.h"

namespace kerf {
namespace {

constexpr std::size_t kLongestComment = 512;

/// Millimetres as text; nine decimals keep converted inches free of rounding noise.
std::string mm(double value) { return number_text(std::round(value * 1e9) / 1e9); }

/// The KEY=value pairs of a WORKPIECE comment, in mm.
class Keys {
 public:
  Keys(const std::vector<std::string_view>& fields, double unit_mm) {
    for (std::size_t i = 2; i < fields.size(); ++i) {
      const std::size_t equals = fields[i].find('=');
      if (equals == std::string_view::npos) continue;
      const std::string key(trim(fields[i].substr(0, equals)));
      const std::string_view value = trim(fields[i].substr(equals + 1));
      if (key == "axis") axis_ = std::string(value);
      if (const auto number = parse_decimal(value)) numbers_[key] = *number * unit_mm;
    }
  }
  char axis() const { return axis_.size() == 1 ? axis_[0] : '?'; }
  bool has(std::initializer_list<const char*> keys) const {
    for (const char* key : keys) {
      if (numbers_.count(key) == 0) return false;
    }
    return true;
  }
  std::string text(const std::string& key) const {
    const auto found = numbers_.find(key);
    return found == numbers_.end() ? "" : mm(found->second);
  }

 private:
  std::map<std::string, double> numbers_;
  std::string axis_ = "z";
};

/// One body as --stock writes it; "" if a key is missing.
std::string workpiece_body(const std::vector<std::string_view>& fields, double unit_mm) {
  const std::string_view kind = fields.size() > 1 ? trim(fields[1]) : std::string_view{};
  const Keys keys(fields, unit_mm);
  if (kind == "box") {
    if (!keys.has({"xmin", "ymin", "zmin", "xmax", "ymax", "zmax"})) return "";
    return fmt::format("box:{},{},{}:{},{},{}", keys.text("xmin"), keys.text("ymin"),
                       keys.text("zmin"), keys.text("xmax"), keys.text("ymax"), keys.text("zmax"));
  }
  const bool tube = kind == "tube";
  const char axis = keys.axis();
  if ((kind != "cylinder" && !tube) || axis < 'x' || axis > 'z') return "";
  std::string point;
  std::string end;
  for (const char letter : {'x', 'y', 'z'}) {
    const std::string name(1, letter);
    const std::string value = keys.text(letter == axis ? name + "min" : name);
    if (value.empty()) return "";
    point += (letter == 'x' ? "" : ",") + value;
    if (letter == axis) end = keys.text(name + "max");
  }
  if (end.empty() || !keys.has({"diameter"}) || (tube && !keys.has({"inner_diameter"}))) return "";
  return fmt::format("{}:{}:{}:{}{}{}", kind, point, end, keys.text("diameter"),
                     tube ? fmt::format(":{}", keys.text("inner_diameter")) : "",
                     axis == 'z' ? "" : fmt::format(":{}", axis));
}

/// STOCK/BLOCK,x,y,z,ox,oy,oz: size, and where the program's origin lies inside, from the lower
/// corner.
std::string block_body(const std::vector<std::string_view>& fields, double unit_mm) {
  if (fields.size() < 7) return "";
  double values[6] = {};
  for (std::size_t i = 0; i < 6; ++i) {
    const std::optional<double> value = parse_decimal(trim(fields[i + 1]));
    if (!value) return "";
    values[i] = *value * unit_mm;
  }
  return fmt::format("box:{},{},{}:{},{},{}", mm(-values[3]), mm(-values[4]), mm(-values[5]),
                     mm(values[0] - values[3]), mm(values[1] - values[4]),
                     mm(values[2] - values[5]));
}

/// Lathe EasyStep says "mm" in programs of inches, too: of those nothing is taken.
///     Rohteil Aussendurchmesser: 50.000 mm
///     Rohteil Z-Bereich: 1.000 bis -80.000 mm
class EasyStepBar {
 public:
  void add(const CommentText& comment, std::string_view lower) {
    if (!lower.starts_with("rohteil ") || comment.inches) return;
    const std::vector<std::string_view> words = words_of(lower);
    if (words.size() < 4 || words.back() != "mm") return;
    if (words[1] == "aussendurchmesser:" && words.size() == 4) {
      diameter_mm_ = parse_decimal(words[2]);
      line_ = comment.line;
    } else if (words[1] == "z-bereich:" && words.size() == 6 && words[3] == "bis") {
      top_mm_ = parse_decimal(words[2]);
      floor_mm_ = parse_decimal(words[4]);
    }
  }

  std::optional<BlankHint> hint() const {
    if (!diameter_mm_ || !top_mm_ || !floor_mm_) return std::nullopt;
    BlankHint bar;
    bar.line = line_;
    bar.dialect = "easystep";
    bar.spec =
        fmt::format("cylinder:0,0,{}:{}:{}", mm(*floor_mm_), mm(*top_mm_), mm(*diameter_mm_));
    return parse_blank(bar.spec) ? std::optional<BlankHint>(bar) : std::nullopt;
  }

 private:
  std::uint32_t line_ = 0;
  std::optional<double> diameter_mm_, top_mm_, floor_mm_;
};

}  // namespace

std::optional<BlankHint> find_blank_hint(std::span<const CommentText> comments) {
  BlankHint workpiece;
  BlankHint block;
  EasyStepBar bar;
  for (const CommentText& comment : comments) {
    if (comment.text.size() > kLongestComment) continue;
    const std::string lower = to_lower(comment.text);
    bar.add(comment, trim(lower));
    const std::vector<std::string_view> fields = split(lower, ',');
    const std::string_view name = trim(fields[0]);
    const double unit_mm = comment.inches ? kMmPerInch : 1;
    if (name == "workpiece") {
      const std::string body = workpiece_body(fields, unit_mm);
      // A blank with a part missing would be wrong everywhere else too: all or none.
      if (body.empty() || !parse_blank(body)) return std::nullopt;
      if (workpiece.spec.empty()) workpiece.line = comment.line;
      workpiece.spec += (workpiece.spec.empty() ? "" : " + ") + body;
    } else if (name == "stock/block" && block.spec.empty()) {
      const std::string body = block_body(fields, unit_mm);
      if (body.empty() || !parse_blank(body)) continue;
      block.line = comment.line;
      block.spec = body;
    }
  }
  if (!workpiece.spec.empty()) {
    workpiece.dialect = "workpiece";
    return parse_blank(workpiece.spec) ? std::optional<BlankHint>(workpiece) : std::nullopt;
  }
  if (block.spec.empty()) return bar.hint();
  block.dialect = "cutviewer";
  return block;
}

}  // namespace kerf
