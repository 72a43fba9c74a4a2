// A spindle's load beside what its cuts should take: what is told, and what must not be.
#include "twin/live/load_watch.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

namespace kerf {
namespace {

/// Some seconds of a machine. `nominal_w` 0: in the air; `takes`: of that, really.
struct Span {
  double seconds = 0;
  double nominal_w = 0;
  double takes = 1;
  double rpm = 8000;
  int tool = 1;
  bool is_known = true;
};

/// A machine with a drive that tells its load late, with noise, in steps.
struct Machine {
  double idle_w = 300;     ///< at 8000 rpm; as the speed
  double lag_s = 0.3;      ///< of its filter
  double noise_w = 15;     ///< standard deviation
  double step = 0.1;       ///< of the number
  double offset = 0;       ///< of the number, percent
  double period_s = 0.02;  ///< from sample to sample
  double freezes_s = 1e9;  ///< the number stands still from then on
  double goes_s = 1e9;     ///< there is none from then on
  double spin_up_s = 0;    ///< after each change of the speed it takes three times as much
  bool tells_rpm = true;
};

Material material() {
  Material out;
  out.name = "steel";
  return out;
}

/// 2 kW are 100 %. Band of the material: 0.6 to 1.4 of nominal.
struct Shop {
  explicit Shop(Machine of = {}) : machine(of), watch(wish(), log) {}
  static CuttingWish wish() {
    CuttingWish out;
    out.material = material();
    out.spindle_power_kw = 2;
    return out;
  }

  void run(const std::vector<Span>& spans, unsigned seed = 1) {
    std::mt19937 random(seed);
    std::normal_distribution<double> noise;
    double shown_w = 0, frozen = 0, changed_s = -1e9, rpm_before = 0;
    std::uint32_t line = 0;
    for (const Span& span : spans) {
      ++line;
      if (span.rpm != rpm_before) changed_s = t_s;
      rpm_before = span.rpm;
      const int samples = static_cast<int>(std::lround(span.seconds / machine.period_s));
      for (int i = 0; i < samples; ++i) {
        t_s += machine.period_s;
        const bool spins_up = t_s - changed_s < machine.spin_up_s;
        const double idle_w = machine.idle_w * span.rpm / 8000 * (spins_up ? 3 : 1);
        const double true_w = idle_w + span.takes * span.nominal_w;
        shown_w += (true_w - shown_w) * std::min(1.0, machine.period_s / machine.lag_s);
        const double percent = (shown_w + machine.noise_w * noise(random)) / 2000 * 100;
        const double number = std::round(percent / machine.step) * machine.step + machine.offset;
        if (t_s < machine.freezes_s) frozen = number;
        AxisSample sample;
        sample.tool = span.tool;
        if (machine.tells_rpm) sample.spindle_rpm = span.rpm;
        if (t_s < machine.goes_s) sample.load = frozen;
        watch.take(sample, t_s);
        CutLoad part;
        part.start_s = t_s - machine.period_s;
        part.seconds = machine.period_s;
        part.tool = span.tool;
        part.source = {0, line};
        part.rpm = span.rpm;
        part.is_engaged = span.nominal_w > 0;
        const ValueRange range{0.6, 1, 1.4};
        if (span.is_known) part.set(LoadKind::kPower, range.times(span.nominal_w / 1000));
        watch.on_load(part);
        if (i % 10 == 0) watch.judge(t_s - LoadWatch::kDelay_s);
      }
    }
    watch.judge(t_s);
  }

  std::size_t told(Severity severity = Severity::kWarning) const {
    std::size_t count = 0;
    for (const Finding& finding : log.kept()) {
      EXPECT_EQ(finding.id, FindingId::kLoadDiffers);
      if (finding.severity == severity) ++count;
    }
    return count;
  }

