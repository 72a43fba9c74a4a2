#include "stock/cutter/turning_holder.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <utility>

#include "base/portable_math.h"
#include "base/small_file.h"
#include "base/text_scan.h"
#include "base/translate.h"
#include "stock/cutter/insert_shape.h"
#include "stock/cutter/profile_file.h"

namespace kerf {
namespace {

/// Corners that are nearer are one.
constexpr double kLeastHolderEdge_mm = 1e-4;
/// Three corners on a line, by the sine of the angle between their sides.
constexpr double kStraightSine = 1e-9;

InsertPart holder_box(const Vec2& a, const Vec2& b) {
  const Vec2 low = glm::min(a, b), high = glm::max(a, b);
  const auto edge = [](double z, double x) {
    return InsertEdge{Vec2(z, x), std::nullopt, InsertSide::kHolder};
  };
  return {edge(high.x, low.y), edge(high.x, high.y), edge(low.x, high.y), edge(low.x, low.y)};
}

double turn_of(const Vec2& a, const Vec2& b, const Vec2& c) {
  const Vec2 in = glm::normalize(b - a), out = glm::normalize(c - b);
  return in.x * out.y - in.y * out.x;
}

}  // namespace

Vec2 shank_direction(int orientation) {
  const Vec2 behind = nose_direction(orientation);
  if (behind.y != 0) return {0, behind.y};
  return behind.x != 0 ? Vec2(behind.x, 0) : Vec2(0, 1);
}

double insert_height_mm(const InsertOutline& insert, const Vec2& back) {
  double height = 0;
  for (const InsertPart& part : insert.parts) {
    for (const InsertEdge& edge : part) {
      height = std::max(height, glm::dot(edge.end_mm, back));
      if (!edge.center_mm) continue;
      // An arc's top is no corner where it is a disc's.
      height = std::max(height, glm::dot(*edge.center_mm, back));
    }
  }
  return height;
}

std::optional<InsertPart> shank_part(const InsertOutline& insert, const Vec2& back, int side,
                                     const ShankBar& bar) {
  const double from = insert_height_mm(insert, back);
  if (!(bar.length_mm - from > kLeastHolderEdge_mm) || !(bar.width_mm > kLeastHolderEdge_mm)) {
    return std::nullopt;
  }
  const Vec2 across = back.x == 0 ? Vec2(1, 0) : Vec2(0, 1);
  const double far = side == 0 ? bar.width_mm / 2 : side * bar.f_mm;
  const double near = side == 0 ? -far : side * (bar.f_mm - bar.width_mm);
  return holder_box(from * back + near * across, bar.length_mm * back + far * across);
}

std::optional<InsertPart> boring_part(int orientation, const BoringBar& bar) {
  const Vec2 back = shank_direction(orientation);
  const bool is_room = bar.length_mm - bar.begin_z_mm > kLeastHolderEdge_mm;
  if (back.y == 0 || orientation == kOrientations || !is_room) return std::nullopt;
  const double half = bar.diameter_mm / 2;
  return holder_box({bar.begin_z_mm, back.y * (bar.f_mm - half)},
                    {bar.length_mm, back.y * (bar.f_mm + half)});
}

namespace {

class HolderReader {
 public:
  HolderReader(std::string_view text, const std::string& name) : text_(text), name_(name) {}

  Result<std::vector<InsertPart>> read() {
    while (!text_.empty()) {
      std::string_view line = take_line(text_);
      ++line_;
      line = trim(line.substr(0, line.find('#')), is_line_blank);
      if (line.empty()) continue;
      if (const Done done = take(words_of(line)); !done) return Error{done.error()};
    }
    if (const Done done = finish_part(); !done) return Error{done.error()};
    if (parts_.empty()) return fault(tr("no part; write 'part', and its corners as 'point Z X'"));
    return std::move(parts_);
  }

 private:
  Error fault(const std::string& what) const {
    return Error{fmt::format("{}:{}: {}", shown(name_), line_, what)};
  }

