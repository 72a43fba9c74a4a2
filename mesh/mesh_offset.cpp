#include "mesh/mesh_offset.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <initializer_list>
#include <vector>

#include "base/portable_math.h"
#include "base/translate.h"
#include "mesh/smooth_skin.h"
#include "mesh/surface_sides.h"

namespace kerf {
namespace {

/// Of a step, the sides of a triangle on a sphere: no point of it is farther from a corner than
/// half a step then, by the circle that holds it.
constexpr double kSide = 0.866;
/// Cosines: normals at a corner that are farther from their middle, or two at an edge that are
/// farther apart, span no triangles on a sphere that are sure to cover what lies between them; the
/// whole sphere does.
constexpr double kNearMiddle = 0.1, kMostTurn = -0.5;
/// Directions that differ by less are one.
constexpr double kSame = 1e-12;

class Grower {
 public:
  Grower(const MeshBody& body, double allowance_mm)
      : body_(body),
        allowance_(allowance_mm),
        step_rad_(2 * portable::acos(1 - std::min(1.0, kRounding_mm / allowance_mm))),
        least_cosine_(portable::cos(kSide * step_rad_)),
        out_{body.mesh.positions_mm, {}} {}

  bool add_all() {
    find_normals();
    skin_ = smooth_skin(body_.mesh, normals_, halves_, allowance_, kRounding_mm);
    const auto base = static_cast<std::uint32_t>(out_.positions_mm.size());
    out_.positions_mm.insert(out_.positions_mm.end(), skin_.outer_mm.begin(), skin_.outer_mm.end());
    for (std::size_t t = 0; t < normals_.size(); ++t) {
      const auto& c = body_.mesh.triangles[t];
      // A prism's lower side is where the body ends: neither is left.
      out_.triangles.push_back(
          skin_.has_prism(t) ? std::array{base + c[0], base + c[1], base + c[2]} : c);
      if (skin_.faces[t] != SmoothSkin::Face::kSkin) add_face(t);
    }
    return add_edges() && add_corners();
  }
  TriangleMesh take() { return std::move(out_); }

 private:
  struct Fan {
    std::uint32_t corner;
    Vec3 first, second;  ///< normals of the faces at an edge that ends there
  };

  Vec3 position(std::uint32_t n) const { return Vec3(body_.mesh.positions_mm[n]); }
  Vec3 out(std::uint32_t n, const Vec3& direction) const {
    return position(n) + allowance_ * direction;
  }
  bool has_room() const { return out_.triangles.size() <= kMostGrown; }

  void find_normals() {
    const TriangleMesh& mesh = body_.mesh;
    std::vector<std::uint32_t> flat;
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
      const Vec3 a = position(mesh.triangles[t][0]);
      const Vec3 normal =
          glm::cross(position(mesh.triangles[t][1]) - a, position(mesh.triangles[t][2]) - a);
      const double length = glm::length(normal);
      normals_.push_back(length > kSame ? normal / length : Vec3(0));
      if (length <= kSame) flat.push_back(t);
    }
    halves_ = sorted_half_edges(mesh);
    if (flat.empty()) return;
    // Without a direction of its own it has that of the face at its longest edge.
    for (std::size_t n = 0; n + 1 < halves_.size(); n += 2) {
      for (const auto& [one, other] : {std::pair(halves_[n].number, halves_[n + 1].number),
                                       std::pair(halves_[n + 1].number, halves_[n].number)}) {
        if (normals_[one / 3] == Vec3(0) && is_longest(one))
          normals_[one / 3] = normals_[other / 3];
      }
    }
  }
  bool is_longest(std::uint32_t number) const {
    const auto& c = body_.mesh.triangles[number / 3];
    const auto length = [&](std::size_t k) {
      return glm::distance(position(c[k % 3]), position(c[(k + 1) % 3]));
    };
    const std::size_t k = number % 3;
    return length(k) >= length(k + 1) && length(k) >= length(k + 2);
  }

