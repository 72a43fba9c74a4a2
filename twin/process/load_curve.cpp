#include "twin/process/load_curve.h"

#include <algorithm>
#include <cmath>

namespace kerf {
namespace {

void keep_greatest(float& value, double other) {
  value = std::max(value, static_cast<float>(other));
}

/// Each two columns become one.
void join_columns(std::vector<float>& values) {
  for (std::size_t i = 0; i < values.size(); ++i)
    values[i / 2] = i % 2 == 0 ? values[i] : std::max(values[i / 2], values[i]);
  values.resize((values.size() + 1) / 2);
}

}  // namespace

void LoadCurve::double_step() {
  for (Columns& columns : columns_) {
    join_columns(columns.nominal);
    join_columns(columns.high);
  }
  step_s_ *= 2;
}

void LoadCurve::add(Columns& columns, const ValueRange& value, std::size_t first, std::size_t end) {
  if (columns.nominal.size() < end) {
    columns.nominal.resize(end);
    columns.high.resize(end);
  }
  for (std::size_t i = first; i < end; ++i) {
    keep_greatest(columns.nominal[i], value.nominal);
    keep_greatest(columns.high[i], value.high);
  }
}

void LoadCurve::on_load(const CutLoad& load) {
  if (!load.is_engaged || !load.is_measured) return;
  const double end_s = load.start_s + load.seconds;
  if (!(load.start_s >= 0) || !(load.seconds > 0) || !std::isfinite(end_s)) return;
  while (end_s >= step_s_ * static_cast<double>(kMost)) double_step();
  const auto first = static_cast<std::size_t>(load.start_s / step_s_);
  // What ends with a column is not in the next.
  const auto end =
      std::max(first + 1, static_cast<std::size_t>(std::ceil(end_s / step_s_ * (1 - 1e-12))));
  for (std::size_t k = 0; k < kLoadKinds; ++k) {
    const ValueRange& value = load.values[k];
    if (value.nominal > 0 && std::isfinite(value.high)) add(columns_[k], value, first, end);
  }
}

}  // namespace kerf