  Machine machine;
  FindingLog log;
  LoadWatch watch;
  double t_s = 0;
};

/// Ten cuts of that many seconds with the same time in the air, as a pocket has them.
std::vector<Span> pocket(double cut_s, double takes, double nominal_w = 600) {
  std::vector<Span> spans{{6, 0, 1, 8000, 1, true}};
  for (int i = 0; i < 10; ++i) {
    spans.push_back({cut_s, nominal_w, takes, 8000, 1, true});
    spans.push_back({cut_s, 0, 1, 8000, 1, true});
  }
  return spans;
}

TEST(LoadWatch, TellsNothingWhileTheLoadFollowsTheModel) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    for (const double takes : {0.7, 1.0, 1.35, 1.7}) {  // 1.4 and what a drive loses: 1.87
      for (const double cut_s : {0.3, 1.0, 4.0, 15.0}) {
        Shop shop;
        shop.run(pocket(cut_s, takes), seed);
        EXPECT_EQ(shop.told(), 0U) << "seed " << seed << ", takes " << takes << ", " << cut_s;
      }
    }
  }
}

TEST(LoadWatch, TellsABluntToolByTheMaterial) {
  Shop shop;
  std::vector<Span> spans = pocket(4, 1);
  spans.push_back({15, 600, 2.4, 8000, 1, true});
  shop.run(spans);
  ASSERT_EQ(shop.told(), 1U);
  const Finding& finding = shop.log.kept().front();
  EXPECT_EQ(finding.tool, 1);
  EXPECT_EQ(finding.source.line, spans.size());
  // Idle 15 %, 30 % nominal: 15 + 18 to 15 + 56 %; it takes up to 15 + 72 %.
  EXPECT_NE(finding.text.find("a blunt tool"), std::string::npos) << finding.text;
  const double onset_s = 6 + 10 * 8;
  EXPECT_GT(*finding.time_s, onset_s);
  EXPECT_LT(*finding.time_s, onset_s + 5);
}

/// 60 % more is within what the material may take, and not what this tool took before.
TEST(LoadWatch, TellsABluntToolByItsOwnPast) {
  for (unsigned seed = 1; seed <= 10; ++seed) {
    Shop shop;
    std::vector<Span> spans = pocket(4, 1);
    spans.push_back({15, 600, 1.6, 8000, 1, true});
    shop.run(spans, seed);
    ASSERT_EQ(shop.told(), 1U);
    EXPECT_NE(shop.log.kept().front().text.find("took before"), std::string::npos);
  }
}

TEST(LoadWatch, ThirtyPercentMoreIsNoBluntTool) {
  Shop shop;
  std::vector<Span> spans = pocket(4, 1);
  spans.push_back({30, 600, 1.3, 8000, 1, true});
  shop.run(spans);
  EXPECT_EQ(shop.told(), 0U);
}

/// Thin chips take more of the material's figure than thick ones: not compared with each other.
TEST(LoadWatch, FinishingIsNotComparedWithRoughing) {
  Shop shop;
  std::vector<Span> spans = pocket(4, 1, 1200);
  for (const Span& span : pocket(4, 1.7, 300)) spans.push_back(span);
  shop.run(spans);
  EXPECT_EQ(shop.told(), 0U);
}

TEST(LoadWatch, TellsABrokenTool) {
  for (const double cut_s : {1.0, 4.0, 15.0}) {
    Shop shop;
    std::vector<Span> spans = pocket(cut_s, 1);
    const std::size_t whole = spans.size();
    for (const Span& span : pocket(cut_s, 0)) spans.push_back(span);
    shop.run(spans);
    ASSERT_EQ(shop.told(), 1U) << cut_s;
    const Finding& finding = shop.log.kept().front();
    EXPECT_GT(finding.source.line, whole);
    EXPECT_NE(finding.text.find("broken or missing"), std::string::npos) << finding.text;
  }
}

TEST(LoadWatch, TellsAToolThatIsMissingFromTheBeginning) {
  Shop shop;
  shop.run(pocket(4, 0));
  EXPECT_EQ(shop.told(), 1U);
}

