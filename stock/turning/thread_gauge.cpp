#include "stock/turning/thread_gauge.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <iterator>
#include <optional>

#include "base/portable_math.h"

namespace kerf {
namespace {

using turning::ProfileEdge;
using turning::ThreadIntegral;
using turning::ThreadPass;
using PassPointer = std::shared_ptr<const ThreadPass>;

/// A groove is full where its section is as large as at most places, but for this share of it, and
/// there at all with this area.
constexpr double kFullShare = 1e-3;
constexpr double kThere_mm2 = 1e-6;
/// Places are looked at so many times a turn, then found to this.
constexpr int kPlacesPerTurn = 16;
constexpr std::size_t kMostPlaces = 20'000;
constexpr double kPlaceBound_mm = 1e-4;
/// Steps of a turn that are the same but for rounding of listings, over the lead.
constexpr double kSameStep = 1e-3;

double width_at(const turning::ConvexChain& chain, double r) {
  double low = 1e300, high = -1e300;
  for (std::size_t i = 0; i < chain.size(); ++i) {
    const Vec2 &a = chain[i == 0 ? chain.size() - 1 : i - 1], &b = chain[i];
    if (std::min(a.y, b.y) > r || std::max(a.y, b.y) < r || a.y == b.y) continue;
    const double z = a.x + (r - a.y) / (b.y - a.y) * (b.x - a.x);
    low = std::min(low, z);
    high = std::max(high, z);
  }
  return std::max(high - low, 0.0);
}

/// The tool comes from inside: its outline is wider there, or else goes on there.
bool is_inner(const ThreadPass& pass) {
  const double low = pass.low_mm().y, high = pass.high_mm().y, in = 0.01 * (high - low);
  const double wider = width_at(pass.corners(), high - in) - width_at(pass.corners(), low + in);
  if (std::abs(wider) > 1e-6) return wider < 0;
  const double above = pass.high_r_mm() - (high + std::min(pass.from_mm().y, pass.to_mm().y));
  const double below = low + std::max(pass.from_mm().y, pass.to_mm().y) - pass.low_r_mm();
  return below < above;
}

/// Middle of what cuts deepest, along z from the controlled point.
double tip_mm(const ThreadPass& pass, bool inner) {
  const double deepest = inner ? pass.high_mm().y : pass.low_mm().y;
  double low = 1e300, high = -1e300;
  for (const Vec2& p : pass.corners()) {
    if (std::abs(p.y - deepest) > 1e-5) continue;
    low = std::min(low, p.x);
    high = std::max(high, p.x);
  }
  return (low + high) / 2;
}

/// Ways of a pass on which something holds.
struct Stretch {
  double low = 0, high = -1;
  double length() const { return high - low; }
};

class Groove {
 public:
  Groove(const TurnedPart& part, const ThreadPass& pass) : pass_(pass) {
    const Vec2 low = pass.swept_low_mm(), high = pass.swept_high_mm();
    turning::append_edges(part.contours(), low.x, high.x, low.y, edges_);
    const double turns = pass.length_mm() / std::abs(pass.lead_mm());
    count_ = std::clamp<std::size_t>(
        static_cast<std::size_t>(std::min(turns * kPlacesPerTurn, 1e9)), 16, kMostPlaces);
    for (std::size_t i = 0; i <= count_; ++i) {
      areas_.push_back(area(way(i)));
    }
    std::vector<double> some;
    std::copy_if(areas_.begin(), areas_.end(), std::back_inserter(some),
                 [](double a) { return a >= kThere_mm2; });
    if (some.empty()) return;
    const auto middle = some.begin() + static_cast<std::ptrdiff_t>(some.size() / 2);
    std::nth_element(some.begin(), middle, some.end());
    usual_ = *middle;
  }

  bool is_there() const { return usual_ > 0; }
  /// The longest on which it is full.
  Stretch full() {
    const auto is_full = [&](double a) { return std::abs(a - usual_) <= kFullShare * usual_; };
    Stretch best;
    for (std::size_t i = 0; i <= count_;) {
      if (!is_full(areas_[i])) {
        ++i;
        continue;
      }
      std::size_t end = i;
      while (end < count_ && is_full(areas_[end + 1])) ++end;
      const Stretch found{border(i, i > 0 ? i - 1 : i, is_full),
                          border(end, std::min(end + 1, count_), is_full)};
      if (found.length() > best.length()) best = found;
      i = end + 1;
    }
    return best;
  }
  /// From the first place to the last one at which it is there.
  Stretch there() {
    const auto is_there = [](double a) { return a >= kThere_mm2; };
    Stretch all;
    for (std::size_t i = 0; i <= count_; ++i) {
      if (!is_there(areas_[i])) continue;
      if (all.high < all.low) all.low = border(i, i > 0 ? i - 1 : i, is_there);
      all.high = border(i, std::min(i + 1, count_), is_there);
    }
    return all;
  }

