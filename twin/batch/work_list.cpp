#include "twin/batch/work_list.h"

#include <glob.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <iostream>
#include <set>
#include <system_error>

#include "base/small_file.h"
#include "base/text_scan.h"
#include "base/translate.h"

namespace kerf {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMaxListBytes = 64U << 20U;

/// Where a name was written: in a list, or (line 0) on the command line.
struct ListPlace {
  std::string list;
  int line = 0;
  std::string text;
};

class WorkList {
 public:
  explicit WorkList(Diagnostics& diagnostics) : diagnostics_(diagnostics) {}

  void add(const std::string& what) {
    std::error_code ignored;
    const bool is_list =
        what == "-" ||
        (!is_program_name(what) && !fs::is_directory(what, ignored) && fs::exists(what, ignored));
    if (is_list) {
      add_list(what);
    } else {
      add_one(what, {});
    }
  }

  std::vector<std::string> take() { return std::move(programs_); }

 private:
  void fault(const ListPlace& place, std::string message, std::string hint = {}) {
    Diagnostic d;
    d.file = place.list;
    d.line = place.line;
    d.column = place.line > 0 ? 1 : 0;
    d.message = std::move(message);
    d.excerpt = place.text;
    d.hint = std::move(hint);
    diagnostics_.push_back(std::move(d));
  }

  void add_program(const std::string& path) {
    if (seen_.insert(fs::path(path).lexically_normal().string()).second) programs_.push_back(path);
  }

  void add_folder(const std::string& folder, const ListPlace& place) {
    std::vector<std::string> found;
    std::error_code error;
    fs::recursive_directory_iterator at(folder, error);
    for (const fs::recursive_directory_iterator end; !error && at != end; at.increment(error)) {
      const std::string name = at->path().filename().string();
      std::error_code ignored;
      if (name.starts_with('.')) {
        if (at->is_directory(ignored)) at.disable_recursion_pending();
      } else if (at->is_regular_file(ignored) && is_program_name(name)) {
        found.push_back(at->path().lexically_normal().string());
      }
    }
    if (error) {
      fault(place, trf("cannot read the folder {}: {}", folder, error.message()));
      return;
    }
    if (found.empty()) {
      fault(place, trf("{}: no program in this folder", folder),
            tr("programs end in .ngc .nc .gcode .gc .tap .cnc .canon"));
    }
    std::sort(found.begin(), found.end());
    for (const std::string& path : found) add_program(path);
  }

  void add_pattern(const std::string& pattern, const ListPlace& place) {
    glob_t found{};
    const int code = glob(pattern.c_str(), 0, nullptr, &found);
    std::vector<std::string> paths;
    for (std::size_t i = 0; code == 0 && i < found.gl_pathc; ++i) {
      paths.emplace_back(found.gl_pathv[i]);
    }
    globfree(&found);
    bool any = false;
    for (const std::string& path : paths) {
      std::error_code ignored;
      if (fs::is_directory(path, ignored)) {
        add_folder(path, place);
      } else if (is_program_name(path)) {
        add_program(path);
      } else {
        continue;
      }
      any = true;
    }
    if (!any) fault(place, trf("{}: no program fits this pattern", pattern));
  }

  void add_one(const std::string& what, const ListPlace& place) {
    std::error_code ignored;
    if (fs::is_directory(what, ignored)) {
      add_folder(what, place);
    } else if (fs::exists(what, ignored)) {
      add_program(what);
    } else if (what.find_first_of("*?[") != what.npos) {
      add_pattern(what, place);
    } else {
      fault(place, trf("{}: no such file or folder", what));
    }
  }

  void add_list(const std::string& path) {
    const bool is_stdin = path == "-";
    const std::string name = is_stdin ? "<stdin>" : path;
    std::string text;
    if (is_stdin) {
      text = read_up_to(std::cin, kMaxListBytes + 1);
      if (text.size() > kMaxListBytes) {
        fault({name, 0, {}}, trf("the list is larger than {} MB", kMaxListBytes >> 20U));
        return;
      }
    } else {
      const Result<std::string> read = read_small_file(path, kMaxListBytes);
      if (!read) {
        fault({}, read.error());
        return;
      }
      text = *read;
    }
    if (text.find('\0') != text.npos) {
      fault({name, 0, {}}, tr("not a list of programs: it holds bytes that are no text"),
            tr("programs end in .ngc .nc .gcode .gc .tap .cnc .canon"));
      return;
    }
    const fs::path folder = is_stdin ? fs::path() : fs::path(path).parent_path();
    int line = 0;
    for (std::string_view rest = text; !rest.empty();) {
      const std::string one(trim(take_line(rest)));
      ++line;
      if (!one.empty() && one.front() != '#') add_one((folder / one).string(), {name, line, one});
    }
  }

  Diagnostics& diagnostics_;
  std::vector<std::string> programs_;
  std::set<std::string> seen_;
};

}  // namespace

bool is_program_name(std::string_view path) {
  constexpr std::array<std::string_view, 7> kEnds{".ngc", ".nc",  ".gcode", ".gc",
                                                  ".tap", ".cnc", ".canon"};
  const std::string end = to_lower(fs::path(path).extension().string());
  return std::find(kEnds.begin(), kEnds.end(), end) != kEnds.end();
}

std::vector<std::string> programs_of(const std::vector<std::string>& what,
                                     Diagnostics& diagnostics) {
  WorkList list(diagnostics);
  for (const std::string& one : what) list.add(one);
  return list.take();
}

}  // namespace kerf