TEST(LoadWatch, ShortDifferencesAreNone) {
  Shop shop;
  std::vector<Span> spans = pocket(4, 1);
  for (int i = 0; i < 5; ++i) {
    spans.push_back({1.5, 600, i % 2 == 0 ? 2.6 : 0.0, 8000, 1, true});
    spans.push_back({12, 600, 1, 8000, 1, true});
  }
  shop.run(spans);
  EXPECT_EQ(shop.told(), 0U);
}

/// What the number is off by is in the idle load as well.
TEST(LoadWatch, AnOffsetIsNoDifference) {
  for (const double offset : {-12.0, 8.0, 40.0}) {
    Machine machine;
    machine.offset = offset;
    Shop shop(machine);
    shop.run(pocket(4, 1));
    EXPECT_EQ(shop.told(), 0U) << offset;
  }
}

TEST(LoadWatch, SpinningUpIsNoLoad) {
  Machine machine;
  machine.spin_up_s = 2.5;
  Shop shop(machine);
  std::vector<Span> spans;
  for (int i = 0; i < 6; ++i) {
    spans.push_back({3, 0, 1, 0, 1, true});
    spans.push_back({7, 0, 1, i % 2 == 0 ? 8000.0 : 5000.0, 1, true});
    spans.push_back({20, 600, 1, i % 2 == 0 ? 8000.0 : 5000.0, 1, true});
  }
  shop.run(spans);
  EXPECT_EQ(shop.told(), 0U);
}

/// Facing at constant surface speed: the same power at speeds that were not seen in the air.
std::vector<Span> face(double takes, double part_per_s) {
  std::vector<Span> spans{{6, 0, 1, 4000, 1, true}};
  double rpm = 4000;
  for (int i = 0; i < 40; ++i, rpm *= std::exp(part_per_s * 0.5))
    spans.push_back({0.5, 600, takes, rpm, 1, true});
  return spans;
}

TEST(LoadWatch, ASpeedThatChangesSlowlyIsJudged) {
  for (unsigned seed = 1; seed <= 5; ++seed) {
    for (const double part_per_s : {0.02, 0.04, -0.04}) {
      for (const double takes : {0.7, 1.0, 1.7}) {
        Shop sound;
        sound.run(face(takes, part_per_s), seed);
        EXPECT_EQ(sound.told(), 0U) << takes << ", " << part_per_s;
        EXPECT_GT(sound.watch.report()->tools.at(0).judged_s, 17);
      }
      Shop blunt;
      blunt.run(face(3.5, part_per_s), seed);
      EXPECT_EQ(blunt.told(), 1U) << part_per_s;
    }
    Shop broken;
    broken.run(face(0, 0.04), seed);
    EXPECT_EQ(broken.told(), 1U);
  }
}

/// What gains speed quickly takes more than it cuts.
TEST(LoadWatch, ASpeedThatChangesQuicklyIsNotJudged) {
  Shop shop;
  shop.run(face(3.5, 0.25));
  EXPECT_EQ(shop.told(), 0U);
  // Until a tenth faster: less than a second.
  const LoadReport report = shop.watch.report().value();
  EXPECT_TRUE(report.tools.empty() || report.tools[0].judged_s < 1);
}

/// A drive that filters for long, and slow polls.
TEST(LoadWatch, LateNumbersAreNoDifference) {
  Machine machine;
  machine.lag_s = 0.8;
  machine.period_s = 0.5;
  Shop shop(machine);
  shop.run(pocket(4, 1));
  EXPECT_EQ(shop.told(), 0U);
}

/// Whole percents.
TEST(LoadWatch, CoarseNumbersAreJudged) {
  Machine machine;
  machine.step = 1;
  machine.noise_w = 2;
  Shop sound(machine);
  sound.run(pocket(6, 1));
  EXPECT_EQ(sound.told(), 0U);
  Shop broken(machine);
  std::vector<Span> spans = pocket(6, 1);
  spans.push_back({12, 600, 0, 8000, 1, true});
  broken.run(spans);
  EXPECT_EQ(broken.told(), 1U);
}