 private:
  double way(std::size_t i) const {
    return pass_.length_mm() * static_cast<double>(i) / static_cast<double>(count_);
  }
  double area(double at) { return integral_.look(pass_, at, {}, edges_).area_mm2; }
  template <class Holds>
  double border(std::size_t inside, std::size_t outside, Holds&& holds) {
    double in = way(inside), out = way(outside);
    while (std::abs(out - in) > kPlaceBound_mm) {
      const double middle = (in + out) / 2;
      (holds(area(middle)) ? in : out) = middle;
    }
    return in;
  }

  const ThreadPass& pass_;
  ThreadIntegral integral_;
  std::vector<ProfileEdge> edges_;
  std::vector<double> areas_;
  std::size_t count_ = 0;
  double usual_ = 0;
};

/// A section, level, over one lead.
class Window {
 public:
  Window(const TurnedProfile& section, const Vec2& middle, double slope, double lead)
      : low_(middle.x - lead / 2), high_(middle.x + lead / 2), lead_(lead) {
    for (const std::vector<Vec2>& ring : section) {
      for (std::size_t i = 0; i < ring.size(); ++i) {
        const Vec2 &a = ring[i == 0 ? ring.size() - 1 : i - 1], &b = ring[i];
        if (std::max(a.x, b.x) < low_ || std::min(a.x, b.x) > high_) continue;
        edges_.push_back({{a.x, a.y - slope * (a.x - middle.x)},
                          {b.x, b.y - slope * (b.x - middle.x)},
                          glm::normalize(b - a)});
      }
    }
  }

  /// How much of the window a line at r is not in material.
  double gap(double r) const {
    std::vector<double> crossings;
    bool inside = false;  // at the low end
    for (const Edge& e : edges_) {
      if (const std::optional<double> z = crossing(e, r)) {
        if (*z > low_ && *z < high_) crossings.push_back(*z);
      }
      // Along z the material begins above edges that run along it.
      if ((e.a.x <= low_) != (e.b.x <= low_)) {
        const double at = e.a.y + (low_ - e.a.x) / (e.b.x - e.a.x) * (e.b.y - e.a.y);
        if (at > r) inside = !inside;
      }
    }
    std::sort(crossings.begin(), crossings.end());
    crossings.push_back(high_);
    double free = 0, from = low_;
    for (const double z : crossings) {
      if (!inside) free += z - from;
      from = z;
      inside = !inside;
    }
    return free;
  }
  /// Ridges, and the mean angle between the flanks of the grooves beside them.
  void look_at(double r, int& ridges, double& angle_rad) const {
    int count = 0;
    double sum = 0;
    for (const Edge& e : edges_) {
      const std::optional<double> z = crossing(e, r);
      if (!z || !(*z > low_ && *z <= high_)) continue;
      ++count;
      sum += portable::atan2(std::abs(e.way.x), std::abs(e.way.y));
    }
    ridges = count / 2;
    angle_rad = count > 0 ? 2 * sum / count : 0;
  }
  /// Where gap() comes to `least`, on the way from one radius to the other.
  double radius_with(double least, double from, double to) const {
    for (int i = 0; i < 60; ++i) {
      const double middle = (from + to) / 2;
      (gap(middle) >= least ? to : from) = middle;
    }
    return (from + to) / 2;
  }
  double lead() const { return lead_; }

 private:
  struct Edge {
    Vec2 a, b;
    Vec2 way;  // as it is
  };
  static std::optional<double> crossing(const Edge& e, double r) {
    if ((e.a.y <= r) == (e.b.y <= r)) return std::nullopt;
    return e.a.x + (r - e.a.y) / (e.b.y - e.a.y) * (e.b.x - e.a.x);
  }

