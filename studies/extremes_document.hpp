// docs/extremes.md: the matrix of the extremes as it was last run.
#pragma once

#include <string>
#include <vector>

#include "studies/extremes.hpp"
#include "studies/verification_document.hpp"

namespace bedload {

/// The matrix for people: heads of the columns; what each must keep to; the cells of a scene, empty where it was refused.
std::vector<std::string> extremes_columns();
std::vector<std::string> extremes_limits();
std::vector<std::string> extremes_cells(const ExtremeRow&);

/// extremes.md; `command` is what was run, and makes it again. Apart from computing times the same matrix gives the same bytes.
DocumentFile extremes_document(const std::vector<ExtremeRow>&, const std::string& command);

}   // namespace bedload
