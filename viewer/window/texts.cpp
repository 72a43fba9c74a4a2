#include "viewer/window/texts.h"

#include <array>
#include <cstdlib>

namespace kerf {
namespace {

struct Row {
  Text which;
  const char* english;
  const char* german;
};

constexpr std::array kRows{
    Row{Text::kPlay, "play", "abspielen"},
    Row{Text::kPause, "pause", "Pause"},
    Row{Text::kStop, "to start", "zum Anfang"},
    Row{Text::kStepBack, "one block back", "ein Satz zurück"},
    Row{Text::kStepForward, "one block forward", "ein Satz vor"},
    Row{Text::kPreviousFinding, "previous finding", "voriger Befund"},
    Row{Text::kNextFinding, "next finding", "nächster Befund"},
    Row{Text::kPreviousTool, "previous tool", "voriges Werkzeug"},
    Row{Text::kNextTool, "next tool", "nächstes Werkzeug"},
    Row{Text::kToEnd, "to the end", "zum Ende"},
    Row{Text::kSpeed, "speed", "Tempo"},
    Row{Text::kGoToLine, "go to line", "zur Zeile"},
    Row{Text::kElapsed, "elapsed", "vergangen"},
    Row{Text::kRemaining, "remaining", "verbleibend"},
    Row{Text::kPaused, "paused", "angehalten"},
    Row{Text::kPlaying, "playing", "läuft"},
    Row{Text::kHurrying, "hurrying there", "eilt dorthin"},
    Row{Text::kFollowing, "following the machine", "folgt der Maschine"},
    Row{Text::kEnded, "ended", "zu Ende"},
    Row{Text::kPosition, "Position", "Position"},
    Row{Text::kMachine, "machine", "Maschine"},
    Row{Text::kWork, "work", "Werkstück"},
    Row{Text::kToGo, "to go", "Restweg"},
    Row{Text::kTool, "Tool", "Werkzeug"},
    Row{Text::kNoTool, "no tool", "kein Werkzeug"},
    Row{Text::kSpindle, "spindle", "Spindel"},
    Row{Text::kFeed, "feed", "Vorschub"},
    Row{Text::kTraverse, "traverse", "Eilgang"},
    Row{Text::kCoolant, "coolant", "Kühlung"},
    Row{Text::kOffset, "work offset", "Nullpunkt"},
    Row{Text::kRemoved, "removed", "abgetragen"},
    Row{Text::kSource, "Source", "Quelle"},
    Row{Text::kLive, "live", "aktuell"},
    Row{Text::kStale, "stale", "veraltet"},
    Row{Text::kLost, "lost", "verloren"},
    Row{Text::kAgo, "old", "alt"},
    Row{Text::kFindings, "Findings", "Befunde"},
    Row{Text::kNoFindings, "none so far", "bisher keine"},
    Row{Text::kProgram, "Program", "Programm"},
    Row{Text::kNoProgram, "no program", "kein Programm"},
    Row{Text::kBreakpoint, "breakpoint", "Haltepunkt"},
    Row{Text::kScene, "Scene", "Szene"},
    Row{Text::kWorkpiece, "workpiece", "Werkstück"},
    Row{Text::kCutter, "cutter", "Schneide"},
    Row{Text::kHolder, "shank and holder", "Schaft und Halter"},
    Row{Text::kTraverses, "traverses", "Eilgänge"},
    Row{Text::kFeeds, "feeds", "Vorschübe"},
    Row{Text::kPlanned, "planned path", "geplanter Weg"},
    Row{Text::kBlank, "blank", "Rohteil"},
    Row{Text::kFrames, "axes", "Achsen"},
    Row{Text::kLocalDrawing, "local drawing", "örtlich zeichnen"},
    Row{Text::kPerspective, "perspective", "Perspektive"},
    Row{Text::kDrawing, "Drawing", "Zeichnen"},
    Row{Text::kFull, "full", "ganz"},
    Row{Text::kLocal, "local", "örtlich"},
    Row{Text::kStill, "still", "unbewegt"},
    Row{Text::kUploaded, "uploaded", "hochgeladen"},
    Row{Text::kWaiting, "waiting", "wartet"},
    Row{Text::kGpuMemory, "GPU memory", "GPU-Speicher"},
    Row{Text::kLanguage, "language", "Sprache"},
    Row{Text::kMore, "more", "weitere"},
    Row{Text::kViews, "Views", "Ansichten"},
    Row{Text::kFit, "fit", "einpassen"},
    Row{Text::kFront, "front", "vorn"},
    Row{Text::kBack, "back", "hinten"},
    Row{Text::kLeft, "left", "links"},
    Row{Text::kRight, "right", "rechts"},
    Row{Text::kTop, "top", "oben"},
    Row{Text::kBottom, "bottom", "unten"},
    Row{Text::kIsometric, "isometric", "isometrisch"},
    Row{Text::kShortcuts, "Keyboard shortcuts", "Tastenkürzel"},
    Row{Text::kCodePanel, "program panel", "Programmfenster"},
    Row{Text::kInfoPanel, "info panel", "Infofenster"},
    Row{Text::kToggleWorkpiece, "workpiece: solid, clear, hidden",
        "Werkstück: fest, durchsichtig, verborgen"},
    Row{Text::kScreenshot, "save the picture", "Bild sichern"},
    Row{Text::kClose, "close", "schließen"},
    Row{Text::kFaster, "faster", "schneller"},
    Row{Text::kSlower, "slower", "langsamer"},
    Row{Text::kMouse, "Mouse", "Maus"},
    Row{Text::kMouseOrbit, "left button: turn", "linke Taste: drehen"},
    Row{Text::kMousePan, "right or middle button, or Shift: move",
        "rechte oder mittlere Taste, oder Umschalt: schieben"},
    Row{Text::kMouseZoom, "wheel: zoom to the cursor", "Rad: zum Zeiger hin vergrößern"},
    Row{Text::kSaved, "saved:", "gesichert:"},
};

constexpr bool rows_are_in_order() {
  for (std::size_t i = 0; i < kRows.size(); ++i) {
    if (static_cast<std::size_t>(kRows[i].which) != i) return false;
  }
  return kRows.size() == static_cast<std::size_t>(Text::kCount_);
}
static_assert(rows_are_in_order(), "one row for each Text, in the order of the enum");

constexpr std::array<std::string_view, kLanguageCount> kCodes{"en", "de"};

}  // namespace

const char* text(Text which, Language language) {
  const Row& row = kRows[static_cast<std::size_t>(which)];
  return language == Language::kGerman ? row.german : row.english;
}

std::string_view code(Language language) { return kCodes[static_cast<std::size_t>(language)]; }

std::optional<Language> language_of(std::string_view code) {
  for (std::size_t i = 0; i < kCodes.size(); ++i) {
    if (kCodes[i] == code) return static_cast<Language>(i);
  }
  return std::nullopt;
}

Language language_of_environment() {
  for (const char* variable : {"LC_ALL", "LC_MESSAGES", "LANG"}) {
    const char* value = std::getenv(variable);
    if (value == nullptr || *value == '\0') continue;
    return language_of(std::string_view(value).substr(0, 2)).value_or(Language::kEnglish);
  }
  return Language::kEnglish;
}

}  // namespace kerf
