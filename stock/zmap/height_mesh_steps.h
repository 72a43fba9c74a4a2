// stock/zmap/height_mesh_steps.h - the squares of the mesher's lattice through which walls run.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "base/geometry.h"
#include "stock/zmap/cell_step.h"
#include "stock/zmap/height_mesh_relief.h"

namespace kerf {

/// A square between four nodes is divided where its edges have a step:
///
///      d-----P--c      Each P is two points above each other, where a wall crosses the edge: one
///      |     |  |      belongs to the surface on this side of the wall, one to that on the other.
///      |     |  |      Two of them are joined by a wall; where the wall turns sharply, by way of
///      a-----P--b      the corner that the squares beside it point to; there more than two meet.
///
/// All that is put on an edge depends on the edge alone, so the squares fit together. Where nothing
/// is left of one side, it is not there, neither above nor on the floor.
class StepSquares {
 public:
  /// `relief` must outlive this. `steps` in the order of cell_steps(). Between a cell with material
  /// and one without there is a step in any case, half way where none is given, unless
  /// `given_only`: for surplus_mm3() alone.
  StepSquares(const Relief& relief, std::span<const CellStep> steps, bool given_only = false);

  /// The square whose low corner is node (i, j): has been divided; has a part without material.
  bool is_divided(int i, int j) const { return divided_[corner(i, j)]; }
  bool is_open(int i, int j) const { return has_holes_ && is_open_square(i, j); }

  /// Where the edge between two neighbouring nodes has a step, its two points: on the side of
  /// (i, j), and on that of (i2, j2).
  struct Points {
    NodeKey here, there;
  };
  std::optional<Points> points(int i, int j, int i2, int j2) const;

  /// The surface and the walls in the divided squares; and the floor in those that are open.
  void add_surface(std::vector<NodeTriangle>& out);
  void add_floor(std::vector<NodeTriangle>& out);
  /// How much more material one divided square has than its corners say, which stand for a quarter
  /// each: of its walls alone, from their feet up to the higher side. What rises beside them is as
  /// the corners have it.
  double surplus_mm3(int i, int j) const;

  /// Keys from Relief's last one on.
  bool is_own(NodeKey key) const { return key >= first_key_; }
  std::size_t key_count() const { return first_key_ + positions_.size(); }
  glm::vec3 position_mm(NodeKey key) const { return positions_[key - first_key_]; }

 private:
  struct Edge {
    std::uint64_t at;  ///< number of the node of low x, y, twice, and the axis
    float part;
    float foot_mm;
  };
  struct Square;
  struct Plan;
  struct Corner {
    int i, j;
  };
  static constexpr std::size_t kNone = ~std::size_t{0};

  std::size_t corner(int i, int j) const {
    return static_cast<std::size_t>(j) * static_cast<std::size_t>(relief_.width()) +
           static_cast<std::size_t>(i);
  }
  std::uint64_t edge_number(int i, int j, int axis) const { return 2 * corner(i, j) + axis; }
  bool is_open_square(int i, int j) const;
  void take_steps(std::span<const CellStep> steps);
  void take_holes();
  void put_points();
  std::size_t find(int i, int j, int axis) const;
  Points points_of(std::size_t edge, Corner a, Corner b) const;
  Square square(int i, int j) const;
  std::optional<glm::dvec2> course(Corner low, std::size_t through) const;
  void put_border_points();
  bool find_ways(const Square& s, std::array<glm::dvec2, 4>& ways) const;
  std::optional<glm::dvec2> meeting(const Square& s, const std::array<glm::dvec2, 4>& ways) const;
  Plan plan(const Square& s) const;
  double wall_mm(const Square& s, std::size_t k) const;
  double bulge_mm2(const Square& s, const Plan& plan) const;
  double part_mm2(const Square& s, std::size_t a, std::size_t b, const glm::dvec2* middle) const;
  NodeKey own_key(const glm::dvec2& xy, float z);
  void add_square(int i, int j, std::vector<NodeTriangle>& out);
  std::size_t go_round(const Square& s, std::size_t a, std::size_t b, NodeKey* keys) const;
  void add_chord(const Square& s, std::size_t a, std::size_t b, std::vector<NodeTriangle>& out);
  void add_around(const Square& s, const glm::dvec2& middle, std::vector<NodeTriangle>& out);
  void add_saddle(const Square& s, std::size_t cut_off, std::vector<NodeTriangle>& out);
  void add_polygon(std::span<const NodeKey> polygon, std::vector<NodeTriangle>& out);
  void add_open_floor(int i, int j, std::vector<NodeTriangle>& out);
  bool is_on_floor(NodeKey key) const;
  glm::dvec3 place(NodeKey key) const;

  const Relief& relief_;
  bool has_holes_;
  NodeKey first_key_;
  std::vector<Edge> edges_;
  std::vector<std::size_t> row_begin_;  ///< of edges_, by row of nodes
  std::vector<bool> divided_;           ///< by low corner
  std::vector<std::uint32_t> squares_;  ///< the divided ones, in order
  std::vector<glm::vec3> positions_;    ///< of own keys
  /// How a divided square was: where its walls meet, or which corner is cut off.
  struct Layout {
    enum class Kind : std::uint8_t { kChord, kAround, kSaddle } kind = Kind::kChord;
    std::uint8_t cut_off = 0;
    NodeKey floor = 0;  ///< kAround: in the middle
  };
  std::vector<Layout> layouts_;  ///< as squares_
};

}  // namespace kerf
