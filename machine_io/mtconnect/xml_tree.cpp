#include "machine_io/mtconnect/xml_tree.h"

#include <expat.h>

#include <memory>

#include "base/expat_line.h"
#include "base/text_scan.h"
#include "base/translate.h"

namespace kerf {
namespace {

std::string_view without_prefix(std::string_view name) {
  const std::size_t colon = name.rfind(':');
  return colon == name.npos ? name : name.substr(colon + 1);
}

/// What expat tells becomes a tree. Parents lie in `open_`: a list of children grows only while
/// none of them is open, so the pointers hold.
class XmlBuilder {
 public:
  explicit XmlBuilder(XML_Parser parser) : parser_(parser) {
    XML_SetUserData(parser, this);
    XML_SetElementHandler(
        parser,
        [](void* self, const XML_Char* name, const XML_Char** attributes) {
          static_cast<XmlBuilder*>(self)->begin(name, attributes);
        },
        [](void* self, const XML_Char*) { static_cast<XmlBuilder*>(self)->end(); });
    XML_SetCharacterDataHandler(parser, [](void* self, const XML_Char* text, int length) {
      auto& open = static_cast<XmlBuilder*>(self)->open_;
      if (!open.empty()) open.back()->text.append(text, static_cast<std::size_t>(length));
    });
    XML_SetStartDoctypeDeclHandler(
        parser, [](void* self, const XML_Char*, const XML_Char*, const XML_Char*, int) {
          static_cast<XmlBuilder*>(self)->fail(tr("a document type is not allowed"));
        });
  }

  Result<XmlElement> build(std::string_view text) {
    const bool good =
        XML_Parse(parser_, text.data(), static_cast<int>(text.size()), XML_TRUE) == XML_STATUS_OK;
    if (!good && fault_.empty()) fail(XML_ErrorString(XML_GetErrorCode(parser_)));
    if (!fault_.empty()) return Error{std::move(fault_)};
    return std::move(root_);
  }

 private:
  void fail(std::string_view what) {
    if (!fault_.empty()) return;
    fault_ = trf("line {}: {}", expat_line(parser_), what);
    XML_StopParser(parser_, XML_FALSE);
  }

  void begin(std::string_view name, const XML_Char** attributes) {
    if (!fault_.empty()) return;
    if (++elements_ > kMostXmlElements) {
      return fail(trf("more than {} elements", kMostXmlElements));
    }
    if (open_.size() >= kMostXmlDepth) {
      return fail(trf("more than {} elements in each other", kMostXmlDepth));
    }
    XmlElement& element = open_.empty() ? root_ : open_.back()->children.emplace_back();
    element.name = without_prefix(name);
    for (const XML_Char** at = attributes; *at != nullptr; at += 2) {
      element.attributes.emplace_back(without_prefix(at[0]), at[1]);
    }
    open_.push_back(&element);
  }
  void end() {
    if (!fault_.empty() || open_.empty()) return;
    std::string& text = open_.back()->text;
    text = std::string(trim(text));
    open_.pop_back();
  }

  XML_Parser parser_;
  XmlElement root_;
  std::vector<XmlElement*> open_;
  std::size_t elements_ = 0;
  std::string fault_;
};

}  // namespace

std::string_view XmlElement::attribute(std::string_view wanted) const {
  for (const auto& [key, value] : attributes) {
    if (key == wanted) return value;
  }
  return {};
}

const XmlElement* XmlElement::child(std::string_view wanted) const {
  for (const XmlElement& one : children) {
    if (one.name == wanted) return &one;
  }
  return nullptr;
}

Result<XmlElement> parse_xml(std::string_view text) {
  if (text.size() > kMostXml_bytes) {
    return Error{trf("{} bytes; {} are allowed", text.size(), kMostXml_bytes)};
  }
  const std::unique_ptr<XML_ParserStruct, decltype(&XML_ParserFree)> parser(
      XML_ParserCreate(nullptr), &XML_ParserFree);
  return XmlBuilder(parser.get()).build(text);
}

}  // namespace kerf
