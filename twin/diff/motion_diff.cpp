#include "twin/diff/motion_diff.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "interp_bridge/motion_kinds.h"
#include "twin/diff/align.h"
#include "twin/diff/path_distance.h"

namespace kerf {
namespace {

constexpr double kSameShare = 1e-3;  // of feeds and speeds: posts round them
constexpr double kSameDwell_s = 1e-3;
constexpr double kSameAxis = 1e-6;  // of the normals of arcs
constexpr double kRadPerDeg = kPi / 180;

bool same_value(double a, double b) {
  return std::abs(a - b) <= kSameShare * std::max(std::abs(a), std::abs(b));
}

/// How a step goes about its way: of one kind may be divided otherwise.
enum class WayClass : std::uint8_t { kNone, kTraverse, kFeed, kThread, kProbe };
WayClass class_of(const DiffStep& s) {
  if (!is_move(s.kind)) return WayClass::kNone;
  if (s.kind == MotionKind::kTraverse || s.rapid) return WayClass::kTraverse;
  if (s.kind == MotionKind::kThread) return WayClass::kThread;
  return s.kind == MotionKind::kProbe ? WayClass::kProbe : WayClass::kFeed;
}

/// The farthest that an end of one is from that of the other.
double ends_apart_mm(const DiffStep& a, const DiffStep& b, bool with_starts) {
  const auto apart = [](const Vec3& p, const Vec3& q, const std::array<double, 3>& p_deg,
                        const std::array<double, 3>& q_deg, const Vec3& p_uvw, const Vec3& q_uvw) {
    double turned = 0;
    for (std::size_t i = 0; i < 3; ++i) turned = std::max(turned, std::abs(p_deg[i] - q_deg[i]));
    return std::max(
        {glm::length(p - q), turned * kRadPerDeg * kTurnLever_mm, glm::length(p_uvw - q_uvw)});
  };
  const double end = apart(a.to_mm, b.to_mm, a.to_abc_deg, b.to_abc_deg, a.to_uvw_mm, b.to_uvw_mm);
  if (!with_starts) return end;
  return std::max(end, apart(a.from_mm, b.from_mm, a.from_abc_deg, b.from_abc_deg, a.from_uvw_mm,
                             b.from_uvw_mm));
}

/// How far the middle of an arc is from that of another one with the same ends.
double arcs_apart_mm(const DiffStep& a, const DiffStep& b) {
  const double radius_mm = glm::length(a.from_mm - a.arc.center_mm);
  if (glm::dot(a.arc.axis, b.arc.axis) < 1 - kSameAxis) return 2 * radius_mm;
  return std::max(glm::length(a.arc.center_mm - b.arc.center_mm),
                  std::abs(a.arc.sweep_rad - b.arc.sweep_rad) * radius_mm);
}

class MotionDiffer {
 public:
  MotionDiffer(std::span<const DiffStep> a, std::span<const DiffStep> b, double tolerance_mm)
      : a_(a), b_(b), tolerance_mm_(tolerance_mm) {}

  MotionDiff run() {
    out_.a_steps = a_.size();
    out_.b_steps = b_.size();
    AlignedPair pair;
    pair.a_size = a_.size();
    pair.b_size = b_.size();
    pair.equal = [this](std::size_t i, std::size_t j) { return same_way(a_[i], b_[j]); };
    pair.a_key = [this](std::size_t i) { return key_of(a_[i]); };
    pair.b_key = [this](std::size_t j) { return key_of(b_[j]); };
    std::size_t i = 0, j = 0;
    for (const AlignedGap& gap : align(pair)) {
      compare_states(i, gap.a_begin, j);
      take_gap(gap);
      i = gap.a_end;
      j = gap.b_end;
    }
    compare_states(i, a_.size(), j);
    close();
    return std::move(out_);
  }

 private:
  /// They go the same way, or are the same event.
  bool same_way(const DiffStep& a, const DiffStep& b) const {
    if (a.kind != b.kind || class_of(a) != class_of(b) || a.start_known != b.start_known ||
        a.unknown_to != b.unknown_to) {
      return false;
    }
    if (a.kind == MotionKind::kToolChange) return a.tool == b.tool;
    if (a.kind == MotionKind::kDwell) return std::abs(a.dwell_s - b.dwell_s) <= kSameDwell_s;
    if (!is_move(a.kind)) return true;
    if (ends_apart_mm(a, b, a.start_known) > tolerance_mm_) return false;
    return a.kind != MotionKind::kArc || arcs_apart_mm(a, b) <= tolerance_mm_;
  }

