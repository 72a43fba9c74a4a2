#include "mesh/threemf_mesh.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "base/text_scan.h"
#include "base/translate.h"
#include "base/zip_file.h"
#include "mesh/threemf_model.h"

namespace kerf {
namespace {

/// Components within components; and all that are placed, so that a small file with objects in
/// objects does not become a year of work.
constexpr int kDeepest = 32;
constexpr int kMostPlaced = 100'000;

/// Names of parts are compared without the slash that they may begin with, in no case.
std::string key_of(std::string_view part) {
  take_prefix(part, "/");
  return to_lower(part);
}

ThreemfTransform then(const ThreemfTransform& inner, const ThreemfTransform& outer) {
  ThreemfTransform out{};
  for (std::size_t row = 0; row < 4; ++row) {
    const Vec3& in = inner[row];
    out[row] = in.x * outer[0] + in.y * outer[1] + in.z * outer[2];
  }
  out[3] += outer[3];
  return out;
}

class Threemf {
 public:
  Threemf(std::string_view bytes, const std::string& path, MeshJoiner& joiner)
      : bytes_(bytes), path_(path), joiner_(joiner) {}

  Done parse() {
    std::optional<std::vector<std::string>> names = names_in_zip(bytes_);
    if (!names) return fault(tr("is no whole zip file"));
    names_ = std::move(*names);
    std::string root = "3d/3dmodel.model";
    if (!number_of(root)) {
      const auto is_model = [](const std::string& name) {
        return key_of(name).ends_with(".model");
      };
      const auto at = std::ranges::find_if(names_, is_model);
      if (at == names_.end()) return fault(tr("is a zip file without a .model in it"));
      root = key_of(*at);
    }
    if (Done done = read_part(root); !done) return done;
    scale_ = parts_.at(root).mm_per_unit;
    for (const ThreemfPlaced& item : parts_.at(root).build) {
      if (Done done = place(item, root, item.transform, 0); !done) return done;
    }
    return Done{std::monostate{}};
  }

 private:
  Error fault(const std::string& text) const { return {fmt::format("{}: {}", path_, text)}; }

  std::optional<std::size_t> number_of(const std::string& key) const {
    for (std::size_t i = 0; i < names_.size(); ++i)
      if (key_of(names_[i]) == key) return i;
    return std::nullopt;
  }

  Done read_part(const std::string& key) {
    if (parts_.contains(key)) return Done{std::monostate{}};
    const std::optional<std::size_t> number = number_of(key);
    if (!number) return fault(trf("has no part '{}'", shown(key)));
    const std::string& name = names_[*number];
    ThreemfReader reader(path_ + ": " + shown(name), joiner_.most());
    const Unpacked end = unpack_zip(bytes_, *number, kMaxModel_bytes,
                                    [&](std::string_view piece) { return reader.take(piece); });
    if (end == Unpacked::kDamaged) return fault(trf("'{}' cannot be unpacked", shown(name)));
    if (end == Unpacked::kTooLarge) {
      return fault(trf("'{}' is larger than {} MB", shown(name), kMaxModel_bytes / (1024 * 1024)));
    }
    Result<ThreemfModel> model = reader.finish();
    if (!model) return Error{model.error()};
    parts_.emplace(key, std::move(model.value()));
    return Done{std::monostate{}};
  }

  Done place(const ThreemfPlaced& placed, const std::string& part,
             const ThreemfTransform& transform, int deep) {
    if (deep > kDeepest || ++placed_ > kMostPlaced)
      return fault(tr("has objects within objects without end"));
    const std::string key = placed.part.empty() ? part : key_of(placed.part);
    if (Done done = read_part(key); !done) return done;
    const auto& objects = parts_.at(key).objects;
    const auto object = objects.find(placed.object);
    if (object == objects.end())
      return fault(trf("object '{}' is placed, but not there", shown(placed.object)));
    if (Done done = add(object->second, transform); !done) return done;
    for (const ThreemfPlaced& component : object->second.components) {
      Done done = place(component, key, then(component.transform, transform), deep + 1);
      if (!done) return done;
    }
    return Done{std::monostate{}};
  }

  Done add(const ThreemfObject& object, const ThreemfTransform& t) {
    for (const auto& triangle : object.triangles) {
      std::array<glm::vec3, 3> corners{};
      for (std::size_t i = 0; i < 3; ++i) {
        const Vec3& p = object.corners[triangle[i]];
        corners[i] = glm::vec3(scale_ * (p.x * t[0] + p.y * t[1] + p.z * t[2] + t[3]));
      }
      if (Done added = joiner_.add(corners, path_); !added) return added;
    }
    return Done{std::monostate{}};
  }

  std::string_view bytes_;
  const std::string& path_;
  MeshJoiner& joiner_;
  std::vector<std::string> names_;
  std::map<std::string, ThreemfModel> parts_;
  double scale_ = 1;
  int placed_ = 0;
};

}  // namespace

Done parse_3mf(std::string_view bytes, const std::string& path, MeshJoiner& joiner) {
  return Threemf(bytes, path, joiner).parse();
}

}  // namespace kerf
