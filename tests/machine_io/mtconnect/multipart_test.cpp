#include "machine_io/mtconnect/multipart.h"

#include <gtest/gtest.h>

#include <vector>

#include "machine_io/mtconnect/xml_tree.h"

namespace kerf {
namespace {

std::vector<std::string> parts_of(std::string_view bytes, std::size_t step) {
  MultipartReader reader("a1b2");
  std::vector<std::string> parts;
  for (std::size_t at = 0; at < bytes.size(); at += step) {
    reader.add(bytes.substr(at, step));
    while (const auto part = reader.next()) parts.push_back(*part);
  }
  EXPECT_EQ(reader.fault(), "");
  return parts;
}

const std::string kTwo =
    "--a1b2\r\nContent-type: text/xml\r\nContent-length: 9\r\n\r\n<a>--a1b</a>\r\n"
    "--a1b2\r\nContent-Length:4\r\n\r\n<b/>\r\n--a1b2--\r\n";

TEST(Multipart, it_does_not_matter_where_the_bytes_are_cut) {
  // 12 bytes: a boundary's beginning within a body is no boundary.
  std::string text = kTwo;
  text.replace(text.find("length: 9"), 9, "length: 12");
  const std::vector<std::string> whole{"<a>--a1b</a>", "<b/>"};
  for (std::size_t step = 1; step <= text.size(); ++step) {
    EXPECT_EQ(parts_of(text, step), whole) << step;
  }
}

TEST(Multipart, without_a_length_a_part_ends_at_the_boundary) {
  const std::string text = "--a1b2\n\n<a/>\n--a1b2\n\n<b/>\n--a1b2--";
  for (std::size_t step = 1; step <= text.size(); ++step) {
    EXPECT_EQ(parts_of(text, step), (std::vector<std::string>{"<a/>\n", "<b/>\n"})) << step;
  }
}

TEST(Multipart, a_part_is_there_as_soon_as_it_is_whole) {
  MultipartReader reader("x");
  reader.add("\r\n--x\r\nContent-length: 4\r\n\r\n<b/");
  EXPECT_FALSE(reader.next());
  reader.add(">");
  EXPECT_EQ(reader.next(), "<b/>");
  EXPECT_FALSE(reader.is_ended());
  reader.add("\r\n--x--");
  EXPECT_FALSE(reader.next());
  EXPECT_TRUE(reader.is_ended());
}

TEST(Multipart, bounds) {
  MultipartReader huge("x");
  huge.add("--x\r\nContent-length: 99999999999\r\n\r\n");
  EXPECT_FALSE(huge.next());
  EXPECT_NE(huge.fault().find("99999999999"), std::string::npos);
  MultipartReader negative("x");
  negative.add("--x\r\nContent-length: -1\r\n\r\n");
  EXPECT_FALSE(negative.next());
  EXPECT_NE(negative.fault(), "");
  MultipartReader endless("x");
  endless.add(std::string(5000, 'a'));
  EXPECT_FALSE(endless.next());
  EXPECT_NE(endless.fault(), "");
  MultipartReader body("x");
  body.add("--x\n\n" + std::string(kMostXml_bytes + 1, 'a'));
  EXPECT_FALSE(body.next());
  EXPECT_NE(body.fault(), "");
}

TEST(Multipart, boundary) {
  EXPECT_EQ(MultipartReader::boundary_of("multipart/x-mixed-replace;boundary=a1b2"), "a1b2");
  EXPECT_EQ(MultipartReader::boundary_of("Multipart/X-Mixed-Replace; Boundary=\"A b\"; x=1"),
            "A b");
  EXPECT_FALSE(MultipartReader::boundary_of("text/xml"));
  EXPECT_FALSE(MultipartReader::boundary_of("multipart/mixed"));
  EXPECT_FALSE(MultipartReader::boundary_of("multipart/mixed;boundary="));
}

}  // namespace
}  // namespace kerf