  /// Of what is rounded to ten tolerances: mostly equal where the steps are.
  std::uint64_t key_of(const DiffStep& s) const {
    std::uint64_t key = 0xcbf29ce484222325;
    const auto mix = [&key](double value) {
      key ^= static_cast<std::uint64_t>(static_cast<std::int64_t>(value));
      key *= 0x9e3779b97f4a7c15;
      key ^= key >> 29;
    };
    const double grain_mm = 10 * std::max(tolerance_mm_, 1e-4);
    const auto place = [&](const Vec3& p) {
      for (int axis = 0; axis < 3; ++axis) mix(std::floor(p[axis] / grain_mm + 0.35));
    };
    mix(static_cast<double>(s.kind));
    if (s.kind == MotionKind::kToolChange) mix(s.tool);
    if (!is_move(s.kind)) return key;
    place(s.from_mm);
    place(s.to_mm);
    for (const double angle_deg : s.to_abc_deg) mix(std::floor(angle_deg * 10 + 0.35));
    return key;
  }

  std::uint16_t states_apart(const DiffStep& a, const DiffStep& b) const {
    std::uint16_t kinds = 0;
    const auto differs = [&](bool is_so, DiffKind kind) {
      if (is_so) kinds = static_cast<std::uint16_t>(kinds | kind);
    };
    differs(!same_value(a.feed, b.feed) || a.feed_per_rev != b.feed_per_rev, kDiffFeed);
    differs(a.tool != b.tool, kDiffTool);
    differs(a.spindle != b.spindle || !same_value(a.rpm, b.rpm) ||
                !same_value(a.surface_mm_per_min, b.surface_mm_per_min),
            kDiffSpindle);
    differs(a.flood != b.flood || a.mist != b.mist, kDiffCoolant);
    TorchState torch_b = b.torch;
    torch_b.spindles_on = a.torch.spindles_on;  // told by `spindle`
    differs(!(a.torch == torch_b), kDiffOutputs);
    return kinds;
  }

  /// Steps that go the same way.
  void compare_states(std::size_t i, std::size_t end, std::size_t j) {
    for (; i < end; ++i, ++j) {
      out_.apart_mm = std::max(
          out_.apart_mm, is_move(a_[i].kind) ? ends_apart_mm(a_[i], b_[j], a_[i].start_known) : 0);
      extend({i, i + 1, j, j + 1}, states_apart(a_[i], b_[j]));
    }
  }

  /// Steps in a row that differ in the same are one place.
  void extend(const AlignedGap& part, std::uint16_t kinds) {
    if (open_ && open_->kinds == kinds && open_->a_end == part.a_begin &&
        open_->b_end == part.b_begin) {
      open_->a_end = part.a_end;
      open_->b_end = part.b_end;
      return;
    }
    close();
    if (kinds == 0) return;
    MotionHunk hunk;
    hunk.a_begin = part.a_begin;
    hunk.a_end = part.a_end;
    hunk.b_begin = part.b_begin;
    hunk.b_end = part.b_end;
    hunk.kinds = kinds;
    open_ = hunk;
  }

  void close() {
    if (!open_) return;
    ++out_.hunk_count;
    if (out_.hunks.size() < MotionDiff::kMostHunks) out_.hunks.push_back(*open_);
    open_.reset();
  }

  /// A part of a gap in which a program goes about its way in one manner.
  struct Leg {
    std::size_t begin = 0, end = 0;
    WayClass way = WayClass::kNone;
  };
  std::vector<Leg> legs_of(std::span<const DiffStep> steps, std::size_t begin,
                           std::size_t end) const {
    std::vector<Leg> legs;
    for (std::size_t i = begin; i < end; ++i) {
      const WayClass way = class_of(steps[i]);
      const bool goes_on = !legs.empty() && legs.back().way == way && way != WayClass::kNone &&
                           steps[i].start_known && states_apart(steps[i - 1], steps[i]) == 0;
      if (goes_on) {
        legs.back().end = i + 1;
      } else {
        legs.push_back({i, i + 1, way});
      }
    }
    return legs;
  }

  /// What stands in the place of each other: the same way, divided otherwise; or not.
  void take_gap(const AlignedGap& gap) {
    const std::vector<Leg> a = legs_of(a_, gap.a_begin, gap.a_end);
    const std::vector<Leg> b = legs_of(b_, gap.b_begin, gap.b_end);
    if (a.size() == b.size() && legs_agree(a, b)) return;
    close();
    open_ = hunk_of(gap);
    close();
  }

  /// Leg by leg the same way; what else they differ in is told.
  bool legs_agree(const std::vector<Leg>& a, const std::vector<Leg>& b) {
    double apart_mm = 0;
    for (std::size_t n = 0; n < a.size(); ++n) {
      if (a[n].way != b[n].way) return false;
      const auto way_a = a_.subspan(a[n].begin, a[n].end - a[n].begin);
      const auto way_b = b_.subspan(b[n].begin, b[n].end - b[n].begin);
      if (a[n].way == WayClass::kNone || !all_known(way_a) || !all_known(way_b)) {
        if (!same_way(way_a.front(), way_b.front())) return false;
        continue;
      }
      // Of threads and probes each counts by itself.
      if (a[n].way > WayClass::kFeed) return false;
      if (ends_apart(way_a, way_b) > tolerance_mm_) return false;
      const double mm = path_distance(way_a, way_b, tolerance_mm_).mm;
      if (mm > tolerance_mm_) return false;
      apart_mm = std::max(apart_mm, mm);
    }
    out_.apart_mm = std::max(out_.apart_mm, apart_mm);
    for (std::size_t n = 0; n < a.size(); ++n) {
      extend({a[n].begin, a[n].end, b[n].begin, b[n].end},
             states_apart(a_[a[n].begin], b_[b[n].begin]));
    }
    return true;
  }

