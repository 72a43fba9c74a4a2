#include "twin/cli/screen_setup.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <sstream>
#include <string_view>
#include <utility>

#include "base/translate.h"
#include "interp_bridge/ini_file.h"

namespace kerf {
namespace {

constexpr std::string_view kBegin = "# kerf setup: begin";
constexpr std::string_view kEnd = "# kerf setup: end";
constexpr std::string_view kName = "EMBED_TAB_NAME", kCommand = "EMBED_TAB_COMMAND",
                           kLocation = "EMBED_TAB_LOCATION";

/// A screen, and where in it a tab has most room.
struct Screen {
  std::string_view name;      ///< a word of DISPLAY begins so
  std::string_view location;  ///< empty: it has no EMBED_TAB_LOCATION
};
constexpr std::array kScreens{Screen{"axis", ""}, Screen{"gmoccapy", "ntb_preview"},
                              Screen{"qtdragon", "stackedWidget_mainTab"}};

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    lines.push_back(text.substr(at, end - at));
    at = end + 1;
  }
  return lines;
}

/// Without blanks at its ends, and without a carriage return.
std::string_view trimmed(std::string_view line) {
  constexpr std::string_view kBlanks = " \t\r";
  const std::size_t first = line.find_first_not_of(kBlanks);
  if (first == line.npos) return {};
  return line.substr(first, line.find_last_not_of(kBlanks) + 1 - first);
}

void fault(Diagnostics& diagnostics, const std::string& path, int line, std::string message,
           std::string hint = {}) {
  Diagnostic d;
  d.file = path;
  d.line = line;
  d.message = std::move(message);
  d.hint = std::move(hint);
  diagnostics.push_back(std::move(d));
}

/// 0-based, half-open: from the first mark to behind the second; equal: there is none. Nothing: one
/// of the marks is missing, or there are more of them.
struct Block {
  std::size_t first = 0, last = 0;
};
std::optional<Block> block_of(const std::vector<std::string>& lines, const std::string& path,
                              Diagnostics& diagnostics) {
  std::vector<std::size_t> begins, ends;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    if (trimmed(lines[i]) == kBegin) begins.push_back(i);
    if (trimmed(lines[i]) == kEnd) ends.push_back(i);
  }
  if (begins.empty() && ends.empty()) return Block{};
  if (begins.size() == 1 && ends.size() == 1 && begins[0] < ends[0]) {
    return Block{begins[0], ends[0] + 1};
  }
  const std::size_t at = begins.empty() ? ends[0] : begins[0];
  fault(diagnostics, path, static_cast<int>(at) + 1,
        trf("'{}' and '{}' are not there once each, in this order", kBegin, kEnd),
        tr("take the lines of kerf out by hand"));
  return std::nullopt;
}

IniChange change_of(const std::vector<std::string>& lines, const std::string& text, Block block,
                    std::vector<std::string> after) {
  IniChange change;
  change.line = static_cast<int>(block.first) + 1;
  const auto at = [&](std::size_t i) { return lines.begin() + static_cast<std::ptrdiff_t>(i); };
  change.before.assign(at(block.first), at(block.last));
  change.after = std::move(after);
  std::vector<std::string> all(lines.begin(), at(block.first));
  all.insert(all.end(), change.after.begin(), change.after.end());
  all.insert(all.end(), at(block.last), lines.end());
  for (const std::string& line : all) change.text += line + '\n';
  // As it was: without a line break at the end, unless what was put in is there.
  const bool is_at_end = block.last == lines.size() && !change.after.empty();
  if (!text.empty() && text.back() != '\n' && !is_at_end) change.text.pop_back();
  return change;
}

const Screen* screen_of(const IniEntry& display) {
  std::istringstream words(display.value);
  for (std::string word; words >> word;) {
    const std::string name = std::filesystem::path(word).filename().string();
    for (const Screen& screen : kScreens) {
      if (name.starts_with(screen.name)) return &screen;
    }
  }
  return nullptr;
}

/// The screen takes the first name, command and place for one tab, and so on.
bool are_tabs_even(IniFile& ini, const Screen& screen, const std::string& path,
                   Diagnostics& diagnostics) {
  const std::vector<const IniEntry*> names = ini.find_all("DISPLAY", kName);
  const std::vector<const IniEntry*> commands = ini.find_all("DISPLAY", kCommand);
  const std::vector<const IniEntry*> places = ini.find_all("DISPLAY", kLocation);
  const std::size_t wanted_places = screen.location.empty() ? places.size() : names.size();
  if (commands.size() != names.size() || places.size() != wanted_places) {
    const IniEntry* const first = !names.empty()      ? names[0]
                                  : !commands.empty() ? commands[0]
                                                      : places[0];
    fault(diagnostics, path, first->line,
          trf("the tabs do not come out even: {} {}, {} {}, {} {}", names.size(), kName,
              commands.size(), kCommand, places.size(), kLocation),
          tr("each tab needs one of each, or the screen mixes them up"));
    return false;
  }
  for (const IniEntry* const command : commands) {
    if (command->value.find("kerf shadow") == std::string::npos) continue;
    fault(diagnostics, path, command->line, tr("there is a tab with kerf already"),
          tr("take it out by hand, or leave it as it is"));
    return false;
  }
  return true;
}

