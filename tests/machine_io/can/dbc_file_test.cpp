// DBC files: what is read, and what is said about bad ones.
#include "machine_io/can/dbc_file.h"

#include <gtest/gtest.h>

#include <string>

#include "tests/base/temporary_folder.h"

namespace kerf {
namespace {

constexpr const char* kBus = R"(VERSION "1.0 BO_ 1 no: 8 x"

NS_ :
	CM_
	BA_DEF_
	SIG_VALTYPE_
	SG_MUL_VAL_

BS_:

BU_: Drives Master

BO_ 897 DriveX: 6 Drives
 SG_ Status : 0|16@1+ (1,0) [0|65535] ""  Master
 SG_ Position : 16|32@1- (0.001,-5) [-1000|1000] "mm" Master

BO_ 2147484545 DriveExt: 8 Drives
 SG_ Position : 7|16@0- (1E-2,+0.5) [0|0] "deg" Master
 SG_ Turns : 24|32@1- (5,0) [0|0] "turn" Master

BO_ 512 Status: 8 Drives
 SG_ Page M : 0|4@1+ (1,0) [0|15] "" Master
 SG_ Tool m1 : 8|16@1+ (1,0) [0|0] "" Master
 SG_ Speed m2 : 8|16@1- (2,0) [0|0] "1/min" Master

BO_ 3221225472 VECTOR__INDEPENDENT_SIG_MSG: 0 Vector__XXX
 SG_ Unused : 0|8@1+ (1,0) [0|0] "" Vector__XXX

CM_ SG_ 897 Position "lies in the drive.
BO_ 5 NotAMessage: 8 x
 SG_ NotASignal : 0|8@1+ (1,0) [0|0] \"\" y";
BA_DEF_ BO_ "Cycle" INT 0 1000;
VAL_ 897 Status 0 "off" 1 "on" ;
SIG_VALTYPE_ 2147484545 Turns : 1;
)";

std::string texts_of(const Diagnostics& diagnostics) {
  std::string all;
  for (const Diagnostic& diagnostic : diagnostics) all += to_string(diagnostic);
  return all;
}

DbcFile parse(std::string_view text, Diagnostics& diagnostics) {
  return parse_dbc(text, "bus.dbc", diagnostics);
}

/// The first diagnostic of a message with this one line in it.
Diagnostic fault_of(const std::string& line) {
  Diagnostics diagnostics;
  parse("BO_ 1 M: 8 x\n" + line + "\n", diagnostics);
  EXPECT_EQ(diagnostics.size(), 1U) << line << "\n" << texts_of(diagnostics);
  return diagnostics.empty() ? Diagnostic{} : diagnostics.front();
}

DbcSignal found(const DbcFile& file, std::string_view name) {
  const auto signal = file.find(name);
  EXPECT_TRUE(signal) << name << ": " << (signal ? "" : signal.error());
  return signal ? *signal : DbcSignal{};
}

void expect_the_bus(const DbcFile& file) {
  ASSERT_EQ(file.signals().size(), 7U);
  const DbcSignal x = found(file, "DriveX.Position");
  EXPECT_EQ(x.signal.id, 0x381U);
  EXPECT_FALSE(x.signal.extended);
  EXPECT_EQ(x.signal.bits.start_bit, 16);
  EXPECT_EQ(x.signal.bits.length, 32);
  EXPECT_EQ(x.signal.bits.endian, CanEndian::kLittle);
  EXPECT_EQ(x.signal.type, CanType::kSigned);
  EXPECT_EQ(x.signal.scale, 0.001);
  EXPECT_EQ(x.signal.offset, -5.0);
  EXPECT_EQ(x.unit, "mm");
  EXPECT_EQ(x.line, 15);
  EXPECT_TRUE(validate(x.signal, "x").empty());

  const DbcSignal extended = found(file, "DriveExt.Position");
  EXPECT_EQ(extended.signal.id, 897U);
  EXPECT_TRUE(extended.signal.extended);
  EXPECT_EQ(extended.signal.bits.start_bit, 7);
  EXPECT_EQ(extended.signal.bits.endian, CanEndian::kBig);
  EXPECT_EQ(extended.signal.scale, 0.01);
  EXPECT_EQ(extended.signal.offset, 0.5);

  EXPECT_EQ(found(file, "Turns").signal.type, CanType::kFloat32);
  EXPECT_EQ(found(file, "Status.Page").signal.mux.has_value(), false);
  const DbcSignal speed = found(file, "Speed");
  ASSERT_TRUE(speed.signal.mux.has_value());
  EXPECT_EQ(speed.signal.mux->value, 2U);
  EXPECT_EQ(speed.signal.mux->bits.length, 4);
}

TEST(DbcFile, SignalsOfABus) {
  Diagnostics diagnostics;
  const DbcFile file = parse(kBus, diagnostics);
  EXPECT_EQ(texts_of(diagnostics), "");
  expect_the_bus(file);
}

TEST(DbcFile, LineEndsOfDosAndAByteOrderMark) {
  std::string text = "\xEF\xBB\xBF";
  for (const char* c = kBus; *c != '\0'; ++c) {
    if (*c == '\n') text += '\r';
    text += *c;
  }
  Diagnostics diagnostics;
  const DbcFile file = parse(text, diagnostics);
  EXPECT_EQ(texts_of(diagnostics), "");
  expect_the_bus(file);
}

TEST(DbcFile, UnitsAreLatin1) {
  Diagnostics diagnostics;
  const DbcFile file = parse("BO_ 1 M: 8 x\n SG_ A : 0|8@1+ (1,0) [0|0] \"\xB0\" x\n", diagnostics);
  EXPECT_EQ(texts_of(diagnostics), "");
  EXPECT_EQ(found(file, "A").unit, "\xC2\xB0");
}

TEST(DbcFile, NamesThatAreNotThereOrNotUnique) {
  Diagnostics diagnostics;
  const DbcFile file = parse(kBus, diagnostics);
  EXPECT_EQ(file.find("Position").error(),
            "bus.dbc: 2 signals are called Position: DriveX.Position, DriveExt.Position; write "
            "Message.Signal");
  EXPECT_EQ(file.find("DriveX.Speed").error(),
            "bus.dbc: no signal is called DriveX.Speed; there is DriveX.Status, DriveX.Position, "
            "Status.Speed");
  EXPECT_EQ(file.find("Nothing").error(),
            "bus.dbc: no signal is called Nothing; there are 7 others");
  EXPECT_FALSE(file.find(""));
  EXPECT_FALSE(file.find("NotAMessage.NotASignal"));
}

TEST(DbcFile, ADiagnosticShowsThePlace) {
  Diagnostics diagnostics;
  parse("BO_ 1 M: 8 x\n SG_ A : 0|8@1* (1,0) [0|0] \"\" x\n", diagnostics);
  EXPECT_EQ(texts_of(diagnostics),
            "bus.dbc:2:15: error: '+' or '-' is missing here\n"
            "     2 |  SG_ A : 0|8@1* (1,0) [0|0] \"\" x\n"
            "       |               ^\n");
}

TEST(DbcFile, FaultySignalsAreReported) {
  const std::vector<std::pair<std::string, std::string>> cases{
      {" SG_ 7 : 0|8@1+ (1,0)", "the signal's name, at most 128 letters, digits and _ is missing"},
      {" SG_ A 0|8@1+ (1,0)", "M, m and a number, or ':' is missing"},
      {" SG_ A m : 0|8@1+ (1,0)", "M, m and a number, or ':' is missing"},
      {" SG_ A : x|8@1+ (1,0)", "the start bit is missing"},
      {" SG_ A : 0 8@1+ (1,0)", "'|' is missing"},
      {" SG_ A : 0|@1+ (1,0)", "the length in bits is missing"},
      {" SG_ A : 0|99999999999999999999@1+ (1,0)", "the length in bits is missing"},
      {" SG_ A : 0|0@1+ (1,0)", "A has 0 bits; allowed are 1 to 64"},
      {" SG_ A : 0|4000000000@1+ (1,0)", "A has 4000000000 bits; allowed are 1 to 64"},
      {" SG_ A : 4000000000|8@1+ (1,0)",
       "A: 8 bits from bit 4000000000 on do not fit into the 8 bytes of M"},
      {" SG_ A : 60|8@1+ (1,0)", "A: 8 bits from bit 60 on do not fit into the 8 bytes of M"},
      {" SG_ A : 0|16@2+ (1,0)",
       "byte order 2 of A; allowed are 1 (little-endian) and 0 (big-endian)"},
      {" SG_ A : 0|8@1+ (nan,0)", "the factor, a finite number is missing"},
      {" SG_ A : 0|8@1+ (1,1e999)", "the offset, a finite number is missing"},
      {" SG_ A : 0|8@1+ (1,0", "')' is missing"},
      {" SG_ A : 0|8@1+ (1,0) [0|1", "']' is missing"},
      {" SG_ A : 0|8@1+ (1,0) [0|1] \"mm", "the '\"' that ends the unit is missing"},
      {" SG_ A m3 : 0|8@1+ (1,0)", "M has multiplexed signals (m0 ...) but no multiplexor (M)"},
      {"BO_ x N: 8 y", "the message's id, a decimal number is missing"},
      {"BO_ 2 N 8 y", "':' is missing"},
      {"BO_ 2 N: y", "the message's length in bytes is missing"},
      {"BO_ 2 N: 1786 y", "a message of 1786 bytes; a frame has at most 64: its signals"},
      {"BO_ 4096 N: 8 y",
       "4096 is no message id; allowed are 0 to 2047, and 2147483648 to 2684354559 for extended"},
      {"BO_ 1 N: 8 y", "a second message with the id 1; the first one counts"},
      {"SIG_VALTYPE_ 1 A : 3;", "value type 3 of A; allowed are 0 (integer), 1 (float32), 2"},
      {"SIG_VALTYPE_ 1 A : ;", "the value type, 0 to 2 is missing"},
      {" SG_ A : 0|16@1+ (1,0)\nSIG_VALTYPE_ 1 A : 1;", "A is a float32 of 16 bits"},
      {"CM_ \"never ends\nBO_ 2 N: 8 y", "a text begins in this statement and never ends"}};
  for (const auto& [line, message] : cases) {
    const Diagnostic fault = fault_of(line);
    EXPECT_EQ(fault.severity, Severity::kError) << line;
    EXPECT_EQ(fault.message.substr(0, message.size()), message) << line;
    EXPECT_GE(fault.line, 1) << line;
  }
}

TEST(DbcFile, ASignalOutsideOfAMessage) {
  Diagnostics diagnostics;
  parse(" SG_ A : 0|8@1+ (1,0) [0|0] \"\" x\n", diagnostics);
  ASSERT_EQ(diagnostics.size(), 1U);
  EXPECT_EQ(diagnostics[0].message, "a signal outside of a message");
}

TEST(DbcFile, TransportMessagesAndExtendedMultiplexingAreLeftOutWithAWarning) {
  Diagnostics diagnostics;
  const DbcFile file = parse(
      "BO_ 1 Long: 200 x\n SG_ A : 900|8@1+ (1,0) [0|0] \"\" x\n"
      "BO_ 2 Nested: 8 x\n SG_ M1 M : 0|4@1+ (1,0)\n SG_ M2 m1M : 4|4@1+ (1,0)\n"
      " SG_ B m2 : 8|8@1+ (1,0)\n SG_ C : 16|8@1+ (1,0)\n",
      diagnostics);
  ASSERT_EQ(diagnostics.size(), 2U) << texts_of(diagnostics);
  EXPECT_FALSE(has_error(diagnostics));
  EXPECT_EQ(diagnostics[1].message,
            "Nested: extended multiplexing is not read; its multiplexed signals are left out");
  EXPECT_EQ(diagnostics[1].line, 3);
  ASSERT_EQ(file.signals().size(), 2U);
  EXPECT_EQ(file.signals()[0].name, "M1");
  EXPECT_EQ(file.signals()[1].name, "C");
}

TEST(DbcFile, ManyFaultsEndTheReading) {
  std::string text;
  for (int i = 0; i < 1000; ++i) text += " SG_ A\n";
  Diagnostics diagnostics;
  parse(text, diagnostics);
  ASSERT_EQ(diagnostics.size(), kMaxDbcDiagnostics);
  EXPECT_EQ(to_string(diagnostics.back()),
            "bus.dbc:50: error: 49 faults; the rest is not read\n   hint: is it a DBC file?\n");
}

TEST(DbcFile, EveryCutOfAFileIsRead) {
  const std::string text = kBus;
  for (std::size_t cut = 0; cut <= text.size(); ++cut) {
    Diagnostics diagnostics;
    const DbcFile file = parse(std::string_view(text).substr(0, cut), diagnostics);
    ASSERT_LE(file.signals().size(), 7U);
    for (const DbcSignal& signal : file.signals()) {
      ASSERT_TRUE(validate(signal.signal, "s").empty());
    }
  }
}

TEST(DbcFile, FilesAreReadAndMissingOnesReported) {
  const TemporaryFolder folder;
  const std::string path = folder / "bus.dbc";
  write_file(path, kBus);
  Diagnostics diagnostics;
  EXPECT_EQ(read_dbc_file(path, diagnostics).signals().size(), 7U);
  EXPECT_TRUE(diagnostics.empty());
  for (const std::string& bad : {folder / "none.dbc", folder.path()}) {
    diagnostics.clear();
    EXPECT_TRUE(read_dbc_file(bad, diagnostics).signals().empty());
    ASSERT_EQ(diagnostics.size(), 1U) << bad;
    EXPECT_EQ(diagnostics[0].message, "the DBC file cannot be read");
  }
}

}  // namespace
}  // namespace kerf
