// machine_io/mtconnect/device_state.h - what a machine's data items say by now, as samples.
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "machine_io/mtconnect/stream_answer.h"
#include "machine_io/position_source.h"

namespace kerf {

/// Takes observations and makes samples of them. An agent tells only what has changed: what has not
/// been told again holds, until it is told to be UNAVAILABLE. Reads no clock.
class DeviceState {
 public:
  /// What was stamped within `gather_ns` of each other is one sample.
  DeviceState(ItemPlan plan, LoadUnit load_unit, std::int64_t gather_ns);

  struct Stamped {
    AxisSample sample;
    std::int64_t stamp_ns = 0;  ///< of the newest observation in it
    bool is_whole = true;       ///< false: there was a missing() then
  };
  /// The samples that they make, in their order; only of data items that count. In the order of
  /// their sequence numbers. An answer may end between two axes of one time: where one is missing
  /// that was told with the others before, the last sample waits for the next call.
  std::vector<Stamped> take(std::span<const Observation> observations);
  /// A sample waits.
  bool is_waiting() const { return is_open_; }
  /// The state as it is, as a sample in which everything known has been read.
  AxisSample sample() const;

  /// Why there is no position that could be cut with. Empty: there is.
  std::string missing() const;
  /// Values that could not be what they are told to be; the last one in trouble().
  std::uint64_t damaged() const { return damaged_; }
  const std::string& trouble() const { return trouble_; }

 private:
  bool apply(const Observation& one);
  bool is_told(const Observation& one) const;
  void set_axis(std::size_t axis, const TakenItem& item, std::string_view text);
  bool set_path(const Observation& one);
  double number_of(const Observation& one, const TakenItem& item, double most);
  std::int32_t whole_of(const Observation& one, const TakenItem& item);
  void complain(const Observation& one, std::string_view wanted);
  void settle();
  std::uint16_t mapped() const;

  ItemPlan plan_;
  std::int64_t gather_ns_;
  AxisSample now_;
  bool is_open_ = false;  ///< now_ has observations that no sample has been made of
  std::int64_t begun_ns_ = 0, newest_ns_ = 0;  ///< of these
  std::uint16_t fresh_before_ = 0;             ///< of the last sample
  std::string execution_, mode_, direction_;
  bool is_available_ = true;
  double rpm_ = std::numeric_limits<double>::quiet_NaN();
  std::uint64_t damaged_ = 0;
  std::string trouble_;
};

}  // namespace kerf
