// DXF as text: pairs of lines, a group code and its value. See outline_file.h for what is read.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "base/portable_math.h"
#include "base/translate.h"
#include "base/units.h"
#include "stock/cutter/scan.h"
#include "stock/plane/outline_curves.h"
#include "stock/plane/outline_file.h"

namespace kerf {
namespace {

constexpr double kMax_mm = 1e5;
constexpr std::size_t kMaxPoints = 10'000'000;
constexpr std::array<std::string_view, 6> kDrawNothing = {"TEXT",      "MTEXT", "POINT",
                                                          "DIMENSION", "HATCH", "SEQEND"};

struct Group {
  int code = 0;
  std::string_view value;
  int line = 0;
};

/// A chain that is not closed yet.
struct Piece {
  std::vector<Vec2> points;
  int line = 0;
};

class DxfReader {
 public:
  DxfReader(std::string_view text, std::string name, double tolerance_mm, OutlineClosing closing)
      : text_(text),
        name_(std::move(name)),
        tolerance_(tolerance_mm),
        has_axis_(closing == OutlineClosing::kAlongAxis) {}

  Result<PlaneOutline> read() {
    std::vector<Group> entity;
    std::string_view section;
    bool names_section = false, names_units = false;
    Group group;
    while (next(group)) {
      if (names_section && group.code == 2) section = group.value;
      if (names_units && group.code == 70) set_units(group);
      names_section = group.code == 0 && group.value == "SECTION";
      names_units = group.code == 9 ? group.value == "$INSUNITS" : names_units && group.code != 70;
      if (group.code == 0) {
        take(entity);
        entity.clear();
        if (group.value == "ENDSEC") section = {};
      }
      if (section == "ENTITIES" && (group.code == 0 || !entity.empty())) entity.push_back(group);
      if (!error_.empty()) return Error{error_};
    }
    take(entity);
    if (in_polyline_) fail(polyline_.line, "POLYLINE without SEQEND");
    if (error_.empty()) join_pieces();
    if (!error_.empty()) return Error{error_};
    if (outline_.rings.empty())
      return Error{trf("{}: no closed contour in the section ENTITIES", name_)};
    return std::move(outline_);
  }

 private:
  void fail(int line, const std::string& what) {
    if (error_.empty()) error_ = fmt::format("{}:{}: {}", name_, line, what);
  }

  bool next_line(std::string_view& line) {
    if (at_ >= text_.size()) return false;
    const std::size_t end = std::min(text_.find('\n', at_), text_.size());
    line = trim(text_.substr(at_, end - at_));
    if (line.ends_with('\r')) line = trim(line.substr(0, line.size() - 1));
    at_ = end + 1;
    ++line_;
    return true;
  }

  bool next(Group& group) {
    std::string_view code;
    if (!error_.empty() || !next_line(code)) return false;
    if (code.empty() && at_ >= text_.size()) return false;
    const std::optional<double> number = parse_decimal(code);
    if (!number || *number != std::floor(*number) || std::abs(*number) > 9999) {
      fail(line_, trf("'{}' is not a group code; is this an ASCII DXF file?", shown(code)));
      return false;
    }
    group.code = static_cast<int>(*number);
    group.line = line_ + 1;
    if (next_line(group.value)) return true;
    fail(line_, trf("the file ends after group code {}", group.code));
    return false;
  }

  void set_units(const Group& group) {
    const std::optional<double> units = parse_decimal(group.value);
    if (units == 0.0 || units == 4.0) return;
    if (units == 1.0) {
      scale_ = kMmPerInch;
      return;
    }
    fail(group.line, fmt::format("$INSUNITS is {}; must be 4 (mm), 1 (inch) or 0 (taken as mm)",
                                 shown(group.value)));
  }

  double number(const Group& group, double low, double high) {
    const Result<double> value =
        parse_within(trf("group {}", group.code), group.value, low, high, tr("drawing units"));
    if (!value) fail(group.line, value.error());
    return value ? *value : 0;
  }

  /// The last value of a group code in the entity; an error if there is none and no default.
  double value_of(const std::vector<Group>& entity, int code, double low, double high,
                  std::optional<double> otherwise = std::nullopt) {
    for (auto group = entity.rbegin(); group != entity.rend(); ++group) {
      if (group->code == code) return number(*group, low, high);
    }
    if (!otherwise) fail(entity[0].line, trf("{} without group {}", entity[0].value, code));
    return otherwise.value_or(0);
  }

