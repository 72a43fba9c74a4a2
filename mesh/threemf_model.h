// mesh/threemf_model.h - one .model of a 3MF file: objects, as meshes and as components.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "base/geometry.h"
#include "base/result.h"

namespace kerf {

/// Rows for x, y, z and the shift, as the file has them.
using ThreemfTransform = std::array<Vec3, 4>;

/// An object that is placed: in the build, or within another.
struct ThreemfPlaced {
  std::string part;  ///< the .model that has it; empty: this one
  std::string object;
  ThreemfTransform transform;
};

struct ThreemfObject {
  std::vector<Vec3> corners;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<ThreemfPlaced> components;
};

struct ThreemfModel {
  double mm_per_unit = 1;
  std::map<std::string, ThreemfObject> objects;
  std::vector<ThreemfPlaced> build;
};

/// Reads a .model as it is unpacked.
class ThreemfReader {
 public:
  /// More triangles than `most` are refused. `name`: of the file and the part, for errors.
  ThreemfReader(std::string name, std::size_t most);
  ~ThreemfReader();
  ThreemfReader(const ThreemfReader&) = delete;
  ThreemfReader& operator=(const ThreemfReader&) = delete;

  /// False: there is a fault; no more is needed.
  bool take(std::string_view piece);
  Result<ThreemfModel> finish();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace kerf
