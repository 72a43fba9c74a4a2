#include "stock/cutter/insert_shape.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include "base/portable_math.h"

namespace kerf {
namespace {

/// Edges shorter than this are none: below what models tell apart.
constexpr double kMinEdge_mm = 1e-5;
/// Flanks closer to half a turn than this have no nose between them.
constexpr double kMinTurn_rad = 1e-6;

Vec2 along(double angle_rad) { return {portable::cos(angle_rad), portable::sin(angle_rad)}; }
Vec2 left_of(const Vec2& v) { return {-v.y, v.x}; }

bool is_size(double mm) { return mm >= 0 && mm <= kMaxInsertReach_mm; }

/// (dz, dx) by orientation. Source: LinuxCNC 2.9, lib/python/rs274/glcanon.py, as (dx, dz).
constexpr std::array<std::array<int, 2>, kOrientations> kNoseDirections{
    {{-1, 1}, {1, 1}, {1, -1}, {-1, -1}, {-1, 0}, {0, 1}, {1, 0}, {0, -1}, {0, 0}}};

std::optional<Vec2> known_direction(int orientation) {
  if (orientation < 1 || orientation > kOrientations) return std::nullopt;
  return nose_direction(orientation);
}

std::optional<InsertOutline> within_reach(InsertOutline outline) {
  if (!(outline_reach_mm(outline) <= kMaxInsertReach_mm)) return std::nullopt;
  return outline;
}

InsertPart disc(const Vec2& center, double radius) {
  const Vec2 right = center + Vec2(radius, 0), left = center - Vec2(radius, 0);
  return {{left, center, InsertSide::kNose}, {right, center, InsertSide::kNose}};
}

/// Where an outline turns, rounded by an arc.
struct Corner {
  Vec2 at{0};
  double radius = 0;
  InsertSide arc = InsertSide::kBody;   ///< of the arc
  InsertSide next = InsertSide::kBody;  ///< of the side from here to the next corner
};

/// Counter-clockwise corners of a convex polygon as a chain. None: the arcs do not fit. `centers`
/// gets the arcs' centres.
std::optional<InsertPart> rounded(std::span<const Corner> corners, std::vector<Vec2>& centers) {
  const std::size_t n = corners.size();
  struct Arc {
    Vec2 from, to, center;
  };
  std::vector<Arc> arcs(n);
  std::vector<double> used(n, 0);  // of the side behind each corner
  for (std::size_t i = 0; i < n; ++i) {
    const Corner& c = corners[i];
    const Vec2 in = glm::normalize(c.at - corners[(i + n - 1) % n].at);
    const Vec2 out = glm::normalize(corners[(i + 1) % n].at - c.at);
    const double turn = portable::atan2(in.x * out.y - in.y * out.x, glm::dot(in, out));
    if (!(turn > kMinTurn_rad)) return std::nullopt;
    const double back = c.radius * portable::tan(turn / 2);
    used[i] += back;
    used[(i + n - 1) % n] += back;
    arcs[i] = {c.at - back * in, c.at + back * out, c.at - back * in + c.radius * left_of(in)};
  }
  InsertPart part;
  centers.clear();
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t next = (i + 1) % n;
    const double rest = glm::distance(corners[i].at, corners[next].at) - used[i];
    if (rest < -kMinEdge_mm) return std::nullopt;
    centers.push_back(arcs[i].center);
    if (corners[i].radius > 0) part.push_back({arcs[i].to, arcs[i].center, corners[i].arc});
    // A side that the arcs use up is none.
    if (rest > kMinEdge_mm) {
      part.push_back({arcs[next].from, std::nullopt, corners[i].next});
    } else if (!part.empty()) {
      part.back().end_mm = arcs[next].from;
    }
  }
  return part;
}

void move(InsertPart& part, const Vec2& by) {
  for (InsertEdge& edge : part) {
    edge.end_mm += by;
    if (edge.center_mm) *edge.center_mm += by;
  }
}

/// Corner 0 is the nose, its rounded centre goes where the orientation has it.
std::optional<InsertOutline> about_nose(std::span<const Corner> corners, const Vec2& direction) {
  std::vector<Vec2> centers;
  std::optional<InsertPart> part = rounded(corners, centers);
  if (!part) return std::nullopt;
  move(*part, corners[0].radius * direction - centers[0]);
  return within_reach({{std::move(*part)}});
}

}  // namespace

