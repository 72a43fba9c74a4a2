// Designations of inserts against what catalogues say of them.
#include "stock/cutter/iso_code.h"

#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

namespace kerf {
namespace {

TEST(IsoCode, CatalogueSizes) {
  struct Row {
    const char* text;
    const char* canonical;
    double circle_mm, radius_mm;
  };
  for (const Row& row : {Row{"CNMG120408", "CNMG120408", 12.7, 0.8},
                         Row{"cnmg 16 06 12-PR", "CNMG160612", 15.875, 1.2},
                         Row{"CCMT060202", "CCMT060202", 6.35, 0.2},
                         Row{"CCMT09T304EN", "CCMT09T304", 9.525, 0.4},
                         Row{"DCMT070204", "DCMT070204", 6.35, 0.4},
                         Row{"DCMT11T308", "DCMT11T308", 9.525, 0.8},
                         Row{"DNMG150608", "DNMG150608", 12.7, 0.8},
                         Row{"VBMT160404", "VBMT160404", 9.525, 0.4},
                         Row{"VCGT110302", "VCGT110302", 6.35, 0.2},
                         Row{"TCMT110204", "TCMT110204", 6.35, 0.4},
                         Row{"TNMG160408", "TNMG160408", 9.525, 0.8},
                         Row{"TNMG220412", "TNMG220412", 12.7, 1.2},
                         Row{"SNMG120408", "SNMG120408", 12.7, 0.8},
                         Row{"WNMG080408", "WNMG080408", 12.7, 0.8},
                         Row{"WNMG060404", "WNMG060404", 9.525, 0.4},
                         Row{"KNUX160405R11", "KNUX160405", 9.525, 0.5},
                         Row{"RCMT0803M0", "RCMT0803M0", 8, 4},
                         Row{"RCMT10T3MO", "RCMT10T3M0", 10, 5},
                         Row{"RNMG120400", "RNMG120400", 12.7, 6.35},
                         Row{"CNMG432", "CNMG432", 12.7, 0.8},
                         Row{"CNMG 431", "CNMG431", 12.7, 0.4},
                         Row{"DCMT21.51", "DCMT21.51", 6.35, 0.4},
                         Row{"CCMT32.52", "CCMT32.52", 9.525, 0.8},
                         Row{"CCMT21.50.5", "CCMT21.50.5", 6.35, 0.2},
                         Row{"TNMG332-M", "TNMG332", 9.525, 0.8},
                         Row{"RNMG43", "RNMG43", 12.7, 6.35}}) {
    const Result<IsoCode> code = parse_iso_code(row.text);
    ASSERT_TRUE(code) << row.text << ": " << (code ? "" : code.error());
    EXPECT_EQ(code->text, row.canonical);
    EXPECT_EQ(code->shape, row.canonical[0]);
    EXPECT_NEAR(code->circle_mm, row.circle_mm, 1e-9) << row.text;
    EXPECT_NEAR(code->radius_mm, row.radius_mm, 1e-9) << row.text;
    EXPECT_EQ(parse_iso_code(code->text)->text, code->text);
  }
}

TEST(IsoCode, EachFaultIsNamed) {
  for (const auto& [text, wanted] : std::vector<std::pair<const char*, const char*>>{
           {"", "'' is no insert of ISO 1832; write for example CNMG120408"},
           {"CNMG12", "'CNMG12' is no insert"},
           {"C1MG120408", "is no insert"},
           {"XNMG120408", "shape X of XNMG120408 is not known; shapes are C D E K M P R S T V W"},
           {"CZMG120408", "clearance: the letter Z"},
           {"CNPG120408", "tolerance: the letter P"},
           {"CNMZ120408", "type: the letter Z"},
           {"CNMG130408", "there is no insert C of size 13; sizes are 04, 05, 06, 08, 09, 12, 16"},
           {"CNMG120499", "corner radius: 99 is not allowed; must be from 00 to 40"},
           {"CNMG1204M0", "M0 is for round inserts"},
           {"RCMT1103M0", "there is no round insert of 11 mm"},
           {"CNMG732", "size: 7 is not allowed"},
           {"CNMG1204081", "is no insert"}}) {
    const Result<IsoCode> code = parse_iso_code(text);
    ASSERT_FALSE(code) << text;
    EXPECT_NE(code.error().find(wanted), std::string::npos) << text << " -> " << code.error();
  }
}

}  // namespace
}  // namespace kerf
