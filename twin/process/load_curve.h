// twin/process/load_curve.h - the loads of a program's cuts over its time, in columns.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "twin/process/load_listener.h"

namespace kerf {

/// A thousand columns for a program of any length, as RunCurve has them; of each kind the greatest
/// in a column, by its nominal value and by the end of its range. One thread.
class LoadCurve final : public LoadListener {
 public:
  static constexpr std::size_t kMost = 1024;
  static constexpr double kFirstStep_s = 0.0625;

  void on_load(const CutLoad& load) override;
  void restart() override { *this = LoadCurve(); }

  double step_s() const { return step_s_; }
  /// 0 where there is none; empty: there is nothing of that kind. Both are as long.
  std::span<const float> nominal(LoadKind kind) const { return of(kind).nominal; }
  std::span<const float> high(LoadKind kind) const { return of(kind).high; }

 private:
  struct Columns {
    std::vector<float> nominal, high;
  };
  const Columns& of(LoadKind kind) const { return columns_[static_cast<std::size_t>(kind)]; }
  void add(Columns& columns, const ValueRange& value, std::size_t first, std::size_t end);
  void double_step();

  double step_s_ = kFirstStep_s;
  std::array<Columns, kLoadKinds> columns_;
};

}  // namespace kerf
