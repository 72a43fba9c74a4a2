#include <fmt/format.h>
#include <imgui.h>
#include <imgui_stdlib.h>

#include <algorithm>

#include "viewer/window/panels.h"

namespace kerf {
namespace {

/// What is in use, where it is not what was typed.
void draw_in_use(const PanelContext& context, const std::string& in_use) {
  if (in_use.empty()) return;
  ImGui::PushTextWrapPos(0.0f);
  ImGui::TextColored(theme::kDim, "%s: %s", context.word(Text::kInUse), in_use.c_str());
  ImGui::PopTextWrapPos();
}

/// "Cell, mm": texts are those of the command line, and so are their units.
void draw_label(const PanelContext& context, Text label) {
  ImGui::TextColored(theme::kDim, "%s, %s", context.word(label),
                     Measures(context.shown.job->unit).name());
}

/// True when Enter ends it.
bool draw_field(const PanelContext& context, Text label, const char* id, std::string* value) {
  draw_label(context, label);
  return draw_text_field(context, id, context.word(Text::kByItself), value);
}

bool draw_tools(const PanelContext& context) {
  JobEdit& edit = context.state->job;
  bool is_entered = false;
  draw_label(context, Text::kTool);
  for (auto& [number, shape] : edit.tools) {
    ImGui::PushID(number);
    ImGui::AlignTextToFramePadding();
    const auto& tools = context.shown.job->tools;
    const auto known = std::find_if(tools.begin(), tools.end(),
                                    [n = number](const JobTool& tool) { return tool.number == n; });
    const bool has_shape = known != tools.end() && !known->in_use.empty();
    // What the program uses, and nobody has described.
    const bool lacks_shape = known != tools.end() && !has_shape && shape.empty();
    ImGui::TextColored(lacks_shape ? theme::kWarning : theme::kText, "T%d", number);
    ImGui::SameLine(46.0f * context.scale);
    const std::string hint = has_shape ? known->in_use : "flat:6";
    is_entered |= draw_text_field(context, fmt::format("##shape{}", number), hint, &shape);
    if (has_shape && ImGui::IsItemHovered()) {
      ImGui::SetTooltip("%s (%s)", known->in_use.c_str(), known->origin.c_str());
    }
    ImGui::PopID();
  }
  ImGui::SetNextItemWidth(90.0f * context.scale);
  ImGui::InputInt("##new", &edit.new_tool, 1, 10);
  edit.new_tool = std::clamp(edit.new_tool, 0, 99999);
  ImGui::SameLine();
  if (ImGui::Button(context.word(Text::kAddTool))) edit.tools.try_emplace(edit.new_tool);
  return is_entered;
}

bool draw_fixtures(const PanelContext& context) {
  JobEdit& edit = context.state->job;
  bool is_entered = false;
  draw_label(context, Text::kFixtures);
  for (std::size_t n = 0; n < edit.fixtures.size(); ++n) {
    is_entered |= draw_text_field(context, fmt::format("##fixture{}", n), "vise:100:60:30",
                                  &edit.fixtures[n]);
  }
  if (ImGui::Button(context.word(Text::kAddFixture))) edit.fixtures.emplace_back();
  return is_entered;
}

JobCommand command_of(const JobEdit& edit) {
  JobCommand command{edit.stock, edit.cell, edit.model, {}, {}};
  for (const std::string& fixture : edit.fixtures) {
    if (!fixture.empty()) command.fixtures.push_back(fixture);
  }
  for (const auto& [number, shape] : edit.tools) {
    if (!shape.empty()) command.tools.emplace_back(number, shape);
  }
  return command;
}

void draw_command(const PanelContext& context) {
  const ViewedJob& job = *context.shown.job;
  if (ImGui::Button(context.word(Text::kCopyCommand))) {
    ImGui::SetClipboardText(job.command.c_str());
    context.state->notice = Text::kCopied;
  }
  ImGui::PushTextWrapPos(0.0f);
  ImGui::PushFont(context.fonts.mono);
  ImGui::TextColored(theme::kDim, "%s", job.command.c_str());
  ImGui::PopFont();
  ImGui::PopTextWrapPos();
}

}  // namespace

JobEdit edit_of(const ViewedJob& job) {
  JobEdit edit;
  edit.stock = job.stock, edit.cell = job.cell, edit.model = job.model;
  edit.fixtures = job.fixtures;
  for (const JobTool& tool : job.tools) edit.tools[tool.number] = tool.given;
  while (edit.tools.count(edit.new_tool) > 0) ++edit.new_tool;
  return edit;
}

void draw_job_tab(const PanelContext& context) {
  const ViewedJob& job = *context.shown.job;
  JobEdit& edit = context.state->job;
  for (const std::string& fault : job.faults) {
    ImGui::PushTextWrapPos(0.0f);
    ImGui::TextColored(theme::kError, "%s", fault.c_str());
    ImGui::PopTextWrapPos();
  }
  if (job.is_fixed) return draw_command(context);
  bool is_asked = draw_field(context, Text::kBlank, "##stock", &edit.stock);
  draw_in_use(context, job.stock_in_use);
  is_asked |= draw_field(context, Text::kCell, "##cell", &edit.cell);
  draw_in_use(context, job.cell_in_use);
  ImGui::TextColored(theme::kDim, "%s", context.word(Text::kModel));
  ImGui::SetNextItemWidth(-1.0f);
  if (ImGui::BeginCombo("##model", edit.model.empty() ? "auto" : edit.model.c_str())) {
    for (const std::string& model : job.models) {
      if (ImGui::Selectable(model.c_str(), model == edit.model)) {
        edit.model = model == "auto" ? "" : model;
      }
    }
    ImGui::EndCombo();
  }
  draw_in_use(context, job.model_in_use);
  is_asked |= draw_tools(context);
  is_asked |= draw_fixtures(context);
  ImGui::Separator();
  is_asked |= ImGui::Button(context.word(Text::kApply));
  if (is_asked) context.commands->push(command_of(edit));
  ImGui::SameLine();
  draw_command(context);
}

}  // namespace kerf