  Done take(const std::vector<std::string_view>& words) {
    const std::string keyword = to_lower(words[0]);
    if (keyword == "part" && words.size() == 1) {
      if (const Done done = finish_part(); !done) return done;
      is_open_ = true;
      return std::monostate{};
    }
    if (keyword != "point" || words.size() != 3) {
      return fault(trf("'{}' is not understood; a line is 'part' or 'point Z X'", shown(words[0])));
    }
    if (!is_open_) return fault(tr("a point before the first 'part'"));
    const std::optional<double> z = parse_decimal(words[1]), x = parse_decimal(words[2]);
    if (!z || !x || !(std::abs(*z) <= kMaxInsertReach_mm) ||
        !(std::abs(*x) <= kMaxInsertReach_mm)) {
      return fault(trf("Z and X must be numbers from -{:g} to {:g} (mm)", kMaxInsertReach_mm,
                       kMaxInsertReach_mm));
    }
    if (++points_ > kMaxProfilePieces) {
      return fault(trf("more than {} points", kMaxProfilePieces));
    }
    const Vec2 at(*z, *x);
    if (glm::length(at) > kMaxInsertReach_mm) {
      return fault(trf("the point is {:.4g} mm away; at most {:g} mm are allowed", glm::length(at),
                       kMaxInsertReach_mm));
    }
    if (!corners_.empty() && glm::distance(corners_.back(), at) < kLeastHolderEdge_mm) {
      return fault(tr("the point before it is the same one"));
    }
    corners_.push_back(at);
    return std::monostate{};
  }

  Done finish_part() {
    if (!is_open_) return std::monostate{};
    // A chain that is closed by its first point says the same.
    if (corners_.size() > 3 &&
        glm::distance(corners_.front(), corners_.back()) < kLeastHolderEdge_mm) {
      corners_.pop_back();
    }
    const std::size_t n = corners_.size();
    if (n < 3) return fault(trf("a part of {} points; at least 3 are needed", n));
    double area = 0;
    for (std::size_t i = 0; i < n; ++i) {
      const Vec2 &a = corners_[i], &b = corners_[(i + 1) % n];
      area += (a.x * b.y - a.y * b.x) / 2;
    }
    if (area < 0) std::reverse(corners_.begin(), corners_.end());
    double turned = 0;
    InsertPart part;
    for (std::size_t i = 0; i < n; ++i) {
      const Vec2 &a = corners_[i], &b = corners_[(i + 1) % n], &c = corners_[(i + 2) % n];
      const double sine = turn_of(a, b, c);
      if (!(sine > kStraightSine)) {
        return fault(
            trf("the part before is hollow, or straight, at Z{:g} X{:g}; divide it into "
                "convex parts",
                b.x, b.y));
      }
      turned += portable::atan2(sine, glm::dot(glm::normalize(b - a), glm::normalize(c - b)));
      part.push_back({b, std::nullopt, InsertSide::kHolder});
    }
    // A star turns the same way at all its corners.
    if (turned > 3 * kPi) return fault(tr("the part before crosses itself"));
    parts_.push_back(std::move(part));
    corners_.clear();
    is_open_ = false;
    return std::monostate{};
  }

  std::string_view text_;
  const std::string& name_;
  int line_ = 0;
  bool is_open_ = false;
  std::size_t points_ = 0;
  std::vector<Vec2> corners_;
  std::vector<InsertPart> parts_;
};

}  // namespace

Result<std::vector<InsertPart>> parse_turning_holder(std::string_view text,
                                                     const std::string& name) {
  return HolderReader(text, name).read();
}

Result<std::vector<InsertPart>> read_turning_holder(const std::string& path) {
  const Result<std::string> text = read_small_file(
      path, kMaxProfileBytes,
      trf("cannot read {}: larger than {} KB", shown(path), kMaxProfileBytes / 1024));
  if (!text) return Error{text.error()};
  return parse_turning_holder(*text, path);
}

}  // namespace kerf