  /// A convex piece of triangles, turned so that it encloses its space.
  void add_piece(std::initializer_list<glm::vec3> corners,
                 std::initializer_list<std::array<std::uint32_t, 3>> triangles) {
    const auto base = static_cast<std::uint32_t>(out_.positions_mm.size());
    out_.positions_mm.insert(out_.positions_mm.end(), corners);
    const Vec3 origin(out_.positions_mm[base]);
    double volume = 0;
    for (const auto& t : triangles) {
      const auto at = [&](std::size_t k) { return Vec3(out_.positions_mm[base + t[k]]) - origin; };
      volume += glm::dot(at(0), glm::cross(at(1), at(2)));
    }
    if (volume == 0) {
      out_.positions_mm.resize(base);
      return;
    }
    for (const auto& t : triangles) {
      out_.triangles.push_back({base + t[0], base + t[1], base + t[2]});
      if (volume < 0) std::swap(out_.triangles.back()[1], out_.triangles.back()[2]);
    }
  }
  /// Between two triangles.
  void add_prism(const std::array<Vec3, 3>& low, const std::array<Vec3, 3>& high) {
    add_piece(
        {glm::vec3(low[0]), glm::vec3(low[1]), glm::vec3(low[2]), glm::vec3(high[0]),
         glm::vec3(high[1]), glm::vec3(high[2])},
        {{2, 1, 0}, {3, 4, 5}, {0, 1, 4}, {0, 4, 3}, {1, 2, 5}, {1, 5, 4}, {2, 0, 3}, {2, 3, 5}});
  }

  void add_face(std::size_t t) {
    const auto& c = body_.mesh.triangles[t];
    const Vec3& n = normals_[t];
    add_prism({position(c[0]), position(c[1]), position(c[2])},
              {out(c[0], n), out(c[1], n), out(c[2], n)});
  }

  bool add_edges() {
    // Of a closed mesh whose triangles agree as many go one way along an edge as the other.
    for (std::size_t begin = 0, end = 0; begin < halves_.size(); begin = end) {
      for (end = begin; end < halves_.size() && halves_[end].ends == halves_[begin].ends; ++end) {
      }
      for (std::size_t i = begin; i < end; ++i) {
        for (std::size_t k = i + 1; k < end; ++k) {
          if (halves_[i].is_rising == halves_[k].is_rising) continue;
          add_walls(halves_[i].number, halves_[k].number);
          if (!is_skin(halves_[i].number) || !is_skin(halves_[k].number))
            add_edge(halves_[i].number, halves_[k].number);
        }
      }
      if (!has_room()) return false;
    }
    return true;
  }
  bool is_skin(std::uint32_t half) const {
    return skin_.faces[half / 3] == SmoothSkin::Face::kSkin;
  }
  /// Where of two triangles at an edge one has a prism.
  void add_walls(std::uint32_t one, std::uint32_t other) {
    if (skin_.has_prism(one / 3) == skin_.has_prism(other / 3)) return;
    const std::uint32_t half = skin_.has_prism(one / 3) ? one : other;
    const auto& c = body_.mesh.triangles[half / 3];
    const auto base = static_cast<std::uint32_t>(body_.mesh.positions_mm.size());
    const std::uint32_t a = c[half % 3], b = c[(half + 1) % 3];
    if (a < b) {
      out_.triangles.push_back({a, b, base + b});
      out_.triangles.push_back({a, base + b, base + a});
    } else {
      out_.triangles.push_back({a, b, base + a});
      out_.triangles.push_back({b, base + b, base + a});
    }
  }
  void add_edge(std::uint32_t one, std::uint32_t other) {
    const auto& c = body_.mesh.triangles[one / 3];
    const std::uint32_t a = c[one % 3], b = c[(one + 1) % 3];
    const Vec3 &n = normals_[one / 3], &m = normals_[other / 3];
    if (glm::distance(n, m) <= kSame) return;
    fans_.push_back({a, n, m});
    fans_.push_back({b, n, m});
    const auto& far = body_.mesh.triangles[other / 3];
    const Vec3 beyond = position(far[(other + 2) % 3]) - position(a);
    if (glm::dot(beyond, n) > 0) return;  // it lies deep: the faces' pieces overlap
    const double angle = portable::acos(std::clamp(glm::dot(n, m), -1.0, 1.0));
    const int parts = static_cast<int>(std::ceil(angle / step_rad_));
    // About the edge, from one face to the other.
    const Vec3 side = glm::cross(n, glm::normalize(position(b) - position(a)));
    const double sense = glm::dot(m, side) < 0 ? -1 : 1;
    Vec3 from = n;
    for (int p = 1; p <= parts; ++p) {
      const double turn = angle * p / parts;
      const Vec3 to = p == parts ? m : portable::cos(turn) * n + portable::sin(turn) * sense * side;
      add_prism({position(a), out(a, from), out(a, to)}, {position(b), out(b, from), out(b, to)});
      from = to;
    }
  }