  double low_, high_, lead_;
  std::vector<Edge> edges_;
};

/// Whether one goes on from the other.
bool are_linked(const ThreadPass& a, const ThreadPass& b) {
  constexpr double kSame_mm = 1e-3, kSame_turns = 1e-2;
  const double turns = a.turns_at(a.length_mm()) - b.from_turns();
  return glm::distance(a.to_mm(), b.from_mm()) < kSame_mm &&
         std::abs(turns - std::round(turns)) < kSame_turns;
}

std::optional<MeasuredThread> measured(const TurnedPart& part, const ThreadPass& pass) {
  const Vec2 step = pass.step_mm();
  const double lead = std::abs(step.x);
  if (lead < 0.1 * std::abs(pass.lead_mm())) return std::nullopt;  // a scroll
  Groove groove(part, pass);
  if (!groove.is_there()) return std::nullopt;
  const Stretch full = groove.full();
  if (full.length() < 0.5 * std::abs(pass.lead_mm())) return std::nullopt;
  MeasuredThread thread;
  thread.is_internal = is_inner(pass);
  thread.is_right_hand = step.x > 0;
  thread.lead_mm = lead;
  const double tip = tip_mm(pass, thread.is_internal), slope = step.y / step.x;
  thread.taper = 2 * slope;
  const auto tips = [&](const ThreadPass& p, const Stretch& ways) {
    const double a = p.at(ways.low).x + tip, b = p.at(ways.high).x + tip;
    return Stretch{std::min(a, b), std::max(a, b)};
  };
  const Stretch full_z = tips(pass, full);
  thread.low_z_mm = full_z.low;
  thread.high_z_mm = full_z.high;
  Stretch all = tips(pass, groove.there());
  for (const PassPointer& other : part.threads().passes()) {
    if (other.get() == &pass || !(are_linked(pass, *other) || are_linked(*other, pass))) continue;
    Groove beside(part, *other);
    if (!beside.is_there()) continue;
    const Stretch z = tips(*other, beside.there());
    all.low = std::min(all.low, z.low);
    all.high = std::max(all.high, z.high);
  }
  thread.low_run_out_mm = full_z.low - all.low;
  thread.high_run_out_mm = all.high - full_z.high;
  // The angle at which the groove is in the middle of the full form.
  const double middle = (full.low + full.high) / 2;
  thread.at_z_mm = pass.at(middle).x + tip;
  const double tip_r =
      pass.at(middle).y + (thread.is_internal ? pass.high_mm().y : pass.low_mm().y);
  const Window window(part.section(2 * kPi * pass.turns_at(middle)), {thread.at_z_mm, tip_r}, slope,
                      lead);
  // Beyond the root there is no gap, beyond the crest nothing else.
  const double room = pass.high_mm().y - pass.low_mm().y, out = thread.is_internal ? -1 : 1;
  const double beyond_root = tip_r - 0.02 * out * room, beyond_crest = tip_r + out * room;
  constexpr double kNone_mm = 1e-7;
  const double root = window.radius_with(kNone_mm, beyond_root, beyond_crest);
  const double crest = window.radius_with(lead - kNone_mm, root, beyond_crest);
  const double pitch = window.radius_with(lead / 2, root, crest);
  thread.major_mm = 2 * std::max(root, crest);
  thread.minor_mm = 2 * std::min(root, crest);
  thread.pitch_diameter_mm = 2 * pitch;
  window.look_at(pitch, thread.starts, thread.angle_rad);
  if (thread.starts < 1) return std::nullopt;
  return thread;
}

}  // namespace

std::vector<MeasuredThread> measure_threads(const TurnedPart& part) {
  struct Found {
    const ThreadPass* pass;
    MeasuredThread thread;
  };
  std::vector<Found> found;
  for (const PassPointer& pass : part.threads().passes()) {
    const std::optional<MeasuredThread> thread = measured(part, *pass);
    if (!thread) continue;
    // Starts beside each other, and passes of one groove, are one thread: the longest full form.
    const auto same = std::find_if(found.begin(), found.end(), [&](const Found& other) {
      const MeasuredThread& t = other.thread;
      return t.is_internal == thread->is_internal &&
             glm::distance(other.pass->step_mm(), pass->step_mm()) < kSameStep * t.lead_mm &&
             std::min(t.high_z_mm, thread->high_z_mm) > std::max(t.low_z_mm, thread->low_z_mm);
    });
    if (same == found.end()) {
      found.push_back({pass.get(), *thread});
    } else if (thread->full_length_mm() > same->thread.full_length_mm()) {
      *same = {pass.get(), *thread};
    }
  }
  std::vector<MeasuredThread> threads;
  for (const Found& one : found) threads.push_back(one.thread);
  std::sort(threads.begin(), threads.end(), [](const MeasuredThread& a, const MeasuredThread& b) {
    return a.low_z_mm < b.low_z_mm;
  });
  return threads;
}

}  // namespace kerf
