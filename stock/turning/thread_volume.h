// stock/turning/thread_volume.h - how much of a turned part passes with a lead cut away.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "stock/turning/convex_cut.h"
#include "stock/turning/covered_passes.h"
#include "stock/turning/thread_pass.h"

namespace kerf::turning {

/// Edges of contours as what lies below them, in mm.
struct ProfileEdge {
  double low_z = 0, high_z = 0;
  double low_r = 0, high_r = 0;  ///< at low_z and at high_z
  double sign = 1;               ///< -1: material begins there, upward
};
/// Of the contours, those above `least_r` between two places along z; edges across the axis bound
/// nothing.
void append_edges(std::span<const Contour> contours, double low_z_mm, double high_z_mm,
                  double least_r_mm, std::vector<ProfileEdge>& edges);

/// The first moment about the axis of what two regions have in common, the first one moved by `by`.
/// The sum over pairs of edges of what lies below both of them: exact, whatever the shapes.
double common_moment_mm3(std::span<const ProfileEdge> region, const Vec2& by,
                         std::span<const ProfileEdge> other);

/// Integrates, over the way of a pass, the moment of what it cuts at each place and what `before`
/// and its own turns before have left there.
///
/// The way is divided into cells of cell_mm(), the last one shorter. Between places where corners
/// come to corners the moment is smooth nearly everywhere: an adaptive Simpson rule that is exact
/// for cubics.
class ThreadIntegral {
 public:
  static double cell_mm(const ThreadPass& pass);
  static std::size_t cell_count(const ThreadPass& pass);

  /// Volume that goes in one cell, mm3. `before`: passes that were there, none of them `pass`.
  double cell_mm3(const ThreadPass& pass, std::size_t cell,
                  std::span<const std::shared_ptr<const ThreadPass>> before,
                  std::span<const ProfileEdge> edges);

  /// What the tool meets at one place of its way.
  struct Place {
    double moment_mm3 = 0;
    double area_mm2 = 0;
    double height_mm = 0;  ///< greatest height of it along one radius
  };
  Place look(const ThreadPass& pass, double way_mm,
             std::span<const std::shared_ptr<const ThreadPass>> before,
             std::span<const ProfileEdge> edges);

 private:
  struct Range {
    double low = 0, high = 0;
  };

  void find_beside(const ThreadPass& pass, const Range& ways,
                   std::span<const std::shared_ptr<const ThreadPass>> before);
  void add_beside(const ThreadPass& pass, const ThreadPass& other, double n, const Range& ways);
  void merge_near(const Range& ways);
  /// What is left of the outline at a place, as edges about the controlled point.
  void cut_free(const ThreadPass& pass, double way_mm);
  double moment(const ThreadPass& pass, double way_mm);
  double integrate(const ThreadPass& pass, const Range& ways, double tolerance);

  std::vector<PassBeside> beside_, active_;
  std::vector<ProfileEdge> near_, free_;
  std::vector<double> breaks_;
  std::vector<Contour> region_;
  std::vector<Point> corners_;
  ConvexRegion other_;
  ConvexCut cut_;
  bool moves_ = false;  // active_ moves relative to the tool
};

}  // namespace kerf::turning
