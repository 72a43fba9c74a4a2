#include "twin/cli/view_setups.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <utility>

#include "base/exit_code.h"
#include "base/translate.h"

namespace kerf {

std::unique_ptr<ViewSetups> ViewSetups::open(const Arguments& asked, Diagnostics& diagnostics) {
  Arguments before = asked;
  before.options.set_flag("--quiet");
  std::optional<JobRun> run = JobRun::open(before, asked.options.text("PROGRAM"), diagnostics);
  if (run) run->check(diagnostics);
  if (!run || has_error(diagnostics)) return nullptr;
  return std::unique_ptr<ViewSetups>(new ViewSetups(asked, std::move(*run)));
}

std::optional<int> ViewSetups::begin(std::size_t first) {
  JobRun::Wishes wishes;
  wishes.compares = false;
  for (std::size_t setup = 0; setup < first; ++setup) {
    Left& left = left_[setup];
    left.arguments = run_.view_arguments(setup, false);
    left.files.add(left.arguments.options.text("PROGRAM"));
  }
  run_.run(0, first, wishes);
  if (!run_.is_ready(first)) return std::max<int>(run_.result().code, kExitFailure);
  first_ = shown_ = first;
  return std::nullopt;
}

std::vector<std::string> ViewSetups::names() const {
  std::vector<std::string> names;
  for (std::size_t n = 0; n < count(); ++n) {
    const std::string& name = run_.job().setups[n].name;
    names.push_back(name.empty() ? trf("setup {}", n + 1) : fmt::format("{}  {}", n + 1, name));
  }
  return names;
}

std::string ViewSetups::title() const {
  return fmt::format("{}, {}", std::filesystem::path(path()).filename().string(),
                     run_.title_of(shown_));
}

std::string ViewSetups::blank_words(const Arguments& shown) const {
  return shown.options.text("--stock") == carried_blank() ? run_.blank_words(shown_)
                                                          : std::string();
}

std::string ViewSetups::carried_blank() const {
  return shown_ == 0 ? std::string() : run_.carried_blank(shown_);
}

Arguments ViewSetups::arguments() const {
  const auto left = left_.find(shown_);
  if (left != left_.end()) return left->second.arguments;
  Arguments out = run_.view_arguments(shown_, shown_ == first_);
  if (!asked_.options.has("--quiet")) out.options.clear("--quiet");
  return out;
}

Arguments ViewSetups::job_arguments(const Arguments& shown) const {
  Arguments out = asked_;
  const Arguments as_is = run_.view_arguments(shown_, shown_ == first_);
  if (shown_ != first_) {
    out.options.clear("--at-line");
    for (const Setting& setting : setting_table())
      if (is_passed_on(setting)) out.options.clear(setting.option);
  }
  out.options.set("PROGRAM", path());
  out.options.set("--setup", fmt::format("{}", shown_ + 1));
  for (const char* const option : {"--stock", "--cell", "--model"}) {
    const std::string& text = shown.options.text(option);
    if (text == as_is.options.text(option)) continue;
    if (text.empty()) {
      out.options.clear(option);
    } else {
      out.options.set(option, text);
    }
  }
  const std::vector<std::string>& tools = shown.options.texts("--tool");
  if (tools != as_is.options.texts("--tool")) out.options.set_all("--tool", tools);
  return out;
}

std::optional<std::size_t> ViewSetups::changed_before(std::size_t setup) const {
  for (const auto& [number, left] : left_) {
    if (number >= setup) break;
    // Of the one that is shown its window looks after the files.
    if (number != shown_ && left.files.differs()) return number;
  }
  return std::nullopt;
}

std::size_t ViewSetups::last_ready(std::size_t setup) const {
  while (!run_.is_ready(setup)) --setup;
  return changed_before(setup).value_or(setup);
}

void ViewSetups::choose(std::size_t setup, const Arguments& left, const FileWatch& files) {
  left_[shown_] = {left, files};
  const auto before = left_.find(setup);
  if (before != left_.end() && before->second.files.differs()) run_.forget_after(setup);
  shown_ = setup;
}

}  // namespace kerf