/// 0-based: behind the last line of the first [DISPLAY] that says something.
std::optional<std::size_t> end_of_section(const std::vector<std::string>& lines) {
  const auto is_head = [](const std::string& line) { return trimmed(line).starts_with('['); };
  auto head = std::find_if(lines.begin(), lines.end(), [](const std::string& line) {
    return trimmed(line).starts_with("[DISPLAY]");
  });
  if (head == lines.end()) return std::nullopt;
  auto end = std::find_if(head + 1, lines.end(), is_head);
  while (end != head + 1) {
    const std::string_view line = trimmed(*(end - 1));
    if (!line.empty() && line.front() != '#' && line.front() != ';') break;
    --end;
  }
  return static_cast<std::size_t>(end - lines.begin());
}

std::vector<std::string> tab_lines(const Screen& screen, const std::string& path,
                                   const std::string& kerf, const std::string& line_end) {
  std::vector<std::string> lines{std::string(kBegin), fmt::format("{} = kerf", kName)};
  if (!screen.location.empty()) lines.push_back(fmt::format("{} = {}", kLocation, screen.location));
  lines.push_back(fmt::format("{} = {} shadow --set source.type=hal --ini {} -x {{XID}}", kCommand,
                              kerf, std::filesystem::path(path).filename().string()));
  lines.emplace_back(kEnd);
  for (std::string& line : lines) line += line_end;
  return lines;
}

}  // namespace

std::optional<IniChange> without_tab(const std::string& text, const std::string& path,
                                     Diagnostics& diagnostics) {
  const std::vector<std::string> lines = lines_of(text);
  const std::optional<Block> block = block_of(lines, path, diagnostics);
  if (!block) return std::nullopt;
  return change_of(lines, text, *block, {});
}

std::optional<IniChange> with_tab(const std::string& text, const std::string& path,
                                  const std::string& kerf, Diagnostics& diagnostics) {
  const std::optional<IniChange> without = without_tab(text, path, diagnostics);
  if (!without) return std::nullopt;
  const auto no_includes = [](const std::string&) { return Result<std::string>(std::string()); };
  Diagnostics of_others;  // other sections' faults are not ours
  IniFile ini = IniFile::parse(without->text, path, no_includes, of_others);
  const IniEntry* const display = ini.find("DISPLAY", "DISPLAY");
  if (display == nullptr || display->file != 0) {
    fault(diagnostics, path, 1, tr("[DISPLAY]DISPLAY is not in this file: which screen is it?"));
    return std::nullopt;
  }
  const Screen* const screen = screen_of(*display);
  if (screen == nullptr) {
    fault(diagnostics, path, display->line,
          trf("the screen '{}' is none that kerf knows: axis, gmoccapy, qtdragon", display->value),
          tr("docs/linuxcnc-screens.md has what a tab needs"));
    return std::nullopt;
  }
  const std::string name = std::filesystem::path(path).filename().string();
  if ((kerf + name).find_first_of(" \t\"'") != std::string::npos) {
    fault(diagnostics, path, display->line,
          trf("'{}' or '{}' has a blank or a quote in it, at which the screen would part it", kerf,
              name));
    return std::nullopt;
  }
  if (!are_tabs_even(ini, *screen, path, diagnostics)) return std::nullopt;
  const std::vector<std::string> lines = lines_of(without->text);
  const std::optional<std::size_t> at = end_of_section(lines);
  if (!at || trimmed(lines[*at - 1]).ends_with('\\')) {
    fault(diagnostics, path, at ? static_cast<int>(*at) : display->line,
          tr("the end of [DISPLAY] is not clear: a line goes on, or the section is elsewhere"));
    return std::nullopt;
  }
  const std::string line_end = lines[*at - 1].ends_with('\r') ? "\r" : "";
  const std::vector<std::string> wanted = tab_lines(*screen, path, kerf, line_end);
  IniChange change = change_of(lines, without->text, {*at, *at}, wanted);
  if (!without->before.empty()) {
    if (change.text == text) return change_of(lines_of(text), text, Block{}, {});
    // Replaced where they are.
    const std::vector<std::string> now = lines_of(text);
    const auto first = static_cast<std::size_t>(without->line - 1);
    change = change_of(now, text, {first, first + without->before.size()}, wanted);
  }
  return change;
}

std::string unified_diff(const std::string& text, const IniChange& change,
                         const std::string& path) {
  if (!change.changes()) return {};
  constexpr std::size_t kAround = 3;
  const std::vector<std::string> lines = lines_of(text);
  const auto at = static_cast<std::size_t>(change.line - 1);
  const std::size_t first = at - std::min(at, kAround);
  const std::size_t behind = at + change.before.size();
  const std::size_t last = std::min(behind + kAround, lines.size());
  const std::size_t old_count = last - first;
  const std::size_t new_count = old_count - change.before.size() + change.after.size();
  std::string out = fmt::format("--- {0}\n+++ {0}\n@@ -{1},{2} +{1},{3} @@\n", path, first + 1,
                                old_count, new_count);
  const auto add = [&](char mark, const std::string& line) {
    out += fmt::format("{}{}\n", mark, line);
  };
  for (std::size_t i = first; i < at; ++i) add(' ', lines[i]);
  for (const std::string& line : change.before) add('-', line);
  for (const std::string& line : change.after) add('+', line);
  for (std::size_t i = behind; i < last; ++i) add(' ', lines[i]);
  return out;
}

}  // namespace kerf
