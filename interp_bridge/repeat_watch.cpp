#include "interp_bridge/repeat_watch.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <glm/geometric.hpp>
#include <utility>

namespace kerf {
namespace {

constexpr std::size_t kFirstPlaces = std::size_t{1} << 12;
constexpr std::size_t kMostPlaces = std::size_t{1} << 20;
constexpr double kEndless_s = 86'400;
/// Commands of one block: a canned cycle has some, a loop about one block has more.
constexpr std::uint64_t kMostOfALine = 10'000;
/// A machine that takes less for a command does not move.
constexpr double kStands_s = 1e-4;
constexpr double kRapid_mm_per_s = 1000;

std::uint64_t mix(std::uint64_t hash, std::uint64_t value) {
  hash = (hash ^ value) * 0x9e3779b97f4a7c15ULL;
  return hash ^ hash >> 29;
}

std::uint64_t mix(std::uint64_t hash, double value) {
  return mix(hash, std::bit_cast<std::uint64_t>(value));
}

double machine_time_s(const Motion& m) {
  if (m.kind == MotionKind::kDwell) return m.duration_s;
  double way = glm::length(m.to_mm - m.from_mm) + glm::length(m.to_uvw_mm - m.from_uvw_mm);
  if (m.kind == MotionKind::kArc) {
    way = std::max(way, glm::length(m.from_mm - m.arc.center_mm) * std::abs(m.arc.sweep_rad));
  }
  for (std::size_t i = 0; i < 3; ++i) way += std::abs(m.to_abc_deg[i] - m.from_abc_deg[i]);
  const double feed = m.feed_mm_per_min > 0 && !m.feed_per_rev ? m.feed_mm_per_min / 60 : 0;
  return way / (feed > 0 ? feed : kRapid_mm_per_s);
}

}  // namespace

bool RepeatWatch::seems_endless() const {
  return machine_s_ > kEndless_s || machine_s_ < kStands_s * static_cast<double>(commands_);
}

void RepeatWatch::take(SourceRef source, std::span<const Motion> motions) {
  const SourceRef before = std::exchange(before_, source);
  same_line_ = source == before ? same_line_ + 1 : 0;
  loops_ |= same_line_ > kMostOfALine || (source.file == before.file && source.line < before.line);
  bool fresh = !loops_;
  if (loops_) {
    for (const Motion& motion : motions) {
      machine_s_ += machine_time_s(motion);
      fresh |= is_new(source, motion);
    }
  }
  ++commands_;
  if (!fresh) return;
  ++news_;
  commands_ = 0;
  machine_s_ = 0;
}

bool RepeatWatch::is_new(SourceRef source, const Motion& m) {
  std::uint64_t key = mix(source.file, std::uint64_t{source.line});
  for (int i = 0; i < 3; ++i) {
    key = mix(mix(key, m.to_mm[i]), m.to_uvw_mm[i]);
    key = mix(key, m.to_abc_deg[static_cast<std::size_t>(i)]);
  }
  return insert(key == 0 ? 1 : key);
}

/// True: it was not there, or there is no room to know.
bool RepeatWatch::insert(std::uint64_t key) {
  if (2 * (count_ + 1) > places_.size()) {
    if (places_.size() >= kMostPlaces) return true;
    grow();
  }
  const std::size_t mask = places_.size() - 1;
  std::size_t at = static_cast<std::size_t>(key) & mask;
  while (places_[at] != 0 && places_[at] != key) at = (at + 1) & mask;
  if (places_[at] == key) return false;
  places_[at] = key;
  ++count_;
  return true;
}

void RepeatWatch::grow() {
  const std::vector<std::uint64_t> before = std::exchange(
      places_, std::vector<std::uint64_t>(places_.empty() ? kFirstPlaces : 2 * places_.size()));
  count_ = 0;
  for (const std::uint64_t key : before) {
    if (key != 0) insert(key);
  }
}

}  // namespace kerf
