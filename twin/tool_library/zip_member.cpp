#include "twin/tool_library/zip_member.h"

#include <algorithm>
#include <optional>
#include <vector>

#include "base/text_scan.h"
#include "base/translate.h"
#include "base/zip_file.h"

namespace kerf {

Result<std::string> json_of_zip(std::string_view bytes, std::size_t max_bytes) {
  const std::optional<std::vector<std::string>> names = names_in_zip(bytes);
  if (!names) return Error{tr("is no whole zip file")};
  const auto at = std::ranges::find_if(
      *names, [](const std::string& name) { return to_lower(name).ends_with(".json"); });
  if (at == names->end())
    return Error{tr("is a zip file without a .json in it; tools.json is needed")};
  std::string text;
  const auto member = static_cast<std::size_t>(at - names->begin());
  const Unpacked end = unpack_zip(bytes, member, max_bytes, [&](std::string_view piece) {
    text += piece;
    return true;
  });
  if (end == Unpacked::kTooLarge)
    return Error{trf("its .json is larger than {} MB", max_bytes / (1024 * 1024))};
  if (end != Unpacked::kWhole) return Error{tr("its .json cannot be unpacked")};
  return text;
}

}  // namespace kerf
