#include "stock/turning/thread_volume.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>

namespace kerf::turning {
namespace {

/// Cells are this much of the outline's extent.
constexpr double kCellShare = 0.5;
constexpr double kLeastCell_mm = 0.02;
/// Of the moment of a whole outline, over the length that is integrated: what an interval may be
/// off. Ten times less than what volumes are promised to, for all intervals of a cell.
constexpr double kShare = 1e-8;
constexpr int kDeepest = 24;
/// So many corners of the material in one cell are taken as places where something changes. Of
/// more, as rings beside a run-out leave them, each changes little: to halve where it matters takes
/// a third of the looks that a part between each two of them would.
constexpr std::size_t kMostCorners = 16;
/// Places where something changes that are nearer to each other, mm, are one: of the moment of a
/// whole outline that is off by as little a part as this is of a cell, squared.
constexpr double kSamePlace_mm = 1e-7;
/// Units of the grid on which outlines are cut: as fine as turn() allows.
constexpr double kFinest = 1 << 27;

double at(const ProfileEdge& e, double z) {
  return e.low_r + (e.high_r - e.low_r) * ((z - e.low_z) / (e.high_z - e.low_z));
}

/// Three times the integral of the square of what is linear between two values.
double square(double a, double b) { return a * a + a * b + b * b; }

double lesser_square(double width, double a0, double a1, double b0, double b1) {
  const double d0 = a0 - b0, d1 = a1 - b1;
  if (d0 <= 0 && d1 <= 0) return width * square(a0, a1);
  if (d0 >= 0 && d1 >= 0) return width * square(b0, b1);
  const double share = d0 / (d0 - d1), middle = a0 + share * (a1 - a0);
  const double first = d0 < 0 ? square(a0, middle) : square(b0, middle);
  const double second = d0 < 0 ? square(middle, b1) : square(middle, a1);
  return width * (share * first + (1 - share) * second);
}

void append_edge(const Vec2& a, const Vec2& b, std::vector<ProfileEdge>& edges) {
  if (a.x < b.x) edges.push_back({a.x, b.x, a.y, b.y, -1});
  if (a.x > b.x) edges.push_back({b.x, a.x, b.y, a.y, 1});
}

}  // namespace

void append_edges(std::span<const Contour> contours, double low_z_mm, double high_z_mm,
                  double least_r_mm, std::vector<ProfileEdge>& edges) {
  const Unit low = to_units(low_z_mm) - 1, high = to_units(high_z_mm) + 1,
             least = to_units(least_r_mm) - 1;
  const auto add = [&](const Point& a, const Point& b) {
    if (std::max(a.X, b.X) < low || std::min(a.X, b.X) > high || std::max(a.Y, b.Y) < least) return;
    append_edge(to_mm(a), to_mm(b), edges);
  };
  for (const Contour& contour : contours) {
    if (contour.box().max_x < low || contour.box().min_x > high || contour.box().max_y < least)
      continue;
    const std::vector<RunPointer>& runs = contour.runs();
    for (std::size_t r = 0; r < runs.size(); ++r) {
      const Run& run = *runs[r];
      add(run.points.back(), runs[r + 1 == runs.size() ? 0 : r + 1]->points.front());
      if (run.box.max_x < low || run.box.min_x > high || run.box.max_y < least) continue;
      for (std::size_t i = 1; i < run.points.size(); ++i) add(run.points[i - 1], run.points[i]);
    }
  }
}

double common_moment_mm3(std::span<const ProfileEdge> region, const Vec2& by,
                         std::span<const ProfileEdge> other) {
  double sum = 0;
  for (const ProfileEdge& f : other) {
    double own = 0;
    for (const ProfileEdge& e : region) {
      const double low = std::max(e.low_z + by.x, f.low_z),
                   high = std::min(e.high_z + by.x, f.high_z);
      if (!(low < high)) continue;
      own += e.sign * lesser_square(high - low, at(e, low - by.x) + by.y, at(e, high - by.x) + by.y,
                                    at(f, low), at(f, high));
    }
    sum += f.sign * own;
  }
  return sum / 6;
}

double ThreadIntegral::cell_mm(const ThreadPass& pass) {
  const Vec2 size = pass.high_mm() - pass.low_mm(), along = glm::abs(pass.direction());
  return std::max(kCellShare * glm::dot(size, along), kLeastCell_mm);
}

std::size_t ThreadIntegral::cell_count(const ThreadPass& pass) {
  return static_cast<std::size_t>(std::ceil(pass.length_mm() / cell_mm(pass)));
}

void ThreadIntegral::add_beside(const ThreadPass& pass, const ThreadPass& other, double n,
                                const Range& ways) {
  PassBeside beside;
  beside.pass = &other;
  const double share = other.lead_mm() / pass.lead_mm();
  const double way = other.way_at(pass.turns_at(ways.low), n);
  beside.offset = other.at(way) - pass.at(ways.low);
  beside.per_way = share * other.direction() - pass.direction();
  // Its way is in 0 .. length while the tool's is in this range.
  const double begin = ways.low + (0 - way) / share,
               end = ways.low + (other.length_mm() - way) / share;
  beside.low_way = std::max(ways.low, std::min(begin, end));
  beside.high_way = std::min(ways.high, std::max(begin, end));
  if (!(beside.low_way < beside.high_way) && !(ways.low == ways.high)) return;
  if (beside.low_way > beside.high_way) return;
  const Vec2 moved = (ways.high - ways.low) * beside.per_way;
  for (int i = 0; i < 2; ++i) {
    const double low = beside.offset[i] + std::min(0.0, moved[i]),
                 high = beside.offset[i] + std::max(0.0, moved[i]);
    if (low + other.low_mm()[i] >= pass.high_mm()[i] ||
        high + other.high_mm()[i] <= pass.low_mm()[i])
      return;
  }
  beside_.push_back(beside);
}

void ThreadIntegral::find_beside(const ThreadPass& pass, const Range& ways,
                                 std::span<const std::shared_ptr<const ThreadPass>> before) {
  beside_.clear();
  const double lead = std::abs(pass.lead_mm());
  // One turn back: what lies farther back and meets the tool lies there as well.
  if (ways.high >= lead) {
    PassBeside back;
    back.pass = &pass;
    back.offset = -lead * pass.direction();
    back.low_way = std::max(ways.low, lead);
    back.high_way = ways.high;
    const Vec2 apart = glm::abs(back.offset);
    if (apart.x < pass.high_mm().x - pass.low_mm().x &&
        apart.y < pass.high_mm().y - pass.low_mm().y)
      beside_.push_back(back);
  }
  for (const auto& other : before) {
    const Vec2 low = glm::min(pass.at(ways.low), pass.at(ways.high)) + pass.low_mm(),
               high = glm::max(pass.at(ways.low), pass.at(ways.high)) + pass.high_mm();
    const Vec2 other_low = other->swept_low_mm(), other_high = other->swept_high_mm();
    if (other_low.x > high.x || other_high.x < low.x || other_low.y > high.y ||
        other_high.y < low.y)
      continue;
    // Only that part of its way along which it is near.
    const Vec2 middle = 0.5 * (low + high);
    const double along = glm::dot(middle - other->from_mm(), other->direction());
    const double near =
        0.5 * glm::length(high - low) +
        glm::length(glm::max(glm::abs(other->low_mm()), glm::abs(other->high_mm())));
    const double first = pass.turns_at(ways.low), last = pass.turns_at(ways.high);
    const ThreadPass::Turns turns =
        other->turns_seen(std::min(first, last), std::max(first, last), along - near, along + near);
    for (std::int64_t n = turns.first; n <= turns.last; ++n)
      add_beside(pass, *other, static_cast<double>(n), ways);
  }
}

void ThreadIntegral::cut_free(const ThreadPass& pass, double way_mm) {
  free_.clear();
  const ConvexChain& own = pass.corners();
  if (active_.empty()) {
    for (std::size_t i = 0; i < own.size(); ++i)
      append_edge(own[i == 0 ? own.size() - 1 : i - 1], own[i], free_);
    return;
  }
  const auto farthest = [](const ThreadPass& p) {
    const Vec2 far = glm::max(glm::abs(p.low_mm()), glm::abs(p.high_mm()));
    return std::max(far.x, far.y);
  };
  // Overlapping, none is farther away than this.
  double reach = farthest(pass);
  for (const PassBeside& b : active_) reach = std::max(reach, farthest(*b.pass));
  const double scale = kFinest / (5 * reach);
  const auto fine = [&](const Vec2& p) {
    return Point{std::llround(p.x * scale), std::llround(p.y * scale)};
  };
  ContourBuilder builder;
  for (const Vec2& p : own) builder.append(fine(p));
  region_.clear();
  region_.push_back(builder.close());
  if (region_[0].runs().empty()) return;
  for (const PassBeside& b : active_) {
    const Vec2 offset = b.offset + (way_mm - b.low_way) * b.per_way;
    corners_.clear();
    for (const Vec2& p : b.pass->corners()) corners_.push_back(fine(p + offset));
    other_.assign(corners_);
    if (!other_.empty() && cut_.look(region_, other_)) cut_.apply(region_);
  }
  for (const Contour& contour : region_) {
    const Ring ring = contour.ring();
    const auto place = [&](const Point& p) {
      return Vec2(static_cast<double>(p.X), static_cast<double>(p.Y)) / scale;
    };
    for (std::size_t i = 0; i < ring.size(); ++i)
      append_edge(place(ring[i == 0 ? ring.size() - 1 : i - 1]), place(ring[i]), free_);
  }
}

double ThreadIntegral::moment(const ThreadPass& pass, double way_mm) {
  if (moves_) cut_free(pass, way_mm);
  return common_moment_mm3(free_, pass.at(way_mm), near_);
}

double ThreadIntegral::integrate(const ThreadPass& pass, const Range& ways, double tolerance) {
  struct Piece {
    double low, high, first, middle, last;
    int depth;
  };
  const auto simpson = [](const Piece& p) {
    return (p.high - p.low) / 6 * (p.first + 4 * p.middle + p.last);
  };
  const double centre = 0.5 * (ways.low + ways.high);
  std::array<Piece, kDeepest + 2> stack;
  std::size_t count = 0;
  stack[count++] = {
      ways.low, ways.high, moment(pass, ways.low), moment(pass, centre), moment(pass, ways.high),
      0};
  double sum = 0;
  while (count > 0) {
    const Piece p = stack[--count];
    const double middle = 0.5 * (p.low + p.high);
    const Piece left{p.low,    middle,     p.first, moment(pass, 0.5 * (p.low + middle)),
                     p.middle, p.depth + 1};
    const Piece right{middle, p.high,     p.middle, moment(pass, 0.5 * (middle + p.high)),
                      p.last, p.depth + 1};
    const double whole = simpson(p), halves = simpson(left) + simpson(right);
    if (std::abs(halves - whole) <= tolerance || p.depth == kDeepest) {
      sum += halves + (halves - whole) / 15;
      continue;
    }
    stack[count++] = right;
    stack[count++] = left;
  }
  return sum;
}

double ThreadIntegral::cell_mm3(const ThreadPass& pass, std::size_t cell,
                                std::span<const std::shared_ptr<const ThreadPass>> before,
                                std::span<const ProfileEdge> edges) {
  const double begin = static_cast<double>(cell) * cell_mm(pass);
  const Range ways{begin, std::min(begin + cell_mm(pass), pass.length_mm())};
  const Vec2 low = glm::min(pass.at(ways.low), pass.at(ways.high)) + pass.low_mm(),
             high = glm::max(pass.at(ways.low), pass.at(ways.high)) + pass.high_mm();
  near_.clear();
  for (const ProfileEdge& e : edges) {
    if (e.high_z > low.x && e.low_z < high.x && std::max(e.low_r, e.high_r) > low.y)
      near_.push_back(e);
  }
  if (near_.empty()) return 0;
  find_beside(pass, ways, before);
  // Where passes begin and end that other ones cover all along is of no interest.
  drop_covered(pass, ways.low, ways.low, ways.high, beside_);
  breaks_.assign({ways.low, ways.high});
  const auto add_break = [&](double way) {
    if (way > ways.low && way < ways.high) breaks_.push_back(way);
  };
  for (const PassBeside& b : beside_) {
    add_break(b.low_way);
    add_break(b.high_way);
  }
  if (near_.size() <= kMostCorners) {
    const Vec2& d = pass.direction();
    for (const ProfileEdge& e : near_) {
      for (const Vec2& p : pass.corners()) {
        if (d.x != 0) {
          add_break((e.low_z - p.x - pass.from_mm().x) / d.x);
          add_break((e.high_z - p.x - pass.from_mm().x) / d.x);
        }
        if (d.y != 0) {
          add_break((e.low_r - p.y - pass.from_mm().y) / d.y);
          add_break((e.high_r - p.y - pass.from_mm().y) / d.y);
        }
      }
    }
  }
  std::sort(breaks_.begin(), breaks_.end());
  merge_near(ways);
  double whole = 0;
  for (const Vec2& p : pass.corners()) whole = std::max(whole, std::abs(p.y + pass.from_mm().y));
  const Vec2 size = pass.high_mm() - pass.low_mm();
  const double tolerance = kShare * whole * size.x * size.y * (ways.high - ways.low);
  double sum = 0;
  for (std::size_t i = 1; i < breaks_.size(); ++i) {
    const Range part{breaks_[i - 1], breaks_[i]};
    active_.clear();
    moves_ = false;
    for (PassBeside b : beside_) {
      if (b.low_way > part.low + kSamePlace_mm || b.high_way < part.high - kSamePlace_mm) continue;
      b.offset += (part.low - ways.low) * b.per_way;
      b.low_way = part.low;
      active_.push_back(b);
    }
    drop_covered(pass, part.low, part.low, part.high, active_);
    for (const PassBeside& b : active_)
      moves_ = moves_ || glm::length(b.per_way) * (part.high - part.low) > kStill_mm;
    if (!moves_) cut_free(pass, part.low);
    sum += integrate(pass, part, tolerance);
  }
  return 2 * kPi / std::abs(pass.lead_mm()) * sum;
}

/// Keeps both ends of the cell.
void ThreadIntegral::merge_near(const Range& ways) {
  std::size_t kept = 1;
  for (const double way : breaks_) {
    const bool is_end = way == ways.high;
    if (way - breaks_[kept - 1] > kSamePlace_mm) {
      breaks_[kept++] = way;
    } else if (is_end && kept > 1) {
      breaks_[kept - 1] = way;
    }
  }
  breaks_.resize(kept);
}

ThreadIntegral::Place ThreadIntegral::look(
    const ThreadPass& pass, double way_mm,
    std::span<const std::shared_ptr<const ThreadPass>> before, std::span<const ProfileEdge> edges) {
  const Vec2 by = pass.at(way_mm);
  near_.clear();
  for (const ProfileEdge& e : edges) {
    if (e.high_z > by.x + pass.low_mm().x && e.low_z < by.x + pass.high_mm().x) near_.push_back(e);
  }
  find_beside(pass, {way_mm, way_mm}, before);
  active_ = beside_;
  for (PassBeside& b : active_) b.low_way = way_mm;
  drop_covered(pass, way_mm, way_mm, way_mm, active_);
  cut_free(pass, way_mm);
  Place place;
  place.moment_mm3 = common_moment_mm3(free_, by, near_);
  // Along radii at the corners of both.
  std::vector<double> places;
  for (const ProfileEdge& e : free_) {
    for (const double z : {e.low_z, 0.5 * (e.low_z + e.high_z), e.high_z})
      places.push_back(z + by.x);
  }
  for (const ProfileEdge& e : near_) {
    for (const double z : {e.low_z, e.high_z}) {
      if (z > by.x + pass.low_mm().x && z < by.x + pass.high_mm().x) places.push_back(z);
    }
  }
  std::sort(places.begin(), places.end());
  const auto below = [](const ProfileEdge& e, double z, double shift_z, double shift_r) {
    return at(e, z - shift_z) + shift_r;
  };
  const auto height_at = [&](double z) {
    // What lies below two edges ends at the lower one.
    double sum = 0;
    for (const ProfileEdge& e : free_) {
      if (!(e.low_z + by.x < z && z < e.high_z + by.x)) continue;
      for (const ProfileEdge& f : near_) {
        if (!(f.low_z < z && z < f.high_z)) continue;
        sum += e.sign * f.sign * std::min(below(e, z, by.x, by.y), below(f, z, 0, 0));
      }
    }
    return sum;
  };
  for (std::size_t i = 1; i < places.size(); ++i) {
    const double low = places[i - 1], width = places[i] - low;
    if (!(width > 1e-7)) continue;
    // Just inside of either end, so that edges that end there count on their side.
    const double inside = 1e-6 * width;
    const double first = height_at(low + inside), middle = height_at(low + 0.5 * width),
                 last = height_at(places[i] - inside);
    place.height_mm = std::max({place.height_mm, first, middle, last});
    place.area_mm2 += width / 6 * (first + 4 * middle + last);
  }
  return place;
}

}  // namespace kerf::turning
