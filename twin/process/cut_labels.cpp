#include "twin/process/cut_labels.h"

#include <algorithm>

namespace kerf {
namespace {

constexpr std::uint32_t kFree = ~std::uint32_t{0};
constexpr std::size_t kFirstSlots = 256;

std::size_t hash_of(const CutLabel& label) {
  std::uint64_t h = static_cast<std::uint64_t>(label.source.line) << 32 ^ label.source.file;
  h ^= static_cast<std::uint64_t>(static_cast<std::uint32_t>(label.tool)) << 20;
  // The finisher of MurmurHash3: every bit of the input reaches the low ones.
  h = (h ^ h >> 33) * 0xff51afd7ed558ccdULL;
  h = (h ^ h >> 33) * 0xc4ceb9fe1a85ec53ULL;
  return static_cast<std::size_t>(h ^ h >> 33);
}

}  // namespace

/// Where the label's number is, or belongs.
std::uint32_t* CutLabels::slot_of(const CutLabel& label) {
  const std::size_t mask = slots_.size() - 1;
  std::size_t at = hash_of(label) & mask;
  while (slots_[at] != kFree && !(labels_[slots_[at]] == label)) at = (at + 1) & mask;
  return &slots_[at];
}

/// At most half of the slots are taken.
void CutLabels::grow() {
  if (2 * (labels_.size() + 1) <= slots_.size()) return;
  slots_.assign(std::max(kFirstSlots, 2 * slots_.size()), kFree);
  for (std::size_t i = 0; i < labels_.size(); ++i) {
    *slot_of(labels_[i]) = static_cast<std::uint32_t>(i);
  }
}

std::uint32_t CutLabels::find_or_add(const CutLabel& label, std::size_t most) {
  grow();
  std::uint32_t* const slot = slot_of(label);
  if (*slot != kFree) return *slot;
  if (labels_.size() >= most) return kUnknown;
  *slot = static_cast<std::uint32_t>(labels_.size());
  labels_.push_back({label.tool, label.source});
  return *slot;
}

void CutLabels::note(std::uint64_t number, double removed_mm3, double cut_s) {
  if (number >= labels_.size()) return;
  labels_[number].removed_mm3 += removed_mm3;
  labels_[number].cut_s += cut_s;
}

std::uint32_t CutLabels::number_of(const CutLabel& label) {
  if (label == last_ && last_number_ != kUnknown) return last_number_;
  std::uint32_t number = find_or_add(label, most_);
  if (number == kUnknown) number = find_or_add({label.tool, {}}, most_ + kSpare);
  last_ = label;
  last_number_ = number;
  return number;
}

}  // namespace kerf
