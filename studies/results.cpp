// Scene and record to rows.
#include "studies/results.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <span>

#include "solver/bed/bed_profiles.hpp"
#include "solver/bed/grain_hops.hpp"
#include "solver/bed/incipient_motion.hpp"
#include "solver/bed/onset_search.hpp"
#include "solver/coupling/drag_laws.hpp"
#include "solver/dimensionless.hpp"
#include "solver/required_models.hpp"
#include "studies/database_values.hpp"
#include "studies/result_tables.hpp"
#include "studies/threshold_curve.hpp"
#include "studies/transport_fits.hpp"

namespace bedload {

namespace {

constexpr double largest_steady_residual = 0.01;   // of the stress on the bed, against that from above

Value whole(double number) { return static_cast<std::int64_t>(std::llround(number)); }
Value whole(std::uint64_t number) { return static_cast<std::int64_t>(number); }
Value flag(bool is) { return std::int64_t{is}; }
Value known(double residual) { return residual < 0 ? Value() : Value(residual); }   // the record's "not known" is -1

/// Values in the order of the table's columns.
void insert(Database& database, std::string_view table, const std::vector<Value>& values) {
  std::string places;
  for (std::size_t n = 0; n < values.size(); ++n) places += n ? ", ?" : "?";
  database.execute(fmt::format("INSERT INTO {} VALUES ({})", table, places), values);
}

/// The event flux from which on a hold counts as moving: the study's own, or that of 1e-2 where another criterion decides.
double least_moving_flux(const Scene& scene) {
  return scene.onset.criterion == Onset::Criterion::flux ? scene.onset.value : 1e-2;
}

struct Scales {
  explicit Scales(const Scene& scene)
      : d(scene.bed.grains.diameter),
        s(scene.bed.grains.density / scene.bed.fluid.density),
        g(norm(scene.bed.gravity)),
        nu(scene.bed.fluid.viscosity),
        galileo(galileo_number(s, g, d, nu)),
        grain_time(s > 1 && g > 0 ? bedload::grain_time(d, s, g, terminal_speed(scene.drag, nu, s, d, g)) : 0) {}

  /// q* of a flux of events: each carries one grain's volume over d/2, so that
  /// q = flux N_s/(t_d A) (pi d^3/6) (d/2), with N_s/A = 0.8/(pi d^2/4).
  double transport(double event_flux, double surface_grains_per_area) const {
    const double q = event_flux * surface_grains_per_area / grain_time * sphere_volume(d) * d / 2;
    return q / std::sqrt(reduced_gravity(s, g) * d * d * d);
  }

