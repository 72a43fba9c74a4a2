#include "machine_io/logs/candump_line.h"

#include <gtest/gtest.h>

#include <string>

namespace kerf {
namespace {

struct Parsed {
  bool is_good = false;
  CandumpLine line;
  CandumpFault fault;
};

Parsed parse(std::string_view text) {
  Parsed parsed;
  parsed.is_good = read_candump_line(text, parsed.line, parsed.fault);
  return parsed;
}

TEST(CandumpLine, ReadsClassicFrames) {
  const Parsed p = parse("(1795210989.363816) can0 381#3706000000FF");
  ASSERT_TRUE(p.is_good) << p.fault.text;
  EXPECT_EQ(p.line.time_ns, 1'795'210'989'363'816'000);
  EXPECT_EQ(p.line.interface, "can0");
  EXPECT_EQ(p.line.frame.id, 0x381U);
  EXPECT_FALSE(p.line.frame.extended || p.line.frame.fd || p.line.frame.remote);
  ASSERT_EQ(p.line.frame.length, 6);
  EXPECT_EQ(p.line.frame.data[0], 0x37);
  EXPECT_EQ(p.line.frame.data[5], 0xFF);
  EXPECT_EQ(parse("(1.5) vcan12 080#").line.frame.length, 0);
  EXPECT_EQ(parse("(0000000001.500000) can0 080#").line.time_ns, 1'500'000'000);
  const Parsed dots = parse("(1.5) can0 080#11.22.33");
  ASSERT_TRUE(dots.is_good);
  EXPECT_EQ(dots.line.frame.length, 3);
}

TEST(CandumpLine, ReadsTheOtherKinds) {
  const Parsed wide = parse("(1.0) can0 1ABCDEF0#aabb R");
  ASSERT_TRUE(wide.is_good);
  EXPECT_TRUE(wide.line.frame.extended);
  EXPECT_EQ(wide.line.frame.id, 0x1ABCDEF0U);
  EXPECT_EQ(wide.line.frame.data[1], 0xBB);
  // An id of 8 digits is extended, however small.
  EXPECT_TRUE(parse("(1.0) can0 00000381#").line.frame.extended);
  for (const char* text : {"(1.0) can0 123#R", "(1.0) can0 123#R4", "(1.0) can0 123#R8_9 T"}) {
    const Parsed remote = parse(text);
    ASSERT_TRUE(remote.is_good) << text << ": " << remote.fault.text;
    EXPECT_TRUE(remote.line.frame.remote);
    EXPECT_EQ(remote.line.frame.length, 0);
  }
  std::string flexible = "(1.0) can0 123##5";
  for (int i = 0; i < 64; ++i) flexible += "AB";
  const Parsed fd = parse(flexible);
  ASSERT_TRUE(fd.is_good) << fd.fault.text;
  EXPECT_TRUE(fd.line.frame.fd);
  EXPECT_EQ(fd.line.frame.length, 64);
  EXPECT_EQ(parse("(1.0) can0 123##0").line.frame.length, 0);
  const Parsed error = parse("(1.0) can0 20000040#0000000000000000");
  ASSERT_TRUE(error.is_good);
  EXPECT_TRUE(error.line.frame.error);
  EXPECT_FALSE(error.line.frame.extended);
  EXPECT_EQ(error.line.frame.id, 0x40U);
  EXPECT_TRUE(parse("(1.0) can0 123#1122334455667788_C").is_good);
}

TEST(CandumpLine, SaysWhereAFaultIs) {
  const auto fault = [](const char* text) {
    const Parsed p = parse(text);
    EXPECT_FALSE(p.is_good) << text;
    return std::to_string(p.fault.column) + " " + (p.fault.text != nullptr ? p.fault.text : "");
  };
  EXPECT_EQ(fault("can0  381   [8]  37 06"), "1 '(' and the time in seconds are expected here");
  EXPECT_EQ(fault("(12.5 can0 381#"), "1 the time has no ')'");
  EXPECT_EQ(fault("(x) can0 381#"),
            "2 the time in seconds is expected here, as in (1795210989.363816)");
  EXPECT_EQ(fault("(-1.0) can0 381#").substr(0, 2), "2 ");
  EXPECT_EQ(fault("(1.0)"), "6 the interface is expected here, as in can0");
  EXPECT_EQ(fault("(1.0) can0 381"),
            "12 3 or 8 hexadecimal digits and '#' are expected here, as in 381#3706");
  EXPECT_EQ(fault("(1.0) can0 38#11").substr(0, 3), "12 ");
  EXPECT_EQ(fault("(1.0) can0 8FF#11"),
            "12 the identifier is too large: 7FF is the last of 3 digits, 1FFFFFFF of 8");
  EXPECT_EQ(fault("(1.0) can0 FFFFFFFF#11").substr(0, 3), "12 ");
  EXPECT_EQ(fault("(1.0) can0 381#112"), "18 two hexadecimal digits per byte are expected here");
  EXPECT_EQ(fault("(1.0) can0 381#112233445566778899"), "32 more bytes than a frame holds");
  EXPECT_EQ(fault("(1.0) can0 381##"), "17 the flags of CAN FD are expected here: one digit");
  EXPECT_EQ(fault("(1.0) can0 381#R9"), "17 a length of 0 to 8 is expected behind R");
  EXPECT_EQ(fault("(1.0) can0 381#1122334455667788_1"),
            "33 a length code of 9 to F is expected behind '_'");
}

TEST(CandumpLine, BearsAnyPrefix) {
  const std::string line = "(1795210989.363816) can0 381##53706000000FF.11 T";
  CandumpLine read;
  CandumpFault fault;
  int good = 0;
  for (std::size_t size = 0; size <= line.size(); ++size) {
    good += read_candump_line(std::string_view(line).substr(0, size), read, fault) ? 1 : 0;
  }
  // "381#" alone is an empty frame. From the flags on, whole at 0 to 7 bytes, and with what
  // follows.
  EXPECT_EQ(good, 1 + 8 + 2);
}

}  // namespace
}  // namespace kerf
