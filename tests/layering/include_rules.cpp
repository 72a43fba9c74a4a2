#include "tests/layering/include_rules.h"

#include <fmt/format.h>

#include <array>
#include <regex>
#include <span>
#include <sstream>

namespace kerf {
namespace {

struct FolderRule {
  std::string_view folder;
  std::vector<std::string_view> may_include;
  std::vector<std::string_view> but_not{};  ///< of these
};

/// The first row whose folder the file lies in decides.
const std::array kFolderRules{
    FolderRule{"base/", {"base/"}},
    FolderRule{"surface/", {"base/", "surface/"}},
    FolderRule{"mesh/", {"base/", "mesh/"}},
    FolderRule{"cutting/", {"base/", "cutting/"}},
    FolderRule{"stock/cutter/", {"base/", "stock/cutter/", "stock/blank.h"}},
    FolderRule{"stock/plane/", {"base/", "stock/plane/", "stock/cutter/scan.h"}},
    FolderRule{"stock/", {"base/", "surface/", "mesh/", "stock/"}},
    FolderRule{"interp_bridge/", {"base/", "interp_bridge/"}},
    FolderRule{"machine_io/", {"base/", "machine_io/"}},
    FolderRule{"viewer/shaders/", {"base/", "viewer/shaders/"}},
    FolderRule{
        "viewer/csg/", {"base/", "surface/", "viewer/"}, {"viewer/raycast/", "viewer/window/"}},
    FolderRule{
        "viewer/raycast/", {"base/", "surface/", "viewer/"}, {"viewer/csg/", "viewer/window/"}},
    FolderRule{"viewer/window/", {"base/", "surface/", "viewer/"}},
    FolderRule{"viewer/",
               {"base/", "surface/", "viewer/"},
               {"viewer/csg/", "viewer/raycast/", "viewer/window/"}},
    // Rooms of twin, each above those that it may include; TheRoomsOfTwinHaveAnOrder.
    FolderRule{"twin/motion/", {"base/", "interp_bridge/", "stock/", "twin/motion/"}},
    FolderRule{"twin/findings/", {"base/", "interp_bridge/", "twin/findings/"}},
    FolderRule{"twin/machine/kinematics/",
               {"base/", "interp_bridge/", "stock/", "twin/motion/", "twin/machine/kinematics/"}},
    FolderRule{"twin/machine/",
               {"base/", "interp_bridge/", "stock/", "twin/motion/", "twin/machine/"}},
    FolderRule{"twin/collision/",
               {"base/", "mesh/", "interp_bridge/", "stock/", "twin/motion/", "twin/machine/",
                "twin/collision/"}},
    FolderRule{"twin/machines/",
               {"base/", "mesh/", "interp_bridge/", "stock/", "twin/motion/", "twin/machine/",
                "twin/collision/", "twin/machines/"}},
    FolderRule{"twin/tool_library/", {"base/", "stock/", "twin/tool_library/"}},
    FolderRule{
        "twin/job/",
        {"base/", "cutting/", "mesh/", "interp_bridge/", "stock/", "twin/motion/", "twin/machine/",
         "twin/collision/", "twin/machines/", "twin/tool_library/", "twin/job/"}},
    FolderRule{"twin/process/milling/",
               {"base/", "cutting/", "mesh/", "surface/", "interp_bridge/", "stock/",
                "twin/motion/", "twin/findings/", "twin/machine/", "twin/collision/",
                "twin/machines/", "twin/job/", "twin/process/"}},
    FolderRule{
        "twin/process/",
        {"base/", "cutting/", "mesh/", "interp_bridge/", "stock/", "twin/motion/", "twin/findings/",
         "twin/machine/", "twin/collision/", "twin/machines/", "twin/job/", "twin/process/"}},
    FolderRule{"twin/compare/",
               {"base/", "mesh/", "surface/", "interp_bridge/", "stock/", "twin/findings/",
                "twin/collision/", "twin/job/", "twin/process/", "twin/compare/"}},
    FolderRule{"twin/report/",
               {"base/", "cutting/", "interp_bridge/", "stock/", "machine_io/", "twin/findings/",
                "twin/machine/", "twin/collision/", "twin/machines/", "twin/job/", "twin/process/",
                "twin/compare/", "twin/report/"}},
    FolderRule{
        "twin/program/",
        {"base/", "cutting/", "mesh/", "interp_bridge/", "stock/", "twin/motion/", "twin/findings/",
         "twin/machine/", "twin/collision/", "twin/machines/", "twin/tool_library/", "twin/job/",
         "twin/process/", "twin/report/", "twin/program/"}},
    FolderRule{"twin/guess/",
               {"base/", "interp_bridge/", "stock/", "twin/motion/", "twin/findings/",
                "twin/machine/", "twin/collision/", "twin/machines/", "twin/job/", "twin/report/",
                "twin/program/", "twin/guess/"}},
    FolderRule{"twin/session/",
               {"base/", "cutting/", "interp_bridge/", "stock/", "twin/motion/", "twin/findings/",
                "twin/machine/", "twin/collision/", "twin/machines/", "twin/job/", "twin/process/",
                "twin/report/", "twin/program/", "twin/guess/", "twin/session/"}},
    FolderRule{"twin/live/",
               {"base/", "cutting/", "interp_bridge/", "stock/", "machine_io/", "twin/motion/",
                "twin/findings/", "twin/machine/", "twin/collision/", "twin/machines/",
                "twin/tool_library/", "twin/job/", "twin/process/", "twin/report/", "twin/program/",
                "twin/live/"}},
    FolderRule{"twin/playback/",
               {"base/", "cutting/", "interp_bridge/", "stock/", "twin/motion/", "twin/findings/",
                "twin/machine/", "twin/collision/", "twin/machines/", "twin/job/", "twin/process/",
                "twin/report/", "twin/program/", "twin/guess/", "twin/playback/"}},
    FolderRule{"twin/scene/",
               {"base/", "surface/", "interp_bridge/", "stock/", "viewer/", "twin/motion/",
                "twin/findings/", "twin/machine/", "twin/collision/", "twin/machines/", "twin/job/",
                "twin/process/", "twin/compare/", "twin/report/", "twin/live/", "twin/playback/",
                "twin/scene/"}},
    FolderRule{"twin/page/",
               {"base/", "mesh/", "interp_bridge/", "stock/", "twin/findings/", "twin/process/",
                "twin/job/load_text.h", "twin/report/", "twin/compare/", "twin/page/"}},
    FolderRule{"twin/diff/",
               {"base/", "surface/", "interp_bridge/", "stock/", "twin/motion/", "twin/findings/",
                "twin/machine/", "twin/process/", "twin/compare/", "twin/diff/"}},
    FolderRule{"twin/optimize/",
               {"base/", "cutting/", "interp_bridge/", "stock/", "twin/motion/", "twin/findings/",
                "twin/machine/", "twin/job/", "twin/process/", "twin/report/", "twin/program/",
                "twin/optimize/"}},
    FolderRule{"twin/config/",
               {"base/", "cutting/", "interp_bridge/", "stock/", "machine_io/", "twin/machine/",
                "twin/collision/", "twin/tool_library/", "twin/job/", "twin/report/", "twin/live/",
                "twin/machines/", "twin/config/"}},
    FolderRule{"twin/batch/",
               {"base/", "interp_bridge/", "twin/report/", "twin/config/", "twin/batch/"}},
    FolderRule{"twin/mcp/",
               {"base/", "interp_bridge/", "stock/cutter/", "twin/page/", "twin/config/",
                "twin/batch/", "twin/mcp/"}},
    FolderRule{"twin/serve/",
               {"base/", "interp_bridge/", "stock/", "viewer/", "twin/findings/", "twin/job/",
                "twin/report/", "twin/session/", "twin/live/", "twin/playback/", "twin/scene/",
                "twin/serve/"}},
    FolderRule{"twin/cli/kerf_machine/",
               {"base/", "interp_bridge/", "machine_io/", "twin/motion/", "twin/machine/",
                "twin/config/", "twin/cli/"}},
    FolderRule{"twin/cli/",
               {"base/", "cutting/", "mesh/", "surface/", "stock/", "interp_bridge/", "machine_io/",
                "viewer/", "twin/"},
               {"twin/cli/kerf_machine/"}},
};

struct LibraryRule {
  std::string_view header;   ///< a header, or a folder of headers if it ends in '/'
  std::string_view folder;   ///< that may include it
  std::string_view also{};   ///< another one
  std::string_view third{};  ///< and another; the only three
};

constexpr std::array kLibraryRules{
    LibraryRule{"yaml-cpp/", "twin/config/"},
    LibraryRule{"CLI/", "twin/cli/"},
    LibraryRule{"nlohmann/", "twin/"},
    LibraryRule{"zip.h", "base/"},
    LibraryRule{"expat.h", "mesh/", "machine_io/mtconnect/", "base/expat_line.h"},
    LibraryRule{"curl/", "machine_io/mtconnect/"},
    LibraryRule{"xxhash.h", "stock/", "twin/batch/", "interp_bridge/"},
    LibraryRule{"polyclipping/", "stock/plane/"},
    LibraryRule{"clipper.hpp", "stock/plane/"},
    LibraryRule{"STEPControl_Reader.hxx", "mesh/kerf_step/"},
    LibraryRule{"canon.hh", "interp_bridge/kerf_interp/"},
    LibraryRule{"interp_base.hh", "interp_bridge/kerf_interp/"},
    LibraryRule{"interp_return.hh", "interp_bridge/kerf_interp/"},
    LibraryRule{"modbus.h", "machine_io/modbus/", "machine_io/simulator/"},
    LibraryRule{"modbus/", "machine_io/modbus/", "machine_io/simulator/"},
    LibraryRule{"linux/can.h", "machine_io/can/", "machine_io/simulator/"},
    LibraryRule{"linux/can/", "machine_io/can/", "machine_io/simulator/"},
    LibraryRule{"hal.h", "machine_io/hal/", "interp_bridge/kerf_interp/"},
    LibraryRule{"linuxcnc/", "machine_io/hal/"},
    LibraryRule{"rcs.hh", "machine_io/hal/"},
    LibraryRule{"emc.hh", "machine_io/hal/"},
    LibraryRule{"emc_nml.hh", "machine_io/hal/"},
    LibraryRule{"microhttpd.h", "twin/serve/"},
    LibraryRule{"GL/", "viewer/"},
    LibraryRule{"GLES3/", "viewer/"},
    LibraryRule{"GLFW/", "viewer/"},
    LibraryRule{"EGL/", "viewer/"},
    LibraryRule{"X11/", "viewer/window/"},
    LibraryRule{"epoxy/", "viewer/"},
    LibraryRule{"imgui/", "viewer/"},
    LibraryRule{"imgui.h", "viewer/"},
    LibraryRule{"png.h", "viewer/"},
    LibraryRule{"stb/", "viewer/"},
};

bool starts_with_any(std::string_view text, std::span<const std::string_view> prefixes) {
  for (const std::string_view prefix : prefixes) {
    if (text.starts_with(prefix)) return true;
  }
  return false;
}

/// The folder of the stock model that `path` belongs to ("stock/zmap/"), or "".
std::string_view stock_model_of(std::string_view path) {
  constexpr std::string_view kStock = "stock/";
  const bool is_shared = path.starts_with("stock/cutter/") || path.starts_with("stock/plane/");
  if (!path.starts_with(kStock) || is_shared) return {};
  const std::size_t end = path.find('/', kStock.size());
  return end == std::string_view::npos ? std::string_view{} : path.substr(0, end + 1);
}

/// The folder of the process that `path` belongs to ("twin/process/torch/"), or "".
std::string_view process_of(std::string_view path) {
  constexpr std::string_view kProcess = "twin/process/";
  if (!path.starts_with(kProcess)) return {};
  const std::size_t end = path.find('/', kProcess.size());
  return end == std::string_view::npos ? std::string_view{} : path.substr(0, end + 1);
}

/// A process is known to its table alone; all others ask for what is in process.h. It knows what
/// processes share, and neither the table nor who calls it.
std::string check_process_include(std::string_view path, std::string_view target) {
  constexpr std::string_view kTable = "twin/process/process_table.cpp";
  const std::string_view own = process_of(path), other = process_of(target);
  if (!other.empty() && other != own && path != kTable) {
    return fmt::format("\"{}\": only {} and {} may include it", target, other, kTable);
  }
  const bool is_above =
      target == "twin/process/cut_stage.h" || target == "twin/process/process_table.h";
  if (!own.empty() && is_above) return fmt::format("a process may not include \"{}\"", target);
  return "";
}

const FolderRule* rule_for(std::string_view path) {
  for (const FolderRule& rule : kFolderRules) {
    if (path.starts_with(rule.folder)) return &rule;
  }
  return nullptr;
}

std::string check_project_include(std::string_view path, bool is_test, std::string_view target,
                                  const std::set<std::string>& project_files) {
  if (!project_files.contains(std::string(target))) {
    return fmt::format("\"{}\" is no file of the project (paths start at the root)", target);
  }
  if (target.starts_with("tests/")) {
    return is_test ? "" : fmt::format("\"{}\" belongs to the tests", target);
  }
  // What a test of a room wants to see may be made in any other.
  const bool sees_all = is_test && path.starts_with("twin/");
  const FolderRule* rule = sees_all ? &kFolderRules.back() : rule_for(path);
  if (rule == nullptr) {
    return is_test ? "" : "lies in a folder that the layers of ARCHITECTURE.md do not name";
  }
  // A test of a part may look at pictures that other parts make.
  const bool is_barred = !is_test && starts_with_any(target, rule->but_not);
  if (is_barred || !starts_with_any(target, rule->may_include)) {
    return fmt::format("{} may not include \"{}\"", rule->folder, target);
  }
  // It writes to devices; kerf must not.
  constexpr std::string_view kSimulator = "machine_io/simulator/";
  if (!is_test && target.starts_with(kSimulator) && !path.starts_with(kSimulator) &&
      rule->folder != "twin/cli/kerf_machine/") {
    return fmt::format("\"{}\": only twin/cli/kerf_machine/ may include it", target);
  }
  if (std::string fault = is_test ? "" : check_process_include(path, target); !fault.empty()) {
    return fault;
  }
  const std::string_view own_model = stock_model_of(path);
  const std::string_view other_model = stock_model_of(target);
  // One stands on two others: a part that is turned and milled. And what looks for loose pieces is
  // none, but goes through heights as their sweeps do.
  const bool stands_on_it =
      (own_model == "stock/millturn/" &&
       (other_model == "stock/turning/" || other_model == "stock/octree/")) ||
      (own_model == "stock/pieces/" && (is_test || other_model == "stock/zmap/"));
  if (!own_model.empty() && !other_model.empty() && own_model != other_model && !stands_on_it) {
    return fmt::format("the model {} may not include the model header \"{}\"", own_model, target);
  }
  return "";
}

std::string check_library_include(std::string_view path, std::string_view target) {
  for (const LibraryRule& rule : kLibraryRules) {
    const bool matches =
        rule.header.ends_with('/') ? target.starts_with(rule.header) : target == rule.header;
    const bool in_also = !rule.also.empty() && path.starts_with(rule.also);
    const bool in_third = !rule.third.empty() && path.starts_with(rule.third);
    if (matches && !path.starts_with(rule.folder) && !in_also && !in_third) {
      return fmt::format("<{}> appears only in {}{}{}{}{}", target, rule.folder,
                         rule.also.empty() ? "" : " and ", rule.also,
                         rule.third.empty() ? "" : " and ", rule.third);
    }
  }
  return "";
}

}  // namespace

std::vector<std::string> find_circles() {
  std::vector<std::string> circles;
  const auto lies_in = [](std::string_view folder, const std::vector<std::string_view>& prefixes) {
    return starts_with_any(folder, prefixes);
  };
  for (const FolderRule& one : kFolderRules) {
    for (const FolderRule& other : kFolderRules) {
      // A folder knows those within it.
      if (one.folder >= other.folder || other.folder.starts_with(one.folder)) continue;
      const bool there =
          lies_in(other.folder, one.may_include) && !lies_in(other.folder, one.but_not);
      const bool back =
          lies_in(one.folder, other.may_include) && !lies_in(one.folder, other.but_not);
      if (there && back) circles.push_back(fmt::format("{} and {}", one.folder, other.folder));
    }
  }
  return circles;
}

std::vector<IncludeLine> find_includes(std::string_view source_text) {
  static const std::regex kInclude(R"(^\s*#\s*include\s*(["<])([^">]+)[">])");
  std::vector<IncludeLine> found;
  std::istringstream in{std::string(source_text)};
  std::string text;
  for (int line = 1; std::getline(in, text); ++line) {
    std::smatch match;
    if (!std::regex_search(text, match, kInclude)) continue;
    found.push_back({line, match[1] == "\"", match[2]});
  }
  return found;
}

std::vector<std::string> check_includes(std::string_view path, std::string_view source_text,
                                        const std::set<std::string>& project_files) {
  const bool is_test = path.starts_with("tests/");
  const std::string_view rights = is_test ? path.substr(6) : path;
  std::vector<std::string> violations;
  for (const IncludeLine& include : find_includes(source_text)) {
    const bool is_bound = !is_test || rule_for(rights) != nullptr;
    std::string fault = is_bound ? check_library_include(rights, include.target) : "";
    if (fault.empty() && include.quoted) {
      fault = check_project_include(rights, is_test, include.target, project_files);
    }
    if (!fault.empty()) violations.push_back(fmt::format("{}:{}: {}", path, include.line, fault));
  }
  return violations;
}

}  // namespace kerf
