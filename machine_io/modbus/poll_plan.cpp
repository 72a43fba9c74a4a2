#include "machine_io/modbus/poll_plan.h"

#include <algorithm>
#include <numeric>
#include <tuple>

namespace kerf {
namespace {

int end_of(const ModbusRegister& wanted) {
  return wanted.address + static_cast<int>(word_count(wanted.type));
}

/// Whether `next`, which begins no earlier than anything in `read`, fits into it.
bool joins(const PollRead& read, const ModbusRegister& next, int max_gap) {
  const int end = read.address + read.count;
  return read.table == next.table && next.address - end <= max_gap &&
         std::max(end, end_of(next)) - read.address <= kMaxReadRegisters;
}

}  // namespace

PollPlan plan_reads(const std::vector<ModbusRegister>& wanted, int max_gap) {
  std::vector<std::size_t> order(wanted.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return std::tuple(wanted[a].table, wanted[a].address, end_of(wanted[a]), a) <
           std::tuple(wanted[b].table, wanted[b].address, end_of(wanted[b]), b);
  });
  PollPlan plan;
  plan.first_word.resize(wanted.size());
  // Taking along as much as fits is optimal: it never makes a later read begin earlier.
  for (const std::size_t i : order) {
    const ModbusRegister& next = wanted[i];
    if (plan.reads.empty() || !joins(plan.reads.back(), next, max_gap)) {
      plan.reads.push_back({next.table, next.address, 0, plan.words, false});
    }
    PollRead& read = plan.reads.back();
    const int end = read.address + read.count;
    read.has_gaps = read.has_gaps || next.address > end;
    read.count = std::max(end, end_of(next)) - read.address;
    plan.first_word[i] = read.first_word + static_cast<std::size_t>(next.address - read.address);
    plan.words = read.first_word + static_cast<std::size_t>(read.count);
  }
  return plan;
}

}  // namespace kerf