  bool add_corners() {
    std::sort(fans_.begin(), fans_.end(),
              [](const Fan& x, const Fan& y) { return x.corner < y.corner; });
    for (std::size_t begin = 0, end = 0; begin < fans_.size(); begin = end) {
      Vec3 sum(0);
      for (end = begin; end < fans_.size() && fans_[end].corner == fans_[begin].corner; ++end)
        sum += fans_[end].first + fans_[end].second;
      add_corner(std::span(fans_).subspan(begin, end - begin), sum);
      if (!has_room()) return false;
    }
    return true;
  }
  void add_corner(std::span<const Fan> fans, const Vec3& sum) {
    const double length = glm::length(sum);
    const Vec3 middle = length > kSame ? sum / length : Vec3(0, 0, 1);
    bool is_open = false;
    for (const Fan& fan : fans) {
      is_open = is_open || glm::dot(middle, fan.first) < kNearMiddle ||
                glm::dot(middle, fan.second) < kNearMiddle ||
                glm::dot(fan.first, fan.second) < kMostTurn;
    }
    if (is_open) return add_sphere(fans[0].corner);
    for (const Fan& fan : fans) add_cap(fan.corner, {middle, fan.first, fan.second});
  }
  void add_sphere(std::uint32_t corner) {
    for (const double x : {-1.0, 1.0})
      for (const double y : {-1.0, 1.0})
        for (const double z : {-1.0, 1.0})
          add_cap(corner, {Vec3(x, 0, 0), Vec3(0, y, 0), Vec3(0, 0, z)});
  }
  /// The cone from a corner to a triangle on the sphere about it, whose longest side is halved
  /// until none is too long. Triangles that share a side halve it in the same places; of narrow
  /// ones there are few.
  void add_cap(std::uint32_t corner, const std::array<Vec3, 3>& directions) {
    std::size_t longest = 0;
    double least = 2;
    for (std::size_t k = 0; k < 3; ++k) {
      const double cosine = glm::dot(directions[k], directions[(k + 1) % 3]);
      if (cosine >= least) continue;
      least = cosine;
      longest = k;
    }
    if (least >= least_cosine_) {
      add_piece({glm::vec3(position(corner)), glm::vec3(out(corner, directions[0])),
                 glm::vec3(out(corner, directions[1])), glm::vec3(out(corner, directions[2]))},
                {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}});
      return;
    }
    const std::size_t next = (longest + 1) % 3;
    const Vec3 middle = glm::normalize(directions[longest] + directions[next]);
    std::array<Vec3, 3> half = directions;
    half[next] = middle;
    add_cap(corner, half);
    half = directions;
    half[longest] = middle;
    add_cap(corner, half);
  }

  const MeshBody& body_;
  double allowance_, step_rad_, least_cosine_;
  TriangleMesh out_;
  SmoothSkin skin_;
  std::vector<Vec3> normals_;
  std::vector<HalfEdge> halves_;
  std::vector<Fan> fans_;
};

}  // namespace

Result<MeshBody> grown(const MeshBody& body, double allowance_mm, const std::string& name) {
  Grower grower(body, allowance_mm);
  if (!grower.add_all()) {
    return Error{
        trf("{}: with an allowance its {} triangles become more than {} million; export "
            "it with a greater deviation",
            name, body.mesh.triangles.size(), kMostGrown / 1'000'000)};
  }
  MeshBody out = body;
  out.mesh = grower.take();
  out.allowance_mm = allowance_mm;
  out.box_mm = {};
  for (const auto& triangle : out.mesh.triangles)
    for (const std::uint32_t n : triangle) out.box_mm.extend(Vec3(out.mesh.positions_mm[n]));
  return out;
}

}  // namespace kerf
