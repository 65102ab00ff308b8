// When a bed is at onset: the hold whose end is kept to be looked at.
#pragma once

#include "solver/bed/bed_record.hpp"
#include "solver/scene.hpp"

namespace bedload {

/// Whether the last hold of the record is where its bed begins to move, as far as the record goes. Of a ramp: it is at or above the
/// criterion, and none is before it or the one before it is below. Of a search: it is a mobile hold of purpose onset, at a lower
/// level than any mobile one before it. Pure in the record, so that a run that was killed and taken up says the same.
bool ends_at_onset(const BedRecord&, const Onset&);

}   // namespace bedload