  Vec2 point_of(const std::vector<Group>& entity, int code) {
    const double x = value_of(entity, code, -kMax_mm, kMax_mm);
    const double y = value_of(entity, code + 10, -kMax_mm, kMax_mm);
    return scale_ * Vec2(x, y);
  }

  static std::string_view layer_of(const std::vector<Group>& entity) {
    const auto layer = std::find_if(entity.begin(), entity.end(),
                                    [](const Group& group) { return group.code == 8; });
    return layer == entity.end() ? std::string_view() : layer->value;
  }

  void take(const std::vector<Group>& entity) {
    if (entity.empty() || !error_.empty()) return;
    const std::string_view kind = entity[0].value;
    if (value_of(entity, 230, -1, 1, 1.0) < 1 - 1e-6)
      return fail(entity[0].line, trf("{} drawn from below (group 230)", kind));
    if (kind == "LINE" && has_axis_ && layer_of(entity) == "FLATS") return;
    if (kind == "LINE") {
      pieces_.push_back({{point_of(entity, 10), point_of(entity, 11)}, entity[0].line});
    } else if (kind == "ARC" || kind == "CIRCLE") {
      take_arc(entity, kind == "CIRCLE");
    } else if (kind == "LWPOLYLINE") {
      take_polyline(entity);
    } else if (kind == "POLYLINE") {
      polyline_ = {{}, entity[0].line};
      bulges_.clear();
      in_polyline_ = true;
      closed_ = (static_cast<int>(value_of(entity, 70, 0, 1023, 0.0)) & 1) != 0;
    } else if (kind == "VERTEX" && in_polyline_) {
      polyline_.points.push_back(point_of(entity, 10));
      bulges_.push_back(value_of(entity, 42, -1e6, 1e6, 0.0));
    } else if (kind == "SEQEND" && in_polyline_) {
      in_polyline_ = false;
      end_polyline();
    } else if (std::find(kDrawNothing.begin(), kDrawNothing.end(), kind) == kDrawNothing.end()) {
      fail(entity[0].line,
           trf("{} is not read; allowed are LINE, ARC, CIRCLE, LWPOLYLINE and POLYLINE",
               shown(kind)));
    }
  }

  void take_arc(const std::vector<Group>& entity, bool circle) {
    const Vec2 center = point_of(entity, 10);
    const double radius = scale_ * value_of(entity, 40, 1e-4, kMax_mm);
    const double from = circle ? 0 : value_of(entity, 50, -720, 720) * kPi / 180;
    double sweep = circle ? 2 * kPi : value_of(entity, 51, -720, 720) * kPi / 180 - from;
    if (!error_.empty()) return;
    while (sweep <= 0) sweep += 2 * kPi;
    std::vector<Vec2> points;
    if (!circle) points.push_back(center + radius * Vec2(portable::cos(from), portable::sin(from)));
    plane::append_arc(center, radius, from, sweep, tolerance_, points);
    if (circle) return add_ring(std::move(points), entity[0].line);
    pieces_.push_back({std::move(points), entity[0].line});
  }

  void take_polyline(const std::vector<Group>& entity) {
    polyline_ = {{}, entity[0].line};
    bulges_.clear();
    closed_ = (static_cast<int>(value_of(entity, 70, 0, 1023, 0.0)) & 1) != 0;
    for (const Group& group : entity) {
      if (group.code == 10) {
        polyline_.points.emplace_back(scale_ * number(group, -kMax_mm, kMax_mm), 0);
        bulges_.push_back(0);
      }
      if (polyline_.points.empty()) continue;
      if (group.code == 20) polyline_.points.back().y = scale_ * number(group, -kMax_mm, kMax_mm);
      if (group.code == 42) bulges_.back() = number(group, -1e6, 1e6);
    }
    end_polyline();
  }

  void end_polyline() {
    const std::vector<Vec2>& corners = polyline_.points;
    if (!error_.empty()) return;
    if (corners.size() < 2) return fail(polyline_.line, tr("a polyline of less than two corners"));
    std::vector<Vec2> points{corners[0]};
    const std::size_t edges = corners.size() - (closed_ ? 0 : 1);
    for (std::size_t i = 0; i < edges; ++i)
      plane::append_bulge(corners[(i + 1) % corners.size()], bulges_[i], tolerance_, points);
    if (!closed_) return pieces_.push_back({std::move(points), polyline_.line});
    points.pop_back();
    add_ring(std::move(points), polyline_.line);
  }

