// Pictures and films of what the window shows.
#include <fmt/format.h>

#include <filesystem>
#include <system_error>
#include <utility>

#include "viewer/window/window_impl.h"

namespace kerf {
namespace {

/// What is cut last comes into the picture a little after the program has ended.
constexpr std::chrono::milliseconds kFilmTail{500};

bool moves(PlayState state) {
  return state == PlayState::kPlaying || state == PlayState::kHurrying;
}

}  // namespace

std::string Window::Impl::picture_folder() const {
  if (!options_.picture_folder.empty()) return options_.picture_folder;
  std::error_code error;
  const std::string& last = settings_.picture_folder;
  return !last.empty() && std::filesystem::is_directory(last, error) ? last : std::string(".");
}

/// The picture is that of now, whenever its name is found.
void Window::Impl::ask_for_picture(bool of_window) {
  using Kind = PictureChoice::Kind;
  taken_.reset();
  taken_path_.clear();
  wants_picture_ = !of_window;
  if (of_window) taken_ = layer_->read();
  open_picture_choice(of_window ? Kind::kWindow : Kind::kScene, picture_folder(), ".png",
                      &state_.picture);
}

void Window::Impl::begin_or_end_film() {
  if (film_) return end_film();
  wants_picture_ = false;
  taken_.reset();
  state_.picture.is_open = false;
  if (!FilmWriter::is_possible()) {
    state_.notice = Text::kNoFfmpeg;
    return;
  }
  open_picture_choice(PictureChoice::Kind::kFilm, picture_folder(), ".mp4", &state_.picture);
}

/// The name was entered.
void Window::Impl::accept_picture() {
  touched();
  const std::optional<std::string> path = chosen_path(&state_.picture);
  if (!path) return;
  frames_without_text_ = 2;
  remember_picture_folder(std::filesystem::path(*path).parent_path().string(), &settings_);
  if (state_.picture.kind == PictureChoice::Kind::kFilm) return begin_film(*path);
  taken_path_ = *path;
  save_taken();
}

void Window::Impl::take_picture() {
  wants_picture_ = false;
  taken_ = renderer_->read();
  save_taken();
}

/// When there are both a picture and a name.
void Window::Impl::save_taken() {
  if (!taken_ || taken_path_.empty()) return;
  if (saving_.valid()) saving_.wait();
  end_saving();
  saving_path_ = std::exchange(taken_path_, {});
  state_.notice = Text::kSaving;
  panels_are_old_ = true;
  // Packing takes longer than a frame may.
  saving_ = std::async(std::launch::async,
                       [picture = *std::exchange(taken_, std::nullopt), path = saving_path_] {
                         Done done = write_png(path, picture);
                         Platform::wake();
                         return done;
                       });
}

void Window::Impl::end_saving() {
  if (!saving_.valid() || saving_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) {
    return;
  }
  const Done done = saving_.get();
  state_.notice = done ? fmt::format("{} {}", text(Text::kSaved), saving_path_) : done.error();
  touched();
}

void Window::Impl::begin_film(const std::string& path) {
  auto film = FilmWriter::start(path, renderer_->read(), Platform::wake);
  if (!film) {
    state_.notice = film.error();
    return;
  }
  film_ = std::move(*film);
  film_has_moved_ = false;
  film_ends_ = {};
  state_.notice = fmt::format("{} {}", text(Text::kFilmRuns), path);
  if (shown_.moment->state == PlayState::kPaused) {
    state_.code.follows = true;
    commands_.push(PlayCommand{});
  }
}

/// Ends a film when the program has, or when ffmpeg has.
void Window::Impl::watch_film() {
  if (!film_) return;
  const bool is_moving = moves(shown_.moment->state);
  film_has_moved_ = film_has_moved_ || is_moving;
  if (is_moving || !film_has_moved_) {
    film_ends_ = {};
  } else if (film_ends_ == Clock::time_point{}) {
    film_ends_ = Clock::now() + kFilmTail;
  }
  const bool is_over = film_ends_ != Clock::time_point{} && Clock::now() >= film_ends_;
  if (is_over || film_->has_failed()) end_film();
}

void Window::Impl::end_film() {
  if (saving_.valid()) saving_.wait();
  end_saving();
  saving_path_ = film_->path();
  state_.notice = Text::kFilmEnds;
  saving_ = std::async(std::launch::async, [film = std::move(film_)] {
    Done done = film->finish();
    Platform::wake();
    return done;
  });
  touched();
}

}  // namespace kerf
