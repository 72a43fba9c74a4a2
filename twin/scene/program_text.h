// twin/scene/program_text.h - the text of a program, for the code panel.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "viewer/scene.h"

namespace kerf {

/// Reads the files. One that cannot be read (standard input, or gone meanwhile) or is larger than
/// `max_bytes` has one line that says so, so that the numbers of files stay.
std::shared_ptr<const ProgramText> read_program_text(const std::vector<std::string>& paths,
                                                     std::size_t max_bytes = std::size_t{512}
                                                                             << 20);

}  // namespace kerf
