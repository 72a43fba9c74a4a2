#include "twin/guess/tool_guess.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "base/translate.h"
#include "twin/motion/motion_geometry.h"

namespace kerf {
namespace {

/// Diameters that people have, mm.
constexpr std::array kDiameters{0.1, 0.2, 0.3, 0.5, 0.8,  1.0,  1.5,  2.0,  3.0,
                                4.0, 5.0, 6.0, 8.0, 10.0, 12.0, 16.0, 20.0, 25.0};
constexpr std::size_t kMostHoles = 2000;
/// Chords of an arc: enough that grids see its course.
constexpr double kChord_rad = 0.2;
/// Of what goes sideways, so much with Z: then Z follows the part. Ramps are less.
constexpr double kFollows = 0.3;
constexpr double kSideways_mm = 1e-6;
/// What is fed so far over the blank touches nothing of it.
constexpr double kClear_mm = 0.01;
/// Of lines in a drawing: how far apart they may be, where they are engraved; and how deep copper
/// is etched, however far apart.
constexpr double kDrawn_mm = 1;
constexpr double kEtched_mm = 0.15;

/// The least of the usual ones that is no smaller.
double usual_from(double size_mm) {
  for (const double diameter : kDiameters)
    if (diameter >= size_mm * (1 - 1e-6)) return diameter;
  return kDiameters.back();
}

/// The greatest of them that is no larger.
double usual_up_to(double size_mm) {
  double found = kDiameters.front();
  for (const double diameter : kDiameters)
    if (diameter <= size_mm * (1 + 1e-6)) found = diameter;
  return found;
}

/// Squares of a plane, 2^n a side, that are marked or not.
class Grid {
 public:
  explicit Grid(std::size_t side) : side_(side), marks_(side * side) {}
  void mark(std::size_t x, std::size_t y) { marks_[y * side_ + x] = 1; }
  std::size_t side() const { return side_; }
  double count() const {
    return static_cast<double>(std::count(marks_.begin(), marks_.end(), std::uint8_t{1}));
  }
  /// With squares twice as wide.
  Grid coarser() const {
    Grid out(side_ / 2);
    for (std::size_t y = 0; y < side_; ++y) {
      for (std::size_t x = 0; x < side_; ++x) {
        if (marks_[y * side_ + x] != 0) out.mark(x / 2, y / 2);
      }
    }
    return out;
  }

