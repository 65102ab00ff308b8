// The tables that results live in: SI, the unit in the column's name, NULL where a number is not known.
#pragma once

#include <string_view>

namespace bedload {

/// Statements that make what is missing. Columns are in the order in which results.cpp and threshold_curve.cpp fill them.
inline constexpr std::string_view result_tables = R"sql(
CREATE TABLE IF NOT EXISTS scenes (                -- one row per finished case: what the dimensionless numbers are made of
  case_id                   TEXT PRIMARY KEY,
  label                     TEXT NOT NULL,
  parameter_set             TEXT NOT NULL,         -- shared by the seeds
  set_label                 TEXT NOT NULL,
  seed                      INTEGER NOT NULL,      -- of the packing
  diameter_m                REAL NOT NULL,         -- mean
  spread                    REAL NOT NULL,         -- standard deviation / mean
  grain_density_kg_per_m3   REAL NOT NULL,
  fluid_density_kg_per_m3   REAL NOT NULL,
  density_ratio             REAL NOT NULL,         -- s
  viscosity_m2_per_s        REAL NOT NULL,         -- kinematic
  gravity_m_per_s2          REAL NOT NULL,
  galileo                   REAL,                  -- sqrt((s-1) g d^3)/nu
  young_modulus_pa          REAL NOT NULL,
  grains                    INTEGER NOT NULL,
  surface_grains            REAL NOT NULL,         -- N_s = 0.8 A/(pi d^2/4)
  length_m                  REAL NOT NULL,
  width_m                   REAL NOT NULL,
  height_m                  REAL NOT NULL,
  cell_x_m                  REAL NOT NULL,
  cell_y_m                  REAL NOT NULL,
  cell_z_m                  REAL NOT NULL,
  drag_law                  TEXT NOT NULL,
  dwell_s                   REAL NOT NULL,
  dem_step_s                REAL NOT NULL,
  fluid_step_limit_s        REAL NOT NULL,
  retries                   INTEGER NOT NULL       -- fluid steps undone and taken again shorter, in all
) STRICT;

CREATE TABLE IF NOT EXISTS ramp_points (           -- one row per hold, means over its last half
  case_id                   TEXT NOT NULL,
  hold                      INTEGER NOT NULL,
  start_s                   REAL NOT NULL,
  end_s                     REAL NOT NULL,
  shields_nominal           REAL NOT NULL,         -- imposed
  shields                   REAL NOT NULL,         -- measured by the momentum balance of the bed
  shields_lid               REAL,                  -- by the lid's stress and the drive above z_b
  stress_residual           REAL,                  -- |shields_lid/shields - 1|: what the flow above z_b still gains or loses
  steady                    INTEGER,               -- 1 = that is below 1 %
  shear_velocity_m_per_s    REAL,                  -- u*
  friction_reynolds         REAL,                  -- Re* = u* d/nu
  lid_speed_m_per_s         REAL NOT NULL,
  drive_m_per_s2            REAL NOT NULL,         -- driving gradient per mass of fluid
  event_flux                REAL NOT NULL,         -- passages of d/2 downstream per surface grain and grain time
  event_flux_error          REAL NOT NULL,         -- its standard error
  transport                 REAL,                  -- q* = q/sqrt((s-1) g d^3)
  transport_error           REAL,
  moving_fraction           REAL NOT NULL,         -- grains faster than 0.01 sqrt((s-1) g d), per surface grain
  moved_grains              INTEGER NOT NULL,      -- that went d/2 downstream since the hold began
  bed_height_m              REAL NOT NULL,         -- z_b: half of the bulk's solid fraction
  bed_top_m                 REAL NOT NULL,         -- mean elevation of the highest grain surfaces
  rebound_level_m           REAL,                  -- where P_s dv_x/dz is largest; NULL where nothing is transported
  slope                     REAL NOT NULL,         -- dz/dx of that elevation, least squares
  roughness_m               REAL NOT NULL,
  porosity                  REAL NOT NULL,
  coordination              REAL NOT NULL,
  bearing_coordination      REAL NOT NULL,         -- without rattlers
  momentum_residual         REAL,                  -- in units of a Shields number
  purpose                   TEXT NOT NULL,         -- ramp, or of a bisection: staircase | onset | stir | stop
  verdict                   TEXT NOT NULL,         -- none (ramp), arrested | undecided | mobile
  PRIMARY KEY (case_id, hold)
) STRICT;

CREATE TABLE IF NOT EXISTS step_health (           -- one row per hold: the worst of its fluid steps, named as in the checkpoint
  case_id                   TEXT NOT NULL,
  hold                      INTEGER NOT NULL,
  steps                     INTEGER NOT NULL,      -- fluid steps
  shortest_step_s           REAL NOT NULL,
  longest_step_s            REAL NOT NULL,
  retries                   INTEGER NOT NULL,      -- undone and taken again shorter
  cfl                       REAL NOT NULL,         -- Courant number
  deepest_overlap           REAL NOT NULL,         -- per diameter of the smaller grain
  grain_travel              REAL NOT NULL,         -- per cell edge
  divergence                REAL NOT NULL,         -- that the projection's linear solve left, of its right-hand side
  divergence_left           REAL NOT NULL,         -- |div(eps u + J)| T that a step left
  void_clamps               INTEGER NOT NULL,      -- summed over grains and steps
  face_clamps               INTEGER NOT NULL,      -- summed over faces and steps
  disturbance_clamps        INTEGER NOT NULL,
  lift_clamps               INTEGER NOT NULL,
  pressure_iterations       INTEGER NOT NULL,      -- most in one step
  drag_iterations           INTEGER NOT NULL,
  limited_by_cfl            INTEGER NOT NULL,      -- steps that this limit shortened
  limited_by_drag           INTEGER NOT NULL,
  limited_by_travel         INTEGER NOT NULL,
  limited_by_contact        INTEGER NOT NULL,
  limited_by_weight         INTEGER NOT NULL,
  PRIMARY KEY (case_id, hold)
) STRICT;

CREATE TABLE IF NOT EXISTS thresholds (            -- per case and criterion
  case_id                   TEXT NOT NULL,
  criterion                 TEXT NOT NULL,         -- flux | moving_fraction | moved_grains | moved_fraction | reference_transport
  value                     REAL NOT NULL,
  decides                   INTEGER NOT NULL,      -- 1 = the study's own criterion, of which the curve is made
  status                    TEXT NOT NULL,         -- bracketed | censored_below | censored_above | noisy
  shields                   REAL,                  -- theta_c
  shields_lower             REAL,
  shields_upper             REAL,
  method                    TEXT NOT NULL,         -- ramp (screening) | bisect
  stop_lower                REAL,                  -- theta_stop: where a moving bed came to rest, and where it did not
  stop_upper                REAL,
  bed_solid_fraction        REAL,                  -- of the bed that the holds began with, in its bulk
  bed_coordination          REAL,
  shear_shields             REAL,                  -- at which it was sheared before; NULL = as poured
  shear_s                   REAL,                  -- for how long
  shear_flux                REAL,                  -- event flux in the last half of that
  PRIMARY KEY (case_id, criterion, value)
) STRICT;

CREATE TABLE IF NOT EXISTS flux_laws (             -- q* = k (theta - theta_0)^n over the holds that move; no row where none fits
  case_id                   TEXT PRIMARY KEY,
  exponent                  REAL NOT NULL,         -- n: 3 laminar, 1.5 turbulent
  threshold                 REAL NOT NULL,         -- theta_0
  threshold_error           REAL NOT NULL,         -- standard error
  coefficient               REAL NOT NULL,         -- k
  coefficient_error         REAL NOT NULL,
  holds                     INTEGER NOT NULL
) STRICT;

CREATE TABLE IF NOT EXISTS motion_decay (          -- last + (first - last) exp(-t/T) of the moving grains in a hold
  case_id                   TEXT NOT NULL,
  hold                      INTEGER NOT NULL,
  decay_time_s              REAL NOT NULL,         -- T
  decay_time_error_s        REAL NOT NULL,         -- standard error
  first                     REAL NOT NULL,         -- grains that move at the beginning
  last                      REAL NOT NULL,         -- and in the end
  samples                   INTEGER NOT NULL,
  PRIMARY KEY (case_id, hold)
) STRICT;

CREATE TABLE IF NOT EXISTS grain_motion (          -- per hold, over its last half: hops and rests that ended in it
  case_id                   TEXT NOT NULL,
  hold                      INTEGER NOT NULL,
  duration_s                REAL NOT NULL,         -- of that last half
  entrained                 INTEGER NOT NULL,      -- times that a grain left rest
  deposited                 INTEGER NOT NULL,      -- times that one came to rest
  entrainment_per_m2_s      REAL NOT NULL,         -- rates per area of the bed and time
  deposition_per_m2_s       REAL NOT NULL,
  hops                      INTEGER NOT NULL,      -- from rest to rest, begun since the hold did
  hop_length_m              REAL,                  -- downstream: mean, standard deviation, median
  hop_length_deviation_m    REAL,
  hop_length_median_m       REAL,
  hop_duration_s            REAL,
  hop_duration_deviation_s  REAL,
  hop_duration_median_s     REAL,
  rests                     INTEGER NOT NULL,      -- that another hop ended, begun since the hold did
  rest_time_s               REAL,
  rest_time_deviation_s     REAL,
  rest_time_median_s        REAL,
  PRIMARY KEY (case_id, hold)
) STRICT;

CREATE TABLE IF NOT EXISTS hop_histograms (        -- how the hops and rests of grain_motion are spread
  case_id                   TEXT NOT NULL,
  hold                      INTEGER NOT NULL,
  lower                     REAL NOT NULL,         -- of a bin that ends at twice that; in d (lengths), t_d (times)
  hops_by_length            INTEGER NOT NULL,      -- the first bin has all below it too, the last all above
  hops_by_duration          INTEGER NOT NULL,
  rests_by_time             INTEGER NOT NULL,
  PRIMARY KEY (case_id, hold, lower)
) STRICT;

CREATE TABLE IF NOT EXISTS bed_statistics (        -- profiles; hold -1 = the settled bed
  case_id                   TEXT NOT NULL,
  hold                      INTEGER NOT NULL,
  z_m                       REAL NOT NULL,
  porosity                  REAL NOT NULL,
  fluid_velocity_m_per_s    REAL NOT NULL,
  grain_velocity_m_per_s    REAL NOT NULL,
  granular_temperature_m2_per_s2 REAL NOT NULL,
  PRIMARY KEY (case_id, hold, z_m)
) STRICT;

CREATE TABLE IF NOT EXISTS samples (               -- the bed in time, means since the sample before
  case_id                   TEXT NOT NULL,
  time_s                    REAL NOT NULL,
  hold                      INTEGER NOT NULL,
  shields_nominal           REAL NOT NULL,
  shields                   REAL NOT NULL,
  event_flux                REAL NOT NULL,
  moving_fraction           REAL NOT NULL,
  moved_grains              INTEGER NOT NULL,      -- since the hold began
  bed_height_m              REAL NOT NULL,
  roughness_m               REAL NOT NULL,
  coordination              REAL NOT NULL,
  moving_speed_m_per_s      REAL,                  -- mean of the grains that move at this instant; NULL = none does
  deepest_overlap           REAL NOT NULL,         -- of the step sampled, per diameter
  momentum_residual         REAL,
  PRIMARY KEY (case_id, time_s)
) STRICT;

CREATE TABLE IF NOT EXISTS tracks (                -- trajectories of record.tracks
  case_id                   TEXT NOT NULL,
  grain                     INTEGER NOT NULL,
  time_s                    REAL NOT NULL,
  x_m                       REAL NOT NULL,
  y_m                       REAL NOT NULL,
  z_m                       REAL NOT NULL,
  vx_m_per_s                REAL NOT NULL,
  vy_m_per_s                REAL NOT NULL,
  vz_m_per_s                REAL NOT NULL,
  wx_rad_per_s              REAL NOT NULL,
  wy_rad_per_s              REAL NOT NULL,
  wz_rad_per_s              REAL NOT NULL,
  PRIMARY KEY (case_id, grain, time_s)
) STRICT;

CREATE TABLE IF NOT EXISTS models (
  case_id                   TEXT NOT NULL,
  position                  INTEGER NOT NULL,
  term                      TEXT NOT NULL,
  is_on                     INTEGER NOT NULL,
  is_wanted                 INTEGER NOT NULL,      -- by the rules
  ratio                     REAL,                  -- the number that decided
  reason                    TEXT NOT NULL,
  PRIMARY KEY (case_id, term)
) STRICT;

CREATE TABLE IF NOT EXISTS warnings (              -- where the scene is out of range, and which terms are missing
  case_id                   TEXT NOT NULL,
  position                  INTEGER NOT NULL,
  text                      TEXT NOT NULL,
  PRIMARY KEY (case_id, position)
) STRICT;

CREATE TABLE IF NOT EXISTS provenance (
  case_id                   TEXT PRIMARY KEY,
  version                   TEXT NOT NULL,
  physics_version           INTEGER NOT NULL,
  compiler                  TEXT NOT NULL,
  flags                     TEXT NOT NULL,
  libraries                 TEXT NOT NULL,
  host                      TEXT NOT NULL,
  seed                      INTEGER NOT NULL,
  state_digest              TEXT NOT NULL          -- of the final state: the same study gives the same
) STRICT;

CREATE TABLE IF NOT EXISTS variations (            -- cases that differ from one of the study in one respect
  case_id                   TEXT PRIMARY KEY,
  name                      TEXT NOT NULL,         -- bracket | hold | mesh | area: of the error budget
  base_id                   TEXT NOT NULL          -- the case of the study
) STRICT;

CREATE VIEW IF NOT EXISTS error_budget AS          -- per pair: theta_c of the variation relative to that of its case
  SELECT v.name AS source, b.label, b.set_label, b.seed, b.shields AS shields_base, b.shields_lower AS base_lower,
         b.shields_upper AS base_upper, p.shields AS shields_pair, p.shields_lower AS pair_lower,
         p.shields_upper AS pair_upper, p.shields / b.shields - 1 AS difference,
         (b.shields_upper - b.shields_lower) / (b.shields_upper + b.shields_lower)
           + (p.shields_upper - p.shields_lower) / (p.shields_upper + p.shields_lower) AS uncertainty,   -- of the brackets
         v.base_id, v.case_id
  FROM variations v
    JOIN (SELECT * FROM thresholds JOIN scenes USING (case_id) WHERE decides) b ON b.case_id = v.base_id
    JOIN (SELECT * FROM thresholds WHERE decides) p ON p.case_id = v.case_id;

CREATE TABLE IF NOT EXISTS error_sources (         -- per source of the budget, over its pairs: what curve and report say
  source                    TEXT PRIMARY KEY,      -- bracket | hold | mesh | area
  label                     TEXT NOT NULL,         -- of the scene
  packings                  INTEGER NOT NULL,      -- with a threshold of both
  difference                REAL,                  -- mean, relative; NULL = every pair has a censored case
  difference_lower          REAL,                  -- where it lies with 95 %
  difference_upper          REAL,
  scatter_known             INTEGER NOT NULL,      -- 0: one packing, the interval is of the brackets alone
  size                      REAL                   -- what counts: the difference, or the farther bound of one not seen
) STRICT;

CREATE TABLE IF NOT EXISTS trades (                -- per setting of a study with [[trade]], written by `bedload trade`
  setting                   TEXT PRIMARY KEY,
  packings                  INTEGER NOT NULL,      -- with results
  thresholds                INTEGER NOT NULL,      -- of them with a theta_c that is no bound
  core_s                    REAL,                  -- of one packing; NULL = no result
  frontier                  INTEGER NOT NULL,      -- 1 = none is as cheap and as good in theta_c
  shields_difference        REAL,                  -- to the finest setting, relative, and where it lies with 95 %
  shields_lower             REAL,
  shields_upper             REAL,
  flux_difference           REAL,                  -- relative
  flux_lower                REAL,
  flux_upper                REAL,
  height_d_difference       REAL,                  -- in diameters
  height_d_lower            REAL,
  height_d_upper            REAL,
  porosity_difference       REAL,
  porosity_lower            REAL,
  porosity_upper            REAL,
  fall_difference           REAL,                  -- relative
  fall_lower                REAL,
  fall_upper                REAL
) STRICT;

CREATE TABLE IF NOT EXISTS threshold_curve (       -- per parameter set, over its seeds
  label                     TEXT NOT NULL,
  diameter_m                REAL NOT NULL,
  density_ratio             REAL NOT NULL,
  viscosity_m2_per_s        REAL NOT NULL,
  cell_z_d                  REAL NOT NULL,         -- height of the cells, in diameters
  method                    TEXT NOT NULL,         -- ramp (screening) | bisect
  criterion                 TEXT NOT NULL,         -- flux | moving_fraction
  criterion_value           REAL NOT NULL,
  galileo                   REAL,
  friction_reynolds         REAL,                  -- Re* at shields, or at the one bound there is
  shields                   REAL,                  -- theta_50: half of all packings move below it
  shields_16                REAL,                  -- and a deviation of its logarithm below and above; NULL = the
  shields_84                REAL,                  -- distribution is narrower than the brackets
  interval_lower            REAL,                  -- where theta_50 lies with this confidence; NULL = open, or one seed
  interval_upper            REAL,
  confidence                REAL NOT NULL,         -- 0.95; less with fewer than six seeds
  shields_lower             REAL,                  -- lowest bound of a seed; NULL = open
  shields_upper             REAL,                  -- highest bound of a seed; NULL = open
  stop                      REAL,                  -- theta_stop: below it half of all moving beds come to rest
  stop_interval_lower       REAL,
  stop_interval_upper       REAL,
  hysteresis                REAL,                  -- 1 - stop/shields
  systematic                REAL,                  -- relative, of the pairs of error_budget; NULL = mesh not tested
  status                    TEXT NOT NULL,         -- bracketed | censored_below | censored_above | noisy
  seeds                     INTEGER NOT NULL,
  bracketed                 INTEGER NOT NULL,
  censored_below            INTEGER NOT NULL,
  censored_above            INTEGER NOT NULL,
  noisy                     INTEGER NOT NULL,
  parameter_set             TEXT PRIMARY KEY
) STRICT;

CREATE VIEW IF NOT EXISTS transport_curve AS
  SELECT s.label, s.set_label, s.seed, s.diameter_m, s.density_ratio, s.viscosity_m2_per_s, r.hold, r.shields,
         r.friction_reynolds, r.event_flux, r.event_flux_error, r.transport, r.transport_error, r.moving_fraction, r.case_id
  FROM ramp_points r JOIN scenes s USING (case_id)
  ORDER BY s.diameter_m, s.density_ratio, s.viscosity_m2_per_s, s.parameter_set, s.seed, r.hold;
)sql";

}   // namespace bedload
