// What the program says on stderr: progress and warnings; results go to stdout and are no concern of this file.
#pragma once

#include <string_view>

#include "base/error.hpp"

namespace bedload {

enum class Verbosity { quiet, normal, verbose };   // -q, neither, -v
void set_verbosity(Verbosity);

void log_detail(std::string_view line);    // only when verbose
void log_note(std::string_view line);      // unless quiet
void log_warning(std::string_view line);   // always, marked
/// The message ("error: " before it unless it places itself in a file, as study-file errors do), then one hint line.
void log_error(const Error&);

/// True when a file descriptor is a terminal, NO_COLOR is unset or empty, and TERM is not "dumb".
bool colour_wanted(int descriptor);

}   // namespace bedload
