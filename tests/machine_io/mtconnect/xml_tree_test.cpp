#include "machine_io/mtconnect/xml_tree.h"

#include <gtest/gtest.h>

namespace kerf {
namespace {

TEST(XmlTree, elements_attributes_texts_without_prefixes) {
  const auto root = parse_xml("<m:a xmlns:m='u' m:k='1'> x &amp; <b c='&lt;'>7</b>y <b/></m:a>");
  ASSERT_TRUE(root) << root.error();
  EXPECT_EQ(root->name, "a");
  EXPECT_EQ(root->attribute("k"), "1");
  EXPECT_EQ(root->attribute("none"), "");
  EXPECT_EQ(root->text, "x & y");
  ASSERT_EQ(root->children.size(), 2U);
  EXPECT_EQ(root->child("b")->text, "7");
  EXPECT_EQ(root->child("b")->attribute("c"), "<");
  EXPECT_EQ(root->child("c"), nullptr);
}

TEST(XmlTree, what_is_none) {
  EXPECT_EQ(parse_xml("<a>\n<b></a>").error(), "line 2: mismatched tag");
  EXPECT_EQ(parse_xml("").error(), "line 1: no element found");
  EXPECT_FALSE(parse_xml("<a/><b/>"));
  EXPECT_FALSE(parse_xml("HTTP/1.1 404"));
}

TEST(XmlTree, entities_that_grow_and_files_of_others) {
  const auto bomb = parse_xml(
      "<!DOCTYPE a [<!ENTITY b 'bbbbbbbbbb'><!ENTITY c '&b;&b;&b;&b;&b;&b;'>]><a>&c;</a>");
  EXPECT_EQ(bomb.error(), "line 1: a document type is not allowed");
  EXPECT_FALSE(parse_xml("<!DOCTYPE a [<!ENTITY b SYSTEM 'file:///etc/passwd'>]><a>&b;</a>"));
  EXPECT_FALSE(parse_xml("<a>&b;</a>"));
}

TEST(XmlTree, bounds) {
  const auto nested = [](std::size_t depth) {
    std::string text;
    for (std::size_t i = 0; i < depth; ++i) text += "<a>";
    for (std::size_t i = 0; i < depth; ++i) text += "</a>";
    return text;
  };
  EXPECT_TRUE(parse_xml(nested(kMostXmlDepth)));
  EXPECT_FALSE(parse_xml(nested(kMostXmlDepth + 1)));
  std::string many = "<a>";
  for (std::size_t i = 0; i < kMostXmlElements; ++i) many += "<b/>";
  EXPECT_FALSE(parse_xml(many + "</a>"));
  EXPECT_FALSE(parse_xml("<a>" + std::string(kMostXml_bytes, ' ') + "</a>"));
}

}  // namespace
}  // namespace kerf
