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
    Row{Text::kPlay, "Play", "Abspielen"},
    Row{Text::kPause, "Pause", "Pause"},
    Row{Text::kStop, "Stop", "Stopp"},
    Row{Text::kToStart, "To the start", "Zum Anfang"},
    Row{Text::kStepBack, "One block back", "Ein Satz zurück"},
    Row{Text::kStepForward, "One block forward", "Ein Satz vor"},
    Row{Text::kPreviousFinding, "Previous finding", "Voriger Befund"},
    Row{Text::kNextFinding, "Next finding", "Nächster Befund"},
    Row{Text::kPreviousTool, "Previous tool", "Voriges Werkzeug"},
    Row{Text::kNextTool, "Next tool", "Nächstes Werkzeug"},
    Row{Text::kToEnd, "To the end", "Zum Ende"},
    Row{Text::kSpeed, "Speed", "Tempo"},
    Row{Text::kFullSpeed, "max", "max"},
    Row{Text::kFullSpeedWhat, "As fast as it can be cut", "So schnell es geht"},
    Row{Text::kGoToLine, "Go to line", "Zur Zeile"},
    Row{Text::kLine, "Line", "Zeile"},
    Row{Text::kRunToHere, "Run to here, as fast as possible", "Schnellstens bis hier"},
    Row{Text::kJumpToHere, "Jump to here", "Hierher springen"},
    Row{Text::kSetBreakpoint, "Set a breakpoint", "Haltepunkt setzen"},
    Row{Text::kClearBreakpoint, "Clear the breakpoint", "Haltepunkt löschen"},
    Row{Text::kFollowLine, "Follow the running line", "Laufender Zeile folgen"},
    Row{Text::kElapsed, "Elapsed", "Vergangen"},
    Row{Text::kRemaining, "Remaining", "Verbleibend"},
    Row{Text::kPaused, "Paused", "Angehalten"},
    Row{Text::kPlaying, "Playing", "Läuft"},
    Row{Text::kHurrying, "Hurrying there", "Eilt dorthin"},
    Row{Text::kFollowing, "Following the machine", "Folgt der Maschine"},
    Row{Text::kMachineLeads, "The machine leads: it cannot be played from here",
        "Die Maschine führt: hier lässt sich nichts abspielen"},
    Row{Text::kEnded, "Ended", "Zu Ende"},
    Row{Text::kMachine, "Machine", "Maschine"},
    Row{Text::kWork, "Work", "Werkstück"},
    Row{Text::kToGo, "To go", "Restweg"},
    Row{Text::kTool, "Tool", "Werkzeug"},
    Row{Text::kNoTool, "No tool", "Kein Werkzeug"},
    Row{Text::kSpindle, "Spindle", "Spindel"},
    Row{Text::kFeed, "Feed", "Vorschub"},
    Row{Text::kTraverse, "Traverse", "Eilgang"},
    Row{Text::kCoolant, "Coolant", "Kühlung"},
    Row{Text::kRemoved, "Removed", "Abgetragen"},
    Row{Text::kLive, "Live", "Aktuell"},
    Row{Text::kStale, "Stale", "Veraltet"},
    Row{Text::kLost, "Lost", "Verloren"},
    Row{Text::kAgo, "old", "alt"},
    Row{Text::kFindings, "Findings", "Befunde"},
    Row{Text::kNoFindings, "None so far", "Bisher keine"},
    Row{Text::kProgram, "Program", "Programm"},
    Row{Text::kNoProgram, "No program", "Kein Programm"},
    Row{Text::kBreakpoint, "Breakpoint", "Haltepunkt"},
    Row{Text::kWorkpiece, "Workpiece", "Werkstück"},
    Row{Text::kCutter, "Cutter", "Schneide"},
    Row{Text::kHolder, "Shank, holder", "Schaft, Halter"},
    Row{Text::kTraverses, "Traverses", "Eilgänge"},
    Row{Text::kFeeds, "Feeds", "Vorschübe"},
    Row{Text::kPlanned, "Planned path", "Geplanter Weg"},
    Row{Text::kBlank, "Blank", "Rohteil"},
    Row{Text::kFrames, "Axes", "Achsen"},
    Row{Text::kPathTail, "Only the last moves of the path", "Vom Weg nur das letzte Stück"},
    Row{Text::kMachineParts, "Machine", "Maschine"},
    Row{Text::kLocalDrawing, "Draw only what changes", "Nur Geändertes zeichnen"},
    Row{Text::kPerspective, "Persp", "Persp"},
    Row{Text::kPerspectiveWhat, "Perspective or orthographic", "Perspektive oder orthografisch"},
    Row{Text::kDrawing, "How it is drawn", "Wie gezeichnet wird"},
    Row{Text::kNextRoad, "Draw by mesh, rays, CSG", "Zeichnen mit Netz, Strahlen, CSG"},
    Row{Text::kRoadMesh, "Mesh", "Netz"},
    Row{Text::kRoadRaycast, "Rays", "Strahlen"},
    Row{Text::kRoadCsg, "CSG", "CSG"},
    Row{Text::kRoadIsPlain, "without colours and section", "ohne Farben und Schnitt"},
    Row{Text::kRoadNoHeights, "Rays need heights, and this workpiece has none ({}): drawn as mesh",
        "Strahlen brauchen Höhen, dieses Werkstück hat keine ({}): als Netz gezeichnet"},
    Row{Text::kRoadCompared, "Deviations are drawn as mesh alone",
        "Abweichungen werden nur als Netz gezeichnet"},
    Row{Text::kRoadNoBox,
        "CSG begins with a full Z-map, and this blank is none ({}): drawn as mesh",
        "CSG beginnt mit einer vollen Z-Map, dieses Rohteil ist keine ({}): als Netz gezeichnet"},
    Row{Text::kRoadTilted, "CSG cuts with upright tools alone: drawn as mesh",
        "CSG schneidet nur mit senkrechtem Werkzeug: als Netz gezeichnet"},
    Row{Text::kRoadTool, "CSG cannot subtract {}: drawn as mesh",
        "CSG kann nicht abziehen: {}; als Netz gezeichnet"},
    Row{Text::kRoadWatched, "CSG is for programs, not for a machine that is watched: drawn as mesh",
        "CSG ist für Programme, nicht für eine beobachtete Maschine: als Netz gezeichnet"},
    Row{Text::kRoadNewest, "CSG: cuts before line {} may be left out",
        "CSG: Schnitte vor Zeile {} fehlen womöglich"},
    Row{Text::kFull, "Whole pictures", "Ganze Bilder"},
    Row{Text::kLocal, "Parts of pictures", "Teile von Bildern"},
    Row{Text::kStill, "Tool alone", "Nur das Werkzeug"},
    Row{Text::kUploaded, "Uploaded", "Hochgeladen"},
    Row{Text::kWaiting, "Waiting", "Wartet"},
    Row{Text::kGpuMemory, "GPU memory", "GPU-Speicher"},
    Row{Text::kFramesPerSecond, "frames/s", "Bilder/s"},
    Row{Text::kTextSize, "Size", "Größe"},
    Row{Text::kDarkBackground, "Dark background", "Dunkler Hintergrund"},
    Row{Text::kUnits, "Millimetres or inches", "Millimeter oder Zoll"},
    Row{Text::kTheme, "Theme", "Farbschema"},
    Row{Text::kThemeDark, "Dark", "Dunkel"},
    Row{Text::kThemeLight, "Light", "Hell"},
    Row{Text::kThemeSystem, "As the desktop", "Wie der Desktop"},
    Row{Text::kView, "View", "Ansicht"},
    Row{Text::kObjects, "Objects", "Objekte"},
    Row{Text::kOpacity, "Opacity", "Deckkraft"},
    Row{Text::kColors, "Colours", "Farben"},
    Row{Text::kNextColors, "Next colours", "Nächste Farben"},
    Row{Text::kColorPlain, "Plain", "Einfarbig"},
    Row{Text::kColorHeight, "By height", "Nach Höhe"},
    Row{Text::kColorTool, "By tool", "Nach Werkzeug"},
    Row{Text::kColorRemovalRate, "By removal rate", "Nach Zeitspanvolumen"},
    Row{Text::kColorLineRange, "By line range", "Nach Zeilenbereich"},
    Row{Text::kColorDeviation, "By deviation", "Nach Abweichung"},
    Row{Text::kFirstLine, "From line", "Von Zeile"},
    Row{Text::kLastLine, "To line", "Bis Zeile"},
    Row{Text::kTolerance, "Tolerance", "Toleranz"},
    Row{Text::kNoColorsYet, "no colours yet", "noch keine Farben"},
    Row{Text::kSection, "Section", "Schnitt"},
    Row{Text::kSectionFlip, "Other side", "Andere Seite"},
    Row{Text::kPoint, "Point", "Punkt"},
    Row{Text::kPickHint, "Click on the workpiece.", "Auf das Werkstück klicken."},
    Row{Text::kHeight, "Height", "Höhe"},
    Row{Text::kCutBy, "Cut by", "Geschnitten von"},
    Row{Text::kNotCut, "not cut", "nicht geschnitten"},
    Row{Text::kAsking, "asking ...", "wird gefragt ..."},
    Row{Text::kDeviation, "Deviation", "Abweichung"},
    Row{Text::kMeasure, "Measure", "Messen"},
    Row{Text::kMeasureFirst, "Click the first point.", "Ersten Punkt anklicken."},
    Row{Text::kMeasureSecond, "Click the second point.", "Zweiten Punkt anklicken."},
    Row{Text::kDistance, "Distance", "Abstand"},
    Row{Text::kClear, "Clear", "Löschen"},
    Row{Text::kFit, "Fit", "Alles"},
    Row{Text::kFront, "Front", "Vorn"},
    Row{Text::kBack, "Back", "Hinten"},
    Row{Text::kLeft, "Left", "Links"},
    Row{Text::kRight, "Right", "Rechts"},
    Row{Text::kTop, "Top", "Oben"},
    Row{Text::kBottom, "Bottom", "Unten"},
    Row{Text::kIsometric, "Iso", "Iso"},
    Row{Text::kFlatOff, "3D", "3D"},
    Row{Text::kFlatXy, "2D XY", "2D XY"},
    Row{Text::kFlatXz, "2D ZX", "2D ZX"},
    Row{Text::kFlat, "3D, flat from above, flat for turning",
        "3D, flach von oben, flach zum Drehen"},
    Row{Text::kPicture, "Picture", "Bild"},
    Row{Text::kQuestionMark, " ? ", " ? "},
    Row{Text::kShortcuts, "Keyboard shortcuts", "Tastenkürzel"},
    Row{Text::kFirstKeys, "The first keys", "Die ersten Tasten"},
    Row{Text::kFirstKeysHow, "F1 shows this again, ? all keys. Any key or click closes it.",
        "F1 zeigt dies wieder, ? alle Tasten. Jede Taste und jeder Klick schließt es."},
    Row{Text::kCodePanel, "Program panel", "Programmfenster"},
    Row{Text::kInfoPanel, "Info panel", "Infofenster"},
    Row{Text::kToggleWorkpiece, "Workpiece: solid, clear, hidden",
        "Werkstück: fest, durchsichtig, verborgen"},
    Row{Text::kScreenshot, "Save the picture", "Bild sichern"},
    Row{Text::kWindowPicture, "Save the whole window", "Ganzes Fenster sichern"},
    Row{Text::kClose, "Close", "Schließen"},
    Row{Text::kFaster, "Faster", "Schneller"},
    Row{Text::kSlower, "Slower", "Langsamer"},
    Row{Text::kMouseOrbit, "Left button: turn", "Linke Taste: drehen"},
    Row{Text::kMousePan, "Right or middle button, or Shift: move",
        "Rechte oder mittlere Taste, oder Umschalt: schieben"},
    Row{Text::kMouseZoom, "Wheel: zoom to the cursor", "Rad: zum Zeiger hin vergrößern"},
    Row{Text::kMousePick, "Click on the workpiece: what is there",
        "Auf das Werkstück klicken: was dort ist"},
    Row{Text::kMouseCode, "Click on a line: jump there; right: menu",
        "Auf eine Zeile klicken: dorthin; rechts: Menü"},
    Row{Text::kMouseGutter, "Click on a line number: breakpoint",
        "Auf eine Zeilennummer klicken: Haltepunkt"},
    Row{Text::kSaving, "Saving ...", "Wird gesichert ..."},
    Row{Text::kSaved, "Saved:", "Gesichert:"},
    Row{Text::kSave, "Save", "Sichern"},
    Row{Text::kPictureTo, "Save the picture as", "Bild sichern als"},
    Row{Text::kWindowTo, "Save the whole window as", "Ganzes Fenster sichern als"},
    Row{Text::kFilmTo, "Save the film as (.mp4 or .webm)", "Film sichern als (.mp4 oder .webm)"},
    Row{Text::kFilm, "Film ...", "Film ..."},
    Row{Text::kFilmWhat, "Film of what is played: begin, end",
        "Film vom Abspielen: beginnen, beenden"},
    Row{Text::kFilmRuns, "Filming (F ends it):", "Film läuft (F beendet ihn):"},
    Row{Text::kFilmEnds, "Film is being packed ...", "Film wird gepackt ..."},
    Row{Text::kFilmEnding, "the name of a film ends in .mp4 or .webm",
        "der Name eines Films endet auf .mp4 oder .webm"},
    Row{Text::kNoFfmpeg, "a film needs the program ffmpeg, which is not installed",
        "ein Film braucht das Programm ffmpeg, das nicht installiert ist"},
    Row{Text::kIsThere, "there is a file of this name already",
        "eine Datei dieses Namens gibt es schon"},
    Row{Text::kNoFolder, "there is no such folder", "diesen Ordner gibt es nicht"},
    Row{Text::kOpen, "Open", "Öffnen"},
    Row{Text::kOpenWhat, "Open a program or a log", "Programm oder Aufzeichnung öffnen"},
    Row{Text::kNothingOpen, "No program is open", "Kein Programm ist offen"},
    Row{Text::kDropHint, "Open one (Ctrl+O), or drop its file here",
        "Öffnen (Strg+O) oder die Datei hierher ziehen"},
    Row{Text::kRecent, "Recent", "Zuletzt"},
    Row{Text::kFolderUp, "Up", "Hoch"},
    Row{Text::kAllFiles, "All files", "Alle Dateien"},
    Row{Text::kFileName, "Name", "Name"},
    Row{Text::kCancel, "Cancel", "Abbrechen"},
    Row{Text::kCannotOpen, "This window shows a machine; kerf view opens programs and logs",
        "Dieses Fenster zeigt eine Maschine; kerf view öffnet Programme und Aufzeichnungen"},
    Row{Text::kSearch, "Search in the program", "Im Programm suchen"},
    Row{Text::kNotFound, "not found", "nicht gefunden"},
    Row{Text::kJob, "Job", "Auftrag"},
    Row{Text::kCell, "Cell, mm", "Zelle, mm"},
    Row{Text::kModel, "Model", "Modell"},
    Row{Text::kByItself, "chosen by itself", "von selbst gewählt"},
    Row{Text::kInUse, "now", "jetzt"},
    Row{Text::kAddTool, "Add a tool", "Werkzeug hinzufügen"},
    Row{Text::kApply, "Apply", "Anwenden"},
    Row{Text::kCopyCommand, "Copy the command", "Befehl kopieren"},
    Row{Text::kCopied, "Copied", "Kopiert"},
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
