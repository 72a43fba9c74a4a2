// What commands do to LinuxCNC's queue of moves.
#include <algorithm>

#include "interp_bridge/motion_fold.h"
#include "interp_bridge/motion_fold_math.h"

namespace kerf {
namespace {

/// What a command does to the queue of moves in LinuxCNC 2.9: its task sends some only when all
/// moves before them are done (emcTaskCheckPreconditions: WAITING_FOR_MOTION), and some more end
/// the chain of feeds that may be merged (flush_segments of emccanon).
enum class QueueEffect : std::uint8_t { kNone, kEndsChain, kOutputs, kHalts, kHaltsForIo };

/// Not those that are steps of their own: a dwell, a tool change, a stop.
QueueEffect queue_effect(CanonicalName name) {
  switch (name) {
    case CanonicalName::kSetG5xOffset:
    case CanonicalName::kSetG92Offset:
    case CanonicalName::kSetXyRotation:
    case CanonicalName::kUseToolLengthOffset:
    case CanonicalName::kStartSpindleClockwise:
    case CanonicalName::kStartSpindleCounterclockwise:
    case CanonicalName::kStopSpindleTurning:
    case CanonicalName::kSetSpindleSpeed:
    case CanonicalName::kOrientSpindle:
    case CanonicalName::kWaitOrientComplete:
    case CanonicalName::kSetAuxOutputBit:
    case CanonicalName::kClearAuxOutputBit:
    case CanonicalName::kSetAuxOutputValue:
    case CanonicalName::kEnableAdaptiveFeed:
    case CanonicalName::kDisableAdaptiveFeed:
    case CanonicalName::kMessage:
      return QueueEffect::kHalts;
    case CanonicalName::kFloodOn:
    case CanonicalName::kFloodOff:
    case CanonicalName::kMistOn:
    case CanonicalName::kMistOff:
    case CanonicalName::kSetToolTableEntry:
    case CanonicalName::kReloadTooldata:
      return QueueEffect::kHaltsForIo;
    case CanonicalName::kSetFeedMode:
    case CanonicalName::kSetMotionControlMode:
    case CanonicalName::kStartSpeedFeedSync:
    case CanonicalName::kStopSpeedFeedSynch:
    case CanonicalName::kEnableFeedOverride:
    case CanonicalName::kDisableFeedOverride:
    case CanonicalName::kEnableSpeedOverride:
    case CanonicalName::kDisableSpeedOverride:
    case CanonicalName::kEnableFeedHold:
    case CanonicalName::kDisableFeedHold:
    case CanonicalName::kLog:
      return QueueEffect::kEndsChain;
    case CanonicalName::kSetMotionOutputBit:
    case CanonicalName::kClearMotionOutputBit:
    case CanonicalName::kSetMotionOutputValue:
      return QueueEffect::kOutputs;
    default:
      return QueueEffect::kNone;
  }
}

}  // namespace

void MotionFold::halt() {
  count_up(halts_);
  chain_end_ = std::max(chain_end_, ChainEnd::kEnds);
}

void MotionFold::note_waits(const CanonicalCommand& command) {
  if (command.name == CanonicalName::kStartChange) change_begun_ = true;
  if (command.name == CanonicalName::kReloadTooldata) {
    const bool joined = halts_ == 0 && chain_end_ == ChainEnd::kNone;
    table_reloaded_ = table_reloaded_ || joined;
    if (joined) lose_held_feed(held_axes_);
  }
  switch (queue_effect(command.name)) {
    case QueueEffect::kHaltsForIo:
      count_up(io_halts_);
      [[fallthrough]];
    case QueueEffect::kHalts:
      halt();
      break;
    case QueueEffect::kOutputs:
      chain_end_ = ChainEnd::kOutputs;
      break;
    case QueueEffect::kEndsChain:
      chain_end_ = std::max(chain_end_, ChainEnd::kEnds);
      break;
    case QueueEffect::kNone:
      break;
  }
}

}  // namespace kerf
