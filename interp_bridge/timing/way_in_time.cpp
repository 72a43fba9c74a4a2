#include "interp_bridge/timing/way_in_time.h"

#include <algorithm>
#include <cmath>

namespace kerf {
namespace {

/// Below this a share of a way or a time is none.
constexpr double kNone = 1e-9;
/// Slowest that a middle counts as, of its greatest speed: keeps divisions finite.
constexpr double kStanding = 1e-6;

/// A middle in seconds of its own: way 1, greatest speed 1.
struct Middle {
  double from, to;    ///< speeds
  double up, down;    ///< ends of the ramps, shares of the way
  double up_s, on_s;  ///< how long
  double down_s;

  explicit Middle(const WayInTime& w) {
    from = static_cast<double>(w.from);
    to = static_cast<double>(w.to);
    const double ramp = static_cast<double>(w.ramp);
    up = std::clamp(ramp * std::abs(1 - from * from), 0.0, 1.0);
    down = std::clamp(1 - ramp * std::abs(1 - to * to), up, 1.0);
    up_s = 2 * up / std::max(from + 1, kStanding);
    on_s = down - up;
    down_s = 2 * (1 - down) / std::max(1 + to, kStanding);
  }
  double whole_s() const { return up_s + on_s + down_s; }

  double time_of(double way) const {
    if (way <= up) return ramp_time(way, up, from, 1);
    if (way <= down) return up_s + (way - up);
    return up_s + on_s + ramp_time(way - down, 1 - down, 1, to);
  }
  double way_of(double s) const {
    if (s <= up_s) return ramp_way(s, up, up_s, from, 1);
    if (s <= up_s + on_s) return up + (s - up_s);
    return down + ramp_way(s - up_s - on_s, 1 - down, down_s, 1, to);
  }

 private:
  /// From speed a to b over `length`, in which it takes 2 length / (a + b).
  static double ramp_time(double way, double length, double a, double b) {
    if (length <= 0) return 0;
    const double square = a * a + (b * b - a * a) * way / length;
    const double speed = std::sqrt(std::max(square, 0.0));
    return 2 * way / std::max(a + speed, kStanding);
  }
  static double ramp_way(double s, double length, double whole_s, double a, double b) {
    if (whole_s <= 0) return length;
    const double speed = a + (b - a) * s / whole_s;
    return std::clamp((a + speed) / 2 * s, 0.0, length);
  }
};

/// A middle under G96: slowness against the way.
struct Slowness {
  double from, to, cap;
  bool falls;

  explicit Slowness(const WayInTime& w)
      : from(1),
        to(static_cast<double>(w.slowness)),
        cap(static_cast<double>(w.cap)),
        falls(to < from) {}