  double d, s, g, nu, galileo, grain_time;
};

void store_scene(Database& database, const CaseIdentity& id, const Scene& scene, const State& state) {
  const Scales scales(scene);
  const BedScene& bed = scene.bed;
  insert(database, "scenes",
         {id.id,
          id.label,
          id.set,
          id.set_label,
          whole(id.seed),
          scales.d,
          bed.grains.spread,
          bed.grains.density,
          bed.fluid.density,
          scales.s,
          scales.nu,
          scales.g,
          real_or_null(scales.galileo),
          bed.grains.young_modulus,
          whole(state.grains.size()),
          surface_grains(scene),
          bed.length.x,
          bed.length.y,
          bed.length.z,
          scene.grid.h.x,
          scene.grid.h.y,
          scene.grid.h.z,
          std::string(name_of(scene.drag)),
          scene.drive.dwell,
          bed.dem_step,
          scene.steps.fluid_interval,
          whole(state.clock.retries)});
}

/// From the profiles of a hold [m]; nan where there are none, or nothing is sheared.
double rebound_level_of(const BedRecord::Profiles& p, double hold) {
  const auto [first, last] = std::ranges::equal_range(p.hold, hold);   // holds are in order
  const auto rows = [&, from = std::size_t(first - p.hold.begin()), n = std::size_t(last - first)](
                        const std::vector<double>& column) { return std::span(column).subspan(from, n); };
  return rebound_level(rows(p.z), rows(p.porosity), rows(p.grain_velocity));
}

void store_ramp(Database& database, const CaseIdentity& id, const Scene& scene, const BedRecord& record) {
  const BedRecord::Holds& h = record.holds;
  const double moves = least_moving_flux(scene);
  const Scales scales(scene);
  const double per_area = surface_grains(scene) / (scene.bed.length.x * scene.bed.length.y);
  const double speed = std::sqrt(reduced_gravity(scales.s, scales.g) * scales.d);   // u* = sqrt(theta (s-1) g d)
  for (std::size_t k = 0; k < h.hold.size(); ++k) {
    const double root = std::sqrt(h.shields_measured[k]);
    insert(database, "ramp_points",
           {id.id,
            whole(h.hold[k]),
            h.start[k],
            h.end[k],
            h.shields_nominal[k],
            h.shields_measured[k],
            h.stress_residual[k] < 0 ? Value() : Value(h.shields_lid[k]),
            known(h.stress_residual[k]),
            h.stress_residual[k] < 0 ? Value() : flag(h.stress_residual[k] < largest_steady_residual),
            real_or_null(root * speed),
            real_or_null(root * scales.galileo),
            h.lid_speed[k],
            h.gradient[k],
            h.flux[k],
            h.flux_standard_error[k],
            real_or_null(scales.transport(h.flux[k], per_area)),
            real_or_null(scales.transport(h.flux_standard_error[k], per_area)),
            h.moving_fraction[k],
            whole(h.moved_grains[k]),
            h.bed_height[k],
            h.bed_top[k],
            real_or_null(h.flux[k] >= moves ? rebound_level_of(record.profiles, h.hold[k]) : std::nan("")),
            h.slope[k],
            h.roughness[k],
            h.porosity[k],
            h.coordination[k],
            h.bearing_coordination[k],
            known(h.momentum_residual[k]),
            std::string(name_of(static_cast<HoldPurpose>(h.purpose[k]))),
            std::string(name_of(static_cast<HoldVerdict>(h.verdict[k])))});
  }
}

/// Columns are in the order of HealthMeasures::each; what counts something is whole.
template <class Measures, class Number>
void store_health_of_hold(Database& database, const std::string& case_id, std::uint64_t hold, const Measures& measures,
                          Number&& number) {
  constexpr std::string_view real[] = {"shortest_step", "longest_step",   "cfl", "deepest_overlap", "grain_travel",
                                       "divergence",    "divergence_left"};
  std::vector<Value> row{case_id, whole(hold)};
  Measures::each(measures, [&](std::string_view name, const auto& measure, std::string_view) {
    const bool is_real = std::ranges::find(real, name) != std::end(real);
    row.push_back(is_real ? Value(number(measure)) : whole(number(measure)));
  });
  insert(database, "step_health", row);
}

/// A row of `thresholds`, with the bed that it was measured on.
void insert_threshold(Database& database, const Scene& scene, const BedRecord& record, std::vector<Value> row) {
  const auto& bed = record.settled;
  const bool sheared = scene.shear.time > 0;
  const auto if_known = [](bool known, double number) { return known ? Value(number) : Value(); };
  for (const Value& value :
       {if_known(bed.solid_fraction > 0, bed.solid_fraction), if_known(bed.solid_fraction > 0, bed.coordination),
        if_known(sheared, scene.shear.shields), if_known(sheared, scene.shear.time), if_known(sheared, bed.shear_flux)})
    row.push_back(value);
  insert(database, "thresholds", row);
}

void store_searched(Database& database, const CaseIdentity& id, const Scene& scene, const BedRecord& record) {
  const SearchedMotion found = searched_motion(record);
  insert_threshold(database, scene, record,
                   {id.id, std::string("flux"), scene.onset.value, flag(true), std::string(name_of(found.onset.status)),
                    real_or_null(found.onset.shields), real_or_null(found.onset.lower), real_or_null(found.onset.upper),
                    std::string("bisect"), real_or_null(found.stop_lower), real_or_null(found.stop_upper)});
}

/// Thresholds beside the study's own: first grain, 1 % and 10 % of the surface moved, and the reference transport
/// W* = q*/theta^1.5 = 0.002 (Parker). Over the levels of a ramp or staircase and the holds of a search that begin from the settled bed; where
/// one goes on because it was undecided, grains have been counted before.
void store_measures_of_motion(Database& database, const CaseIdentity& id, const Scene& scene, const BedRecord& record) {
  const BedRecord::Holds& h = record.holds;
  const Scales scales(scene);
  const double surface = surface_grains(scene), per_area = surface / (scene.bed.length.x * scene.bed.length.y);
  std::vector<double> shields, grains, fraction, reference;
  for (std::size_t k = 0; k < h.hold.size(); ++k) {
    const auto purpose = static_cast<HoldPurpose>(h.purpose[k]);
    const bool of_onset = purpose == HoldPurpose::onset;
    if (purpose != HoldPurpose::ramp && purpose != HoldPurpose::staircase && !of_onset) continue;
    const bool goes_on = of_onset && k > 0 && h.purpose[k - 1] == h.purpose[k] && h.level[k - 1] == h.level[k];
    if (goes_on || !(h.shields_measured[k] > 0)) continue;
    shields.push_back(h.shields_measured[k]);
    grains.push_back(h.moved_grains[k]);
    fraction.push_back(h.moved_grains[k] / surface);
    const double w = scales.transport(h.flux[k], per_area) / std::pow(h.shields_measured[k], 1.5);
    reference.push_back(std::isfinite(w) ? std::max(w, 0.0) : 0.0);
  }
  const std::string method = scene.onset.method == Onset::Method::bisect ? "bisect" : "ramp";
  const auto store = [&](const char* criterion, const std::vector<double>& motion, double value) {
    const IncipientMotion found = lowest_reached(shields, motion, value);
    insert_threshold(
        database, scene, record,
        {id.id, std::string(criterion), value, flag(false), std::string(name_of(found.status)),
         real_or_null(found.shields), real_or_null(found.lower), real_or_null(found.upper), method, Value(), Value()});
  };
  store("moved_grains", grains, 1);
  store("moved_fraction", fraction, 0.01);
  store("moved_fraction", fraction, 0.1);
  store("reference_transport", reference, 0.002);
}

/// Over the holds that move by the criterion of flux; n is the usual 3 for laminar and 1.5 for turbulent flow.
void store_flux_law(Database& database, const CaseIdentity& id, const Scene& scene, const BedRecord::Holds& h) {
  const Scales scales(scene);
  const double per_area = surface_grains(scene) / (scene.bed.length.x * scene.bed.length.y);
  const double moves = least_moving_flux(scene);
  std::vector<double> shields, transport;
  for (std::size_t k = 0; k < h.hold.size(); ++k) {
    if (static_cast<HoldPurpose>(h.purpose[k]) == HoldPurpose::staircase || h.flux[k] < moves) continue;
    shields.push_back(h.shields_measured[k]);
    transport.push_back(scales.transport(h.flux[k], per_area));
  }
  const auto law = fit_flux_law(shields, transport, scene.terms.turbulence ? 1.5 : 3);
  if (!law || !(law->threshold > 0)) return;   // below zero: the holds are too few or too near each other to tell
  insert(database, "flux_laws",
         {id.id, law->exponent, law->threshold, law->threshold_error, law->coefficient, law->coefficient_error,
          whole(std::uint64_t(shields.size()))});
}

/// How the number of moving grains falls within each hold.
void store_decays(Database& database, const CaseIdentity& id, const Scene& scene, const BedRecord& record) {
  const BedRecord::Samples& s = record.samples;
  const double surface = surface_grains(scene);
  for (std::size_t k = 0; k < record.holds.hold.size(); ++k) {
    std::vector<double> time, moving;
    for (std::size_t n = 0; n < s.time.size(); ++n) {
      if (s.hold[n] != record.holds.hold[k]) continue;
      time.push_back(s.time[n] - record.holds.start[k]);
      moving.push_back(s.moving_fraction[n] * surface);
    }
    const auto decay = fit_decay(time, moving);
    if (!decay) continue;
    insert(database, "motion_decay",
           {id.id, whole(record.holds.hold[k]), decay->time, decay->time_error, decay->first, decay->last,
            whole(std::uint64_t(time.size()))});
  }
}

/// The study's own criterion, and flux at 1e-3 (where rearrangements begin to count) and 1e-2 for every study alike.
void store_thresholds(Database& database, const CaseIdentity& id, const Scene& scene, const BedRecord& record) {
  const Onset& onset = scene.onset;
  if (onset.method == Onset::Method::none) return;
  if (onset.method == Onset::Method::bisect) return store_searched(database, id, scene, record);
  using Criterion = Onset::Criterion;
  std::set<std::pair<Criterion, double>> wanted{{Criterion::flux, 1e-3}, {Criterion::flux, 1e-2}};
  wanted.emplace(onset.criterion, onset.value);
  for (const auto& [criterion, value] : wanted) {
    const IncipientMotion found = incipient_motion(record, criterion, value);
    const bool decides = criterion == onset.criterion && value == onset.value;
    insert_threshold(database, scene, record,
                     {id.id, std::string(criterion == Criterion::flux ? "flux" : "moving_fraction"), value,
                      flag(decides), std::string(name_of(found.status)), real_or_null(found.shields),
                      real_or_null(found.lower), real_or_null(found.upper), std::string("ramp"), Value(), Value()});
  }
}

/// Entrainment and deposition, hops and rests; measures of what did not happen are NULL.
void store_grain_motion(Database& database, const CaseIdentity& id, const Scene& scene, const BedRecord& record) {
  const BedRecord::Hops& h = record.hops;
  const BedRecord::HopHistograms& bins = record.hop_histograms;
  const Scales scales(scene);
  if (!(scales.grain_time > 0)) return;   // no rest without a weight
  const double area = scene.bed.length.x * scene.bed.length.y;
  for (std::size_t k = 0; k < h.hold.size(); ++k) {
    const auto median = [&](const std::vector<double>& counts, double unit) {
      return real_or_null(unit * Spread::median(std::span(counts).subspan(k * Spread::bins, Spread::bins)));
    };
    const auto of = [](double count, double least, double measure) {
      return count >= least ? Value(measure) : Value();
    };
    const double per_area_and_time = 1 / (area * h.duration[k]);
    insert(database, "grain_motion",
           {id.id, whole(h.hold[k]), h.duration[k], whole(h.entrained[k]), whole(h.deposited[k]),
            h.entrained[k] * per_area_and_time, h.deposited[k] * per_area_and_time, whole(h.hops[k]),
            of(h.hops[k], 1, h.hop_length[k]), of(h.hops[k], 2, h.hop_length_deviation[k]),
            median(bins.by_length, scales.d), of(h.hops[k], 1, h.hop_duration[k]),
            of(h.hops[k], 2, h.hop_duration_deviation[k]), median(bins.by_duration, scales.grain_time),
            whole(h.rests[k]), of(h.rests[k], 1, h.rest_time[k]), of(h.rests[k], 2, h.rest_time_deviation[k]),
            median(bins.rests, scales.grain_time)});
  }
  for (std::size_t n = 0; n < bins.hold.size(); ++n)
    insert(database, "hop_histograms",
           {id.id, whole(bins.hold[n]), bins.lower[n], whole(bins.by_length[n]), whole(bins.by_duration[n]),
            whole(bins.rests[n])});
}

void store_profiles(Database& database, const CaseIdentity& id, const BedRecord::Profiles& p) {
  for (std::size_t n = 0; n < p.z.size(); ++n)
    insert(database, "bed_statistics",
           {id.id, whole(p.hold[n]), p.z[n], p.porosity[n], p.fluid_velocity[n], p.grain_velocity[n],
            p.granular_temperature[n]});
}

void store_samples(Database& database, const CaseIdentity& id, const BedRecord::Samples& s) {
  for (std::size_t n = 0; n < s.time.size(); ++n)
    insert(database, "samples",
           {id.id, s.time[n], whole(s.hold[n]), s.shields_nominal[n], s.shields_measured[n], s.flux[n],
            s.moving_fraction[n], whole(s.moved_grains[n]), s.bed_height[n], s.roughness[n], s.coordination[n],
            known(s.moving_speed[n]), s.deepest_overlap[n], known(s.momentum_residual[n])});
}

void store_tracks(Database& database, const CaseIdentity& id, const BedRecord::Tracks& t) {
  for (std::size_t n = 0; n < t.time.size(); ++n)
    insert(database, "tracks",
           {id.id, whole(t.grain[n]), t.time[n], t.x[n], t.y[n], t.z[n], t.vx[n], t.vy[n], t.vz[n], t.wx[n], t.wy[n],
            t.wz[n]});
}

}   // namespace

void create_result_tables(Database& database) {
  Database::Transaction transaction(database);
  database.execute(result_tables);
  transaction.commit();
}

void store_results(Database& database, const CaseIdentity& id, const Scene& scene, const State& state,
                   const Provenance& made_by) {
  Database::Transaction transaction(database);
  for (const char* table : {"scenes", "ramp_points", "thresholds", "flux_laws", "motion_decay", "grain_motion",
                            "hop_histograms", "bed_statistics", "samples", "tracks", "provenance"})
    database.execute(fmt::format("DELETE FROM {} WHERE case_id = ?", table), {id.id});
  store_scene(database, id, scene, state);
  store_ramp(database, id, scene, state.record);
  store_health(database, id.id, state);
  store_thresholds(database, id, scene, state.record);
  if (scene.onset.method != Onset::Method::none) {
    store_measures_of_motion(database, id, scene, state.record);
    store_flux_law(database, id, scene, state.record.holds);
    store_decays(database, id, scene, state.record);
  }
  store_grain_motion(database, id, scene, state.record);
  store_profiles(database, id, state.record.profiles);
  store_samples(database, id, state.record.samples);
  store_tracks(database, id, state.record.tracks);
  insert(database, "provenance",
         {id.id, made_by.version, std::int64_t{physics_version}, made_by.compiler, made_by.flags, made_by.libraries,
          made_by.host, whole(id.seed), state_digest(state)});
  update_threshold_curve(database);
  transaction.commit();
}

std::string unsteady_holds(const Database& database) {
  if (!has_table(database, "ramp_points")) return "";
  const auto row = database
                       .query(
                           "SELECT count(*) FILTER (WHERE NOT steady), count(*), max(stress_residual) FROM "
                           "ramp_points WHERE steady IS NOT NULL AND purpose IN ('ramp', 'onset', 'stop') AND " +
                           in_study(database))
                       .rows.at(0);
  if (!(number_in(row[0]) > 0)) return "";
  return fmt::format(
      "{} of {} holds are not steady: the stress on the bed differs from that of lid and drive by up to {:.2g} %",
      number_in(row[0]), number_in(row[1]), 100 * number_in(row[2]));
}

void store_health(Database& database, const std::string& case_id, const State& state) {
  Database::Transaction transaction(database);
  database.execute("DELETE FROM step_health WHERE case_id = ?", {case_id});
  const auto& finished = state.record.health;
  for (std::size_t k = 0; k < finished.hold.size(); ++k)
    store_health_of_hold(database, case_id, static_cast<std::uint64_t>(finished.hold[k]), finished.measures,
                         [k](const auto& column) { return column[k]; });
  const auto& search = state.search;
  if (search.phase == Search::holding && search.health.steps > 0)
    store_health_of_hold(database, case_id, search.hold, search.health, [](double measure) { return measure; });
  transaction.commit();
}

void store_models(Database& database, const std::string& case_id, const Scene& scene) {
  Database::Transaction transaction(database);
  for (const char* table : {"models", "warnings"})
    database.execute(fmt::format("DELETE FROM {} WHERE case_id = ?", table), {case_id});
  std::uint64_t position = 0;
  for (const auto& m : decisions_of(scene))
    insert(database, "models",
           {case_id, whole(position++), m.term, flag(m.on), flag(m.wanted), real_or_null(m.ratio), m.reason});
  position = 0;
  for (const auto& warning : warnings_of(scene)) insert(database, "warnings", {case_id, whole(position++), warning});
  transaction.commit();
}

}   // namespace bedload
