#include "twin/findings/finding.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/translate.h"

namespace kerf {
namespace {

/// As deep as the same contact was before.
constexpr double kSameDepth_mm = 0.005;

/// Two decimals, and never "-0.00".
std::string coordinate(double value) {
  const double rounded = std::round(value * 100) / 100;
  return fmt::format("{:.2f}", rounded == 0 ? 0.0 : rounded);
}

const char* depth_word(FindingId id) {
  if (id == FindingId::kBelowStock) return tr("below its floor");
  if (id == FindingId::kExcess) return tr("at most");
  return id == FindingId::kOffPath ? tr("off at most, first") : tr("deep");
}

}  // namespace

std::string message_of(const Finding& finding) {
  std::string out = finding.text;
  if (finding.depth_mm) {
    out += fmt::format(", {:.2f} mm {}", *finding.depth_mm, depth_word(finding.id));
  }
  if (finding.position_mm) {
    const Vec3& p = *finding.position_mm;
    out += trf(" at X{} Y{} Z{}", coordinate(p.x), coordinate(p.y), coordinate(p.z));
    if (finding.tool) out += trf(" (tool {})", *finding.tool);
  }
  if (finding.times > 1) out += trf("; {} times, deepest here", finding.times);
  return out;
}

Diagnostic diagnostic_of(const Finding& finding, const std::vector<std::string>& files) {
  Diagnostic out;
  out.severity = finding.severity;
  out.line = static_cast<int>(finding.source.line);
  out.file = finding.file;
  if (out.file.empty() && finding.source.file < files.size()) out.file = files[finding.source.file];
  out.excerpt = finding.excerpt;
  out.hint = finding.hint;
  out.message = fmt::format("{}: {}", to_string(finding.id), message_of(finding));
  return out;
}

FindingLog::Handle FindingLog::add(Finding finding) {
  if (muted_) return kMaxKept;
  if (const std::optional<Handle> before = repeated(finding)) return repeat(*before, finding);
  ++counts_[static_cast<std::size_t>(finding.severity)];
  if (kept_.size() >= kMaxKept) return kMaxKept;
  kept_.push_back(std::move(finding));
  return kept_.size() - 1;
}

std::optional<FindingLog::Handle> FindingLog::repeated(const Finding& finding) const {
  if (!joins_repeats_ || !finding.has_bodies() || finding.bodies[1] == kWorkpieceBody ||
      finding.id == FindingId::kNearMiss)
    return std::nullopt;
  for (Handle handle = kept_.size(); handle-- > 0;) {
    const Finding& kept = kept_[handle];
    if (kept.source == finding.source && kept.id == finding.id &&
        kept.severity == finding.severity && kept.tool == finding.tool &&
        kept.bodies == finding.bodies)
      return handle;
  }
  return std::nullopt;
}

FindingLog::Handle FindingLog::repeat(Handle handle, const Finding& finding) {
  ++kept_[handle].times;
  events_[handle] = {finding.time_s, finding.position_mm};
  if (finding.depth_mm) deepen(handle, *finding.depth_mm);
  return handle;
}

void FindingLog::raise(Handle handle, Severity severity) {
  if (handle >= kept_.size()) return;
  --counts_[static_cast<std::size_t>(kept_[handle].severity)];
  ++counts_[static_cast<std::size_t>(severity)];
  kept_[handle].severity = severity;
}

void FindingLog::forget_from(std::size_t count) {
  while (kept_.size() > count) {
    --counts_[static_cast<std::size_t>(kept_.back().severity)];
    kept_.pop_back();
  }
}

void FindingLog::join(const FindingLog& other, const std::vector<std::string>& files) {
  for (std::size_t i = 0; i < other.kept_.size() && kept_.size() < kMaxKept; ++i) {
    Finding& finding = kept_.emplace_back(other.kept_[i]);
    const std::size_t file = finding.source.file;
    if (finding.file.empty() && file < files.size()) finding.file = files[file];
  }
  for (std::size_t i = 0; i < 3; ++i) counts_[i] += other.counts_[i];
}

void FindingLog::deepen(Handle handle, double depth_mm) {
  if (handle >= kept_.size()) return;
  Finding& finding = kept_[handle];
  const auto event = events_.find(handle);
  if (event != events_.end()) {
    if (depth_mm <= finding.depth_mm.value_or(0.0) + kSameDepth_mm) return;
    finding.time_s = event->second.time_s;
    finding.position_mm = event->second.position_mm;
  }
  finding.depth_mm = std::max(finding.depth_mm.value_or(0.0), depth_mm);
}

}  // namespace kerf
