#include "solver/bed/onset_moment.hpp"

#include <span>

#include "solver/bed/onset_search.hpp"

namespace bedload {

namespace {

bool ramp_ends_at_onset(const BedRecord::Holds& holds, const Onset& onset) {
  const auto& activity = onset.criterion == Onset::Criterion::flux ? holds.flux : holds.moving_fraction;
  const std::size_t n = activity.size();
  return activity[n - 1] >= onset.value && (n == 1 || activity[n - 2] < onset.value);
}

bool is_mobile_at_onset(const JudgedHold& hold) {
  return hold.purpose == HoldPurpose::onset && hold.verdict == HoldVerdict::mobile;
}

bool search_ends_at_onset(const std::vector<JudgedHold>& done) {
  if (!is_mobile_at_onset(done.back())) return false;
  for (const JudgedHold& before : std::span(done).first(done.size() - 1))
    if (is_mobile_at_onset(before) && before.level <= done.back().level) return false;
  return true;
}

}   // namespace

bool ends_at_onset(const BedRecord& record, const Onset& onset) {
  if (record.holds.hold.empty() || onset.method == Onset::Method::none) return false;
  return onset.method == Onset::Method::bisect ? search_ends_at_onset(judged_holds(record.holds))
                                               : ramp_ends_at_onset(record.holds, onset);
}

}   // namespace bedload
