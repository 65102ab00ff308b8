// When which case was worked on, and how each attempt ended.
#pragma once

#include <string>

#include "scheduler/database.hpp"

namespace bedload {

/// Tables attempts and cases: one row per case or bed in the order of enrolment, one bar per attempt from its start to its
/// end, coloured by the cause of its end; an attempt that has none yet reaches to the last time the database knows.
/// Inline SVG; empty where there are no attempts.
std::string attempt_figure(const Database&);

}   // namespace bedload
