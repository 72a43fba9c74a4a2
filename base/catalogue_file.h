// base/catalogue_file.h - where the texts of a language lie, for who needs to know their letters.
#pragma once

#include <string>

namespace kerf {

/// The catalogue of one of languages() (base/translate.h): "/usr/share/locale/fr/LC_MESSAGES/
/// kerf.mo". Empty for "en", whose texts are in the program.
std::string catalogue_file(const std::string& code);

}  // namespace kerf
