// twin/cli/entry_ask.h - what a start at a line would miss and meet, asked for in the window.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <thread>

#include "stock/stock_model.h"
#include "twin/config/written_options.h"
#include "twin/report/shown_lengths.h"
#include "viewer/scene_mailbox.h"

namespace kerf {

/// Of the JSON report of a `kerf run --enter` (kerf-report/1); nothing: it has no such part.
std::optional<EntryAnswer> entry_answer(int line, const std::string& json, LengthUnit unit);

/// Runs `kerf run --from-line N --enter` as a process of its own, one at a time: the window goes on
/// meanwhile. One thread asks; answers come by SceneUpdate::entry.
class EntryAsk {
 public:
  explicit EntryAsk(SceneMailbox& mailbox) : mailbox_(mailbox) {}
  EntryAsk(const EntryAsk&) = delete;
  EntryAsk& operator=(const EntryAsk&) = delete;

  /// The question before this one is dropped. `options`: of the window; what `kerf run` has, too,
  /// is passed on. `now`: not null: the workpiece as it is, in place of its blank.
  void ask(int line, const std::string& program, const WrittenOptions& options, LengthUnit unit,
           std::shared_ptr<const StockModel> now = nullptr);
  /// It cannot be told, and why.
  void refuse(int line, std::string why);
  /// No answer comes any more: it would be about what is not shown now.
  void forget();

 private:
  void answer(EntryAnswer answer);

  SceneMailbox& mailbox_;
  std::jthread thread_;  // last: it uses all of the above
};

}  // namespace kerf
