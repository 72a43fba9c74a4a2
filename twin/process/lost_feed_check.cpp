#include "twin/process/lost_feed_check.h"

#include <string>
#include <utility>

#include "base/translate.h"
#include "interp_bridge/held_feed.h"

namespace kerf {

void LostFeedCheck::watch(const Motion& m, const TimedStep& step) {
  if (!m.by_number && !m.table_reloaded && !last_.by_number) {
    last_.feed = is_held_back(m);
    last_.merges = m.merge_tolerance_mm > 0;
    last_.source = m.source;
    last_.from_mm = m.from_mm;
    last_.start_s = step.start_s;
    return;
  }
  Held now{is_held_back(m), m.merge_tolerance_mm > 0, m.by_number, m.source, m.from_mm,
           step.start_s};
  const bool joined = m.halts == 0 && m.chain_end == ChainEnd::kNone;
  if (m.by_number && last_.feed && joined) tell_lost(last_, "M61", m.source, m.tool);
  if (m.table_reloaded && last_.feed) tell_lost(last_, "G10 L0", {}, m.tool);
  if (now.feed && last_.by_number && m.source == last_.source && m.source.line != 0) {
    tell_lost(now, "M61", m.source, m.tool);
    now.feed = false;
  }
  last_ = now;
}

/// `word` stands at `place`; its line 0: it comes behind the feed.
void LostFeedCheck::tell_lost(const Held& feed, const char* word, SourceRef place, int tool) {
  Finding finding;
  finding.id = FindingId::kFeedLost;
  finding.source = feed.source;
  finding.time_s = feed.start_s;
  finding.position_mm = feed.from_mm;
  finding.tool = tool;
  const bool same_block = place == feed.source;
  finding.text =
      trf("LinuxCNC does not run this feed{}: {} {}; the machine stays where it is, and what comes "
          "next starts from there",
          feed.merges ? tr(", nor feeds that G64 merges with it") : "", word,
          same_block        ? std::string(tr("is in its block"))
          : place.line != 0 ? trf("in line {} comes right after it", place.line)
                            : std::string(tr("comes right after it")));
  finding.hint = same_block ? trf("write {} in a block of its own, behind G4 P0", word)
                            : trf("write G4 P0 between the feed and {}", word);
  log_.add(std::move(finding));
}

}  // namespace kerf
