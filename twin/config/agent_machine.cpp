#include "twin/config/agent_machine.h"

#include <fmt/format.h>

#include <utility>

#include "base/translate.h"
#include "machine_io/mtconnect/mtconnect_source.h"
#include "twin/config/key_table.h"
#include "twin/machine/kinematics/kinematics_setup.h"

namespace kerf {
namespace {

void tell(Severity severity, std::string message, Diagnostics& diagnostics, std::string hint = {}) {
  diagnostics.push_back({severity, {}, 0, 0, std::move(message), {}, std::move(hint)});
}

void take_limits(const ItemPlan& plan, const std::string& url, TimelineOptions& timeline,
                 Diagnostics& diagnostics) {
  std::string taken;
  for (std::size_t i = 0; i < kMaxPositions; ++i) {
    const std::optional<double>& least = plan.least[i];
    const std::optional<double>& most = plan.most[i];
    if (!least || !most || !(*least < *most)) continue;
    AxisLimits& axis = timeline.limits.axes[i];
    axis.present = true;
    axis.min = *least;
    axis.max = *most;
    taken += fmt::format("{}{} {:g}..{:g}", taken.empty() ? "" : ", ", kAllAxes[i], *least, *most);
  }
  if (taken.empty()) return;
  tell(Severity::kNote, trf("limits of the axes, by {}: {}", url, taken), diagnostics);
}

void take_kinematics(const LinuxcncKinematics& told, const std::string& letters,
                     TimelineOptions& timeline, Diagnostics& diagnostics) {
  if (told.module.empty() || told.module == "trivkins") return;
  KinematicsRequest request;
  request.kinematics = told.params.empty() ? told.module : told.module + " " + told.params;
  Result<MachineKinematics> machine = kinematics_of_request(request, letters);
  if (!machine) {
    tell(Severity::kWarning,
         trf("{}; positions are taken as those of the tip in a machine with straight axes",
             machine.error()),
         diagnostics);
    return;
  }
  timeline.kinematics = std::make_shared<const MachineKinematics>(std::move(machine.value()));
  timeline.kinematics_known = true;
  tell(Severity::kNote,
       trf("kinematics, by the agent: {}; it does not say where the turning axes are",
           request.kinematics),
       diagnostics, tr("machine.ini or machine.kinematics and its pins do"));
}

}  // namespace

void take_agent_machine(const LiveConfig& config, TimelineOptions& timeline,
                        Diagnostics& diagnostics) {
  const auto* const agent = std::get_if<MtconnectSettings>(&config.source);
  if (agent == nullptr || config.machine.ini) return;
  const Result<AgentMachine> machine = ask_machine(*agent);
  if (!machine) {
    tell(Severity::kNote,
         trf("limits and kinematics of the machine are not known: {}", machine.error()),
         diagnostics);
    return;
  }
  if (!timeline.limits_known) {
    take_limits(machine->plan, machine->device.name, timeline, diagnostics);
  }
  const bool is_said = config.machine.kinematics && config.machine.kinematics->is_given();
  if (machine->device.kinematics && !is_said && !timeline.kinematics_known) {
    std::string letters = machine->plan.letters();
    std::erase(letters, ' ');
    take_kinematics(*machine->device.kinematics, letters, timeline, diagnostics);
  }
}

}  // namespace kerf
