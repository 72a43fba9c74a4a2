// base/expat_line.h - where expat is in what it reads.
#pragma once

#include <expat.h>

namespace kerf {

/// Since 2.9 expat warns of the type by which it counted lines before. From 1.
inline auto expat_line(XML_Parser parser) {
#if XML_MAJOR_VERSION > 2 || XML_MINOR_VERSION >= 9
  return XML_GetCurrentLineNumber64(parser);
#else
  return XML_GetCurrentLineNumber(parser);
#endif
}

}  // namespace kerf
