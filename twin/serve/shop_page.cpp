#include "twin/serve/shop_page.h"

#include <nlohmann/json.hpp>

#include "base/translate.h"
#include "twin/serve/shop_assets.h"

namespace kerf {
namespace {

/// Where shop.html takes the texts that its script shows, and its language.
constexpr std::string_view kTextsMark = "@TEXTS@", kLanguageMark = "@LANGUAGE@";

void put_in(std::string& text, std::string_view mark, const std::string& value) {
  const std::size_t at = text.find(mark);
  if (at != text.npos) text.replace(at, mark.size(), value);
}

/// In a script element of the page, which only "</" would end.
std::string texts_json() {
  nlohmann::json out;
  out["connecting"] = tr("connecting");
  out["no_answer"] = tr("No answer from kerf: what is shown is old");
  out["findings"] = tr("Findings");
  out["no_findings"] = tr("none yet");
  out["none"] = tr("none");
  out["more_findings"] = tr("and {} more");
  out["token"] = tr("Token");
  out["token_wanted"] = tr("kerf has printed a link with a token where it was started");
  out["open"] = tr("Open");
  out["old"] = tr("{} old");
  out["loading"] = tr("the part is loading");
  out["no_drawing"] = tr("this browser does not draw in 3D (WebGL)");
  out["line"] = tr("line {}");
  out["iso"] = tr("Iso");
  out["top"] = tr("Top");
  out["front"] = tr("Front");
  out["right"] = tr("Right");
  out["part"] = tr("The part in 3D");
  std::string text = out.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
  for (std::size_t at = 0; (at = text.find("</", at)) != text.npos; at += 3)
    text.insert(at + 1, "\\");
  return text;
}

}  // namespace

ShopPage::ShopPage()
    : page_{"text/html; charset=utf-8", shop_assets::shop_html},
      style_{"text/css; charset=utf-8", shop_assets::shop_css},
      script_{"text/javascript; charset=utf-8", shop_assets::shop_js},
      icon_{"image/svg+xml", shop_assets::icon_svg} {
  put_in(page_.body, kTextsMark, texts_json());
  put_in(page_.body, kLanguageMark, language());
}

const ShopFile* ShopPage::find(std::string_view path) const {
  if (path == "/") return &page_;
  if (path == "/shop.css") return &style_;
  if (path == "/shop.js") return &script_;
  if (path == "/icon.svg") return &icon_;
  return nullptr;
}

}  // namespace kerf
