// The ladder: its groups, its study files, its verdicts.
#include "studies/validation.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/error.hpp"
#include "studies/study_file.hpp"
#include "studies/study_keys.hpp"
#include "studies/validation_files.hpp"

namespace bedload {

namespace {

constexpr ValidationGroup groups[] = {
    {"contact", "collisions, friction and rolling of one or two grains, dry and wet", contact_rungs},
    {"settling", "a sphere alone in still fluid, on many meshes", settling_rungs},
    {"bed", "what the drag of many grains adds up to: beds, suspensions, flow over a bed", bed_rungs},
    {"fluid", "flows without grains, laminar and turbulent", fluid_rungs},
    {"onset", "what it takes to move a grain out of its place", onset_rungs},
};

/// If a group's name is that of one of its studies, says so.
void refuse_study(const std::string& name) {
  for (const auto& group : groups)
    for (const auto& rung : group.rungs())
      if (rung.study == name)
        throw Error(ErrorKind::usage, fmt::format("{} is a study of the group {}, not a group", name, group.name),
                    fmt::format("bedload validate {} judges it with its group; bedload run studies/validation/{}.toml "
                                "runs it by itself",
                                group.name, name));
}

}   // namespace

double ValidationRow::deviation() const {
  const double difference = ours - reference;
  return band.relative ? difference / std::abs(reference) : difference;
}

bool ValidationRow::in_band() const {
  const double off = deviation();
  return decides() && std::isfinite(off) && off >= -band.below && off <= band.above;
}

std::size_t Findings::deciding() const {
  return static_cast<std::size_t>(std::ranges::count_if(rows, &ValidationRow::decides));
}
std::size_t Findings::in_band() const {
  return static_cast<std::size_t>(std::ranges::count_if(rows, &ValidationRow::in_band));
}

bool RungResult::passed() const {
  return failure.empty() && !stopped && findings.deciding() > 0 && findings.in_band() == findings.deciding();
}

std::span<const ValidationGroup> validation_groups() { return groups; }

std::vector<ValidationGroup> groups_named(const std::vector<std::string>& names) {
  if (names.empty()) return {std::begin(groups), std::end(groups)};
  std::vector<ValidationGroup> named;
  for (const auto& group : groups)
    if (std::ranges::find(names, group.name) != names.end()) named.push_back(group);
  for (const auto& name : names) {
    if (std::ranges::find(groups, name, &ValidationGroup::name) != std::end(groups)) continue;
    refuse_study(name);
    std::string all, choices = "extremes";
    for (const auto& group : groups)
      all += fmt::format("{}{}", all.empty() ? "" : ", ", group.name), choices += fmt::format("|{}", group.name);
    const auto nearest = nearest_word(name, choices);
    throw Error(ErrorKind::usage, fmt::format("there is no validation group \"{}\"", name),
                fmt::format("{}the groups are {} and extremes",
                            nearest.empty() ? "" : fmt::format("did you mean {}? ", nearest), all));
  }
  return named;
}

Study validation_study(std::string_view name) {
  const std::filesystem::path file = fmt::format("studies/validation/{}.toml", name);
  return parse_study(validation_text(file), file.string());
}

std::vector<Case> cases_of(const Rung& rung, bool quick) {
  auto cases = unfold(validation_study(rung.study), validation_text);
  if (quick) std::erase_if(cases, [&](const Case& one) { return !rung.quick || !rung.quick(one); });
  return cases;
}

std::size_t Trajectory::row_at(double t) const {
  return static_cast<std::size_t>(std::ranges::lower_bound(time, t) - time.begin());
}

Trajectory trajectory_of(const FinishedCase& run, std::uint64_t grain) {
  const auto& tracks = run.state.record.tracks;
  const auto& bed = run.one.scene.bed;
  Trajectory path;
  for (std::size_t n = 0; n < tracks.time.size(); ++n) {
    if (tracks.grain[n] != static_cast<double>(grain)) continue;
    Vec3 x{tracks.x[n], tracks.y[n], tracks.z[n]};
    for (int c = 0; c < 3 && path.size() > 0; ++c)
      if (bed.sides[c] == Side::periodic)
        x[c] += bed.length[c] * std::round((path.position.back()[c] - x[c]) / bed.length[c]);
    path.time.push_back(tracks.time[n]);
    path.position.push_back(x);
    path.velocity.push_back({tracks.vx[n], tracks.vy[n], tracks.vz[n]});
    path.spin.push_back({tracks.wx[n], tracks.wy[n], tracks.wz[n]});
  }
  return path;
}

}   // namespace bedload
