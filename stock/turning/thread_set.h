// stock/turning/thread_set.h - all grooves of a turned part that wind.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "stock/turning/thread_volume.h"

namespace kerf::turning {

/// Passes, and how much each of them has taken of the region that turns, in the order in which they
/// came: what two have cut is the first one's. A pass that another one covers is dropped; so twenty
/// passes of a thread leave one. Copies share passes and cells.
class ThreadSet {
 public:
  bool empty() const { return passes_.empty(); }
  std::span<const std::shared_ptr<const ThreadPass>> passes() const { return passes_; }
  double volume_mm3() const;

  /// `replaces`: passes that are parts of the new ones. `region` is the part's, as far as it is
  /// there at any angle.
  void add(std::vector<std::shared_ptr<const ThreadPass>> fresh,
           std::span<const std::shared_ptr<const ThreadPass>> replaces,
           std::span<const Contour> region);
  /// The region has lost something within `changed`.
  void refresh(const Rect& changed, std::span<const Contour> region);
  /// Passes as they were saved, in their order.
  void restore(std::vector<std::shared_ptr<const ThreadPass>> passes,
               std::span<const Contour> region);

  /// Takes out of the region what is cut at one angle, in turns, between two places along z at
  /// least. Of one that is marked the new edges have the passes' ids.
  void carve(double turns, double low_z_mm, double high_z_mm, ConvexCut& cut,
             std::vector<Contour>& region) const;
  /// Round all that any of them sweeps.
  Rect box() const;
  std::size_t unique_bytes() const;

  ThreadIntegral& integral() { return scratch_.integral; }

 private:
  struct Scratch {
    Scratch() = default;
    Scratch(const Scratch&) {}
    Scratch& operator=(const Scratch&) { return *this; }
    ThreadIntegral integral;
    ConvexCut cut;
    ConvexRegion swept;
    std::vector<ProfileEdge> edges;
  };
  using Cells = std::vector<double>;

  /// Anew from cell `first` on.
  void measure(std::size_t pass, std::size_t first, std::span<const Contour> region);
  void drop(std::size_t pass);

  std::vector<std::shared_ptr<const ThreadPass>> passes_;
  std::vector<std::shared_ptr<const Cells>> cells_;  // of each pass, mm3
  std::vector<double> volumes_mm3_;
  Scratch scratch_;
};

}  // namespace kerf::turning