  /// Where the slope begins and ends.
  double first() const { return falls ? 0 : cap; }
  double last() const { return falls ? cap : 1; }
  double time_of(double way) const {
    const double length = last() - first();
    const double on = std::clamp(way - first(), 0.0, std::max(length, 0.0));
    const double slope = length > 0 ? (to - from) / length : 0;
    return from * std::min(way, first()) + (from + slope * on / 2) * on +
           to * std::max(way - last(), 0.0);
  }
  double whole_s() const { return time_of(1); }
  double at(double way) const {
    const double length = last() - first();
    const double on = length > 0 ? std::clamp((way - first()) / length, 0.0, 1.0) : 1.0;
    return way <= first() && length <= 0 ? from : from + (to - from) * on;
  }
  double way_of(double s) const {
    const double length = last() - first();
    const double even_s = from * first();
    if (s <= even_s) return from > 0 ? s / from : 0;
    const double slope_s = (from + to) / 2 * length;
    if (s >= even_s + slope_s) return std::min(last() + (s - even_s - slope_s) / to, 1.0);
    // (from + slope w / 2) w = s
    const double slope = (to - from) / length;
    const double root = std::sqrt(std::max(from * from + 2 * slope * (s - even_s), 0.0));
    return first() + 2 * (s - even_s) / (from + root);
  }
};

}  // namespace

bool WayInTime::is_even() const { return *this == WayInTime{}; }

double WayInTime::unevenness() const {
  if (is_even()) return 0;
  const double before = static_cast<double>(in_way), before_s = static_cast<double>(in_time);
  const double left = 1 - before - static_cast<double>(out_way);
  const double left_s = 1 - before_s - static_cast<double>(out_time);
  double most = std::max(std::abs(before_s - before), std::abs(left + before - left_s - before_s));
  const auto look = [&](double way, double time) {
    most = std::max(most, std::abs(before_s + left_s * time - before - left * way));
  };
  if (slowness != 1) {
    const Slowness slow(*this);
    const double whole_s = slow.whole_s();
    for (const double way : {slow.cap, slow.cap / 2, (1 + slow.cap) / 2}) {
      look(way, slow.time_of(way) / whole_s);
    }
    return most;
  }
  // At the ends of the ramps, and half of their time before and behind.
  const Middle m(*this);
  const double whole_s = m.whole_s();
  look(m.up, m.up_s / whole_s);
  look(m.down, (m.up_s + m.on_s) / whole_s);
  look((3 * m.from + 1) / 8 * m.up_s, m.up_s / 2 / whole_s);
  look(1 - (3 * m.to + 1) / 8 * m.down_s, 1 - m.down_s / 2 / whole_s);
  return most;
}

void WayInTime::set_slowness(double first, double last, double mean) {
  if (first <= 0 || last <= 0 || std::abs(last - first) < 1e-6 * first) return;
  // Even at the slower or the faster end, so long that the mean is right.
  const double slope =
      last < first ? 2 * (mean - last) / (first - last) : 1 - 2 * (mean - first) / (last - first);
  slowness = static_cast<float>(last / first);
  cap = static_cast<float>(std::clamp(slope, 0.0, 1.0));
}

void WayInTime::set_ramps(double length, double accel, double first, double cruise, double last) {
  if (!(cruise > 0 && length > 0 && accel > 0)) return;
  from = static_cast<float>(first / cruise);
  to = static_cast<float>(last / cruise);
  ramp = static_cast<float>(cruise * cruise / (2 * accel * length));
}

double WayInTime::time_of(double way) const {
  way = std::clamp(way, 0.0, 1.0);
  if (is_even()) return way;
  const double before = static_cast<double>(in_way), behind = static_cast<double>(out_way);
  const double before_s = static_cast<double>(in_time), behind_s = static_cast<double>(out_time);
  if (way < before) return before_s * way / before;
  const double length = 1 - before - behind;
  if (way > 1 - behind && behind > kNone) return 1 - behind_s * (1 - way) / behind;
  if (length <= kNone) return before_s;
  const double on = std::clamp((way - before) / length, 0.0, 1.0);
  double share = 0;
  if (slowness != 1) {
    const Slowness slow(*this);
    share = slow.time_of(on) / slow.whole_s();
  } else {
    const Middle middle(*this);
    share = middle.time_of(on) / middle.whole_s();
  }
  return before_s + (1 - before_s - behind_s) * std::clamp(share, 0.0, 1.0);
}

double WayInTime::way_of(double time) const {
  time = std::clamp(time, 0.0, 1.0);
  if (is_even()) return time;
  const double before = static_cast<double>(in_way), behind = static_cast<double>(out_way);
  const double before_s = static_cast<double>(in_time), behind_s = static_cast<double>(out_time);
  if (time < before_s) return before * time / before_s;
  const double whole_s = 1 - before_s - behind_s;
  if (time > 1 - behind_s && behind_s > kNone) return 1 - behind * (1 - time) / behind_s;
  if (whole_s <= kNone) return before;
  const double on = std::clamp((time - before_s) / whole_s, 0.0, 1.0);
  double share = 0;
  if (slowness != 1) {
    const Slowness slow(*this);
    share = slow.way_of(on * slow.whole_s());
  } else {
    const Middle middle(*this);
    share = middle.way_of(on * middle.whole_s());
  }
  return before + (1 - before - behind) * std::clamp(share, 0.0, 1.0);
}

WayInTime::Part WayInTime::between(double from_way, double to_way) const {
  Part out;
  out.from_time = from_way <= 0 ? 0 : time_of(from_way);
  out.to_time = to_way >= 1 ? 1 : time_of(to_way);
  const double length = to_way - from_way, time = out.to_time - out.from_time;
  if (is_even() || length <= kNone || time <= kNone) return out;
  const double before = static_cast<double>(in_way), behind = static_cast<double>(out_way);
  const double left = std::max(1 - before - behind, kNone);
  const double on = std::clamp((from_way - before) / left, 0.0, 1.0);
  const double off = std::clamp((to_way - before) / left, on, 1.0);
  if (off > on) out.way = part(on, off);
  // Of the ends so much as lies in the part.
  const auto share = [](double of, double whole, bool stands) {
    return whole > kNone ? of / whole : (stands ? 1.0 : 0.0);
  };
  const double first = std::clamp(before - from_way, 0.0, length);
  const double last = std::clamp(to_way - 1 + behind, 0.0, length - first);
  const double first_s = static_cast<double>(in_time) * share(first, before, from_way <= 0);
  const double last_s = static_cast<double>(out_time) * share(last, behind, to_way >= 1);
  out.way.in_way = static_cast<float>(first / length);
  out.way.in_time = static_cast<float>(std::min(first_s / time, 1.0));
  out.way.out_way = static_cast<float>(last / length);
  out.way.out_time =
      static_cast<float>(std::min(last_s / time, 1.0 - std::min(first_s / time, 1.0)));
  return out;
}

double WayInTime::slowness_at(double way) const { return Slowness(*this).at(way); }

double WayInTime::speed_at(double way) const {
  const Middle m(*this);
  if (way >= m.up && way <= m.down) return 1;
  const bool begins = way < m.up;
  const double end = static_cast<double>(begins ? from : to);
  const double on = begins ? way / m.up : (1 - way) / (1 - m.down);
  return std::sqrt(std::max(end * end + (1 - end * end) * on, 0.0));
}

WayInTime WayInTime::part(double from_way, double to_way) const {
  WayInTime out;
  const double length = to_way - from_way;
  if (length <= kNone) return out;
  if (slowness != 1) {
    out.slowness = static_cast<float>(slowness_at(to_way) / slowness_at(from_way));
    if (out.slowness == 1) return out;
    const double at = (static_cast<double>(cap) - from_way) / length;
    out.cap = static_cast<float>(std::clamp(at, 0.0, 1.0));
    return out;
  }
  if (ramp <= 0) return out;
  const Middle m(*this);
  const double a = speed_at(from_way), b = speed_at(to_way);
  // Between the two it is fastest on the even part, if there is some of it.
  const bool even = from_way < m.down && to_way > m.up;
  const double most = std::max(even ? 1.0 : std::max(a, b), kStanding);
  out.from = static_cast<float>(a / most);
  out.to = static_cast<float>(b / most);
  out.ramp = static_cast<float>(static_cast<double>(ramp) * most * most / length);
  return out;
}

}  // namespace kerf
