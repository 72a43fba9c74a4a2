// twin/process/cut_labels.h - names for cuts that many of them share: the tool and the line of the
// program.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "base/mesh_patch.h"
#include "interp_bridge/motion.h"

namespace kerf {

/// Who cut, and what came of it so far.
struct CutLabel {
  int tool = 0;
  SourceRef source;  ///< line 0: not known
  double removed_mm3 = 0;
  double cut_s = 0;  ///< of all its moves, those through air as well
  /// It is the same tool and line, whatever they did.
  bool operator==(const CutLabel& other) const {
    return tool == other.tool && source == other.source;
  }
};

/// Numbers labels in the order in which they first come, for StockModel::keep_cut_ids(). A machine
/// that is watched makes a thousand moves a second for weeks; their labels are no more than the
/// program has lines, as often as it is run: about 40 bytes each, at most kMost of them. One
/// thread.
class CutLabels {
 public:
  static constexpr std::size_t kMost = std::size_t{1} << 21;
  /// The number of none.
  static constexpr std::uint32_t kUnknown = MeshPatch::kNotCut - 1;

  /// `most`: beyond it, labels that are new get the number of their tool without a line; and
  /// kUnknown if that is new, too, and kSpare tools have come already.
  explicit CutLabels(std::size_t most = kMost) : most_(most) {}
  static constexpr std::size_t kSpare = 256;

  /// Nanoseconds if it is the one that was asked for last.
  std::uint32_t number_of(const CutLabel& label);

  /// A move of this label has been cut. A number that is none is left out.
  void note(std::uint64_t number, double removed_mm3, double cut_s);

  /// By number. Only grows; until the next call of number_of().
  std::span<const CutLabel> all() const { return labels_; }

 private:
  std::uint32_t find_or_add(const CutLabel& label, std::size_t most);
  std::uint32_t* slot_of(const CutLabel& label);
  void grow();

  std::size_t most_;
  std::vector<CutLabel> labels_;
  std::vector<std::uint32_t> slots_;  ///< open hash table of numbers, a power of two long
  CutLabel last_;
  std::uint32_t last_number_ = kUnknown;
};

}  // namespace kerf
