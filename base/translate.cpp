#include "base/translate.h"

#include <libintl.h>

#include <algorithm>
#include <atomic>
#include <clocale>
#include <cstdlib>
#include <filesystem>
#include <mutex>
#include <shared_mutex>

#include "base/catalogue_file.h"
#include "base/text_scan.h"

// glibc's: counts changes of the language, so that gettext forgets what it has looked up (manual of
// gettext, "gettext grok").
extern "C" int _nl_msg_cat_cntr;

namespace kerf {
namespace {

constexpr const char* kDomain = "kerf";

struct State {
  std::shared_mutex changing;  ///< gettext reads LANGUAGE at each lookup; it is changed in between
  std::string code = "en";
};

std::atomic<bool> translates{false};

State& state() {
  static State* const only = new State;  // texts are asked for until the last static has gone
  return *only;
}

std::filesystem::path folder() {
  if (const char* told = std::getenv("TEXTDOMAINDIR")) return told;
  std::error_code none;
  const std::filesystem::path self = std::filesystem::read_symlink("/proc/self/exe", none);
  return self.parent_path().parent_path() / "share" / "locale";
}

/// gettext translates nothing in the locale C, whatever LANGUAGE says; which other one is in force
/// does not matter, but there must be one.
void leave_locale_c(const std::string& code) {
  // "de_DE", "zh_CN"
  const std::string place = contains(code, "_") ? code : code + "_" + to_upper(code);
  for (const std::string& name : {std::string(), place + ".UTF-8", std::string("en_US.UTF-8")}) {
    const char* found = std::setlocale(LC_MESSAGES, name.c_str());
    const std::string_view in_force = found ? found : "C";
    if (in_force != "C" && in_force != "POSIX" && !in_force.starts_with("C.")) return;
  }
  // Good for glibc before 2.39 only.
  std::setlocale(LC_MESSAGES, "C.UTF-8");
}

std::string value_of(const char* variable) {
  const char* value = std::getenv(variable);
  return value ? value : "";
}

/// "de_AT.UTF-8@euro": de_AT, else de, if there is one. Empty: there is none.
std::string known_of(std::string name, const std::vector<std::string>& known) {
  name = name.substr(0, name.find_first_of(".@"));
  for (const std::string& candidate : {name, name.substr(0, name.find('_'))}) {
    if (std::find(known.begin(), known.end(), candidate) != known.end()) return candidate;
  }
  return {};
}

}  // namespace

const char* tr(const char* text) {
  if (!translates.load(std::memory_order_relaxed) || *text == '\0') return text;
  const std::shared_lock lock(state().changing);
  return dgettext(kDomain, text);
}

const char* trn(const char* one, const char* many, unsigned long n) {
  if (!translates.load(std::memory_order_relaxed)) return n == 1 ? one : many;
  const std::shared_lock lock(state().changing);
  return dngettext(kDomain, one, many, n);
}

std::string formatted(const char* text, const char* translation, fmt::format_args arguments) {
  if (translation != text) {
    try {
      return fmt::vformat(translation, arguments);
    } catch (const fmt::format_error&) {
      // Somebody's own catalogue: a text in English is better than none.
    }
  }
  return fmt::vformat(text, arguments);
}

std::string trnf(const char* one, const char* many, unsigned long n) {
  return formatted(n == 1 ? one : many, trn(one, many, n), fmt::make_format_args(n));
}

std::string catalogue_file(const std::string& code) {
  if (code == "en") return "";
  return folder() / code / "LC_MESSAGES" / "kerf.mo";
}

std::vector<std::string> languages() {
  std::vector<std::string> all;
  std::error_code none;
  for (const auto& entry : std::filesystem::directory_iterator(folder(), none)) {
    const std::string code = entry.path().filename();
    if (code != "en" && std::filesystem::exists(catalogue_file(code), none)) {
      all.push_back(code);
    }
  }
  std::sort(all.begin(), all.end());
  all.insert(all.begin(), "en");
  return all;
}

std::string language_of_environment() {
  const std::vector<std::string> known = languages();
  std::string wanted = value_of("LC_ALL");
  if (wanted.empty()) wanted = value_of("LC_MESSAGES");
  if (wanted.empty()) wanted = value_of("LANG");
  if (wanted.empty() || wanted == "C" || wanted == "POSIX" || wanted.starts_with("C.")) return "en";
  std::string list = value_of("LANGUAGE");
  while (!list.empty()) {
    const std::size_t end = std::min(list.find(':'), list.size());
    if (std::string code = known_of(list.substr(0, end), known); !code.empty()) return code;
    list.erase(0, end + 1);
  }
  const std::string code = known_of(wanted, known);
  return code.empty() ? "en" : code;
}

bool use_language(std::string_view code) {
  const std::vector<std::string> known = languages();
  if (std::find(known.begin(), known.end(), code) == known.end()) return false;
  const std::unique_lock lock(state().changing);
  state().code = code;
  // Always set, so that a later change only replaces it: others may be reading the environment
  // then.
  setenv("LANGUAGE", state().code.c_str(), 1);
  ++_nl_msg_cat_cntr;
  if (code != "en") {
    leave_locale_c(state().code);
    bindtextdomain(kDomain, folder().c_str());
    bind_textdomain_codeset(kDomain, "UTF-8");
  }
  translates = code != "en";
  return true;
}

std::string name_of_language(const std::string& code) {
  // TRANSLATORS: what this language calls itself, as "Deutsch"
  const char* name = tr_noop("English");
  if (code == "en") return name;
  const std::unique_lock lock(state().changing);
  leave_locale_c(code);
  bindtextdomain(kDomain, folder().c_str());
  bind_textdomain_codeset(kDomain, "UTF-8");
  setenv("LANGUAGE", code.c_str(), 1);
  ++_nl_msg_cat_cntr;
  std::string found = dgettext(kDomain, name);
  setenv("LANGUAGE", state().code.c_str(), 1);
  ++_nl_msg_cat_cntr;
  return found == name ? code : found;
}

std::string language() {
  const std::shared_lock lock(state().changing);
  return state().code;
}

}  // namespace kerf
