#include "viewer/window/scene_programs.h"

#include <string>
#include <string_view>
#include <utility>

#include "viewer/shaders/shaders.h"

namespace kerf {
namespace {

/// The source with lines added after the first, which is the version.
std::string with_lines(std::string_view source, const std::string& lines) {
  const std::size_t after_version = source.find('\n') + 1;
  std::string result(source);
  return result.insert(after_version, lines);
}

Result<GlProgram> scene_variant(const std::string& defines) {
  return GlProgram::create(with_lines(shaders::scene_vert, defines).c_str(),
                           with_lines(shaders::scene_frag, defines).c_str());
}

}  // namespace

Result<ScenePrograms> ScenePrograms::create() {
  // In the order of Name; the workpiece's in that of Paint.
  const std::string open = "#define SECTION\n#define TWO_SIDED\n";
  Result<GlProgram> made[]{
      scene_variant(""),
      scene_variant(open),
      scene_variant("#define BY_CUT\n"),
      scene_variant("#define BY_CUT\n" + open),
      scene_variant("#define BY_MOVE\n"),
      scene_variant("#define BY_MOVE\n" + open),
      scene_variant("#define BY_MEASURE\n"),
      scene_variant("#define BY_MEASURE\n" + open),
      scene_variant("#define TWO_SIDED\n"),
      scene_variant("#define BESIDE_GLASS\n#define TWO_SIDED\n"),
      GlProgram::create(shaders::screen_vert, shaders::background_frag),
      GlProgram::create(shaders::screen_vert, shaders::section_frag),
      GlProgram::create(shaders::screen_vert, shaders::glass_frag),
  };
  std::vector<GlProgram> programs;
  for (Result<GlProgram>& program : made) {
    if (!program) return Error{program.error()};
    programs.push_back(std::move(*program));
  }
  return ScenePrograms(std::move(programs));
}

}  // namespace kerf
