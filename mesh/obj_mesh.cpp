#include "mesh/obj_mesh.h"

#include <fmt/format.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/geometric.hpp>
#include <optional>
#include <span>
#include <vector>

#include "base/geometry.h"
#include "base/text_scan.h"
#include "base/translate.h"

namespace kerf {
namespace {

/// Of the product of two sides: a corner that turns back by rounding alone.
constexpr double kStraight = 1e-4;

/// Every corner turns the same way, so that a fan is all of it and no more.
bool is_convex(std::span<const glm::vec3> face) {
  const std::size_t count = face.size();
  Vec3 normal{0};
  for (std::size_t i = 1; i + 1 < count; ++i)
    normal += glm::cross(Vec3(face[i] - face[0]), Vec3(face[i + 1] - face[0]));
  const double size = glm::length(normal);
  if (!(size > 0)) return true;  // no area, or no numbers: add() has a word for that
  for (std::size_t i = 0; i < count; ++i) {
    const Vec3 in(face[(i + 1) % count] - face[i]);
    const Vec3 out(face[(i + 2) % count] - face[(i + 1) % count]);
    const double turn = glm::dot(glm::cross(in, out), normal) / size;
    if (turn < -kStraight * glm::length(in) * glm::length(out)) return false;
  }
  return true;
}

class Obj {
 public:
  Obj(const std::string& path, float scale, MeshJoiner& joiner)
      : path_(path), scale_(scale), joiner_(joiner) {}

  Done line(std::string_view text) {
    ++line_;
    const std::vector<std::string_view> words = words_of(text.substr(0, text.find('#')));
    if (words.empty()) return Done{std::monostate{}};
    if (words[0] == "v") return corner(words);
    if (words[0] == "f" || words[0] == "fo") return face(words);
    if (words[0] == "surf" || words[0] == "curv" || words[0] == "curv2") {
      return fault(trf("'{}': curved surfaces are not read; triangles are understood", words[0]));
    }
    return Done{std::monostate{}};
  }

 private:
  Error fault(const std::string& text) const {
    return {fmt::format("{}:{}: {}", path_, line_, text)};
  }

  Done corner(const std::vector<std::string_view>& words) {
    glm::vec3 out{0};
    for (std::size_t i = 0; i < 3; ++i) {
      const std::string_view word = i + 1 < words.size() ? words[i + 1] : std::string_view();
      const std::optional<double> value = parse_decimal(word);
      if (!value) return fault(trf("'{}' found where a number is due", shown(word)));
      out[static_cast<int>(i)] = scale_ * static_cast<float>(*value);
    }
    corners_.push_back(out);
    return Done{std::monostate{}};
  }

  Done face(const std::vector<std::string_view>& words) {
    face_.clear();
    for (std::size_t i = 1; i < words.size(); ++i) {
      // CORNER/TEXTURE/NORMAL; counted from 1, or backwards from the last one.
      const std::string_view word = words[i].substr(0, words[i].find('/'));
      std::int64_t number = 0;
      if (!read_number(word, number))
        return fault(trf("'{}' found where a number is due", shown(words[i])));
      const auto count = static_cast<std::int64_t>(corners_.size());
      const std::int64_t index = number < 0 ? count + number : number - 1;
      if (index < 0 || index >= count) {
        return fault(
            trf("corner {} is not there; {} corners are before it", number, corners_.size()));
      }
      face_.push_back(corners_[static_cast<std::size_t>(index)]);
    }
    if (face_.size() < 3) return fault(tr("a face has three corners or more"));
    if (face_.size() > 3 && !is_convex(face_))
      return fault(tr("a face that is not convex; triangles are understood"));
    for (std::size_t i = 1; i + 1 < face_.size(); ++i) {
      if (Done added = joiner_.add({face_[0], face_[i], face_[i + 1]}, path_); !added) return added;
    }
    return Done{std::monostate{}};
  }

  const std::string& path_;
  float scale_;
  MeshJoiner& joiner_;
  std::vector<glm::vec3> corners_;
  std::vector<glm::vec3> face_;
  int line_ = 0;
};

}  // namespace

Done parse_obj(std::string_view bytes, const std::string& path, double mm_per_unit,
               MeshJoiner& joiner) {
  Obj obj(path, static_cast<float>(mm_per_unit), joiner);
  std::string joined;
  while (!bytes.empty()) {
    std::string_view text = trim(take_line(bytes), is_line_blank);
    if (text.ends_with('\\') && !bytes.empty()) {
      // Goes on in the next line.
      joined += std::string(text.substr(0, text.size() - 1)) + ' ';
      continue;
    }
    if (!joined.empty()) {
      joined += text;
      text = joined;
    }
    if (Done done = obj.line(text); !done) return done;
    joined.clear();
  }
  return Done{std::monostate{}};
}

}  // namespace kerf