  void add_ring(std::vector<Vec2> points, int line) {
    count_ += points.size();
    if (count_ > kMaxPoints) return fail(line, trf("more than {} points", kMaxPoints));
    outline_.rings.push_back(std::move(points));
    outline_.lines.push_back(line);
  }

  using Cell = std::pair<std::int64_t, std::int64_t>;
  static Cell cell_of(const Vec2& p) {
    return {std::llround(p.x / kJoin_mm), std::llround(p.y / kJoin_mm)};
  }

  /// An unused piece with an end at p.
  std::size_t piece_at(const Vec2& p, const std::multimap<Cell, std::size_t>& ends,
                       const std::vector<char>& used) const {
    const Cell middle = cell_of(p);
    std::size_t best = pieces_.size();
    for (std::int64_t x = middle.first - 1; x <= middle.first + 1; ++x) {
      for (std::int64_t y = middle.second - 1; y <= middle.second + 1; ++y) {
        const auto [begin, end] = ends.equal_range({x, y});
        for (auto at = begin; at != end; ++at) {
          const Piece& piece = pieces_[at->second];
          const bool meets = near(piece.points.front(), p) || near(piece.points.back(), p);
          if (!used[at->second] && meets) best = std::min(best, at->second);
        }
      }
    }
    return best;
  }

  static bool near(const Vec2& a, const Vec2& b) {
    return portable::hypot(a.x - b.x, a.y - b.y) <= kJoin_mm;
  }

  bool is_on_axis(const Vec2& p) const { return has_axis_ && std::abs(p.y) <= kJoin_mm; }

  void join_pieces() {
    std::erase_if(pieces_, [this](const Piece& piece) {
      return std::all_of(piece.points.begin(), piece.points.end(),
                         [this](const Vec2& p) { return is_on_axis(p); });
    });
    std::multimap<Cell, std::size_t> ends;
    for (std::size_t i = 0; i < pieces_.size(); ++i) {
      ends.emplace(cell_of(pieces_[i].points.front()), i);
      ends.emplace(cell_of(pieces_[i].points.back()), i);
    }
    std::vector<char> used(pieces_.size(), 0);
    for (std::size_t first = 0; first < pieces_.size(); ++first) {
      if (used[first]) continue;
      used[first] = 1;
      std::vector<Vec2> ring = pieces_[first].points;
      bool closes = true, turned = false;
      while (closes && (ring.size() < 3 || !near(ring.front(), ring.back()))) {
        const std::size_t next = piece_at(ring.back(), ends, used);
        if (next == pieces_.size() && is_on_axis(ring.back())) {
          // Here it ends; so it must on the other side.
          closes = !turned;
          turned = true;
          std::reverse(ring.begin(), ring.end());
          continue;
        }
        if (next == pieces_.size()) {
          return fail(pieces_[first].line,
                      trf("the contour that begins here is open: nothing goes on at "
                          "X{:.4f} Y{:.4f} (within {} mm)",
                          ring.back().x, ring.back().y, kJoin_mm));
        }
        used[next] = 1;
        std::vector<Vec2> points = pieces_[next].points;
        if (!near(points.front(), ring.back())) std::reverse(points.begin(), points.end());
        ring.insert(ring.end(), points.begin() + 1, points.end());
      }
      if (closes) {
        ring.pop_back();
      } else {
        ring.front().y = ring.back().y = 0;
      }
      add_ring(std::move(ring), pieces_[first].line);
    }
  }

  std::string_view text_;
  std::string name_;
  double tolerance_;
  bool has_axis_;
  std::size_t at_ = 0;
  int line_ = 0;
  double scale_ = 1;
  std::string error_;
  bool in_polyline_ = false, closed_ = false;
  Piece polyline_;
  std::vector<double> bulges_;
  std::vector<Piece> pieces_;
  std::size_t count_ = 0;
  PlaneOutline outline_;
};

}  // namespace

Result<PlaneOutline> parse_dxf_outline(std::string_view text, const std::string& name,
                                       double tolerance_mm, OutlineClosing closing) {
  return DxfReader(text, name, tolerance_mm, closing).read();
}

}  // namespace kerf