Vec2 nose_direction(int orientation) {
  const std::array<int, 2>& d = kNoseDirections[static_cast<std::size_t>(orientation - 1)];
  return Vec2(d[0], d[1]);
}

std::optional<InsertOutline> nose_insert(const NoseInsert& insert) {
  const std::optional<Vec2> direction = known_direction(insert.orientation);
  const double r = insert.radius_mm, length = insert.edge_mm;
  const bool are_angles = std::isfinite(insert.front_rad) && std::isfinite(insert.back_rad);
  if (!direction || !is_size(r) || !are_angles) return std::nullopt;
  const Vec2 center = r * *direction;
  if (insert.orientation == kOrientations) {
    if (r < kMinEdge_mm) return std::nullopt;
    return within_reach({{disc(center, r)}});
  }
  const double low = std::min(insert.front_rad, insert.back_rad);
  const double high = std::max(insert.front_rad, insert.back_rad);
  const bool between = high - low > kMinTurn_rad || r > kMinEdge_mm;
  if (!(high - low < kPi - kMinTurn_rad) || !between || !is_size(length) || length < kMinEdge_mm) {
    return std::nullopt;
  }
  const InsertSide at_low =
      insert.front_rad <= insert.back_rad ? InsertSide::kFront : InsertSide::kBack;
  const InsertSide at_high = at_low == InsertSide::kFront ? InsertSide::kBack : InsertSide::kFront;
  const Vec2 out_low = along(low), out_high = along(high);
  const Vec2 leave = center - r * left_of(out_low), enter = center + r * left_of(out_high);
  InsertPart part;
  part.push_back({leave + length * out_low, std::nullopt, at_low});
  part.push_back({enter + length * out_high, std::nullopt, InsertSide::kBody});
  part.push_back({enter, std::nullopt, at_high});
  if (r > 0) part.push_back({leave, center, InsertSide::kNose});
  return within_reach({{std::move(part)}});
}

namespace {

constexpr double degrees(double value) { return value * kPi / 180; }

/// ISO 1832: letters and angles as the catalogues of insert makers print them. Of the trigon W the
/// blunt corners are what six sides about one circle leave: (720 - 3 x 80) / 3.
constexpr std::array kIsoShapes{
    IsoShape{'C', 4, degrees(80), degrees(100)},
    IsoShape{'D', 4, degrees(55), degrees(125)},
    IsoShape{'E', 4, degrees(75), degrees(105)},
    IsoShape{'K', 4, degrees(55), degrees(125), false},
    IsoShape{'M', 4, degrees(86), degrees(94)},
    IsoShape{'P', 5, degrees(108), degrees(108)},
    IsoShape{'R', 0, 0, 0},
    IsoShape{'S', 4, degrees(90), degrees(90)},
    IsoShape{'T', 3, degrees(60), degrees(60)},
    IsoShape{'V', 4, degrees(35), degrees(145)},
    IsoShape{'W', 6, degrees(80), degrees(160)},
};

/// Inscribed circles of the series, mm: 5/32 to 1 1/4 inch.
constexpr std::array kIsoCircles_mm{3.97, 4.76,   5.56,  6.35, 7.94, 9.525,
                                    12.7, 15.875, 19.05, 25.4, 31.75};
/// The long side of K with a circle of 9.525 mm is 16.15 mm (KNUX 16 04): the only size in use.
constexpr double kLongOfK = 16.15 / 9.525;

const IsoShape* shape_of(char letter) {
  for (const IsoShape& shape : kIsoShapes) {
    if (shape.letter == letter) return &shape;
  }
  return nullptr;
}

/// Of the side that begins at a corner of either kind, the other kind at its end. `first`: it
/// begins at the nose, counter-clockwise.
double side_mm(const IsoShape& shape, double circle, bool first) {
  if (shape.equal_sides) {
    return circle / 2 *
           (1 / portable::tan(shape.nose_rad / 2) + 1 / portable::tan(shape.other_rad / 2));
  }
  return first ? circle * kLongOfK : circle / portable::sin(shape.nose_rad);
}

}  // namespace

std::span<const IsoShape> iso_shapes() { return kIsoShapes; }

