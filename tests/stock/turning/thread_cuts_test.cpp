// Grooves that wind: volumes against closed forms and a dense sampler, contacts, bits.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "tests/stock/turning/turning_oracle.h"

namespace kerf {
namespace {

using namespace turning_test;

/// Radially, with its tip at the controlled point: 60 degrees and sharp unless said otherwise.
InsertOutline vee(double depth_mm, double flat_mm = 0, double angle_deg = 60) {
  return *thread_insert({radians(angle_deg), flat_mm, depth_mm, 6});
}

TurnMove thread(const Vec2& from, const Vec2& to, double lead, std::uint64_t id = 0) {
  return {from, to, std::nullopt, id, lead};
}

TurnedPart bar(double length, double diameter) {
  return *TurnedPart::create(bar_profile(-length, 0, diameter));
}

/// First moment about the axis of a groove whose flat is at r and whose flanks open by `half`, up
/// to a height above.
double groove_moment(double r, double height, double flat, double half) {
  const double t = std::tan(half);
  return flat * (r * height + height * height / 2) +
         2 * t * (r * height * height / 2 + height * height * height / 3);
}

/// The largest radius of the region.
double top_mm(const TurnedPart& part) { return turning::to_mm(part.contours()[0].box().max_y); }

/// What moves remove, by looking at each place of a raster, another one at each of many angles,
/// whether one of them had the tool there. Angles by the rule of the seam, written down once more.
/// A move that is not gone on from leaves a ring.
double sampled_mm3(const TurnedProfile& region, const InsertOutline& tool,
                   const std::vector<TurnMove>& moves, int angles, double step) {
  const Vec2 low(-6, 4), high(0, 5.2);
  double sum = 0;
  for (int a = 0; a < angles; ++a) {
    const double turns = (a + 0.37) / angles;
    std::vector<Vec2> places;
    double start = 0;
    for (std::size_t i = 0; i < moves.size(); ++i) {
      const TurnMove& m = moves[i];
      const Vec2 way = m.to_mm - m.from_mm;
      const double length = glm::length(way);
      const bool goes_on = i > 0 && moves[i - 1].to_mm == m.from_mm;
      start = goes_on
                  ? start - glm::distance(moves[i - 1].from_mm, m.from_mm) / moves[i - 1].lead_mm
                  : 0;
      for (int n = -100; n <= 100; ++n) {
        const double s = m.lead_mm * (start - turns + n);
        if (s >= 0 && s <= length) places.push_back(m.from_mm + s / length * way);
      }
      if (i + 1 < moves.size() && moves[i + 1].from_mm != m.to_mm) places.push_back(m.to_mm);
    }
    const auto part_of = [](double x) { return x - std::floor(x); };
    const Vec2 shift(part_of(0.6180339887 * a), part_of(0.7548776662 * a));
    for (double z = low.x + step * shift.x; z < high.x; z += step) {
      for (double r = low.y + step * shift.y; r < high.y; r += step) {
        const Vec2 p(z, r);
        const bool met = std::any_of(places.begin(), places.end(), [&](const Vec2& at) {
          return std::abs(z - at.x) < 1.2 && r > at.y && distance_to_tool(tool, p - at) <= 0;
        });
        if (met && is_within(region, p)) sum += 2 * kPi / angles * r * step * step;
      }
    }
  }
  return sum;
}

TEST(ThreadCuts, a_groove_through_a_bar_has_its_volume) {
  for (const double lead : {1.5, -1.5, 4.0, 0.4}) {
    for (const double flat : {0.0, 0.19}) {
      TurnedPart part = bar(20, 10);
      const double height = 0.3;
      const TurnCut cut =
          part.cut(TurningTool(vee(2, flat)), thread({4, 4.7}, {-24, 4.7}, lead, 7));
      const double expected =
          2 * kPi / std::abs(lead) * 20 * groove_moment(4.7, height, flat, radians(30));
      // Beside each other turns of 0.4 mm overlap.
      if (std::abs(lead) > 1) {
        EXPECT_NEAR(cut.removed_mm3 / expected, 1, 1e-6) << lead;
        EXPECT_NEAR(cut.depth_mm, height, 2e-6);
        EXPECT_EQ(part.threads().passes().size(), 1u);
        EXPECT_EQ(part.contours()[0].corner_count(), 4u);
      } else {
        EXPECT_LT(cut.removed_mm3, expected);
      }
      EXPECT_EQ(cut.id, 7u);
      EXPECT_NEAR(part.remaining_mm3(), cylinder_mm3(10, 20) - cut.removed_mm3, 1e-9);
    }
  }
}

TEST(ThreadCuts, overlapping_turns_leave_what_they_leave) {
  // A vee 0.3 deep whose turns are 0.2 apart: at each angle a row of teeth of 0.2 mm at the top of
  // which 0.3 - 0.1 / tan 30 is cut all round.
  TurnedPart part = bar(20, 10);
  const TurnCut cut = part.cut(TurningTool(vee(2)), thread({8, 4.7}, {-28, 4.7}, 0.2));
  const double tooth = 0.1 / std::tan(radians(30)), crest = 4.7 + tooth;
  const double expected = cylinder_mm3(10, 20) - cylinder_mm3(2 * crest, 20) +
                          2 * kPi / 0.2 * 20 * groove_moment(4.7, tooth, 0, radians(30));
  EXPECT_NEAR(cut.removed_mm3 / expected, 1, 1e-6);
  // Crests are turned to their height, but for the ends where no turn follows: these are in air.
  EXPECT_NEAR(top_mm(part), crest, 2e-5);
  // A flat that is wider than the lead turns.
  TurnedPart turned = bar(20, 10), wound = bar(20, 10);
  const TurningTool blade(*groove_insert({3, 0, 20, 2}));
  turned.cut(blade, line({4, 4.7}, {-24, 4.7}));
  const TurnCut ring = wound.cut(blade, thread({4, 4.7}, {-24, 4.7}, 1.5));
  EXPECT_NEAR(wound.remaining_mm3() / turned.remaining_mm3(), 1, 1e-8);
  EXPECT_NEAR(ring.removed_mm3 / (cylinder_mm3(10, 20) - cylinder_mm3(9.4, 20)), 1, 1e-7);
}

TEST(ThreadCuts, a_bore_has_its_thread) {
  TurnedPart part = *TurnedPart::create(tube_profile(-20, 0, 30, 10));
  const TurningTool tool(mirrored_in_x(vee(2, 0.1)));
  const TurnCut cut = part.cut(tool, thread({4, 5.4}, {-24, 5.4}, 1.5));
  // Seen from the tip inward.
  const double t = std::tan(radians(30)), h = 0.4, r = 5.4;
  const double moment = 0.1 * (r * h - h * h / 2) + 2 * t * (r * h * h / 2 - h * h * h / 3);
  EXPECT_NEAR(cut.removed_mm3 / (2 * kPi / 1.5 * 20 * moment), 1, 1e-6);
}

TEST(ThreadCuts, starts_beside_each_other_add_up) {
  TurnedPart part = bar(20, 10);
  const TurningTool tool(vee(2));
  const double one = part.cut(tool, thread({4, 4.6}, {-24, 4.6}, 3)).removed_mm3;
  part.cut(tool, line({-24, 8}, {4, 8}));
  EXPECT_NEAR(part.cut(tool, thread({4, 4.6}, {-24, 4.6}, 3)).removed_mm3, 0, 1e-9);
  part.cut(tool, line({-24, 8}, {4, 8}));
  const double other = part.cut(tool, thread({5.5, 4.6}, {-24, 4.6}, 3)).removed_mm3;
  EXPECT_NEAR(other / one, 1, 1e-6);
  EXPECT_EQ(part.threads().passes().size(), 2u);
  // Of four starts that overlap a sharp crest stays: 0.75 wide.
  for (const double start : {4.75, 6.25}) {
    part.cut(tool, line({-24, 8}, {4, 8}));
    part.cut(tool, thread({start, 4.6}, {-24, 4.6}, 3));
  }
  EXPECT_EQ(part.profile()[0].size(), 4u);
  TurnedPart deep = bar(20, 10);
  for (const double start : {4.0, 4.75, 5.5, 6.25}) {
    deep.cut(tool, thread({start, 4}, {-24, 4}, 3));
    deep.cut(tool, line({-24, 8}, {4, 8}));
  }
  const double crest = 4 + 0.375 / std::tan(radians(30));
  EXPECT_NEAR(top_mm(deep), crest, 2e-5);
  const double grooves = 2 * kPi / 0.75 * 20 * groove_moment(4, crest - 4, 0, radians(30));
  EXPECT_NEAR(deep.remaining_mm3() / (cylinder_mm3(2 * crest, 20) - grooves), 1, 1e-6);
}

TEST(ThreadCuts, a_taper_thread_has_its_volume) {
  // A cone of 1 in 16 on the diameter, and a groove of even depth along it: way and surface are
  // parallel, so the groove's section is the same all along, but its radius.
  const double taper = 1.0 / 32;
  TurnedPart part = *TurnedPart::create({{{-20, 0}, {0, 0}, {0, 10}, {-20, 10 + 20 * taper}}});
  const double depth = 0.5, lead = 2;
  const Vec2 from(5, 10 - 5 * taper - depth), to(-25, 10 + 25 * taper - depth);
  const TurnCut cut = part.cut(TurningTool(vee(3)), thread(from, to, lead));
  // Midpoints over the way; each section is a triangle cut by a slanting line, as far as it is
  // within the ends.
  const double t = std::tan(radians(30)), length = glm::distance(from, to);
  double sum = 0;
  constexpr int kSteps = 200'000;
  for (int i = 0; i < kSteps; ++i) {
    const double s = (i + 0.5) / kSteps;
    const Vec2 tip = from + s * (to - from);
    // Left and right corner at the surface r = 10 - z taper.
    const double top = 10 - tip.x * taper - tip.y;
    const double right = top * t / (1 + taper * t), left = top * t / (1 - taper * t);
    const auto moment = [&](double low, double high) {  // of the triangle between two places
      double m = 0;
      const auto part_of = [&](double a, double b, double flank) {
        if (!(a < b)) return;
        const auto value = [&](double x) {
          const double bottom = tip.y + std::abs(x) / flank, surface = 10 - (tip.x + x) * taper;
          return (surface * surface - bottom * bottom) / 2;
        };
        m += (b - a) / 6 * (value(a) + 4 * value((a + b) / 2) + value(b));
      };
      part_of(std::max(low, -left), std::min(high, 0.0), t);
      part_of(std::max(low, 0.0), std::min(high, right), t);
      return m;
    };
    sum += moment(-20 - tip.x, -tip.x);
  }
  EXPECT_NEAR(cut.removed_mm3 / (2 * kPi / lead * sum * length / kSteps), 1, 1e-6);
}

TEST(ThreadCuts, twenty_passes_leave_the_last_one) {
  for (const double slope : {0.0, std::tan(radians(29.5))}) {
    TurnedPart part = bar(30, 10), once = bar(30, 10);
    const TurningTool tool(vee(2, 0.1));
    double gone = 0;
    for (int i = 1; i <= 20; ++i) {
      const double depth = 0.92 * std::sqrt(i / 20.0);
      const Vec2 from(4 - depth * slope, 5 - depth), to(-20 - depth * slope, 5 - depth);
      const Vec2 out = to + Vec2(-1.5, 1.2);
      gone += part.cut(tool, line({4, 8}, from)).removed_mm3;
      const TurnCut cut = part.cut(tool, thread(from, to, 1.5));
      EXPECT_GT(cut.removed_mm3, 1);
      gone += cut.removed_mm3;
      const double lead = 1.5 * glm::length(to - out) / 1.5;
      gone += part.cut(tool, thread(to, out, lead)).removed_mm3;
      EXPECT_FALSE(part.first_contact(tool.inset(0.01), line(out, {out.x, 8})));
      gone += part.cut(tool, line(out, {out.x, 8})).removed_mm3;
      EXPECT_FALSE(part.first_contact(tool.inset(0.01), line({out.x, 8}, {4, 8})));
      EXPECT_EQ(part.threads().passes().size(), 2u);
      if (i < 20) continue;
      once.cut(tool, thread(from, to, 1.5));
      once.cut(tool, thread(to, out, lead));
      once.cut(tool, line(out, {out.x, 8}));
    }
    EXPECT_EQ(part.digest(), once.digest());
    EXPECT_NEAR(part.remaining_mm3(), once.remaining_mm3(), 1e-9);
    EXPECT_NEAR(gone, cylinder_mm3(10, 30) - part.remaining_mm3(), 1e-6);
  }
}

TEST(ThreadCuts, a_thread_in_pieces_is_one_thread) {
  const TurningTool tool(vee(2, 0.1));
  TurnedPart whole = bar(30, 10), pieces = bar(30, 10);
  whole.cut(tool, thread({4, 4.2}, {-20, 4.2}, 1.5));
  double at = 4, gone = 0;
  std::mt19937 random(3);
  while (at > -20) {
    const double next = std::max(-20.0, at - 0.01 * static_cast<double>(1 + random() % 40));
    gone += pieces.cut(tool, thread({at, 4.2}, {next, 4.2}, 1.5)).removed_mm3;
    at = next;
  }
  EXPECT_EQ(pieces.threads().passes().size(), 1u);
  EXPECT_NEAR(pieces.remaining_mm3(), whole.remaining_mm3(), 1e-6);
  EXPECT_NEAR(gone, cylinder_mm3(10, 30) - pieces.remaining_mm3(), 1e-6);
  // Round a corner it goes on with the turn.
  TurnedPart bent = bar(30, 10);
  bent.cut(tool, thread({4, 4.2}, {-10.3, 4.2}, 1.5));
  bent.cut(tool, thread({-10.3, 4.2}, {-20, 4.0}, 1.5));
  ASSERT_EQ(bent.threads().passes().size(), 2u);
  const auto passes = bent.threads().passes();
  const double turns = passes[0]->turns_at(passes[0]->length_mm()) - passes[1]->from_turns();
  EXPECT_NEAR(turns, std::round(turns), 1e-9);
  // Along a bend without corners the way made of pieces keeps to them.
  TurnedPart arc = bar(60, 10);
  Vec2 from(0, 4);
  for (int i = 1; i <= 2000; ++i) {
    const Vec2 to(-0.01 * i, 4 + 0.5 * std::pow(i / 2000.0, 2));
    arc.cut(tool, thread(from, to, 1.5));
    from = to;
  }
  for (const auto& pass : arc.threads().passes()) {
    for (const double t : {0.0, 0.3, 0.7, 1.0}) {
      const Vec2 p = pass->at(t * pass->length_mm());
      EXPECT_NEAR(p.y, 4 + 0.5 * std::pow(-p.x / 20, 2), 2e-4);
    }
  }
  EXPECT_GT(arc.threads().passes().size(), 10u);
}

TEST(ThreadCuts, a_thread_that_stops_in_material_ends_in_a_ring) {
  const TurningTool tool(vee(2, 0.2));
  TurnedPart part = bar(30, 10);
  part.cut(tool, thread({4, 4.4}, {-15, 4.4}, 1.5));
  EXPECT_EQ(part.profile()[0].size(), 4u);
  // Out of it, back above it, and in it once more.
  const TurningTool inner = tool.inset(0.01);
  EXPECT_FALSE(part.first_contact(inner, line({-15, 4.4}, {-15, 8})));
  const TurnCut out = part.cut(tool, line({-15, 4.4}, {-15, 8}));
  EXPECT_GT(out.removed_mm3, 1);
  EXPECT_GT(part.profile()[0].size(), 6u);
  EXPECT_FALSE(part.first_contact(inner, line({-15, 8}, {4, 8})));
  EXPECT_TRUE(part.first_contact(inner, line({-15, 4.4}, {4, 4.4})));
  EXPECT_TRUE(part.first_contact(inner, line({-15, 4.95}, {4, 4.95})));
  EXPECT_FALSE(part.first_contact(inner, line({-15, 5}, {4, 5})));
  // Into what has been cut the same way nothing is touched, by another lead or deeper it is.
  EXPECT_FALSE(part.first_contact(inner, thread({4, 4.4}, {-15, 4.4}, 1.5)));
  EXPECT_TRUE(part.first_contact(inner, thread({4, 4.4}, {-15, 4.4}, -1.5)));
  const std::optional<TurnContact> deeper =
      part.first_contact(inner, thread({4, 4.3}, {-15, 4.3}, 1.5));
  ASSERT_TRUE(deeper);
  EXPECT_NEAR(deeper->depth_mm, 0.09, 1e-3);
  EXPECT_NEAR(deeper->at_mm.x, 0, 1);
}

TEST(ThreadCuts, what_is_turned_off_later_takes_its_thread_along) {
  const TurningTool tool(vee(2)), turner(right_hand(0));
  TurnedPart part = bar(30, 10);
  part.cut(tool, thread({4, 4.4}, {-34, 4.4}, 1.5));
  part.cut(tool, line({-34, 8}, {4, 8}));
  const auto left = [](double r, double length) {
    return cylinder_mm3(2 * r, length) -
           2 * kPi / 1.5 * length * groove_moment(4.4, r - 4.4, 0, radians(30));
  };
  EXPECT_NEAR(part.remaining_mm3() / left(5, 30), 1, 1e-6);
  const double all = part.remaining_mm3();
  const double removed = part.cut(turner, line({2, 4.7}, {-34, 4.7})).removed_mm3;
  EXPECT_NEAR(part.remaining_mm3() / left(4.7, 30), 1, 1e-6);
  EXPECT_NEAR(removed, all - part.remaining_mm3(), 1e-8);
  // Parted off in the middle, the piece is without the groove, and so is the rest.
  part.cut(TurningTool(*groove_insert({2, 0, 20, 2})), line({-12, 8}, {-12, -0.1}));
  ASSERT_EQ(part.freed().size(), 1u);
  EXPECT_NEAR(part.freed()[0].volume_mm3 / left(4.7, 10), 1, 1e-6);
  EXPECT_NEAR(part.remaining_mm3() / left(4.7, 18), 1, 1e-6);
  // Below the groove nothing of it is left.
  part.cut(turner, line({-11, 4.3}, {-34, 4.3}));
  EXPECT_TRUE(part.threads().empty());
  EXPECT_NEAR(part.remaining_mm3() / cylinder_mm3(8.6, 18), 1, 1e-6);
}

TEST(ThreadCuts, copies_and_bands_know_of_threads) {
  const TurningTool tool(vee(2));
  TurnedPart part = *TurnedPart::create(bar_profile(-64, 0, 10));
  const TurnedPart before = part;
  part.cut(tool, thread({-20.2, 4.4}, {-30.3, 4.4}, 1.5));
  EXPECT_NE(part.digest(), before.digest());
  EXPECT_TRUE(before.threads().empty());
  for (std::size_t band = 0; band < TurnedPart::kBands; ++band) {
    const double low = part.band_low_z_mm(band);
    // The outline is 0.35 to either side at the surface, and 0.03 where it is clipped above it.
    const bool touched = low <= -20.2 + 0.4 && low + 1 >= -30.3 - 0.4;
    EXPECT_EQ(part.band_version(band) != before.band_version(band), touched) << band;
  }
  const TurnedPart copy = part;
  EXPECT_LT(copy.unique_bytes(), 100u);
  EXPECT_EQ(copy.digest(), part.digest());
  EXPECT_EQ(copy.remaining_mm3(), part.remaining_mm3());
}

TEST(ThreadCuts, numbers_that_are_none_and_long_ways_are_no_trouble) {
  const TurningTool tool(vee(2));
  TurnedPart part = bar(20, 10);
  const std::string digest = part.digest();
  const double nan = std::nan("");
  EXPECT_EQ(part.cut(tool, thread({nan, 4}, {0, 4}, 1)).removed_mm3, 0);
  EXPECT_EQ(part.cut(tool, thread({4, 1e9}, {4, 1e8}, 1)).removed_mm3, 0);
  EXPECT_EQ(part.cut(tool, thread({4, 4}, {4, 4}, 1)).removed_mm3, 0);
  EXPECT_EQ(part.digest(), digest);
  // From far away, with turns that nobody counts out.
  const TurnCut cut = part.cut(tool, thread({1e6, 4.7}, {-1e6, 4.7}, 1.5));
  EXPECT_NEAR(cut.removed_mm3, 2 * kPi / 1.5 * 20 * groove_moment(4.7, 0.3, 0, radians(30)), 1e-4);
  // Hardly any lead is a ring.
  TurnedPart ring = bar(20, 10), turned = bar(20, 10);
  ring.cut(tool, thread({4, 4.7}, {-10, 4.7}, 1e-4));
  turned.cut(tool, line({4, 4.7}, {-10, 4.7}));
  EXPECT_EQ(ring.digest(), turned.digest());
}

/// Other leads, slanting ways, both hands, and starts across each other.
TEST(ThreadCuts, random_passes_remove_what_a_sampler_finds) {
  for (unsigned seed = 0; seed < 8; ++seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> unit(0, 1);
    TurnedPart part = *TurnedPart::create({{{-6, 0},
                                            {0, 0},
                                            {0, 4.6},
                                            {-0.4, 5},
                                            {-2.5, 5},
                                            {-2.7, 4.5},
                                            {-3, 4.5},
                                            {-3.2, 5.1},
                                            {-6, 5.1}}});
    const TurnedProfile blank = part.profile();
    const double all = part.remaining_mm3();
    const double nose_mm = 0.1 * unit(random), wide_deg = 40 + 40 * unit(random);
    const InsertOutline outline = vee(1.2, nose_mm, wide_deg);
    const TurningTool tool(outline);
    std::vector<TurnMove> moves;
    for (int i = 0; i < 4; ++i) {
      const Vec2 from{1 - 3 * unit(random), 4.2 + 0.6 * unit(random)},
          to{-3 - 5 * unit(random), 4.2 + 0.6 * unit(random)};
      const double lead = (unit(random) < 0.3 ? -1 : 1) * (0.5 + unit(random));
      moves.push_back(thread(from, to, lead));
      if (i % 2 == 1) moves.push_back(thread(to, {to.x - 1, 5.3}, lead * 1.3));
    }
    double removed = 0;
    for (const TurnMove& move : moves) removed += part.cut(tool, move).removed_mm3;
    EXPECT_NEAR(removed, all - part.remaining_mm3(), 1e-9);
    EXPECT_NEAR(sampled_mm3(blank, outline, moves, 240, 0.0263) / removed, 1, 5e-4) << seed;
  }
}

}  // namespace
}  // namespace kerf
