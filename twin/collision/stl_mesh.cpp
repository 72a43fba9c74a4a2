#include "twin/collision/stl_mesh.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <optional>
#include <unordered_map>

#include "base/small_file.h"
#include "base/text_scan.h"
#include "base/translate.h"
#include "interp_bridge/ini_file.h"

namespace kerf {
namespace {

constexpr std::size_t kHead_bytes = 84;
constexpr std::size_t kTriangle_bytes = 50;
/// Farther away a position has less than a hundredth of a millimetre.
constexpr float kFar_mm = 1e5f;

/// Adds triangles whose corners are joined where they are equal.
class Joiner {
 public:
  bool add(const std::array<glm::vec3, 3>& corners) {
    std::array<std::uint32_t, 3> triangle{};
    for (std::size_t i = 0; i < 3; ++i) {
      const glm::vec3 p = corners[i] + glm::vec3(0.0f);  // -0 becomes 0: they are the same place
      for (int axis = 0; axis < 3; ++axis) {
        if (!(std::abs(p[axis]) <= kFar_mm)) return false;
      }
      triangle[i] = index_of(p);
    }
    const bool flat =
        triangle[0] == triangle[1] || triangle[1] == triangle[2] || triangle[2] == triangle[0];
    if (!flat) mesh_.triangles.push_back(triangle);
    return true;
  }
  TriangleMesh take() { return std::move(mesh_); }

 private:
  struct Hash {
    std::size_t operator()(const glm::vec3& p) const {
      std::uint64_t hash = 0;
      for (int axis = 0; axis < 3; ++axis) {
        hash = (hash ^ std::bit_cast<std::uint32_t>(p[axis])) * 0x9E3779B97F4A7C15ULL;
        hash ^= hash >> 29U;
      }
      return hash;
    }
  };
  std::uint32_t index_of(const glm::vec3& p) {
    const auto next = static_cast<std::uint32_t>(mesh_.positions_mm.size());
    const auto [at, is_new] = places_.try_emplace(p, next);
    if (is_new) mesh_.positions_mm.push_back(p);
    return at->second;
  }

  TriangleMesh mesh_;
  std::unordered_map<glm::vec3, std::uint32_t, Hash> places_;
};

/// STL is little endian.
template <class Value>
Value value_at(std::string_view bytes, std::size_t at) {
  static_assert(std::endian::native == std::endian::little);
  Value value{};
  std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}

Result<TriangleMesh> checked(TriangleMesh mesh, const std::string& path) {
  if (mesh.triangles.empty()) return Error{trf("{}: has no triangles", path)};
  return mesh;
}

Error bad_corner(const std::string& path, std::size_t triangle) {
  return {trf("{}: triangle {}: a corner is no number, or farther away than {} m", path, triangle,
              kFar_mm / 1000)};
}

Result<TriangleMesh> parse_binary(std::string_view bytes, const std::string& path, float scale) {
  const auto count = value_at<std::uint32_t>(bytes, kHead_bytes - 4);
  Joiner joiner;
  for (std::size_t i = 0; i < count; ++i) {
    std::array<glm::vec3, 3> corners{};
    for (std::size_t k = 0; k < 9; ++k) {
      // A normal of three numbers comes first.
      corners[k / 3][static_cast<int>(k % 3)] =
          scale * value_at<float>(bytes, kHead_bytes + i * kTriangle_bytes + 12 + 4 * k);
    }
    if (!joiner.add(corners)) return bad_corner(path, i + 1);
  }
  return checked(joiner.take(), path);
}

/// The words of a text with the lines that they stand in.
class Words {
 public:
  explicit Words(std::string_view text) : text_(text) {}
  /// Empty at the end.
  std::string_view next() {
    while (at_ < text_.size() && is_text_blank(text_[at_])) line_ += text_[at_++] == '\n' ? 1 : 0;
    const std::size_t from = at_;
    while (at_ < text_.size() && !is_text_blank(text_[at_])) ++at_;
    return text_.substr(from, at_ - from);
  }
  void skip_line() { at_ = std::min(text_.find('\n', at_), text_.size()); }
  int line() const { return line_; }