std::optional<double> iso_circle_mm(char shape, int size) {
  const IsoShape* const row = shape_of(shape);
  if (row == nullptr) return std::nullopt;
  for (const double circle : kIsoCircles_mm) {
    const double edge = row->corners == 0 ? circle : side_mm(*row, circle, true);
    // Catalogues give tenths, and the size is these without their decimal: T of 6.35 mm is 11.
    if (static_cast<int>(std::round(10 * edge)) / 10 == size) return circle;
  }
  return std::nullopt;
}

std::vector<IsoSize> iso_sizes(char shape) {
  std::vector<IsoSize> sizes;
  for (int size = 1; size < 100; ++size) {
    if (const std::optional<double> circle = iso_circle_mm(shape, size)) {
      sizes.push_back({size, *circle});
    }
  }
  return sizes;
}

std::optional<InsertOutline> iso_insert(const IsoInsert& insert) {
  const IsoShape* const shape = shape_of(insert.shape);
  const std::optional<Vec2> direction = known_direction(insert.orientation);
  if (shape == nullptr || !direction || !is_size(insert.circle_mm) || !is_size(insert.radius_mm) ||
      insert.circle_mm < kMinEdge_mm || !(std::abs(insert.front_rad) <= 2 * kPi)) {
    return std::nullopt;
  }
  if (shape->corners == 0) {
    const double r = insert.circle_mm / 2;
    return within_reach({{disc(r * *direction, r)}});
  }
  // Counter-clockwise from the nose along the flank of the smaller angle.
  const double low = insert.back_is_ahead ? insert.front_rad : insert.front_rad - shape->nose_rad;
  const InsertSide first = insert.back_is_ahead ? InsertSide::kFront : InsertSide::kBack;
  const InsertSide last = insert.back_is_ahead ? InsertSide::kBack : InsertSide::kFront;
  std::vector<Corner> corners;
  Vec2 at{0};
  double heading = low;
  for (int i = 0; i < shape->corners; ++i) {
    // The long side of a parallelogram is its front: it is the first where the front is.
    const bool is_long = (i % 2 == 0) == insert.back_is_ahead;
    corners.push_back({at, insert.radius_mm});
    at += side_mm(*shape, insert.circle_mm, is_long) * along(heading);
    heading += kPi - (i % 2 == 0 ? shape->other_rad : shape->nose_rad);
  }
  corners.front().arc = InsertSide::kNose;
  corners.front().next = first;
  corners.back().next = last;
  return about_nose(corners, *direction);
}

std::optional<InsertOutline> groove_insert(const GrooveInsert& insert) {
  const std::optional<Vec2> direction = known_direction(insert.orientation);
  const double w = insert.width_mm, r = insert.corner_mm, length = insert.length_mm;
  if (!direction || !is_size(w) || !is_size(r) || !is_size(length) || w < kMinEdge_mm ||
      length < kMinEdge_mm || r > w / 2 ||
      !(insert.relief_rad >= 0 && insert.relief_rad < kPi / 4)) {
    return std::nullopt;
  }
  // Worked out for a blade that points to -x; the others are that one turned and mirrored.
  const double deep = insert.axial ? direction->x : direction->y;
  const double across = insert.axial ? direction->y : direction->x;
  // The sides begin to run back above the rounded corners, which make the width.
  const bool has_land = r > 0 && insert.relief_rad > 0;
  const double narrower = (length - r) * portable::tan(insert.relief_rad);
  if (deep == 0 || 2 * narrower >= w || r > length) return std::nullopt;
  const double from = across > 0 ? 0 : across < 0 ? -w : -w / 2;
  std::vector<Corner> corners{Corner{{from, 0}, r, InsertSide::kNose, InsertSide::kNose},
                              Corner{{from + w, 0}, r, InsertSide::kNose, InsertSide::kBack}};
  if (has_land) corners.push_back({{from + w, r}, 0, InsertSide::kBack, InsertSide::kBack});
  corners.push_back({{from + w - narrower, length}, 0, InsertSide::kBody, InsertSide::kBody});
  corners.push_back({{from + narrower, length}, 0, InsertSide::kBody, InsertSide::kFront});
  if (has_land) corners.push_back({{from, r}, 0, InsertSide::kFront, InsertSide::kFront});
  std::vector<Vec2> centers;
  std::optional<InsertPart> part = rounded(corners, centers);
  if (!part) return std::nullopt;
  InsertOutline outline{{std::move(*part)}};
  if (insert.axial) {
    // (z, x) -> (x, -z) is a turn: x runs across then, and the blade points to +z.
    for (InsertPart& turned : outline.parts) {
      for (InsertEdge& edge : turned) {
        edge.end_mm = {-edge.end_mm.y, edge.end_mm.x};
        if (edge.center_mm) edge.center_mm = Vec2(-edge.center_mm->y, edge.center_mm->x);
      }
    }
    return within_reach(deep < 0 ? outline : mirrored_in_z(outline));
  }
  return within_reach(deep > 0 ? outline : mirrored_in_x(outline));
}

