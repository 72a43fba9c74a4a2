#include "viewer/window/settings.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <sstream>
#include <string_view>
#include <system_error>

#include "base/atomic_file.h"
#include "base/text_scan.h"
#include "base/translate.h"

namespace kerf {
namespace {

constexpr int kMinSize_px = 320;
constexpr int kMaxSize_px = 16384;
constexpr float kMinOpacity = 0.05f;
/// A file of settings is a screenful; more than this is something else.
constexpr std::uintmax_t kMaxBytes = 64 * 1024;

constexpr std::array<std::string_view, kSceneObjectCount> kObjectNames{
    "workpiece", "cutter", "holder",   "traverses", "feeds",   "planned",
    "blank",     "frames", "findings", "machine",   "fixtures"};

/// One name, how it is written, and how it is read: the reader returns what is allowed if the value
/// is not.
struct Field {
  std::string name;
  std::function<std::string(const ViewSettings&)> write;
  std::function<std::string(std::string_view, ViewSettings*)> read;
};

Field switch_field(std::string name, std::function<bool*(ViewSettings*)> member) {
  return {std::move(name),
          [member](const ViewSettings& settings) {
            ViewSettings copy = settings;
            return std::string(*member(&copy) ? "on" : "off");
          },
          [member](std::string_view value, ViewSettings* settings) -> std::string {
            if (value != "on" && value != "off") return tr("on or off");
            *member(settings) = value == "on";
            return "";
          }};
}

Field size_field(std::string name, int ViewSettings::*member) {
  return {std::move(name),
          [member](const ViewSettings& settings) { return std::to_string(settings.*member); },
          [member](std::string_view value, ViewSettings* settings) -> std::string {
            int number = 0;
            if (!read_number(value, number) || number < kMinSize_px || number > kMaxSize_px) {
              return trf("{} to {} (pixels)", kMinSize_px, kMaxSize_px);
            }
            settings->*member = number;
            return "";
          }};
}

/// One of a list of words, stored as its place in the list.
Field choice_field(std::string name, std::vector<std::string_view> words,
                   std::function<int(const ViewSettings&)> get,
                   std::function<void(int, ViewSettings*)> set) {
  return {std::move(name),
          [words, get](const ViewSettings& settings) {
            return std::string(words[static_cast<std::size_t>(get(settings))]);
          },
          [words, set](std::string_view value, ViewSettings* settings) -> std::string {
            for (std::size_t i = 0; i < words.size(); ++i) {
              if (words[i] != value) continue;
              set(static_cast<int>(i), settings);
              return "";
            }
            return fmt::format("{}", fmt::join(words, ", "));
          }};
}

Field number_field(std::string name, std::function<double*(ViewSettings*)> member, double low,
                   double high) {
  return {std::move(name),
          [member](const ViewSettings& settings) {
            ViewSettings copy = settings;
            return fmt::format("{:.6g}", *member(&copy));
          },
          [member, low, high](std::string_view value, ViewSettings* settings) -> std::string {
            double number = 0.0;
            if (!read_number(value, number) || !(number >= low && number <= high)) {
              return trf("{} to {}", low, high);
            }
            *member(settings) = number;
            return "";
          }};
}

Field opacity_field(std::size_t object) {
  return {fmt::format("opacity.{}", kObjectNames[object]),
          [object](const ViewSettings& settings) {
            return fmt::format("{:.2f}", settings.drawing.looks[object].opacity);
          },
          [object](std::string_view value, ViewSettings* settings) -> std::string {
            float number = 0.0f;
            if (!read_number(value, number) || !(number >= kMinOpacity && number <= 1.0f)) {
              return trf("{} to 1", kMinOpacity);
            }
            settings->drawing.looks[object].opacity = number;
            return "";
          }};
}

std::vector<Field> choices() {
  return {
      choice_field(
          "flat", {"off", "xy", "zx"},
          [](const ViewSettings& s) { return static_cast<int>(s.flat); },
          [](int choice, ViewSettings* s) { s->flat = static_cast<FlatView>(choice); }),
      choice_field(
          "curve",
          {"none", "removal-rate", "feed", "feed-per-tooth", "engagement", "chip", "force",
           "torque", "power", "deflection"},
          [](const ViewSettings& s) { return static_cast<int>(s.curve); },
          [](int choice, ViewSettings* s) { s->curve = static_cast<CurveChoice>(choice); }),
      choice_field(
          "color",
          {"plain", "height", "tool", "removal-rate", "feed", "feed-per-tooth", "engagement",
           "chip", "force", "torque", "power", "deflection", "line-range", "deviation"},
          [](const ViewSettings& s) { return static_cast<int>(s.drawing.color_by); },
          [](int choice, ViewSettings* s) { s->drawing.color_by = static_cast<ColorBy>(choice); }),
      choice_field(
          "color.on", {"surface", "both", "path"},
          [](const ViewSettings& s) { return static_cast<int>(s.drawing.color_on); },
          [](int choice, ViewSettings* s) {
            s->drawing.color_on = static_cast<ColorTarget>(choice);
          }),
      choice_field(
          "draw", {"mesh", "raycast", "csg"},
          [](const ViewSettings& s) { return static_cast<int>(s.drawing.draw_mode); },
          [](int choice, ViewSettings* s) {
            s->drawing.draw_mode = static_cast<DrawMode>(choice);
          }),
      choice_field(
          "section.axis", {"x", "y", "z"}, [](const ViewSettings& s) { return s.section.axis; },
          [](int choice, ViewSettings* s) { s->section.axis = choice; }),
      switch_field("section.flipped", [](ViewSettings* s) { return &s->section.is_flipped; }),
      choice_field(
          "path", {"all", "last"},
          [](const ViewSettings& s) { return s.drawing.path_tail > 0 ? 1 : 0; },
          [](int choice, ViewSettings* s) { s->drawing.path_tail = choice == 0 ? 0 : kTailMoves; }),
      switch_field("dark", [](ViewSettings* s) { return &s->drawing.is_dark; }),
      choice_field(
          "units", {"mm", "inch"}, [](const ViewSettings& s) { return static_cast<int>(s.units); },
          [](int choice, ViewSettings* s) { s->units = static_cast<LengthUnit>(choice); }),
      choice_field(
          "theme", {"dark", "light", "system"},
          [](const ViewSettings& s) { return static_cast<int>(s.theme); },
          [](int choice, ViewSettings* s) { s->theme = static_cast<ThemeChoice>(choice); }),
      switch_field("keys-seen", [](ViewSettings* s) { return &s->knows_keys; }),
      number_field(
          "tolerance", [](ViewSettings* s) { return &s->drawing.tolerance_mm; }, kMinTolerance_mm,
          kMaxTolerance_mm),
      number_field(
          "text-scale", [](ViewSettings* s) { return &s->text_scale; }, kMinTextScale,
          kMaxTextScale),
      number_field(
          "panel.code.width", [](ViewSettings* s) { return &s->code_width_px; }, kMinPanel_px,
          kMaxPanel_px),
      number_field(
          "panel.info.width", [](ViewSettings* s) { return &s->info_width_px; }, kMinPanel_px,
          kMaxPanel_px),
  };
}

/// A path of the list; further ones follow those that are there.
Field recent_field(std::size_t place) {
  return {fmt::format("recent.{}", place + 1),
          [place](const ViewSettings& settings) {
            return place < settings.recent.size() ? settings.recent[place] : std::string();
          },
          [](std::string_view value, ViewSettings* settings) -> std::string {
            if (!value.empty() && value.front() != '/') return tr("an absolute path");
            if (!value.empty() && settings->recent.size() < kMostRecent) {
              settings->recent.emplace_back(value);
            }
            return "";
          }};
}

std::vector<Field> all_fields() {
  std::vector<Field> fields{
      size_field("width", &ViewSettings::width_px),
      size_field("height", &ViewSettings::height_px),
      {"language", [](const ViewSettings& s) { return s.language; },
       [](std::string_view value, ViewSettings* s) -> std::string {
         const std::vector<std::string> known = languages();
         if (std::find(known.begin(), known.end(), value) == known.end()) {
           return fmt::format("{}", fmt::join(known, "|"));
         }
         s->language = value;
         return "";
       }},
      switch_field("perspective", [](ViewSettings* s) { return &s->is_perspective; }),
      switch_field("panel.code", [](ViewSettings* s) { return &s->shows_code; }),
      switch_field("panel.info", [](ViewSettings* s) { return &s->shows_info; }),
      switch_field("panel.counters", [](ViewSettings* s) { return &s->shows_counters; }),
      switch_field("local-drawing", [](ViewSettings* s) { return &s->drawing.is_local; }),
  };
  for (Field& field : choices()) fields.push_back(std::move(field));
  for (std::size_t object = 0; object < kSceneObjectCount; ++object) {
    fields.push_back(
        switch_field(fmt::format("show.{}", kObjectNames[object]),
                     [object](ViewSettings* s) { return &s->drawing.looks[object].is_visible; }));
    fields.push_back(opacity_field(object));
  }
  fields.push_back({"picture.folder", [](const ViewSettings& s) { return s.picture_folder; },
                    [](std::string_view value, ViewSettings* s) -> std::string {
                      if (!value.empty() && value.front() != '/') return tr("an absolute path");
                      s->picture_folder = value;
                      return "";
                    }});
  for (std::size_t place = 0; place < kMostRecent; ++place) fields.push_back(recent_field(place));
  return fields;
}

/// Column of `part` in `line`, from 1.
int column_of(std::string_view part, std::string_view line) {
  return static_cast<int>(part.data() - line.data()) + 1;
}

/// Reads one line; a fault has column, message and hint.
std::optional<Diagnostic> read_line(std::string_view line, const std::vector<Field>& fields,
                                    ViewSettings* settings) {
  const std::string_view content = trim(line.substr(0, line.find('#')), is_line_blank);
  if (content.empty()) return std::nullopt;
  Diagnostic fault;
  fault.severity = Severity::kWarning;
  fault.excerpt = line;
  fault.column = column_of(content, line);
  const std::size_t equals = content.find('=');
  if (equals == std::string_view::npos) {
    fault.message = tr("no '='; a line reads `name = value`");
    return fault;
  }
  const std::string_view name = trim(content.substr(0, equals), is_line_blank);
  const std::string_view value = trim(content.substr(equals + 1), is_line_blank);
  for (const Field& field : fields) {
    if (field.name != name) continue;
    const std::string allowed = field.read(value, settings);
    if (allowed.empty()) return std::nullopt;
    if (!value.empty()) fault.column = column_of(value, line);
    fault.message = trf("{}: '{}' is not allowed; must be {}", name, value, allowed);
    return fault;
  }
  fault.message = trf("'{}' is no setting of the window", name);
  return fault;
}

/// Absolute; empty if a line of the file cannot hold it.
std::string kept_path(const std::string& path) {
  std::error_code error;
  const std::string absolute = std::filesystem::absolute(path, error).lexically_normal().string();
  const bool can_be = !error && absolute.find_first_of("#\n\r") == std::string::npos &&
                      trim(absolute, is_line_blank) == absolute;
  return can_be ? absolute : std::string();
}

}  // namespace

std::string settings_path() {
  constexpr std::string_view kFile = "kerf/view.conf";
  if (const char* config = std::getenv("XDG_CONFIG_HOME"); config != nullptr && *config == '/') {
    return fmt::format("{}/{}", config, kFile);
  }
  if (const char* home = std::getenv("HOME"); home != nullptr && *home != '\0') {
    return fmt::format("{}/.config/{}", home, kFile);
  }
  return "";
}

ViewSettings load_settings(const std::string& path, Diagnostics* faults) {
  ViewSettings settings;
  std::error_code error;
  if (path.empty() || !std::filesystem::exists(path, error)) return settings;
  const std::string hint = trf(
      "the default is used; when the window closes, the file is kept as {}.damaged and a new one "
      "is written",
      path);
  const auto whole_file_fault = [&](std::string message) {
    Diagnostic fault;
    fault.severity = Severity::kWarning;
    fault.file = path;
    fault.message = std::move(message);
    fault.hint = hint;
    faults->push_back(std::move(fault));
    return settings;
  };
  if (!std::filesystem::is_regular_file(path, error)) return whole_file_fault(tr("not a file"));
  if (std::filesystem::file_size(path, error) > kMaxBytes) {
    return whole_file_fault(trf("more than {} bytes: no settings of kerf", kMaxBytes));
  }
  std::ifstream file(path, std::ios::binary);
  if (!file) return whole_file_fault(tr("cannot be read"));
  const std::vector<Field> fields = all_fields();
  std::string line;
  for (int number = 1; std::getline(file, line); ++number) {
    if (std::optional<Diagnostic> fault = read_line(line, fields, &settings)) {
      fault->file = path;
      fault->line = number;
      fault->hint = hint;
      faults->push_back(std::move(*fault));
    }
  }
  return settings;
}

Done save_settings(const std::string& path, const ViewSettings& settings) {
  std::string content = "# Remembered by the window of kerf; written when it closes.\n";
  for (const Field& field : all_fields()) {
    const std::string value = field.write(settings);
    if (!value.empty()) content += fmt::format("{} = {}\n", field.name, value);
  }
  std::error_code error;
  std::filesystem::create_directories(std::filesystem::path(path).parent_path(), error);
  if (error) return Error{trf("writing {}: {}", path, error.message())};
  Result<AtomicFile> file = AtomicFile::create(path);
  if (!file) return Error{file.error()};
  file->write(content.data(), content.size());
  return file->commit();
}

void remember_picture_folder(const std::string& folder, ViewSettings* settings) {
  const std::string absolute = kept_path(folder);
  if (!absolute.empty()) settings->picture_folder = absolute;
}

void remember_program(const std::string& path, ViewSettings* settings) {
  const std::string absolute = kept_path(path);
  if (absolute.empty()) return;
  std::erase(settings->recent, absolute);
  settings->recent.insert(settings->recent.begin(), absolute);
  if (settings->recent.size() > kMostRecent) settings->recent.resize(kMostRecent);
}

Result<std::string> set_aside(const std::string& path) {
  constexpr int kMostKept = 9;
  for (int number = 1; number <= kMostKept; ++number) {
    std::string kept = path + ".damaged";
    if (number > 1) kept += fmt::format("-{}", number);
    std::error_code error;
    if (std::filesystem::exists(std::filesystem::symlink_status(kept, error))) continue;
    std::filesystem::rename(path, kept, error);
    if (error) return Error{trf("keeping {} as {}: {}", path, kept, error.message())};
    return kept;
  }
  return Error{trf("keeping {}: {}.damaged to {}.damaged-{} are there already", path, path, path,
                   kMostKept)};
}

}  // namespace kerf
