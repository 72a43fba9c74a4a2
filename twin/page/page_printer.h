// twin/page/page_printer.h - a page as PDF, by a browser that is installed.
#pragma once

#include <string>

#include "base/result.h"

namespace kerf {

/// The browser that prints (chromium, chromium-browser, google-chrome, of PATH); empty: none is
/// installed.
std::string printing_browser();

/// Prints `page` (HTML, complete) into `path`, A4 or what the page asks for; with a folder of its
/// own for whatever the browser keeps, and no network. Within two minutes. Written to a temporary
/// name and renamed. Error: no browser, what the browser said, no file.
Done print_page(const std::string& page, const std::string& path);

}  // namespace kerf
