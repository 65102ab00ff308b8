// Who a case is: the digest of its physics.
#pragma once

#include <string>

#include "studies/case_inputs.hpp"

namespace bedload {

/// Case id, 64 hex digits: SHA-256 over the sorted list of resolved inputs (shortest round-trip numbers in SI, digest of
/// the CSV) and physics_version. Not in it: names, how the study is run, the onset criterion and its value (results are
/// recomputed), the number of steps of a ramp (a longer ramp continues the final checkpoint).
std::string case_id(const CaseInputs&);

/// The same without the packing's seed: the parameter set that the seeds of a study share.
std::string parameter_set_id(const CaseInputs&);

/// The id of the bed that a case starts on; empty when its grains are not settled before.
std::string bed_id(const CaseInputs&);

/// The list that is hashed, a line "key = value" each.
std::string canonical_inputs(const CaseInputs&);

/// The directory name of an id: its first 12 digits.
std::string short_id(const std::string& id);

}   // namespace bedload
