// base/translate.h - the texts that people read, in their language. One catalogue of GNU gettext,
// `kerf`, holds them all: the English text in the source is the key, po/LANGUAGE.po the
// translation; another language is one such file. What other programs read (JSON keys, finding ids,
// option and key names, saved files) is never translated.
//
//     d.message = trf("{} is not allowed; must be above {} (mm)", value, least);
//     finding.hint = tr("end it with M2 or M30");
//     constexpr Row kRows[] = {{kFlat, tr_noop("end mill")}};   ...   tr(row.name)
//
// Any thread may ask. English costs a look at a flag; else a lookup of gettext, some 0.2 us.
#pragma once

#include <fmt/format.h>

#include <string>
#include <string_view>
#include <vector>

namespace kerf {

/// The text in the language in use; itself where there is no translation. Lives as long as the
/// program.
const char* tr(const char* text);

/// By number, as the grammar of the language has it. Both texts hold `{}` for it.
const char* trn(const char* one, const char* many, unsigned long n);

/// Marks a text that stands where nothing can be called, for the catalogue alone.
constexpr const char* tr_noop(const char* text) { return text; }

std::string formatted(const char* text, const char* translation, fmt::format_args arguments);

/// The text with its `{}` filled in. A translation may number them ({0}, {1}) to change their
/// order.
template <class... Arguments>
std::string trf(fmt::format_string<Arguments...> text, Arguments&&... arguments) {
  const char* const english = fmt::string_view(text).data();
  return formatted(english, tr(english), fmt::make_format_args(arguments...));
}

/// trn() with its number filled in.
std::string trnf(const char* one, const char* many, unsigned long n);

/// "en", and the languages of the catalogues that are installed, by their codes: "de". A catalogue
/// is FOLDER/CODE/LC_MESSAGES/kerf.mo, FOLDER being TEXTDOMAINDIR, else ../share/locale beside the
/// program's folder.
std::vector<std::string> languages();

/// The language that LC_ALL, LC_MESSAGES or LANG ask for (LANGUAGE first, where they ask for any),
/// of those that there are; else "en".
std::string language_of_environment();

/// From now on texts are in this one of languages(); false and nothing for another. Texts that were
/// made before stay. First called while the program has one thread.
bool use_language(std::string_view code);

/// "en", "de"
std::string language();

/// What a language calls itself, "Deutsch".
std::string name_of_language(const std::string& code);

}  // namespace kerf
