#include "twin/report/finding_lists.h"

#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <set>

#include "tests/base/temporary_folder.h"

namespace kerf {
namespace {

using Json = nlohmann::json;

Finding finding(FindingId id, Severity severity, std::uint32_t line) {
  Finding f;
  f.id = id;
  f.severity = severity;
  f.source.line = line;
  f.text = "something";
  return f;
}

ListedProgram program(const std::string& path, std::size_t errors, std::size_t notes) {
  ListedProgram out;
  out.path = path;
  out.files = {path};
  for (std::size_t i = 0; i < notes; ++i)
    out.findings.add(finding(FindingId::kNearMiss, Severity::kNote, 1));
  for (std::size_t i = 0; i < errors; ++i)
    out.findings.add(finding(FindingId::kRapidContact, Severity::kError, 2));
  return out;
}

TEST(FindingTable, EachFindingHasAnIdOfItsOwnAndSaysWhatItMeans) {
  std::set<std::string> names;
  for (const FindingRow& row : finding_table()) {
    EXPECT_TRUE(names.insert(row.name).second) << row.name;
    EXPECT_EQ(std::string(row.meaning).back(), '.') << row.name;
    EXPECT_STREQ(to_string(row.id), row.name);
  }
  EXPECT_EQ(names.size(), kFindingIds);
}

TEST(Sarif, WhereThereAreTooManyTheWorstAreKept) {
  const ListedProgram listed[] = {program("a.ngc", 2, 5), program("b.ngc", 3, 4)};
  const Json run = Json::parse(sarif_text(listed, "1", "/parts", 6))["runs"][0];
  ASSERT_EQ(run["results"].size(), 6u);
  for (int i = 0; i < 5; ++i) EXPECT_EQ(run["results"][i]["level"], "error") << i;
  EXPECT_EQ(run["results"][5]["level"], "note");
  const std::string told =
      run["invocations"][0]["toolExecutionNotifications"][0]["message"]["text"];
  EXPECT_NE(told.find("14"), std::string::npos) << told;
  EXPECT_NE(told.find("8"), std::string::npos) << told;
  // All of them: in the order in which they were found, and nothing to tell.
  const Json whole = Json::parse(sarif_text(listed, "1", "/parts", 14))["runs"][0];
  EXPECT_EQ(whole["results"].size(), 14u);
  EXPECT_EQ(whole["results"][0]["level"], "note");
  EXPECT_FALSE(whole["invocations"][0].contains("toolExecutionNotifications"));
}

TEST(Sarif, PathsAreUrisBelowTheFolderOrElsewhere) {
  for (const auto& [path, uri] : std::vector<std::pair<std::string, std::string>>{
           {"part 1.ngc", "part%201.ngc"},
           {"./sub/../a#b.ngc", "a%23b.ngc"},
           {"/parts/x/deep.ngc", "x/deep.ngc"},
           {"../out.ngc", "file:///out.ngc"},
           {"/else/where.ngc", "file:///else/where.ngc"}}) {
    const ListedProgram listed = program(path, 1, 0);
    const Json run = Json::parse(sarif_text({&listed, 1}, "1", "/parts"))["runs"][0];
    const Json place = run["results"][0]["locations"][0]["physicalLocation"]["artifactLocation"];
    EXPECT_EQ(place["uri"], uri);
    EXPECT_EQ(place.contains("uriBaseId"), !uri.starts_with("file:")) << path;
  }
}

/// About the program as a whole: its first line, since code hosts want one.
TEST(Sarif, WhatHasNoLineIsAtTheFirst) {
  ListedProgram listed = program("a.ngc", 0, 0);
  listed.findings.add(finding(FindingId::kToolUnused, Severity::kNote, 0));
  const Json run = Json::parse(sarif_text({&listed, 1}, "1", "/parts"))["runs"][0];
  EXPECT_EQ(run["results"][0]["locations"][0]["physicalLocation"]["region"]["startLine"], 1);
}

TEST(Sarif, FingerprintsGoByTheWordsOfTheLine) {
  const TemporaryFolder folder;
  const std::string path = folder.path() + "/a.ngc";
  const auto print_of = [&](const std::string& text, std::uint32_t line) {
    std::ofstream(path) << text;
    ListedProgram listed = program(path, 0, 0);
    listed.findings.add(finding(FindingId::kRapidContact, Severity::kError, line));
    const Json run = Json::parse(sarif_text({&listed, 1}, "1", folder.path()))["runs"][0];
    return run["results"][0]["partialFingerprints"]["kerf/v1"].get<std::string>();
  };
  const std::string first = print_of("G0 X1\n", 1);
  EXPECT_EQ(first.size(), 16u);
  EXPECT_EQ(print_of("(new)\r\nN20 g0  x1 (over) ; to\r\n", 2), first);
  EXPECT_NE(print_of("G0 X2\n", 1), first);
  // Two of the same words are told apart.
  ListedProgram two = program(path, 2, 0);
  const Json run = Json::parse(sarif_text({&two, 1}, "1", folder.path()))["runs"][0];
  EXPECT_NE(run["results"][0]["partialFingerprints"], run["results"][1]["partialFingerprints"]);
}

/// main.ngc calls drill.ngc in its lines 2 and 4, which calls deep.ngc, which a subroutine in
/// main.ngc itself calls as well.
TEST(Sarif, WhatIsInASubroutineHasTheLinesThatCallIt) {
  const TemporaryFolder folder;
  const auto write = [&](const std::string& name, const std::string& text) {
    std::ofstream(folder.path() + "/" + name) << text;
    return folder.path() + "/" + name;
  };
  const std::string program = write("main.ngc",
                                    "o<own> sub\nN2 O<Drill> call\no<own> endsub\n"
                                    "o<drill> call (twice)\no<own> call\n(o<drill> call)\nM2\n");
  const std::string drill =
      write("drill.ngc", "o<drill> sub\nG1 Z-1\no<deep> call\no<drill> endsub\n");
  const std::string deep = write("deep.ngc", "o<deep> sub\nG1 Z-2\no<deep> endsub\n");
  ListedProgram listed;
  listed.path = program;
  listed.files = {program, drill, deep};
  for (const auto& [file, line] : {std::pair(0u, 5u), std::pair(1u, 2u), std::pair(2u, 2u)}) {
    Finding f = finding(FindingId::kRapidContact, Severity::kError, line);
    f.source.file = file;
    listed.findings.add(f);
  }
  const Json log = Json::parse(sarif_text({&listed, 1}, "1", folder.path()));
  const Json& results = log["runs"][0]["results"];
  ASSERT_EQ(results.size(), 3u);
  const auto callers = [&](std::size_t n) {
    std::vector<std::string> out;
    if (!results[n].contains("relatedLocations")) return out;
    for (const Json& at : results[n]["relatedLocations"]) {
      const Json& place = at["physicalLocation"];
      out.push_back(place["artifactLocation"]["uri"].get<std::string>() + ":" +
                    std::to_string(place["region"]["startLine"].get<int>()) + " " +
                    at["message"]["text"].get<std::string>());
    }
    return out;
  };
  using Texts = std::vector<std::string>;
  EXPECT_EQ(callers(0), Texts{});  // in the program itself
  EXPECT_EQ(callers(1),
            (Texts{"main.ngc:2 o<Drill> is called here", "main.ngc:4 o<drill> is called here",
                   "main.ngc:5 o<own> is called here"}));
  EXPECT_EQ(callers(2),
            (Texts{"drill.ngc:3 o<deep> is called here", "main.ngc:2 o<Drill> is called here",
                   "main.ngc:4 o<drill> is called here", "main.ngc:5 o<own> is called here"}));
  // Of another file a headline says which.
  for (bool& looked : listed.looked_at) looked = true;
  ListedProgram in_drill = listed;
  in_drill.findings = {};
  Finding f = finding(FindingId::kRapidContact, Severity::kError, 2);
  f.source.file = 1;
  in_drill.findings.add(f);
  EXPECT_NE(junit_text({&in_drill, 1}, "1").find("message=\"" + drill + ":2: "), std::string::npos);
}

TEST(Junit, TextIsWhatXmlTakes) {
  EXPECT_EQ(xml_text("a<b>&\"c\""), "a&lt;b&gt;&amp;&quot;c&quot;");
  EXPECT_EQ(xml_text("\xC3\xA4 \xE2\x82\xAC \xF0\x9F\x98\x80"),
            "\xC3\xA4 \xE2\x82\xAC \xF0\x9F\x98\x80");
  const std::string none = "\xEF\xBF\xBD";
  EXPECT_EQ(xml_text("\x01"), none);
  EXPECT_EQ(xml_text("\xFF"), none);                             // no UTF-8
  EXPECT_EQ(xml_text("\xC0\xAF"), none + none);                  // longer than need be
  EXPECT_EQ(xml_text("\xED\xA0\x80"), none + none + none);       // half of a pair
  EXPECT_EQ(xml_text("\xEF\xBF\xBF"), none + none + none);       // no character
  EXPECT_EQ(xml_text(std::string("\xE2\x82", 2)), none + none);  // cut off
}

TEST(Junit, ChecksThatFailAndWhatIsMilder) {
  ListedProgram listed = program("a.ngc", 2, 1);
  for (bool& looked : listed.looked_at) looked = true;
  const std::string text = junit_text({&listed, 1}, "1");
  EXPECT_NE(text.find("tests=\"12\" failures=\"1\" errors=\"0\""), std::string::npos) << text;
  EXPECT_NE(text.find("(and 1 more)"), std::string::npos) << text;
  EXPECT_NE(text.find("<system-out>a.ngc:1: note: near-miss"), std::string::npos) << text;
}

}  // namespace
}  // namespace kerf
