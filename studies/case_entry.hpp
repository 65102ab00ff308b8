// A case as a row of the database.
#pragma once

#include "scheduler/ledger.hpp"
#include "studies/case_file.hpp"
#include "studies/results.hpp"
#include "studies/study.hpp"

namespace bedload {

CaseEntry case_entry(const Case&);
CaseEntry bed_entry(const CaseInputs& bed);
/// Of a directory, whatever study file made it.
CaseEntry entry_of(const CaseDirectory&);

CaseIdentity identity_of(const CaseDirectory&);

}   // namespace bedload