std::optional<InsertOutline> thread_insert(const ThreadInsert& insert) {
  const std::optional<Vec2> direction = known_direction(insert.orientation);
  if (!direction || direction->x != 0 || direction->y == 0 || !is_size(insert.flat_mm) ||
      !is_size(insert.depth_mm) || insert.depth_mm < kMinEdge_mm ||
      !(insert.angle_rad > kMinTurn_rad && insert.angle_rad < kPi - kMinTurn_rad)) {
    return std::nullopt;
  }
  const double half = insert.flat_mm / 2;
  const double wide = half + insert.depth_mm * portable::tan(insert.angle_rad / 2);
  if (!is_size(wide)) return std::nullopt;
  const Vec2 low{-half, 0}, high{half, 0};
  InsertPart part;
  if (insert.flat_mm > kMinEdge_mm) part.push_back({high, std::nullopt, InsertSide::kNose});
  part.push_back({{wide, insert.depth_mm}, std::nullopt, InsertSide::kBack});
  part.push_back({{-wide, insert.depth_mm}, std::nullopt, InsertSide::kBody});
  part.push_back({insert.flat_mm > kMinEdge_mm ? low : Vec2(0), std::nullopt, InsertSide::kFront});
  InsertOutline outline{{std::move(part)}};
  return within_reach(direction->y > 0 ? outline : mirrored_in_x(outline));
}

std::optional<InsertOutline> axial_outline(const Cutter& cutter, double length_mm) {
  InsertOutline outline;
  const double flutes = std::min(cutter.flute_length_mm().value_or(length_mm), length_mm);
  if (!is_size(length_mm) || cutter.radius_mm() > kMaxInsertReach_mm) return std::nullopt;
  for (const ProfilePiece& piece : cutter.profile()) {
    if (piece.r1 - piece.r0 < kMinEdge_mm) continue;  // a wall: that of the part before
    const bool is_arc = piece.kind == ProfilePiece::Kind::kArc;
    if ((is_arc && !piece.convex) || piece.z1 >= flutes) return std::nullopt;
    // Widening upward, each piece with what is above it is convex.
    InsertPart part;
    std::optional<Vec2> below, above;
    if (is_arc) {
      below = Vec2(piece.center_z, -piece.center_r);
      above = Vec2(piece.center_z, piece.center_r);
    }
    part.push_back({{piece.z1, -piece.r1}, below, InsertSide::kNose});
    part.push_back({{flutes, -piece.r1}, std::nullopt, InsertSide::kFront});
    if (length_mm - flutes > kMinEdge_mm) {
      part.push_back({{length_mm, -piece.r1}, std::nullopt, InsertSide::kBody});
    }
    part.push_back({{length_mm, piece.r1}, std::nullopt, InsertSide::kBody});
    if (length_mm - flutes > kMinEdge_mm) {
      part.push_back({{flutes, piece.r1}, std::nullopt, InsertSide::kBody});
    }
    part.push_back({{piece.z1, piece.r1}, std::nullopt, InsertSide::kFront});
    part.push_back({{piece.z0, piece.r0}, above, InsertSide::kNose});
    if (piece.r0 > kMinEdge_mm) {
      part.push_back({{piece.z0, -piece.r0}, std::nullopt, InsertSide::kNose});
    }
    outline.parts.push_back(std::move(part));
  }
  if (outline.parts.empty()) return std::nullopt;
  return within_reach(std::move(outline));
}

}  // namespace kerf
