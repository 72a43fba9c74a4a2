// Comments of programs and remarks of tool tables from arbitrary bytes, one a line; a line that
// begins with 'i' is in inches.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <vector>

#include "stock/blank.h"
#include "stock/cutter/shape_spec.h"
#include "stock/cutter/tool_hints.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(data, data + size);
  std::vector<kerf::CommentText> comments;
  std::size_t begin = 0;
  while (begin < text.size()) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    kerf::CommentText comment;
    comment.line = static_cast<std::uint32_t>(comments.size() + 1);
    comment.text = text.substr(begin, end - begin);
    comment.inches = comment.text.starts_with('i');
    if (comment.inches) comment.text.erase(0, 1);
    comments.push_back(std::move(comment));
    begin = end + 1;
  }
  for (const kerf::ToolHint& hint : kerf::find_tool_hints(comments)) {
    if (!kerf::parse_shape(hint.shape) || hint.tool < -1) std::abort();
  }
  const auto blank = kerf::find_blank_hint(comments);
  if (blank && !kerf::parse_blank(blank->spec)) std::abort();
  for (const kerf::CommentText& comment : comments) {
    const auto hint = kerf::shape_from_remark(1, comment.inches ? 25.4 : 0, comment.text);
    if (hint && !kerf::parse_shape(hint->shape)) std::abort();
  }
  return 0;
}
