#include "twin/findings/finding.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/translate.h"

namespace kerf {
namespace {

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
  ++counts_[static_cast<std::size_t>(finding.severity)];
  if (kept_.size() >= kMaxKept) return kMaxKept;
  kept_.push_back(std::move(finding));
  return kept_.size() - 1;
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
  finding.depth_mm = std::max(finding.depth_mm.value_or(0.0), depth_mm);
}

}  // namespace kerf
