// The question where a picture or a film is to go.
#include <fmt/chrono.h>
#include <fmt/format.h>
#include <imgui.h>
#include <imgui_stdlib.h>

#include <ctime>
#include <filesystem>
#include <system_error>
#include <utility>

#include "viewer/film_writer.h"
#include "viewer/window/panels.h"

namespace kerf {
namespace {

namespace fs = std::filesystem;

constexpr float kWidth_px = 420.0f;

/// A name that is free: the second, and a number if several pictures are taken in it.
std::string free_name(const fs::path& folder, const std::string& ending) {
  const std::string stem = fmt::format("kerf-{:%Y%m%d-%H%M%S}", fmt::localtime(std::time(nullptr)));
  std::string name = stem + ending;
  std::error_code error;
  for (int number = 2; fs::exists(folder / name, error); ++number) {
    name = fmt::format("{}-{}{}", stem, number, ending);
  }
  return name;
}

Text question(PictureChoice::Kind kind) {
  switch (kind) {
    case PictureChoice::Kind::kWindow:
      return Text::kWindowTo;
    case PictureChoice::Kind::kFilm:
      return Text::kFilmTo;
    case PictureChoice::Kind::kScene:
      break;
  }
  return Text::kPictureTo;
}

}  // namespace

void open_picture_choice(PictureChoice::Kind kind, const std::string& folder,
                         const std::string& ending, PictureChoice* choice) {
  std::error_code error;
  fs::path absolute = fs::absolute(folder.empty() ? "." : folder, error).lexically_normal();
  if (!absolute.has_filename()) absolute = absolute.parent_path();  // "/tmp/."
  *choice = {true, true, false, kind, absolute.string(), free_name(absolute, ending), ""};
}

std::optional<std::string> chosen_path(PictureChoice* choice) {
  choice->is_accepted = false;
  fs::path path = fs::path(choice->folder) / choice->name;
  const bool is_film = choice->kind == PictureChoice::Kind::kFilm;
  if (!path.has_extension()) path += is_film ? ".mp4" : ".png";
  std::error_code error;
  if (is_film && !FilmWriter::can_be_named(path.string())) {
    choice->fault = text(Text::kFilmEnding);
  } else if (!fs::is_directory(path.parent_path(), error)) {
    choice->fault = fmt::format("{}: {}", path.parent_path().string(), text(Text::kNoFolder));
  } else if (fs::exists(path, error)) {
    choice->fault = fmt::format("{}: {}", path.string(), text(Text::kIsThere));
  } else {
    choice->is_open = false;
    return path.string();
  }
  choice->is_new = true;
  return std::nullopt;
}

void draw_picture_choice(const PanelContext& context, glm::vec2 window_px) {
  PictureChoice& choice = context.state->picture;
  ImGui::SetNextWindowPos({0.5f * window_px.x, 0.4f * window_px.y}, ImGuiCond_Always, {0.5f, 0.5f});
  const std::string title = fmt::format("{}###picture", context.word(question(choice.kind)));
  if (ImGui::Begin(title.c_str(), &choice.is_open,
                   ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoSavedSettings |
                       ImGuiWindowFlags_NoCollapse)) {
    ImGui::TextColored(theme::kDim, "%s/", choice.folder.c_str());
    if (std::exchange(choice.is_new, false)) ImGui::SetKeyboardFocusHere();
    ImGui::SetNextItemWidth(kWidth_px * context.scale);
    ImGui::InputTextWithHint("##name", context.word(Text::kFileName), &choice.name);
    if (!choice.fault.empty()) {
      ImGui::PushTextWrapPos(kWidth_px * context.scale);
      ImGui::TextColored(theme::kError, "%s", choice.fault.c_str());
      ImGui::PopTextWrapPos();
    }
    if (ImGui::Button(context.word(Text::kSave))) choice.is_accepted = true;
    ImGui::SameLine();
    if (ImGui::Button(context.word(Text::kCancel))) choice.is_open = false;
    if (choice.kind == PictureChoice::Kind::kScene) {
      ImGui::SameLine();
      if (ImGui::Button(context.word(Text::kFilm))) context.state->action = Action::kFilm;
    }
  }
  ImGui::End();
}

}  // namespace kerf
