#include "machine_io/modbus/poll_plan.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <set>

namespace kerf {
namespace {

ModbusRegister reg(int address, ModbusType type, ModbusTable table = ModbusTable::kHolding) {
  return ModbusRegister{address, table, type};
}

int end_of(const ModbusRegister& wanted) {
  return wanted.address + static_cast<int>(word_count(wanted.type));
}

/// Whether one read may fetch the whole group.
bool one_read(const std::vector<ModbusRegister>& group, int max_gap) {
  std::set<int> wanted;
  for (const ModbusRegister& r : group) {
    if (r.table != group[0].table) return false;
    for (int a = r.address; a < end_of(r); ++a) wanted.insert(a);
  }
  if (*wanted.rbegin() - *wanted.begin() + 1 > kMaxReadRegisters) return false;
  for (auto a = wanted.begin(), b = std::next(a); b != wanted.end(); ++a, ++b) {
    if (*b - *a - 1 > max_gap) return false;
  }
  return true;
}

/// The fewest groups, by trying every way to part the wanted numbers.
int fewest(const std::vector<ModbusRegister>& wanted, int max_gap, std::size_t next,
           std::vector<std::vector<ModbusRegister>>& groups) {
  if (next == wanted.size()) {
    for (const auto& group : groups) {
      if (!one_read(group, max_gap)) return 1000;
    }
    return static_cast<int>(groups.size());
  }
  int best = 1000;
  for (std::size_t g = 0; g < groups.size(); ++g) {
    groups[g].push_back(wanted[next]);
    best = std::min(best, fewest(wanted, max_gap, next + 1, groups));
    groups[g].pop_back();
  }
  groups.push_back({wanted[next]});
  best = std::min(best, fewest(wanted, max_gap, next + 1, groups));
  groups.pop_back();
  return best;
}

void expect_valid(const PollPlan& plan, const std::vector<ModbusRegister>& wanted, int max_gap) {
  std::size_t words = 0;
  for (const PollRead& read : plan.reads) {
    EXPECT_GE(read.count, 1);
    EXPECT_LE(read.count, kMaxReadRegisters);
    EXPECT_EQ(read.first_word, words);
    words += static_cast<std::size_t>(read.count);
    int gap = 0;
    bool any_gap = false;
    for (int a = read.address; a < read.address + read.count; ++a) {
      const bool is_wanted = std::any_of(wanted.begin(), wanted.end(), [&](const auto& r) {
        return r.table == read.table && a >= r.address && a < end_of(r);
      });
      gap = is_wanted ? 0 : gap + 1;
      any_gap = any_gap || !is_wanted;
      EXPECT_LE(gap, max_gap);
    }
    EXPECT_EQ(read.has_gaps, any_gap);
  }
  EXPECT_EQ(plan.words, words);
  ASSERT_EQ(plan.first_word.size(), wanted.size());
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    const bool found = std::any_of(plan.reads.begin(), plan.reads.end(), [&](const PollRead& read) {
      const int at = static_cast<int>(plan.first_word[i] - read.first_word);
      return plan.first_word[i] >= read.first_word && read.table == wanted[i].table &&
             read.address + at == wanted[i].address &&
             at + static_cast<int>(word_count(wanted[i].type)) <= read.count;
    });
    EXPECT_TRUE(found) << "number " << i;
  }
}

TEST(PollPlan, nine_axes_in_a_row_are_one_read) {
  std::vector<ModbusRegister> wanted;
  for (int i = 8; i >= 0; --i) wanted.push_back(reg(2 * i, ModbusType::kFloat32));
  const PollPlan plan = plan_reads(wanted, 0);
  ASSERT_EQ(plan.reads.size(), 1u);
  EXPECT_EQ(plan.reads[0].address, 0);
  EXPECT_EQ(plan.reads[0].count, 18);
  EXPECT_FALSE(plan.reads[0].has_gaps);
  EXPECT_EQ(plan.first_word[0], 16u);
}

TEST(PollPlan, a_value_is_not_split_at_125_registers) {
  const std::vector<ModbusRegister> wanted{reg(0, ModbusType::kInt16),
                                           reg(122, ModbusType::kFloat64)};
  EXPECT_EQ(plan_reads(wanted, 123).reads.size(), 2u);
  EXPECT_EQ(plan_reads({wanted[0], reg(121, ModbusType::kFloat64)}, 123).reads.size(), 1u);
}

TEST(PollPlan, the_last_address_can_be_read) {
  const PollPlan plan =
      plan_reads({reg(65535, ModbusType::kUint16), reg(0, ModbusType::kInt16)}, 123);
  ASSERT_EQ(plan.reads.size(), 2u);
  EXPECT_EQ(plan.reads[1].address, 65535);
  EXPECT_EQ(plan.reads[1].count, 1);
}

TEST(PollPlan, no_plan_is_shorter) {
  std::mt19937 random(11);
  constexpr ModbusType kTypes[] = {ModbusType::kInt16, ModbusType::kFloat32, ModbusType::kFloat64};
  for (int round = 0; round < 2000; ++round) {
    const int span = round % 3 == 0 ? 300 : round % 3 == 1 ? 60 : 20;
    const int max_gap = static_cast<int>(random() % 60) * (round % 2);
    std::vector<ModbusRegister> wanted;
    const std::size_t count = 1 + random() % 6;
    for (std::size_t i = 0; i < count; ++i) {
      wanted.push_back(reg(static_cast<int>(random() % static_cast<unsigned>(span)),
                           kTypes[random() % 3],
                           random() % 4 == 0 ? ModbusTable::kInput : ModbusTable::kHolding));
    }
    const PollPlan plan = plan_reads(wanted, max_gap);
    expect_valid(plan, wanted, max_gap);
    std::vector<std::vector<ModbusRegister>> groups;
    ASSERT_EQ(static_cast<int>(plan.reads.size()), fewest(wanted, max_gap, 0, groups))
        << "round " << round;
  }
}

}  // namespace
}  // namespace kerf