  static bool all_known(std::span<const DiffStep> steps) {
    return std::all_of(steps.begin(), steps.end(), has_way);
  }
  static double ends_apart(std::span<const DiffStep> a, std::span<const DiffStep> b) {
    return std::max(glm::length(a.front().from_mm - b.front().from_mm),
                    glm::length(a.back().to_mm - b.back().to_mm));
  }

  MotionHunk hunk_of(const AlignedGap& gap) {
    MotionHunk hunk;
    hunk.a_begin = gap.a_begin;
    hunk.a_end = gap.a_end;
    hunk.b_begin = gap.b_begin;
    hunk.b_end = gap.b_end;
    std::vector<DiffStep> ways_a, ways_b;
    std::vector<WayClass> said_a, said_b;
    pick(a_.subspan(gap.a_begin, gap.a_end - gap.a_begin), ways_a, said_a);
    pick(b_.subspan(gap.b_begin, gap.b_end - gap.b_begin), ways_b, said_b);
    std::uint16_t kinds = 0;
    const auto differs = [&](bool is_so, DiffKind kind) {
      if (is_so) kinds = static_cast<std::uint16_t>(kinds | kind);
    };
    differs(!same_events(gap), kDiffEvents);
    if (ways_a.empty() || ways_b.empty()) {
      differs(!ways_a.empty() || !ways_b.empty(), kDiffPath);
      // The first moves, which come from nobody knows where, go elsewhere.
      hunk.kinds = kinds == 0 ? std::uint16_t{kDiffPath} : kinds;
      return hunk;
    }
    PathDistance apart = path_distance(ways_a, ways_b, tolerance_mm_);
    if (ways_a.size() == ways_b.size()) {
      for (std::size_t i = 0; i < ways_a.size(); ++i) {
        const double mm = ends_apart_mm(ways_a[i], ways_b[i], false);
        if (mm > apart.mm) apart = {mm, ways_a[i].to_mm, ways_a[i].source, ways_b[i].source};
      }
    }
    hunk.apart_mm = apart.mm;
    hunk.at_mm = apart.at_mm;
    hunk.a_at = apart.a;
    hunk.b_at = apart.b;
    out_.apart_mm = std::max(out_.apart_mm, apart.mm);
    differs(apart.mm > tolerance_mm_, kDiffPath);
    differs(said_a != said_b, kDiffRapid);
    // The states of what they begin with say enough.
    kinds = static_cast<std::uint16_t>(kinds | states_apart(ways_a.front(), ways_b.front()));
    hunk.kinds = kinds == 0 ? std::uint16_t{kDiffPath} : kinds;
    return hunk;
  }

  /// Tool changes, dwells and stops, in their order.
  bool same_events(const AlignedGap& gap) const {
    std::size_t i = gap.a_begin, j = gap.b_begin;
    while (true) {
      while (i < gap.a_end && is_move(a_[i].kind)) ++i;
      while (j < gap.b_end && is_move(b_[j].kind)) ++j;
      if (i == gap.a_end || j == gap.b_end) return i == gap.a_end && j == gap.b_end;
      if (!same_way(a_[i++], b_[j++])) return false;
    }
  }

  static void pick(std::span<const DiffStep> steps, std::vector<DiffStep>& ways,
                   std::vector<WayClass>& said) {
    for (const DiffStep& step : steps) {
      if (has_way(step)) ways.push_back(step);
      const WayClass way = class_of(step);
      if (way == WayClass::kNone || (!said.empty() && said.back() == way)) continue;
      said.push_back(way);
    }
  }

  std::span<const DiffStep> a_, b_;
  double tolerance_mm_;
  MotionDiff out_;
  std::optional<MotionHunk> open_;  ///< may go on
};

}  // namespace

const char* name_of(DiffKind kind) {
  switch (kind) {
    case kDiffPath:
      return "path";
    case kDiffRapid:
      return "rapid";
    case kDiffEvents:
      return "events";
    case kDiffFeed:
      return "feed";
    case kDiffTool:
      return "tool";
    case kDiffSpindle:
      return "spindle";
    case kDiffCoolant:
      return "coolant";
    case kDiffOutputs:
      return "outputs";
  }
  return "";
}

MotionDiff diff_motions(std::span<const DiffStep> a, std::span<const DiffStep> b,
                        double tolerance_mm) {
  return MotionDiffer(a, b, tolerance_mm).run();
}

}  // namespace kerf
