// machine_io/mtconnect/xml_tree.h - an XML document as a tree, within bounds.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/result.h"

namespace kerf {

/// What no agent of one machine exceeds; what does is refused, not cut off.
inline constexpr std::size_t kMostXml_bytes = std::size_t{8} << 20U;
inline constexpr std::size_t kMostXmlElements = 200'000;
inline constexpr std::size_t kMostXmlDepth = 64;

/// Names are without the prefixes of namespaces: MTConnect's are told apart without them, and
/// extensions ("x:Kinematics") have names that the standard has not.
struct XmlElement {
  std::string name;
  std::vector<std::pair<std::string, std::string>> attributes;
  std::string text;  ///< its own, blanks at both ends taken off
  std::vector<XmlElement> children;

  /// Empty: it has none of that name.
  std::string_view attribute(std::string_view wanted) const;
  /// The first child of that name; null: there is none.
  const XmlElement* child(std::string_view wanted) const;
};

/// Error: one sentence with the line ("line 3: mismatched tag"). Document types are refused, and
/// with them entities of their own: a few bytes would become many, or another file's.
Result<XmlElement> parse_xml(std::string_view text);

}  // namespace kerf
