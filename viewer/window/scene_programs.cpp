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

Result<GlProgram> ScenePrograms::compiled(unsigned name) {
  switch (name) {
    case kMoving:
      return scene_variant("#define TWO_SIDED\n");
    case kBesideGlass:
      return scene_variant("#define BESIDE_GLASS\n#define TWO_SIDED\n");
    case kBackground:
      return GlProgram::create(shaders::screen_vert, shaders::background_frag);
    case kSectionFace:
      return GlProgram::create(shaders::screen_vert, shaders::section_frag);
    case kGlass:
      return GlProgram::create(shaders::screen_vert, shaders::glass_frag);
    default:
      break;
  }
  // In the order of Paint.
  constexpr std::array kPaints{"", "#define BY_CUT\n", "#define BY_MOVE\n", "#define BY_MEASURE\n"};
  const bool has_section = name % 2 != 0;
  return scene_variant(std::string(kPaints[(name - kWorkpiece) / 2]) +
                       (has_section ? "#define SECTION\n#define TWO_SIDED\n" : ""));
}

Result<ScenePrograms> ScenePrograms::create() {
  ScenePrograms programs;
  for (const unsigned name : {unsigned{kWorkpiece}, unsigned{kMoving}, unsigned{kBackground}}) {
    Result<GlProgram> made = compiled(name);
    if (!made) return Error{made.error()};
    programs.programs_[name] = std::move(*made);
  }
  return programs;
}

const GlProgram& ScenePrograms::program(unsigned name) const {
  if (std::optional<GlProgram>& here = programs_[name]; !here) {
    Result<GlProgram> made = compiled(name);
    release_gl_compiler();
    if (!made && trouble_.empty()) trouble_ = made.error();
    here = made ? std::move(*made) : GlProgram::stand_in();
  }
  return *programs_[name];
}

}  // namespace kerf
