// Numbers read without LinuxCNC's stream: the same bits, the same records, the same errors.
#include <gtest/gtest.h>

#include <bit>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <random>
#include <set>

#include "interp_bridge/kerf_interp/plain_number.h"
#include "interp_bridge/record_format.h"
#include "tests/interp_bridge/program_test_support.h"

namespace kerf {
namespace {

namespace fs = std::filesystem;

std::string file_text(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// Records of one program, but for those that say how the time went.
std::string records_of(const std::string& program, const std::string& fast,
                       const TestFolder& folder, int& status) {
  const std::string out = folder.path("records");
  const std::string command =
      "cd '" + fs::path(program).parent_path().string() + "' && INI_FILE_NAME= HOME='" +
      folder.path("tmp") + "' timeout 20 '" KERF_INTERP_EXECUTABLE "' --fast " + fast +
      " --parameters /nowhere/p '" + program + "' 3>'" + out + "' >/dev/null 2>&1";
  status = std::system(command.c_str());
  const std::string all = file_text(out);
  std::string text = all.substr(0, sizeof records::kMagic);
  for (std::size_t at = text.size(); at + sizeof(records::Head) <= all.size();) {
    records::Head head;
    std::memcpy(&head, all.data() + at, sizeof head);
    const std::size_t bytes = sizeof head + records::payload_bytes(head);
    if (head.code != records::kAt) text += all.substr(at, bytes);
    at += bytes;
  }
  return text;
}

void expect_equal_records(const std::string& program, const TestFolder& folder) {
  int fast_status = 0, slow_status = 0;
  const std::string fast = records_of(program, "must", folder, fast_status);
  const std::string slow = records_of(program, "off", folder, slow_status);
  EXPECT_EQ(fast_status, slow_status) << program;
  EXPECT_GT(fast.size(), sizeof records::kMagic) << program;
  EXPECT_TRUE(fast == slow) << program;
}

/// As programs write them, and as nobody should.
std::string drawn_number(std::mt19937& random) {
  const auto below = [&random](unsigned n) { return static_cast<unsigned>(random() % n); };
  std::string text = below(3) == 0 ? "-" : below(8) == 0 ? "+" : "";
  for (unsigned digits = below(below(6) == 0 ? 22 : 6); digits > 0; --digits) {
    text += static_cast<char>('0' + below(10));
  }
  if (below(4) != 0) text += '.';
  for (unsigned digits = below(below(6) == 0 ? 22 : 7); digits > 0; --digits) {
    text += static_cast<char>('0' + below(10));
  }
  return text;
}

TEST(PlainNumber, HasTheBitsOfStrtod) {
  std::mt19937 random(7);
  std::size_t plain = 0;
  for (int i = 0; i < 400'000; ++i) {
    const std::string text = drawn_number(random);
    double value = 0;
    if (!interp::read_plain_number(text, value)) continue;
    ++plain;
    char* end = nullptr;
    const double expected = std::strtod(text.c_str(), &end);
    ASSERT_EQ(*end, 0) << text;
    ASSERT_EQ(std::bit_cast<std::uint64_t>(value), std::bit_cast<std::uint64_t>(expected)) << text;
  }
  EXPECT_GT(plain, 200'000U);
}

TEST(PlainNumber, LeavesTheRestToOthers) {
  for (const char* text : {"", "+", "-", ".", "-.", "--1", "+-1", "1.2.3", "1..", "1e3", " 1", "1 ",
                           "0x1", "nan", "inf", "9007199254740992", "1234567890123456789"}) {
    double value = 42;
    EXPECT_FALSE(interp::read_plain_number(text, value)) << text;
    EXPECT_EQ(value, 42) << text;
  }
  for (const char* text :
       {"0", "-0", "-0.0", "7.", ".5", "+.5", "9007199254740991", "0.1", "12345678901.2345"}) {
    double value = 42;
    EXPECT_TRUE(interp::read_plain_number(text, value)) << text;
    EXPECT_EQ(std::bit_cast<std::uint64_t>(value),
              std::bit_cast<std::uint64_t>(std::strtod(text, nullptr)))
        << text;
  }
}

/// The programs in a file of tests/truth, each in one of its own.
void unpack(const fs::path& truth, const TestFolder& folder, std::set<std::string>& programs) {
  std::ifstream lines(truth);
  std::ofstream program;
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("== ")) {
      program = {};
      const fs::path name = line.substr(3);
      if (name.extension() != ".ngc" && name.extension() != ".nc") continue;
      const std::string path = folder.path(truth.parent_path().filename().string() + "_" +
                                           truth.stem().string() + "_" + name.filename().string());
      program.open(path);
      programs.insert(path);
    } else if (program.is_open()) {
      program << line << '\n';
    }
  }
}

TEST(FastNumbers, EveryProgramOfTheTestsGivesEqualRecords) {
  const TestFolder folder;
  std::set<std::string> programs;
  for (const auto& entry : fs::recursive_directory_iterator(TRUTH_FOLDER)) {
    if (entry.path().extension() == ".truth") unpack(entry.path(), folder, programs);
  }
  EXPECT_GT(programs.size(), 900U);
  std::vector<fs::path> roots = {EXAMPLES_FOLDER};
  if (const char* shared = std::getenv("KERF_SHARED_DATA"))
    roots.push_back(fs::path(shared) / "nc");
  for (const fs::path& root : roots) {
    for (const auto& entry : fs::recursive_directory_iterator(root)) {
      if (entry.path().extension() == ".ngc" || entry.path().extension() == ".nc") {
        programs.insert(entry.path().string());
      }
    }
  }
  for (const std::string& program : programs) expect_equal_records(program, folder);
  std::cout << programs.size() << " programs\n";
}

TEST(FastNumbers, DrawnBlocksGiveEqualRecordsAndErrors) {
  const TestFolder folder;
  std::mt19937 random(25);
  const auto below = [&random](unsigned n) { return static_cast<unsigned>(random() % n); };
  for (int i = 0; i < 60; ++i) {
    std::string text = "G21 G90 F500\n";
    const unsigned odd = below(2) != 0 ? below(200) : 1000;  // where an odd number stands, if any
    for (unsigned line = 0; line < 200; ++line) {
      text += below(5) == 0 ? "G0" : "g1";
      for (const char axis : {'X', 'y', 'Z', 'A'}) {
        if (below(3) == 0) continue;
        text += below(4) == 0 ? " " : "";
        std::string number = drawn_number(random);
        const bool is_plain = number.find_first_of("0123456789") != number.npos;
        if (!is_plain) number = "1.5";
        if (line == odd && axis == 'X') number = below(2) != 0 ? "1.2.3" : "-.";
        text += axis + number;
      }
      text += below(30) == 0 ? " F[100+#1]\n" : below(30) == 0 ? " (remark)\n" : "\n";
    }
    expect_equal_records(folder.write("drawn.ngc", text + "M2\n"), folder);
  }
}

}  // namespace
}  // namespace kerf
