// Every listing of the shared test data must be understood. Needs KERF_SHARED_DATA.
#include <gtest/gtest.h>

#include <cstdio>

#include "interp_bridge/canonical.h"
#include "interp_bridge/canonical_reader.h"
#include "tests/interp_bridge/program_test_support.h"

namespace kerf {
namespace {

std::string listing_text(const std::filesystem::path& path) {
  if (path.extension() != ".gz") return text_of(path);
  std::string text;
  std::FILE* const unpacked = popen(("zcat '" + path.string() + "'").c_str(), "r");
  EXPECT_NE(unpacked, nullptr);
  char buffer[65536];
  while (const std::size_t got = std::fread(buffer, 1, sizeof buffer, unpacked))
    text.append(buffer, got);
  EXPECT_EQ(pclose(unpacked), 0);
  return text;
}

std::vector<std::filesystem::path> listings(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> found;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    if (name.find(".canon") != name.npos && entry.is_regular_file()) found.push_back(entry.path());
  }
  return found;
}

struct Read {
  ProgramSummary summary;
  Diagnostics diagnostics;
  std::size_t motions = 0;

  explicit Read(std::string_view text) {
    const MotionSink sink = [this](std::span<const Motion> batch) {
      motions += batch.size();
      return true;
    };
    CanonicalReaderOptions options;
    options.listing_name = "listing";
    CanonicalReader reader(options, sink, summary, diagnostics);
    while (!text.empty()) {
      const std::span<char> room = reader.room();
      const std::size_t bytes = std::min(room.size(), text.size());
      std::copy_n(text.begin(), bytes, room.begin());
      if (!reader.received(bytes)) break;
      text.remove_prefix(bytes);
    }
    reader.finish();
  }
};

TEST(ListingCorpus, EveryListingIsUnderstood) {
  if (shared_data().empty()) GTEST_SKIP() << "KERF_SHARED_DATA is not set";
  std::size_t files = 0;
  std::size_t motions = 0;
  std::uint64_t commands = 0;
  for (const auto& path : listings(shared_data() / "canon")) {
    const Read read(listing_text(path));
    for (const Diagnostic& diagnostic : read.diagnostics) {
      const bool spline = diagnostic.message.find("spline") != std::string::npos;
      // Two listings are of numbers that no machine has.
      const bool wild = diagnostic.message.find("no machine has") != std::string::npos;
      const bool is_wild = path.filename() == "neg.ngc.canon" || path.filename() == "big.ngc.canon";
      EXPECT_TRUE(spline || (wild && is_wild)) << path << ": " << to_string(diagnostic);
    }
    ++files;
    motions += read.motions;
    for (const auto& [name, count] : read.summary.canonical_commands) commands += count;
  }
  EXPECT_GE(files, 600u);
  EXPECT_GE(commands, 380'000u);
  EXPECT_GE(motions, 290'000u);
}

TEST(ListingCorpus, SyntheticListingsCutAtEveryByte) {
  if (shared_data().empty()) GTEST_SKIP() << "KERF_SHARED_DATA is not set";
  for (const auto& path : listings(shared_data() / "canon/synthetic")) {
    const std::string text = listing_text(path).substr(0, 30'000);
    // The line in which the cut lies is what matters; the ones before it are the same every time.
    std::size_t begin = 0;
    while (begin < text.size()) {
      const std::size_t end = std::min(text.find('\n', begin), text.size());
      for (std::size_t cut = begin; cut <= end; ++cut) {
        const std::vector<char> line(text.begin() + static_cast<std::ptrdiff_t>(begin),
                                     text.begin() + static_cast<std::ptrdiff_t>(cut));
        CanonicalLine parsed;
        parse_canonical_line({line.data(), line.size()}, parsed);
        // A command ends in its parenthesis; only a string may look complete before its end.
        const bool closed = !line.empty() && line.back() == ')';
        EXPECT_TRUE(parsed.kind != CanonicalLineKind::kCommand || closed ||
                    parsed.command.name == CanonicalName::kCanonError)
            << path << " " << cut;
      }
      begin = end + 1;
    }
  }
}

TEST(ListingCorpus, GluedLinesAreReported) {
  if (shared_data().empty()) GTEST_SKIP() << "KERF_SHARED_DATA is not set";
  std::string text = listing_text(shared_data() / "canon/synthetic/all_canon.ngc.canon");
  std::replace(text.begin(), text.end(), '\n', ' ');
  const Read read(text);
  EXPECT_EQ(read.motions, 0u);
  EXPECT_EQ(read.diagnostics.size(), 1u);
}

}  // namespace
}  // namespace kerf