 private:
  std::size_t side_;
  std::vector<std::uint8_t> marks_;
};

}  // namespace

void ToolTrace::add_chord(const Vec3& from, const Vec3& to) {
  const double sideways = std::hypot(to.x - from.x, to.y - from.y);
  const double down = std::abs(to.z - from.z);
  if (sideways > kSideways_mm) {
    sideways_mm_.extend(from);
    sideways_mm_.extend(to);
    sideways_length_mm_ += sideways;
    // A hundredth of the way is no following: so do levels that are not quite level.
    if (down > 0.01 * sideways) slanted_length_mm_ += sideways;
    if (chords_.size() < kMostChords) {
      chords_.push_back({static_cast<float>(from.x), static_cast<float>(from.y),
                         static_cast<float>(from.z), static_cast<float>(to.x),
                         static_cast<float>(to.y), static_cast<float>(to.z)});
    }
  } else if (to.z < from.z && holes_mm_.size() < kMostHoles) {
    holes_mm_.emplace_back(to.x, to.y);
  }
}

void ToolTrace::note_circle(const Motion& m) {
  if (std::abs(m.arc.sweep_rad) < 2 * kPi - 1e-6 || std::abs(m.arc.axis.z) < 0.5) return;
  const double radius = std::hypot(m.to_mm.x - m.arc.center_mm.x, m.to_mm.y - m.arc.center_mm.y);
  if (least_circle_mm_ == 0 || radius < least_circle_mm_) least_circle_mm_ = radius;
}

void ToolTrace::add(const Motion& m, bool upright) {
  bounds_mm_.extend(bounds_of(m));
  tilted_ = tilted_ || !upright;
  if (!m.start_known) return;
  if (runs_ == 0 || m.from_mm != last_mm_) ++runs_;
  last_mm_ = m.to_mm;
  if (m.kind != MotionKind::kArc) {
    add_chord(m.from_mm, m.to_mm);
    return;
  }
  note_circle(m);
  const double slanted_mm = slanted_length_mm_;  // helices are ramps: Z follows nothing
  const int chords =
      std::clamp(static_cast<int>(std::ceil(std::abs(m.arc.sweep_rad) / kChord_rad)), 1, 1000);
  Vec3 from = m.from_mm;
  for (int i = 1; i <= chords; ++i) {
    const Vec3 to = point_at(m, static_cast<double>(i) / chords);
    add_chord(from, to);
    from = to;
  }
  slanted_length_mm_ = slanted_mm;
}

double ToolTrace::step_over_mm() const {
  constexpr std::size_t kSide = 1024;
  constexpr double kMostSamples = 8e6;
  const double size = std::max(sideways_mm_.size().x, sideways_mm_.size().y);
  if (chords_.empty() || !(size > 0)) return 0;
  // Long paths are looked at in coarser grids.
  std::size_t side = kSide;
  while (side > 64 && 2 * sideways_length_mm_ * static_cast<double>(side) / size > kMostSamples) {
    side /= 2;
  }
  double cell = size * (1 + 1e-9) / static_cast<double>(side);
  Grid grid(side);
  const double x0 = sideways_mm_.min.x, y0 = sideways_mm_.min.y;
  const auto place = [&](double value, double low) {
    return std::min(side - 1, static_cast<std::size_t>(std::max(0.0, (value - low) / cell)));
  };
  for (const Chord& c : chords_) {
    const double dx = double{c.to_x} - double{c.from_x}, dy = double{c.to_y} - double{c.from_y};
    const int steps = std::max(1, static_cast<int>(std::ceil(2 * std::hypot(dx, dy) / cell)));
    for (int i = 0; i <= steps; ++i) {
      const double t = static_cast<double>(i) / steps;
      grid.mark(place(double{c.from_x} + t * dx, x0), place(double{c.from_y} + t * dy, y0));
    }
  }
  // Of its length each place counts once, however often it is passed: 4 / pi squares a square's
  // width on average over all directions.
  double count = grid.count();
  const double length = count * cell * kPi / 4;
  constexpr double kAreaLike = 2.5;
  constexpr double kFewSquares = 48;
  while (grid.side() >= 16 && count >= kFewSquares) {
    const Grid next = grid.coarser();
    const double less = next.count();
    // The coarser squares cover the area, the finer ones may have gaps.
    if (count / less >= kAreaLike) return std::max(cell, 4 * less * cell * cell / length);
    grid = next;
    count = less;
    cell *= 2;
  }
  return 0;
}

double ToolTrace::hole_spacing_mm() const {
  std::vector<Vec2> holes = holes_mm_;
  std::sort(holes.begin(), holes.end(),
            [](const Vec2& a, const Vec2& b) { return a.x != b.x ? a.x < b.x : a.y < b.y; });
  double least = 0;
  constexpr double kSameHole_mm = 0.01;
  for (std::size_t i = 0; i < holes.size(); ++i) {
    for (std::size_t j = i + 1; j < holes.size(); ++j) {
      if (least > 0 && holes[j].x - holes[i].x >= least) break;
      const double apart = std::hypot(holes[j].x - holes[i].x, holes[j].y - holes[i].y);
      if (apart > kSameHole_mm && (least == 0 || apart < least)) least = apart;
    }
  }
  return least;
}

ShapeGuess ToolTrace::drill(double depth_mm) const {
  // Drills that are made are some ten diameters long; holes leave a web between them.
  double size = std::clamp(depth_mm / 2, 1.0, 6.0);
  size = std::max(size, depth_mm / 12);
  const double spacing = hole_spacing_mm();
  if (spacing > 0) size = std::min(size, 0.6 * spacing);
  ShapeGuess out;
  out.shape = fmt::format("drill:{:g}:118", usual_up_to(size));
  out.reason = tr("it only goes up and down");
  if (spacing > 0) out.reason += trf(", the nearest holes are {:.3g} mm apart", spacing);
  return out;
}

/// Z follows the part.
ShapeGuess ToolTrace::follower(double depth_mm, double step_mm) const {
  ShapeGuess out;
  const Vec3 size = bounds_mm_.size();
  const double least = std::max(0.1, std::min(size.x, size.y));
  if (step_mm <= 0 && depth_mm <= 0.2 * std::max(size.x, size.y)) {
    // 60 degrees are 1.16 times as wide as they are deep.
    out.shape = fmt::format("vee:{:g}:60", std::max(3.0, usual_from(1.2 * depth_mm)));
    out.reason = tr("single lines, Z follows them");
    return out;
  }
  const double wanted = step_mm > 0 ? 8 * step_mm : 0.05 * std::max(size.x, size.y);
  const double most = std::max(0.2 * least, depth_mm / 10);
  out.shape = fmt::format("ball:{:g}", usual_up_to(std::clamp(wanted, 0.1, std::max(0.1, most))));
  out.reason = tr("Z follows the part");
  if (step_mm > 0) out.reason += trf(", passes {:.2g} mm apart", step_mm);
  return out;
}

/// Where nothing lies side by side: by the part's size.
double ToolTrace::flat_size_mm() const {
  const Vec3 size = sideways_mm_.size();
  return usual_from(std::clamp(0.03 * std::hypot(size.x, size.y), 0.3, 8.0));
}

ShapeGuess ToolTrace::end_mill(double depth_mm, double step_mm) const {
  ShapeGuess out;
  double size = flat_size_mm();
  out.reason = tr("single lines, by the size of the part");
  if (step_mm > 0) {
    // Most pockets are cut with half the diameter from pass to pass; less than that leaves ridges.
    size = usual_from(2 * step_mm);
    out.reason = trf("passes {:.2g} mm apart", step_mm);
  }
  if (size < depth_mm / 6) {
    size = usual_from(depth_mm / 6);
    out.reason += trf(", {:.3g} mm deep", depth_mm);
  }
  const double circle = least_circle_mm_;
  if (circle > 0 && 2 * circle > size && 2 * circle <= 2 * size) {
    size = usual_from(2 * circle);
    out.reason += trf(", circles of radius {:.3g} mm", circle);
  }
  out.shape = fmt::format("flat:{:g}", size);
  return out;
}

/// Many short lines; passes of a pocket or a surface go on, or from side to side.
bool ToolTrace::is_drawing() const {
  constexpr std::size_t kFewLines = 5;
  const double size = std::max(sideways_mm_.size().x, sideways_mm_.size().y);
  return runs_ >= kFewLines && sideways_length_mm_ < 0.5 * size * static_cast<double>(runs_);
}

bool ToolTrace::only_plunges(double top_mm) const {
  if (tilted_ || bounds_mm_.empty() || bounds_mm_.min.z >= top_mm) return false;
  return sideways_mm_.empty() || sideways_mm_.min.z > top_mm + kClear_mm;
}

ShapeGuess ToolTrace::guess(double top_mm) const {
  const double depth = bounds_mm_.empty() ? 0 : std::max(0.0, top_mm - bounds_mm_.min.z);
  const bool upright = !tilted_ && !(sideways_length_mm_ > 0);
  if (upright || only_plunges(top_mm)) return drill(depth);
  const double step = step_over_mm();
  const bool follows = slanted_length_mm_ > kFollows * sideways_length_mm_;
  if (tilted_) {
    ShapeGuess out;
    const Vec3 size = bounds_mm_.size();
    out.shape =
        fmt::format("ball:{:g}", usual_up_to(std::clamp(0.05 * glm::length(size), 0.5, 10.0)));
    out.reason = tr("tool or part turn; by the size of the part");
    return out;
  }
  if (follows) return follower(depth, step);
  // Lines of a drawing may be as dense as passes; what is milled is milled deeper, or in wide
  // steps.
  const bool drawn = step <= kDrawn_mm || depth <= kEtched_mm;
  if (depth <= kEngraved_mm && drawn) {
    // Bits for copper have a small flat, or else such lines would be as good as none.
    return {depth <= kEtched_mm ? "vee:3:60:0.2" : "vee:3:60", trf("lines {:.2g} mm deep", depth)};
  }
  if (step > 0 && is_drawing()) {
    const std::string reason = trf("lines of a drawing, {:.2g} mm apart", step);
    // 60 degrees are 1.16 times as wide as they are deep.
    if (1.2 * depth <= step) {
      return {fmt::format("vee:{:g}:60", std::max(3.0, usual_from(1.2 * depth))), reason};
    }
    return {fmt::format("flat:{:g}", usual_up_to(std::min(step, flat_size_mm()))), reason};
  }
  return end_mill(depth, step);
}

}  // namespace kerf