 private:
  std::string_view text_;
  std::size_t at_ = 0;
  int line_ = 1;
};

class AsciiStl {
 public:
  AsciiStl(std::string_view text, const std::string& path, float scale)
      : words_(text), path_(path), scale_(scale) {}

  Result<TriangleMesh> parse() {
    words_.skip_line();  // solid, and its name
    for (std::size_t triangle = 1;; ++triangle) {
      const std::string_view word = words_.next();
      // Some programs write several solids into one file.
      if (word == "endsolid") {
        words_.skip_line();
        const std::string_view after = words_.next();
        if (after.empty()) return checked(joiner_.take(), path_);
        if (!expect(after, "solid")) return Error{fault_};
        words_.skip_line();
        continue;
      }
      if (!expect(word, "facet") || !read_facet(triangle)) return Error{fault_};
    }
  }

 private:
  bool expect(std::string_view found, std::string_view due) {
    if (found == due) return true;
    fault_ = found.empty() ? trf("{}:{}: ends where '{}' is due", path_, words_.line(), due)
                           : trf("{}:{}: '{}' found where '{}' is due", path_, words_.line(),
                                 shown(found), due);
    return false;
  }
  bool read_number(float& out) {
    const std::string_view word = words_.next();
    const std::optional<double> value = parse_decimal(word);
    if (!value) {
      return expect(word, "a number");
    }
    out = static_cast<float>(*value);
    return true;
  }
  bool read_facet(std::size_t triangle) {
    if (!expect(words_.next(), "normal")) return false;
    // Of facets without area some programs write a normal of "nan".
    for (int i = 0; i < 3; ++i) words_.next();
    if (!expect(words_.next(), "outer") || !expect(words_.next(), "loop")) return false;
    std::array<glm::vec3, 3> corners{};
    for (glm::vec3& corner : corners) {
      if (!expect(words_.next(), "vertex")) return false;
      for (int i = 0; i < 3; ++i) {
        if (!read_number(corner[i])) return false;
      }
      corner *= scale_;
    }
    if (!expect(words_.next(), "endloop") || !expect(words_.next(), "endfacet")) return false;
    if (joiner_.add(corners)) return true;
    fault_ = bad_corner(path_, triangle).message;
    return false;
  }

  Words words_;
  const std::string& path_;
  float scale_;
  Joiner joiner_;
  std::string fault_;
};

}  // namespace

Result<TriangleMesh> parse_stl(std::string_view bytes, const std::string& path,
                               double mm_per_unit) {
  const auto scale = static_cast<float>(mm_per_unit);
  if (bytes.empty()) return Error{trf("{}: is empty", path)};
  const bool says_solid = trim(bytes.substr(0, 80)).starts_with("solid");
  if (bytes.size() >= kHead_bytes) {
    const std::uint64_t count = value_at<std::uint32_t>(bytes, kHead_bytes - 4);
    const std::uint64_t due = kHead_bytes + count * kTriangle_bytes;
    // Some programs add a few bytes of their own; a head that begins with "solid" is common too.
    if (due == bytes.size() || (!says_solid && due < bytes.size())) {
      return parse_binary(bytes, path, scale);
    }
    if (!says_solid) {
      return Error{
          trf("{}: cut off, or no STL: {} triangles announced, which take {} bytes, but {} "
              "bytes found",
              path, count, due, bytes.size())};
    }
  }
  if (!says_solid) {
    return Error{
        trf("{}: no STL: {} bytes, and the first word is not 'solid'", path, bytes.size())};
  }
  return AsciiStl(bytes, path, scale).parse();
}

Result<TriangleMesh> read_stl(const std::string& path, double mm_per_unit) {
  const Result<std::string> bytes = read_small_file(path, kMaxStl_bytes);
  if (!bytes) return Error{bytes.error()};
  return parse_stl(*bytes, path, mm_per_unit);
}

}  // namespace kerf
