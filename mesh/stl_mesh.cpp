#include "mesh/stl_mesh.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <optional>

#include "base/small_file.h"
#include "base/text_scan.h"
#include "base/translate.h"

namespace kerf {
namespace {

constexpr std::size_t kTriangle_bytes = 50;

/// STL is little endian.
template <class Value>
Value value_at(std::string_view bytes, std::size_t at) {
  static_assert(std::endian::native == std::endian::little);
  Value value{};
  std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}

Done parse_binary(std::string_view bytes, const std::string& path, float scale,
                  MeshJoiner& joiner) {
  const auto count = value_at<std::uint32_t>(bytes, kStlHead_bytes - 4);
  if (Done fits = joiner.announce(count, path); !fits) return fits;
  for (std::size_t i = 0; i < count; ++i) {
    std::array<glm::vec3, 3> corners{};
    for (std::size_t k = 0; k < 9; ++k) {
      // A normal of three numbers comes first.
      corners[k / 3][static_cast<int>(k % 3)] =
          scale * value_at<float>(bytes, kStlHead_bytes + i * kTriangle_bytes + 12 + 4 * k);
    }
    if (Done added = joiner.add(corners, path); !added) return added;
  }
  return Done{std::monostate{}};
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
  AsciiStl(std::string_view text, const std::string& path, float scale, MeshJoiner& joiner)
      : words_(text), path_(path), scale_(scale), joiner_(joiner) {}

  Done parse() {
    words_.skip_line();  // solid, and its name
    while (true) {
      const std::string_view word = words_.next();
      // Some programs write several solids into one file.
      if (word == "endsolid") {
        words_.skip_line();
        const std::string_view after = words_.next();
        if (after.empty()) return Done{std::monostate{}};
        if (!expect(after, "solid")) return Error{fault_};
        words_.skip_line();
        continue;
      }
      if (!expect(word, "facet") || !read_facet()) return Error{fault_};
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
  bool read_facet() {
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
    const Done added = joiner_.add(corners, path_);
    if (!added) fault_ = added.error();
    return static_cast<bool>(added);
  }

  Words words_;
  const std::string& path_;
  float scale_;
  MeshJoiner& joiner_;
  std::string fault_;
};

}  // namespace

std::size_t triangles_of_stl(std::string_view head, std::size_t size) {
  if (head.size() < kStlHead_bytes) return 0;
  const std::size_t count = value_at<std::uint32_t>(head, kStlHead_bytes - 4);
  return kStlHead_bytes + count * kTriangle_bytes == size ? count : 0;
}

Done parse_stl(std::string_view bytes, const std::string& path, double mm_per_unit,
               MeshJoiner& joiner) {
  const auto scale = static_cast<float>(mm_per_unit);
  if (bytes.empty()) return Error{trf("{}: is empty", path)};
  const bool says_solid = trim(bytes.substr(0, 80)).starts_with("solid");
  if (bytes.size() >= kStlHead_bytes) {
    const std::uint64_t count = value_at<std::uint32_t>(bytes, kStlHead_bytes - 4);
    const std::uint64_t due = kStlHead_bytes + count * kTriangle_bytes;
    // Some programs add a few bytes of their own; a head that begins with "solid" is common too.
    if (due == bytes.size() || (!says_solid && due < bytes.size())) {
      return parse_binary(bytes, path, scale, joiner);
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
  return AsciiStl(bytes, path, scale, joiner).parse();
}

Result<TriangleMesh> parse_stl(std::string_view bytes, const std::string& path,
                               double mm_per_unit) {
  MeshJoiner joiner;
  if (const Done parsed = parse_stl(bytes, path, mm_per_unit, joiner); !parsed)
    return Error{parsed.error()};
  return joiner.take(path);
}

Result<TriangleMesh> read_stl(const std::string& path, double mm_per_unit) {
  const Result<std::string> bytes = read_small_file(path, kMaxStl_bytes);
  if (!bytes) return Error{bytes.error()};
  return parse_stl(*bytes, path, mm_per_unit);
}

}  // namespace kerf
