// SVG as text: tags and their attributes. See outline_file.h for what is read.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "base/text_scan.h"
#include "base/translate.h"
#include "base/units.h"
#include "stock/cutter/scan.h"
#include "stock/plane/outline_curves.h"
#include "stock/plane/outline_file.h"
#include "stock/plane/svg_path.h"

namespace kerf {
namespace {

constexpr double kMaxUser = 1e6;
/// What is in these is drawn only where something refers to it.
constexpr std::array<std::string_view, 5> kNotDrawn = {"defs", "symbol", "clipPath", "mask",
                                                       "marker"};
constexpr std::array<std::string_view, 6> kRefused = {"line", "polyline", "use",
                                                      "text", "image",    "foreignObject"};

using Attributes = std::map<std::string_view, std::string_view>;

template <std::size_t kCount>
bool contains(const std::array<std::string_view, kCount>& names, std::string_view name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

class SvgReader {
 public:
  SvgReader(std::string_view text, std::string name, double tolerance_mm)
      : text_(text), name_(std::move(name)), tolerance_(tolerance_mm) {}

  Result<PlaneOutline> read() {
    while (error_.empty() && next_tag()) {
    }
    if (error_.empty() && !seen_svg_) fail(tr("no <svg> element; is this an SVG file?"));
    if (error_.empty() && outline_.rings.empty()) fail(tr("no closed contour"));
    if (!error_.empty()) return Error{error_};
    return std::move(outline_);
  }

 private:
  void fail(const std::string& what) {
    const auto line =
        1 + std::count(text_.begin(),
                       text_.begin() + static_cast<std::ptrdiff_t>(std::min(tag_, text_.size())),
                       '\n');
    if (error_.empty()) error_ = fmt::format("{}:{}: {}", name_, line, what);
  }
  int line() {
    line_ += static_cast<int>(std::count(text_.begin() + static_cast<std::ptrdiff_t>(counted_),
                                         text_.begin() + static_cast<std::ptrdiff_t>(tag_), '\n'));
    counted_ = tag_;
    return line_;
  }

  /// Past the end of `ending`; false if it does not come.
  bool skip_past(std::string_view ending) {
    const std::size_t end = text_.find(ending, at_);
    if (end == std::string_view::npos) {
      fail(trf("the file ends before '{}'", ending));
      return false;
    }
    at_ = end + ending.size();
    return true;
  }

  bool next_tag() {
    tag_ = text_.find('<', at_);
    if (tag_ == std::string_view::npos) {
      tag_ = text_.size();
      return false;
    }
    at_ = tag_;
    const std::string_view rest = text_.substr(at_);
    if (rest.starts_with("<!--")) return skip_past("-->");
    if (rest.starts_with("<![CDATA[")) return skip_past("]]>");
    if (rest.starts_with("<?") || rest.starts_with("<!")) return skip_past(">");
    ++at_;
    const bool closing = at_ < text_.size() && text_[at_] == '/';
    if (closing) ++at_;
    const std::string_view element = word();
    Attributes attributes;
    if (!read_attributes(attributes)) return false;
    const bool empty = text_[at_ - 2] == '/';
    if (closing) {
      if (not_drawn_ > 0 && contains(kNotDrawn, element)) --not_drawn_;
    } else if (contains(kNotDrawn, element)) {
      not_drawn_ += empty ? 0 : 1;
    } else if (not_drawn_ == 0) {
      const auto kind = attributes.find("class");
      const bool is_no_edge = element == "line" && kind != attributes.end() &&
                              (kind->second == "axis" || kind->second == "flats");
      if (!is_no_edge) take(element, attributes);
    }
    return true;
  }

  void skip_blanks() {
    while (at_ < text_.size() && is_text_blank(text_[at_])) ++at_;
  }
  std::string_view word() {
    const std::size_t begin = at_;
    while (at_ < text_.size() && !is_text_blank(text_[at_]) &&
           std::string_view("=/>\"'<").find(text_[at_]) == std::string_view::npos)
      ++at_;
    return text_.substr(begin, at_ - begin);
  }

  /// Up to and past '>'.
  bool read_attributes(Attributes& attributes) {
    while (true) {
      skip_blanks();
      if (at_ >= text_.size()) return fail(tr("the file ends within a tag")), false;
      if (text_[at_] == '>') return ++at_, true;
      if (text_[at_] == '/') {
        ++at_;
        continue;
      }
      const std::string_view key = word();
      skip_blanks();
      const bool equals = at_ < text_.size() && text_[at_] == '=';
      if (key.empty() || !equals) return fail(tr("an attribute is not NAME=\"VALUE\"")), false;
      ++at_;
      skip_blanks();
      const char quote = at_ < text_.size() ? text_[at_] : ' ';
      if (quote != '"' && quote != '\'') return fail(tr("an attribute is not in quotes")), false;
      const std::size_t end = text_.find(quote, ++at_);
      if (end == std::string_view::npos) return fail(tr("the file ends within a tag")), false;
      attributes.emplace(key, text_.substr(at_, end - at_));
      at_ = end + 1;
    }
  }

  double number(const Attributes& attributes, std::string_view key, double low,
                std::optional<double> otherwise) {
    const auto at = attributes.find(key);
    if (at == attributes.end()) {
      if (!otherwise) fail(trf("the attribute {} is missing", key));
      return otherwise.value_or(0);
    }
    const Result<double> value =
        parse_within(key, trim(at->second), low, kMaxUser, tr("user units"));
    if (!value) fail(value.error());
    return value ? *value : 0;
  }

  void take(std::string_view element, const Attributes& attributes) {
    if (attributes.contains("transform"))
      return fail(
          trf("{}: a transform is not read; apply it in the drawing program", shown(element)));
    if (element == "svg") return take_svg(attributes);
    if (element == "path") return take_path(attributes);
    if (element == "polygon") return take_polygon(attributes);
    if (element == "rect") return take_rect(attributes);
    if (element == "circle" || element == "ellipse") return take_ellipse(attributes, element);
    if (contains(kRefused, element))
      fail(trf("{} is not read; allowed are path, rect, circle, ellipse and polygon", element));
  }

  /// Millimetres of a length like "210mm"; 0 for one in user units.
  double length_mm(const Attributes& attributes, std::string_view key) {
    const auto at = attributes.find(key);
    if (at == attributes.end()) return 0;
    const std::string_view text = trim(at->second);
    for (const auto& [unit, mm] :
         {std::pair<std::string_view, double>{"mm", 1}, {"cm", 10}, {"in", kMmPerInch}}) {
      if (!text.ends_with(unit)) continue;
      const std::optional<double> value = parse_decimal(text.substr(0, text.size() - unit.size()));
      if (value && *value > 0) return *value * mm;
      fail(trf("{}: '{}' is not a length", key, shown(text)));
    }
    return 0;
  }

  void take_svg(const Attributes& attributes) {
    if (seen_svg_) return fail(tr("an <svg> within an <svg>"));
    seen_svg_ = true;
    const double width = length_mm(attributes, "width"), height = length_mm(attributes, "height");
    const auto box = attributes.find("viewBox");
    if (box == attributes.end()) {
      if (width > 0 || height > 0)
        fail(tr("width and height are lengths, but there is no viewBox to scale by"));
      return;
    }
    Result<std::vector<double>> numbers = plane::parse_numbers(box->second);
    if (!numbers) return fail("viewBox: " + numbers.error());
    const std::vector<double>& view = *numbers;
    if (view.size() != 4 || !(view[2] > 0) || !(view[3] > 0))
      return fail(trf("viewBox: '{}' must be x, y, width, height", shown(box->second)));
    if (width > 0) scale_ = width / view[2];
    if (width == 0 && height > 0) scale_ = height / view[3];
    if (width > 0 && height > 0 && std::abs(height / view[3] / scale_ - 1) > 1e-3)
      return fail(tr("width and height scale the viewBox differently"));
    lower_edge_ = view[1] + view[3];
  }

  void take_path(const Attributes& attributes) {
    const auto data = attributes.find("d");
    if (data == attributes.end()) return;
    Result<std::vector<std::vector<Vec2>>> rings =
        plane::parse_svg_path(data->second, tolerance_ / scale_);
    if (!rings) return fail("path: " + rings.error());
    for (std::vector<Vec2>& ring : *rings) add(std::move(ring));
  }

  void take_polygon(const Attributes& attributes) {
    const auto data = attributes.find("points");
    if (data == attributes.end()) return fail(tr("the attribute points is missing"));
    const Result<std::vector<double>> numbers = plane::parse_numbers(data->second);
    if (!numbers) return fail("points: " + numbers.error());
    if (numbers->size() % 2 != 0) return fail(tr("points: an odd number of coordinates"));
    std::vector<Vec2> ring;
    for (std::size_t i = 0; i < numbers->size(); i += 2)
      ring.emplace_back((*numbers)[i], (*numbers)[i + 1]);
    add(std::move(ring));
  }

  void take_rect(const Attributes& attributes) {
    const double x = number(attributes, "x", -kMaxUser, 0.0);
    const double y = number(attributes, "y", -kMaxUser, 0.0);
    const double w = number(attributes, "width", 0, std::nullopt);
    const double h = number(attributes, "height", 0, std::nullopt);
    const double round =
        std::max(number(attributes, "rx", 0, 0.0), number(attributes, "ry", 0, 0.0));
    if (round > 0) return fail(tr("rect: round corners are not read; make it a path"));
    add({{x, y}, {x + w, y}, {x + w, y + h}, {x, y + h}});
  }

  void take_ellipse(const Attributes& attributes, std::string_view element) {
    const bool circle = element == "circle";
    const Vec2 center(number(attributes, "cx", -kMaxUser, 0.0),
                      number(attributes, "cy", -kMaxUser, 0.0));
    const double rx = number(attributes, circle ? "r" : "rx", 0, std::nullopt);
    const double ry = circle ? rx : number(attributes, "ry", 0, std::nullopt);
    if (!error_.empty() || rx == 0 || ry == 0) return;
    std::vector<Vec2> ring;
    // The longer axis first: the number of chords is that of its circle.
    plane::append_arc(center, std::max(rx, ry), 0, 2 * kPi, tolerance_ / scale_, ring,
                      std::min(rx, ry) / std::max(rx, ry), rx < ry ? kPi / 2 : 0);
    add(std::move(ring));
  }

  void add(std::vector<Vec2> ring) {
    if (!error_.empty()) return;
    for (Vec2& p : ring) p = scale_ * Vec2(p.x, lower_edge_ - p.y);
    outline_.rings.push_back(std::move(ring));
    outline_.lines.push_back(line());
  }

  std::string_view text_;
  std::string name_;
  double tolerance_;
  std::size_t at_ = 0, tag_ = 0, counted_ = 0;
  int line_ = 1;
  int not_drawn_ = 0;
  bool seen_svg_ = false;
  double scale_ = 1, lower_edge_ = 0;
  std::string error_;
  PlaneOutline outline_;
};

}  // namespace

Result<PlaneOutline> parse_svg_outline(std::string_view text, const std::string& name,
                                       double tolerance_mm) {
  return SvgReader(text, name, tolerance_mm).read();
}

}  // namespace kerf
