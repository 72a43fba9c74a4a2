#include "twin/tool_library/tool_library.h"

#include "base/text_scan.h"
#include "base/translate.h"

namespace kerf {

std::string title_of(const LibraryTool& tool) {
  if (tool.number && tool.name.empty()) return trf("tool {}", *tool.number);
  if (tool.number) return trf("tool {} ({})", *tool.number, shown(tool.name));
  return tool.name.empty() ? tr("a tool without a name") : trf("the tool '{}'", shown(tool.name));
}

}  // namespace kerf
