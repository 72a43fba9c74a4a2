// The list from which a program is opened. kerf's own: it needs no desktop and no other program.
#include <fmt/format.h>
#include <imgui.h>
#include <imgui_stdlib.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <glm/common.hpp>
#include <system_error>

#include "base/text_scan.h"
#include "base/translate.h"
#include "viewer/window/panels.h"

namespace kerf {
namespace {

namespace fs = std::filesystem;

constexpr glm::vec2 kSize_px{560.0f, 420.0f};
/// A folder with more is not made to be looked through; what is typed opens the rest.
constexpr std::size_t kMostEntries = 5000;

/// Of programs, and of logs, which are replayed.
constexpr std::array kProgramEndings{".ngc",  ".nc",  ".tap", ".gcode", ".cnc",
                                     ".ncc",  ".gc",  ".iso", ".mpf",   ".canon",
                                     ".kerf", ".eia", ".csv", ".log",   ".sam"};

bool is_program_name(const fs::path& path) {
  const std::string ending = to_lower(path.extension().string());
  return std::find(kProgramEndings.begin(), kProgramEndings.end(), ending) != kProgramEndings.end();
}

void list_folder(FileChoice* files) {
  files->entries.clear();
  files->fault.clear();
  std::error_code error;
  for (fs::directory_iterator at(files->folder, error), end; !error && at != end;
       at.increment(error)) {
    const fs::path& path = at->path();
    std::string name = path.filename().string();
    if (name.empty() || name.front() == '.') continue;
    std::error_code ignored;
    const bool is_folder = at->is_directory(ignored);
    if (!is_folder && !files->shows_all && !is_program_name(path)) continue;
    if (files->entries.size() < kMostEntries)
      files->entries.push_back({std::move(name), is_folder});
  }
  if (error) files->fault = fmt::format("{}: {}", files->folder, error.message());
  std::sort(files->entries.begin(), files->entries.end(),
            [](const FileChoice::Entry& a, const FileChoice::Entry& b) {
              if (a.is_folder != b.is_folder) return a.is_folder;
              return to_lower(a.name) < to_lower(b.name);
            });
}

void go_into(const fs::path& folder, FileChoice* files) {
  files->folder = folder.lexically_normal().string();
  files->name.clear();
  list_folder(files);
}

/// Opens a file, goes into a folder, or says what is wrong with the name.
void choose(const fs::path& path, const PanelContext& context) {
  FileChoice& files = context.state->files;
  std::error_code error;
  if (fs::is_directory(path, error)) {
    go_into(path, &files);
  } else if (fs::exists(path, error)) {
    files.is_open = false;
    context.commands->push(OpenCommand{path.string()});
  } else {
    files.fault = fmt::format("{}: {}", path.string(),
                              error ? error.message() : std::string(tr("there is no such file")));
  }
}

void draw_list(const PanelContext& context) {
  FileChoice& files = context.state->files;
  const float below = 2.4f * ImGui::GetFrameHeightWithSpacing();
  std::string chosen;
  if (ImGui::BeginChild("entries", {0.0f, -below}, true)) {
    ImGuiListClipper clipper;
    clipper.Begin(static_cast<int>(files.entries.size()));
    while (clipper.Step()) {
      for (int i = clipper.DisplayStart; i < clipper.DisplayEnd; ++i) {
        const FileChoice::Entry& entry = files.entries[static_cast<std::size_t>(i)];
        ImGui::PushID(i);
        const std::string label = entry.is_folder ? entry.name + "/" : entry.name;
        if (entry.is_folder) ImGui::PushStyleColor(ImGuiCol_Text, theme::kNote);
        if (ImGui::Selectable(label.c_str(), files.name == entry.name,
                              ImGuiSelectableFlags_AllowDoubleClick)) {
          files.name = entry.name;
          files.fault.clear();
          if (entry.is_folder || ImGui::IsMouseDoubleClicked(ImGuiMouseButton_Left)) {
            chosen = entry.name;
          }
        }
        if (entry.is_folder) ImGui::PopStyleColor();
        ImGui::PopID();
      }
    }
  }
  ImGui::EndChild();
  // The list is another one afterwards.
  if (!chosen.empty()) choose(fs::path(files.folder) / chosen, context);
}

void draw_recent(const PanelContext& context, const char* name) {
  const std::vector<std::string>& recent = context.settings->recent;
  if (recent.empty()) return;
  ImGui::SetNextItemWidth(-1.0f);
  if (!ImGui::BeginCombo(name, context.word(Text::kRecent))) return;
  for (const std::string& path : recent) {
    if (ImGui::Selectable(path.c_str())) choose(path, context);
  }
  ImGui::EndCombo();
}

}  // namespace

void open_file_choice(const ShownValues& shown, const ViewSettings& settings, FileChoice* files) {
  std::error_code error;
  fs::path folder = fs::current_path(error);
  if (shown.job && !shown.job->program.empty()) {
    folder = fs::absolute(shown.job->program, error).parent_path();
  } else if (!settings.recent.empty()) {
    const fs::path last = fs::path(settings.recent.front()).parent_path();
    if (fs::is_directory(last, error)) folder = last;
  }
  files->is_open = true;
  go_into(folder, files);
}

void draw_file_choice(const PanelContext& context, glm::vec2 window_px) {
  FileChoice& files = context.state->files;
  const glm::vec2 size = glm::min(kSize_px * context.scale, 0.95f * window_px);
  ImGui::SetNextWindowPos({0.5f * window_px.x, 0.5f * window_px.y}, ImGuiCond_Always, {0.5f, 0.5f});
  ImGui::SetNextWindowSize({size.x, size.y});
  const std::string title = fmt::format("{}###files", context.word(Text::kOpenWhat));
  if (ImGui::Begin(title.c_str(), &files.is_open,
                   ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoCollapse |
                       ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove)) {
    if (ImGui::Button(context.word(Text::kFolderUp))) {
      go_into(fs::path(files.folder).parent_path(), &files);
    }
    ImGui::SameLine();
    ImGui::AlignTextToFramePadding();
    ImGui::TextUnformatted(files.folder.c_str());
    draw_recent(context, "##recent");
    draw_list(context);
    if (ImGui::IsWindowAppearing()) ImGui::SetKeyboardFocusHere();
    ImGui::SetNextItemWidth(-250.0f * context.scale);
    const bool is_entered = ImGui::InputTextWithHint(
        "##name", context.word(Text::kFileName), &files.name, ImGuiInputTextFlags_EnterReturnsTrue);
    ImGui::SameLine();
    if (ImGui::Checkbox(context.word(Text::kAllFiles), &files.shows_all)) list_folder(&files);
    ImGui::SameLine();
    const bool opens = ImGui::Button(context.word(Text::kOpen)) || is_entered;
    if (!files.fault.empty()) {
      ImGui::TextColored(theme::kError, "%s", files.fault.c_str());
    }
    // A path that begins with / leads away from the folder.
    if (opens && !files.name.empty()) choose(fs::path(files.folder) / files.name, context);
  }
  ImGui::End();
}

void draw_empty_hint(const PanelContext& context, glm::vec2 window_px, const PanelRoom& room) {
  const ShownValues& shown = context.shown;
  const bool is_empty = shown.job && shown.job->can_open && shown.job->program.empty();
  if (!is_empty || context.state->files.is_open) return;
  const glm::vec2 middle{0.5f * (room.left + window_px.x - room.right),
                         0.45f * (room.top + window_px.y - room.bottom)};
  ImGui::SetNextWindowPos({middle.x, middle.y}, ImGuiCond_Always, {0.5f, 0.5f});
  ImGui::Begin("empty", nullptr,
               ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove |
                   ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_AlwaysAutoResize |
                   ImGuiWindowFlags_NoBringToFrontOnFocus);
  ImGui::TextUnformatted(context.word(Text::kNothingOpen));
  ImGui::TextColored(theme::kDim, "%s", context.word(Text::kDropHint));
  if (ImGui::Button(context.word(Text::kOpen))) context.state->action = Action::kOpen;
  const std::vector<std::string>& recent = context.settings->recent;
  if (!recent.empty()) {
    ImGui::Separator();
    ImGui::TextColored(theme::kDim, "%s", context.word(Text::kRecent));
    for (const std::string& path : recent) {
      if (ImGui::Selectable(path.c_str())) context.commands->push(OpenCommand{path});
    }
  }
  ImGui::End();
}

}  // namespace kerf