/// A register that nobody writes any more is no broken tool, and no blunt one.
TEST(LoadWatch, ANumberThatStandsStillIsANote) {
  for (const double freezes_s : {20.5, 24.5}) {  // in the air, in a cut
    Machine machine;
    machine.freezes_s = freezes_s;
    Shop shop(machine);
    shop.run(pocket(4, 1));
    EXPECT_EQ(shop.told(), 0U) << freezes_s;
    EXPECT_EQ(shop.told(Severity::kNote), 1U) << freezes_s;
  }
}

TEST(LoadWatch, WithoutANumberNothingIsJudged) {
  Machine machine;
  machine.goes_s = 24.5;
  Shop shop(machine);
  shop.run(pocket(4, 0.9));
  EXPECT_EQ(shop.told() + shop.told(Severity::kNote), 0U);
}

TEST(LoadWatch, CutsThatNobodyKnowsAreNotJudged) {
  Shop shop;
  shop.run({{10, 0}, {30, 1, 0, 8000, 1, false}, {30, 1, 900, 8000, 1, false}});
  EXPECT_EQ(shop.told(), 0U);
  const LoadReport report = shop.watch.report().value();
  EXPECT_TRUE(report.tools.empty());
  ASSERT_EQ(report.unjudged.size(), 1U) << "but it is said for how long";
  EXPECT_EQ(report.unjudged[0].number, 1);
  EXPECT_NEAR(report.unjudged[0].seconds, 60, 0.1);
}

TEST(LoadWatch, NobodyIsToldOfAnInstantThatIsNotKnown) {
  Shop shop;
  shop.run({{10, 0}, {30, 900}, {0.5, 900, 1, 8000, 1, false}, {10, 900}});
  EXPECT_TRUE(shop.watch.report()->unjudged.empty());
}

/// What should take less than the idle load trembles cannot be seen.
TEST(LoadWatch, CutsThatTakeNothingAreNotJudged) {
  Shop shop;
  shop.run(pocket(4, 0, 40));
  EXPECT_EQ(shop.told(), 0U);
}

TEST(LoadWatch, EachToolIsToldOnce) {
  Shop shop;
  std::vector<Span> spans{{6, 0}};
  for (const int tool : {1, 2, 1}) {
    spans.push_back({6, 0, 1, 8000, tool, true});
    spans.push_back({15, 600, 0, 8000, tool, true});
  }
  shop.run(spans);
  EXPECT_EQ(shop.told(), 2U);
}

TEST(LoadWatch, ReportsWhatItHasSeen) {
  Shop shop;
  shop.run(pocket(10, 1));
  const LoadReport report = shop.watch.report().value();
  ASSERT_EQ(report.idle.size(), 1U);
  EXPECT_NEAR(report.idle[0].load, 15, 1);
  ASSERT_EQ(report.tools.size(), 1U);
  // In the mean 15 + 30 * share of the time; the band around it.
  EXPECT_GT(report.tools[0].judged_s, 80);
  EXPECT_EQ(report.tools[0].differs_s, 0);
  EXPECT_LT(report.tools[0].low, report.tools[0].measured);
  EXPECT_GT(report.tools[0].high, report.tools[0].measured);
}

TEST(LoadWatch, ShowsWhatShouldBe) {
  Shop shop;
  shop.run({{6, 0}, {10, 600}});
  const LoadNow now = shop.watch.now().value();
  EXPECT_NEAR(now.measured, 45, 4);
  EXPECT_NEAR(now.low.value(), 15 + 0.6 * 30, 1.5);
  EXPECT_NEAR(now.high.value(), 15 + 1.4 * 30 / 0.75, 1.5);
}

}  // namespace
}  // namespace kerf
